//! One module of rust-hdl's Verilog, taken apart far enough to be written better.

use super::token::{Kind, Token, tokens};
use std::collections::{BTreeMap, BTreeSet};

/// A module as rust-hdl wrote it.
#[derive(Debug)]
pub(super) struct Module<'a> {
    /// As rust-hdl writes it, with `$` between the parts of its path.
    pub(super) name: &'a str,
    /// Port declarations, each without its semicolon.
    ports: Vec<Vec<Token<'a>>>,
    /// Everything between the header and `endmodule`.
    body: Vec<Token<'a>>,
}

/// The modules of a text, in its order.
pub(super) fn split(text: &str) -> Vec<Module<'_>> {
    let mut modules = Vec::new();
    let mut rest = tokens(text).into_iter();
    while rest.any(|t| t.is("module")) {
        let all: Vec<_> = rest.by_ref().take_while(|t| !t.is("endmodule")).collect();
        let name = all.iter().find(|t| t.kind == Kind::Ident).map_or("", |t| t.text);
        let header = all.iter().position(|t| t.is(";")).map_or(all.len(), |n| n + 1);
        let mut module = Module { name, ports: Vec::new(), body: Vec::new() };
        let mut at = header;
        while at < all.len() {
            let statement = || all[at..].iter().take_while(|t| !t.is(";")).copied();
            if matches!(all[at].text, "input" | "output" | "inout") && all[at].kind == Kind::Ident {
                module.ports.push(statement().filter(|t| !t.is_blank()).collect());
                at += statement().count() + 1;
            } else {
                module.body.push(all[at]);
                at += 1;
            }
        }
        module.drop_unused_constants();
        let constants = module.constants();
        let connected = super::pins::connect(&module.body, &module.ports, &constants);
        module.body = super::always::cut(&connected, &constants);
        modules.push(module);
    }
    modules
}

impl<'a> Module<'a> {
    /// Every identifier but module names.
    pub(super) fn identifiers(&self) -> impl Iterator<Item = &'a str> {
        let parts = self.part_positions();
        let body = self.body.iter().enumerate().filter(move |(n, _)| !parts.contains(n)).map(|(_, t)| t);
        self.ports.iter().flatten().chain(body).filter(|t| t.kind == Kind::Ident).map(|t| t.text)
    }

    /// The modules it instantiates, in order.
    pub(super) fn children(&self) -> Vec<&'a str> {
        self.part_positions().iter().map(|n| self.body[*n].text).collect()
    }

    /// Where in the body a module name stands: `kind name (`.
    fn part_positions(&self) -> Vec<usize> {
        let solid: Vec<_> = self.body.iter().enumerate().filter(|(_, t)| !t.is_blank()).collect();
        let instance = |w: &&[(usize, &Token)]| {
            w[0].1.kind == Kind::Ident
                && w[1].1.kind == Kind::Ident
                && w[2].1.is("(")
                && !matches!(w[0].1.text, "begin" | "end" | "else" | "reg" | "wire" | "task" | "function")
                && !matches!(w[1].1.text, "if" | "case" | "begin")
        };
        solid.windows(3).filter(instance).map(|w| w[0].0).collect()
    }

    /// Width and name (`dff_16`, `dff_6_from_3f`) of a flip-flop of rust-hdl's shape.
    pub(super) fn flip_flop(&self) -> Option<(u32, String)> {
        let port = |name: &str| self.ports.iter().find(|p| p.last().is_some_and(|t| t.is(name)));
        if self.ports.len() != 3 {
            return None;
        }
        let (_, q, _) = (port("d")?, port("q")?, port("clock")?);
        let solid: Vec<_> = self.body.iter().filter(|t| !t.is_blank()).map(|t| t.text).collect();
        let ["initial", "begin", "q", "=", start, ";", "end", rest @ ..] = solid.as_slice() else {
            return None;
        };
        if rest.concat() != "always@(posedgeclock)beginq<=d;end" {
            return None;
        }
        let width =
            q.iter().skip_while(|t| !t.is("[")).nth(1).map_or(Some(1), |t| Some(t.text.parse::<u32>().ok()? + 1))?;
        let digits = start.rsplit(['h', 'b', 'd']).next()?.trim_start_matches('0');
        let from = if digits.is_empty() { String::new() } else { format!("_from_{digits}") };
        Some((width, format!("dff_{width}{from}")))
    }

    /// Names of its `localparam`s.
    fn constants(&self) -> BTreeSet<&'a str> {
        let mut names = BTreeSet::new();
        let mut rest = self.body.iter();
        while rest.any(|t| t.is("localparam")) {
            names.extend(rest.find(|t| t.kind == Kind::Ident && !t.is("signed")).map(|t| t.text));
        }
        names
    }

    /// rust-hdl repeats the values of an enum in every module that has such a signal.
    fn drop_unused_constants(&mut self) {
        let count = |name: &str| self.body.iter().filter(|t| t.kind == Kind::Ident && t.text == name).count();
        let mut kept = Vec::new();
        let mut at = 0;
        while at < self.body.len() {
            let rest = &self.body[at..];
            if rest[0].is("localparam") {
                let length = rest.iter().position(|t| t.is(";")).map_or(rest.len(), |n| n + 1);
                let mut words = rest[1..length].iter().filter(|t| t.kind == Kind::Ident && !t.is("signed"));
                if words.next().is_some_and(|name| count(name.text) == 1) {
                    at += length;
                    continue;
                }
            }
            kept.push(rest[0]);
            at += 1;
        }
        self.body = kept;
    }

    /// The module under a new name, with new names inside.
    pub(super) fn render(&self, title: &str, names: &BTreeMap<&str, String>, part: &dyn Fn(&str) -> String) -> String {
        let rename = |token: &Token| match (token.kind, names.get(token.text)) {
            (Kind::Ident, Some(name)) => name.clone(),
            _ => token.text.to_owned(),
        };
        let ports: Vec<_> = self.ports.iter().map(|port| declaration(port, &rename)).collect();
        let parts = self.part_positions();
        let mut body = String::new();
        for (n, token) in self.body.iter().enumerate() {
            body += &if parts.contains(&n) { part(token.text) } else { rename(token) };
        }
        format!("module {title} (\n    {}\n);\n{}endmodule\n", ports.join(",\n    "), tidy(&body))
    }
}

/// `input wire [3:0] name`.
fn declaration(port: &[Token], rename: &dyn Fn(&Token) -> String) -> String {
    let mut text = String::new();
    for (n, token) in port.iter().enumerate() {
        let in_range = n > 0 && (matches!(token.text, "]" | ":") || matches!(port[n - 1].text, "[" | ":"));
        if n > 0 && !in_range {
            text.push(' ');
        }
        text += &rename(token);
    }
    text
}

/// Single blanks, single empty lines, no titles of empty sections, indentation by nesting.
fn tidy(body: &str) -> String {
    let squeezed = body.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "));
    let lines: Vec<String> = squeezed.collect();
    let title = |line: &str| match line {
        "// Module arguments" | "// Update code" | "// Update code (custom)" => Some(""),
        "// Constant declarations" | "// Enums" => Some("// Constants"),
        "// Stub signals" => Some("// Pins of the parts"),
        "// Local signals" => Some("// Intermediate values"),
        "// Sub module instances" => Some("// Parts"),
        _ => None,
    };
    let mut kept: Vec<&str> = Vec::new();
    for (n, line) in lines.iter().enumerate() {
        let next = lines[n + 1..].iter().find(|l| !l.is_empty());
        let line = match title(line) {
            Some(_) if next.is_none_or(|l| title(l).is_some()) => continue,
            Some(new) => new,
            None => line,
        };
        if line.is_empty() && kept.last().is_none_or(|l| l.is_empty()) {
            continue;
        }
        kept.push(line);
    }
    while kept.last().is_some_and(|l| l.is_empty()) {
        kept.pop();
    }
    let mut text = String::from("\n");
    let mut depth = 1usize;
    for line in &join_short(&kept) {
        let words = || line.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
        let opens = words().filter(|w| matches!(*w, "begin" | "case")).count() + line.matches('(').count();
        let closes = words().filter(|w| matches!(*w, "end" | "endcase")).count() + line.matches(')').count();
        let first_closes = line.starts_with(')') || words().next().is_some_and(|w| matches!(w, "end" | "endcase"));
        let indent = depth - usize::from(first_closes);
        if !line.is_empty() {
            text += &"    ".repeat(indent);
            text += line;
        }
        text.push('\n');
        depth = (depth + opens).saturating_sub(closes).max(1);
    }
    text
}

/// Instances that fit on one line stand on one line.
fn join_short(lines: &[&str]) -> Vec<String> {
    let mut joined = Vec::new();
    let mut at = 0;
    while at < lines.len() {
        let end = lines[at..].iter().position(|l| *l == ");").filter(|_| lines[at].ends_with('('));
        if let Some(end) = end {
            let one = lines[at..=at + end].join(" ").replace("( .", " (.").replace(" );", ");");
            if one.len() <= 110 {
                joined.push(one);
                at += end + 1;
                continue;
            }
        }
        joined.push(lines[at].to_owned());
        at += 1;
    }
    joined
}
