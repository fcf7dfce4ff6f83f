//! Pins of parts that only repeat another signal, connected to it directly.
//!
//! ```text
//! reg fetch_clock;                                  dff_1 fetch (.clock(clock), …);
//! dff_1 fetch (.clock(fetch_clock), …);      =>
//! always @(*) fetch_clock = clock;
//! ```
//!
//! Half of the lines go, and a simulator sees one clock instead of a hundred that it cannot know to
//! be the same.

use super::token::{Kind, Token};
use std::collections::{BTreeMap, BTreeSet};

/// The body with such pins connected. `ports` are the module's own declarations; `constants` are no
/// signals.
pub(super) fn connect<'a>(body: &[Token<'a>], ports: &[Vec<Token<'a>>], constants: &BTreeSet<&str>) -> Vec<Token<'a>> {
    let solid: Vec<usize> = (0..body.len()).filter(|n| !body[*n].is_blank()).collect();
    let text = |n: usize| solid.get(n).map_or("", |n| body[*n].text);
    let ident = |n: usize| solid.get(n).is_some_and(|n| body[*n].kind == Kind::Ident);
    let mut uses: BTreeMap<&str, usize> = BTreeMap::new();
    for token in body.iter().filter(|t| t.kind == Kind::Ident) {
        *uses.entry(token.text).or_default() += 1;
    }
    let shapes = shapes(body, ports);
    let mut direct: BTreeMap<&str, Token<'a>> = BTreeMap::new();
    let mut dropped: BTreeSet<usize> = BTreeSet::new();
    for at in top_level(body, &solid) {
        let plain = ident(at) && text(at + 1) == "=" && ident(at + 2) && text(at + 3) == ";";
        let (pin, source) = (text(at), text(at + 2));
        // Declared, connected, assigned: nobody else looks at it.
        let private = pin.contains('$') && uses.get(pin) == Some(&3);
        let alike = shapes.get(pin).is_some_and(|shape| shapes.get(source) == Some(shape));
        if plain && private && alike && !constants.contains(source) {
            direct.insert(pin, body[solid[at + 2]]);
            dropped.extend(solid[at]..=solid[at + 3]);
        }
    }
    let mut at = 0;
    while at < body.len() {
        if matches!(body[at].text, "reg" | "wire") && body[at].kind == Kind::Ident {
            let end = (at..body.len()).find(|n| body[*n].is(";")).unwrap_or(body.len() - 1);
            if body[at..end].iter().any(|t| direct.contains_key(t.text)) {
                dropped.extend(at..=end);
            }
            at = end;
        }
        at += 1;
    }
    let kept = body.iter().enumerate().filter(|(n, _)| !dropped.contains(n));
    kept.map(|(_, token)| *direct.get(token.text).unwrap_or(token)).collect()
}

/// Positions (in `solid`) where a statement of the big process begins, outside any condition.
fn top_level(body: &[Token], solid: &[usize]) -> Vec<usize> {
    let is = |n: usize, text: &str| solid.get(n).is_some_and(|n| body[*n].is(text));
    let shape = ["always", "@", "(", "*", ")", "begin"];
    let Some(start) = (0..solid.len()).find(|n| shape.iter().enumerate().all(|(k, text)| is(n + k, text))) else {
        return Vec::new();
    };
    let mut starts = Vec::new();
    let mut depth = 1;
    let mut at = start + shape.len();
    while at < solid.len() && depth > 0 {
        // After `;`, `end` or the head; a branch of an `if` begins with `begin`.
        if depth == 1 && (is(at - 1, ";") || is(at - 1, "end") || is(at - 1, "begin") || is(at - 1, "endcase")) {
            starts.push(at);
        }
        depth += i32::from(is(at, "begin")) + i32::from(is(at, "case"));
        depth -= i32::from(is(at, "end")) + i32::from(is(at, "endcase"));
        at += 1;
    }
    starts
}

/// Sign and range of every declared signal.
fn shapes<'a>(body: &[Token<'a>], ports: &[Vec<Token<'a>>]) -> BTreeMap<&'a str, String> {
    let mut shapes = BTreeMap::new();
    let mut declare = |declaration: &[Token<'a>]| {
        let solid: Vec<_> = declaration.iter().filter(|t| !t.is_blank()).collect();
        let Some((name, rest)) = solid.split_last() else { return };
        let kind = ["reg", "wire", "input", "output", "inout"];
        let shape: Vec<_> = rest.iter().filter(|t| !kind.contains(&t.text)).map(|t| t.text).collect();
        shapes.insert(name.text, shape.concat());
    };
    ports.iter().for_each(|port| declare(port));
    let mut at = 0;
    while at < body.len() {
        let end = || (at..body.len()).find(|n| body[*n].is(";")).unwrap_or(body.len());
        if matches!(body[at].text, "reg" | "wire") && body[at].kind == Kind::Ident {
            let end = end();
            declare(&body[at..end]);
            at = end;
        }
        at += 1;
    }
    shapes
}

#[cfg(test)]
mod tests {
    use super::super::token::tokens;
    use super::*;

    fn connected(text: &str) -> String {
        let port = tokens("input wire clock").into_iter().filter(|t| !t.is_blank()).collect();
        let parts = connect(&tokens(text), &[port], &BTreeSet::from(["K"]));
        let text: String = parts.iter().map(|t| t.text).collect();
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn a_pin_that_repeats_a_signal_is_connected_to_it() {
        assert_eq!(
            connected(
                "reg p$clock; reg p$d; wire p$q; part p(.clock(p$clock), .d(p$d), .q(p$q)); always @(*) begin p$clock = clock; p$d = p$q; if (clock) begin p$d = 1'b0; end end"
            ),
            "reg p$d; wire p$q; part p(.clock(clock), .d(p$d), .q(p$q)); always @(*) begin p$d = p$q; if (clock) begin p$d = 1'b0; end end"
        );
    }

    #[test]
    fn a_pin_is_kept_if_anybody_reads_it_or_it_has_another_shape_or_is_constant_or_conditional() {
        for text in [
            "reg p$a; part p(.a(p$a)); always @(*) begin p$a = clock; y = p$a; end",
            "reg [1:0] p$a; part p(.a(p$a)); always @(*) begin p$a = clock; end",
            "reg p$a; part p(.a(p$a)); always @(*) begin p$a = K; end",
            "reg p$a; part p(.a(p$a)); always @(*) begin p$a = clock & x; end",
            "reg p$a; part p(.a(p$a)); always @(*) begin if (x) begin p$a = clock; end end",
        ] {
            assert_eq!(connected(text), text);
        }
    }
}
