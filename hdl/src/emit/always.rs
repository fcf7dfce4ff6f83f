//! One big `always @(*)` cut into independent ones.
//!
//! rust-hdl writes a whole `update` as one process. Seen from outside, every output then depends on
//! every input, and two blocks that talk to each other look like a combinational loop, though no
//! signal depends on itself:
//!
//! ```text
//! always @(*) begin               always @(*) busy = running_q;
//!     busy = running_q;     =>    always @(*) begin
//!     running_d = running_q;          running_d = running_q;
//!     if (start) running_d = 1;       if (start) running_d = 1;
//! end                             end
//! ```
//!
//! Statements stay together, in their order, if they write a common signal, or if one reads what a
//! later one writes. The others find the final value whichever process computes it.

use super::token::{Kind, Token};
use std::collections::{BTreeMap, BTreeSet};

const KEYWORDS: [&str; 8] = ["begin", "end", "if", "else", "case", "endcase", "default", "casez"];

/// A statement with what it touches.
struct Statement<'a> {
    tokens: Vec<Token<'a>>,
    writes: BTreeSet<&'a str>,
    reads: BTreeSet<&'a str>,
    simple: bool,
}

/// The body of a module with its big process cut up; `constants` are no signals.
pub(super) fn cut<'a>(body: &[Token<'a>], constants: &BTreeSet<&str>) -> Vec<Token<'a>> {
    let Some((start, inside, end)) = find(body) else {
        return body.to_vec();
    };
    let statements = statements(&body[inside..end], constants);
    let mut cut = body[..start].to_vec();
    let mut after_line = false;
    for group in groups(&statements) {
        let one = group.len() == 1 && statements[group[0]].simple;
        cut.extend(words(if after_line && !one { "\n" } else { "" }));
        cut.extend(words(if one { "always @(*) " } else { "always @(*) begin\n" }));
        for index in group {
            cut.extend(&statements[index].tokens);
            cut.extend(words("\n"));
        }
        cut.extend(words(if one { "" } else { "end\n\n" }));
        after_line = one;
    }
    cut.extend(&body[end + 1..]);
    cut
}

fn words(text: &'static str) -> Vec<Token<'static>> {
    super::token::tokens(text)
}

/// Where the process begins, its first token inside, and its `end`.
fn find(body: &[Token]) -> Option<(usize, usize, usize)> {
    let solid: Vec<usize> = (0..body.len()).filter(|n| !body[*n].is_blank()).collect();
    let shape = ["always", "@", "(", "*", ")", "begin"];
    let at = solid.windows(shape.len()).find(|w| w.iter().zip(shape).all(|(n, text)| body[*n].is(text)))?;
    let inside = at[shape.len() - 1] + 1;
    let mut depth = 1;
    for (n, token) in body.iter().enumerate().skip(inside) {
        depth += i32::from(token.is("begin")) - i32::from(token.is("end"));
        if depth == 0 {
            return Some((at[0], inside, n));
        }
    }
    None
}

fn statements<'a>(inside: &[Token<'a>], constants: &BTreeSet<&str>) -> Vec<Statement<'a>> {
    let mut found = Vec::new();
    let mut at = 0;
    while at < inside.len() {
        if inside[at].kind == Kind::Space {
            at += 1;
            continue;
        }
        let end = statement_end(inside, at);
        found.push(examine(&inside[at..end], constants));
        at = end;
    }
    found
}

/// One past the statement that begins at or after `at`; comments belong to what follows.
fn statement_end(tokens: &[Token], at: usize) -> usize {
    let solid = |from: usize| (from..tokens.len()).find(|n| !tokens[*n].is_blank());
    let Some(first) = solid(at) else { return tokens.len() };
    let closing = |from: usize, open: &str, close: &str| {
        let mut depth = 0;
        for (n, token) in tokens.iter().enumerate().skip(from) {
            depth += i32::from(token.is(open)) - i32::from(token.is(close));
            if depth == 0 && n > from {
                return n + 1;
            }
        }
        tokens.len()
    };
    match tokens[first].text {
        "begin" => closing(first, "begin", "end"),
        "case" => closing(first, "case", "endcase"),
        "if" => {
            let condition = closing(solid(first + 1).unwrap_or(first), "(", ")");
            let then = statement_end(tokens, condition);
            match solid(then) {
                Some(next) if tokens[next].is("else") => statement_end(tokens, next + 1),
                _ => then,
            }
        }
        _ => (first..tokens.len()).find(|n| tokens[*n].is(";")).map_or(tokens.len(), |n| n + 1),
    }
}

fn examine<'a>(tokens: &[Token<'a>], constants: &BTreeSet<&str>) -> Statement<'a> {
    let solid: Vec<&Token> = tokens.iter().filter(|t| !t.is_blank()).collect();
    let is = |n: usize, text: &str| solid.get(n).is_some_and(|t| t.is(text));
    let mut targets = BTreeSet::new();
    for n in 1..solid.len() {
        let comparison = is(n + 1, "=") || ["=", "!", "<", ">"].iter().any(|c| is(n - 1, c));
        if is(n, "=") && !comparison {
            targets.insert(base(&solid, n - 1));
        }
    }
    let name = |n: &usize| solid[*n].kind == Kind::Ident && !KEYWORDS.contains(&solid[*n].text);
    let names: Vec<usize> = (0..solid.len()).filter(name).collect();
    let text = |n: &usize| solid[*n].text;
    Statement {
        writes: names.iter().filter(|n| targets.contains(n)).map(text).collect(),
        reads: names.iter().filter(|n| !targets.contains(n) && !constants.contains(text(n))).map(text).collect(),
        simple: tokens.iter().all(|t| t.kind != Kind::Comment && !KEYWORDS.contains(&t.text)),
        tokens: tokens.to_vec(),
    }
}

/// The name before `[…]` that ends at `at`.
fn base(solid: &[&Token], at: usize) -> usize {
    let mut depth = 0;
    for n in (0..=at).rev() {
        depth += i32::from(solid[n].is("]")) - i32::from(solid[n].is("["));
        if depth == 0 && solid[n].kind == Kind::Ident {
            return n;
        }
    }
    at
}

/// Statements that must stay together, in their order; groups in the order of their first.
fn groups(statements: &[Statement]) -> Vec<Vec<usize>> {
    let mut leader: Vec<usize> = (0..statements.len()).collect();
    let mut last_write: BTreeMap<&str, usize> = BTreeMap::new();
    for (n, statement) in statements.iter().enumerate() {
        for name in &statement.writes {
            if let Some(earlier) = last_write.insert(name, n) {
                join(&mut leader, earlier, n);
            }
        }
    }
    for (n, statement) in statements.iter().enumerate() {
        for last in statement.reads.iter().filter_map(|name| last_write.get(name)).filter(|last| n < **last) {
            join(&mut leader, *last, n);
        }
    }
    // Processes with the same inputs are as good as one.
    let mut same_inputs: BTreeMap<&BTreeSet<&str>, usize> = BTreeMap::new();
    for group in collect(&leader) {
        let statement = &statements[group[0]];
        if group.len() == 1 && statement.simple {
            let first = *same_inputs.entry(&statement.reads).or_insert(group[0]);
            join(&mut leader, first, group[0]);
        }
    }
    // A process that reads nothing never runs, so constants go with one that does.
    let reads = |group: &[usize]| group.iter().any(|n| !statements[*n].reads.is_empty());
    let (running, idle): (Vec<_>, Vec<_>) = collect(&leader).into_iter().partition(|group| reads(group));
    if let Some(first) = running.first() {
        idle.iter().for_each(|group| join(&mut leader, first[0], group[0]));
    }
    collect(&leader)
}

fn collect(leader: &[usize]) -> Vec<Vec<usize>> {
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for n in 0..leader.len() {
        groups.entry(find_leader(leader, n)).or_default().push(n);
    }
    groups.into_values().collect()
}

fn find_leader(leader: &[usize], of: usize) -> usize {
    let mut at = of;
    while leader[at] != at {
        at = leader[at];
    }
    at
}

fn join(leader: &mut [usize], a: usize, b: usize) {
    let (a, b) = (find_leader(leader, a), find_leader(leader, b));
    leader[a.max(b)] = a.min(b);
}

#[cfg(test)]
mod tests {
    use super::super::token::tokens;
    use super::*;

    fn cut_text(inside: &str) -> String {
        let text = format!("always @(*) begin {inside} end");
        let parts = cut(&tokens(&text), &BTreeSet::from(["K"]));
        let text: String = parts.iter().map(|t| t.text).collect();
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn what_writes_the_same_signal_stays_together_in_order() {
        assert_eq!(
            cut_text("d = q; busy = q2; if (a) d = 1'b1; else if (b == c) begin d[(3)+:(2)] = K; end"),
            "always @(*) begin d = q; if (a) d = 1'b1; else if (b == c) begin d[(3)+:(2)] = K; end end \
             always @(*) busy = q2;"
        );
    }

    #[test]
    fn a_final_value_may_be_read_elsewhere_but_an_intermediate_one_not() {
        assert_eq!(cut_text("n = a; y = n;"), "always @(*) n = a; always @(*) y = n;");
        assert_eq!(cut_text("n = a; y = n; n = b;"), "always @(*) begin n = a; y = n; n = b; end");
    }

    #[test]
    fn constants_run_with_somebody_who_has_inputs() {
        assert_eq!(cut_text("x = K; y = a; z = 1'b0;"), "always @(*) begin x = K; y = a; z = 1'b0; end");
    }

    #[test]
    fn equal_inputs_share_a_process() {
        assert_eq!(
            cut_text(
                "p_clock = clock; r = s; q_clock = clock; case (m) 1: begin t = u; end default: begin t = v; end endcase"
            ),
            "always @(*) begin p_clock = clock; q_clock = clock; end always @(*) r = s; \
             always @(*) begin case (m) 1: begin t = u; end default: begin t = v; end endcase end"
        );
    }
}
