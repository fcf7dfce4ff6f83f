//! What other tools think of an emitted text, and a gate on it.
//!
//! rust-hdl's simulation and its Verilog can differ in silence; one such case shows as a width
//! warning of one kind: an operator whose own width is *less* than the target's, so that a carry
//! or a sign is lost before the value is extended.
//!
//! | finding | passes the gate |
//! |---|---|
//! | `WIDTH`, operator narrower than its target | no |
//! | `WIDTH`, plain signal wider than its target | no |
//! | `WIDTH`, arithmetic narrower than the mask, shift or comparison it is in | no |
//! | `COMPARED`, arithmetic inside a comparison or a shift to the right | no |
//! | `WIDTH`, other (32-bit literals in arithmetic and comparisons) | yes |
//! | `DECLFILENAME`, `UNUSED…`, `VARHIDDEN` | yes |
//! | anything else: `LATCH`, `COMBDLY`, `MULTIDRIVEN`, `UNOPTFLAT`, `UNDRIVEN`, `CASEINCOMPLETE`, … | no |

use super::{CosimError, folder};
use hdl::emit::token::tokens;
use std::fmt;
use std::path::Path;

/// Kinds that say nothing about the circuit.
const HARMLESS: [&str; 5] = ["DECLFILENAME", "UNUSED", "UNUSEDPARAM", "UNUSEDSIGNAL", "VARHIDDEN"];

/// Verilator's names of the operators whose result depends on the high bits of an operand.
const HIGH_BITS_COUNT: [&str; 9] = ["AND", "SHIFTR", "EQ", "NEQ", "LT", "LTE", "GT", "GTE", "DIV"];

/// One remark of a tool.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Who complains: verilator, icarus or yosys.
    pub tool: &'static str,
    /// The tool's name for it: `WIDTH`, `LATCH`; `ERROR` where it has none.
    pub kind: String,
    /// Line in the text, 1-based; 0 if unknown.
    pub line: u32,
    /// What the tool says, first line.
    pub message: String,
    /// That line of the text.
    pub source: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "  {} {} line {}: {}\n      {}", self.tool, self.kind, self.line, self.message, self.source.trim())
    }
}

impl Finding {
    /// Whether it may hide a wrong circuit.
    #[must_use]
    pub fn is_fatal(&self) -> bool {
        if self.kind == "WIDTH" {
            return width_loses(&self.message);
        }
        !HARMLESS.contains(&self.kind.as_str())
    }
}

/// `Operator ASSIGN expects 17 bits on the Assign RHS, but Assign RHS's SUB generates 16 bits.`
fn width_loses(message: &str) -> bool {
    let Some(rest) = message.strip_prefix("Operator ") else {
        // A port connection of the wrong width is never benign.
        return true;
    };
    let number = |after: &str| {
        let digits = &rest[rest.find(after)? + after.len()..];
        digits.split_whitespace().next()?.parse::<u32>().ok()
    };
    let (Some(target), Some(source)) = (number("expects "), number("generates ")) else {
        return true;
    };
    let operator = rest.split_whitespace().next().unwrap_or("");
    let is = |kinds: &[&str]| kinds.iter().any(|kind| rest.contains(&format!("HS's {kind} ")));
    if operator.starts_with("ASSIGN") {
        return if source < target { !is(&["CONST"]) } else { is(&["VARREF", "SEL"]) };
    }
    // Arithmetic that the Verilog does in more bits than the simulation did, where those bits count.
    HIGH_BITS_COUNT.contains(&operator) && source < target && is(&["ADD", "SUB", "NOT", "NEGATE", "MUL", "SHIFTL"])
}

/// Everything Verilator has to say with all warnings on.
///
/// # Errors
/// If Verilator is missing or the files cannot be written.
pub fn verilator(name: &str, verilog: &str, top: &str) -> Result<Vec<Finding>, CosimError> {
    in_scratch(name, verilog, |folder| {
        let arguments = ["--lint-only", "-Wall", "-Wno-fatal", "--top-module", top, "design.v"];
        let output = folder::call("verilator", &arguments, folder)?;
        Ok(parse_verilator(&folder::both(&output), verilog))
    })
}

/// What yosys finds: undriven or doubly driven wires, combinational loops, latches.
///
/// # Errors
/// If yosys is missing or the files cannot be written.
pub fn yosys(name: &str, verilog: &str, top: &str) -> Result<Vec<Finding>, CosimError> {
    in_scratch(name, verilog, |folder| {
        let script = format!(
            "read_verilog design.v; hierarchy -check -top {top}; proc; flatten; opt_clean; check -assert; \
             select -assert-none t:$dlatch t:$adlatch t:$dlatchsr"
        );
        let output = folder::call("yosys", &["-Q", "-T", "-p", &script], folder)?;
        let said = folder::both(&output);
        let fails = |line: &&str| {
            // That a tri-state bus is no subject for yosys is known; its other remarks count.
            let tristate = line.contains("limited support for tri-state");
            line.starts_with("ERROR:")
                || (line.starts_with("Warning:") && !line.contains("found and reported") && !tristate)
        };
        let finding = |line: &str| Finding {
            tool: "yosys",
            kind: if line.contains("latch") { "LATCH" } else { "CHECK" }.into(),
            line: 0,
            message: line.into(),
            source: String::new(),
        };
        let mut findings: Vec<_> = said.lines().filter(fails).map(finding).collect();
        if !output.status.success() && findings.is_empty() {
            findings.push(finding(said.lines().last().unwrap_or("yosys failed without a word")));
        }
        Ok(findings)
    })
}

/// What Icarus says as Verilog-2001 with all warnings.
///
/// # Errors
/// If Icarus is missing or the files cannot be written.
pub fn icarus(name: &str, verilog: &str, top: &str) -> Result<Vec<Finding>, CosimError> {
    in_scratch(name, verilog, |folder| {
        // Without a time unit in the text, Icarus' remark about it is about nothing.
        let arguments = ["-g2001", "-Wall", "-Wno-timescale", "-s", top, "-o", "design.vvp", "design.v"];
        let output = folder::call("iverilog", &arguments, folder)?;
        let finding = |line: &str| Finding {
            tool: "iverilog",
            kind: if line.contains("warning") { "WARNING" } else { "ERROR" }.into(),
            line: line.split(':').nth(1).and_then(|n| n.parse().ok()).unwrap_or(0),
            message: line.into(),
            source: String::new(),
        };
        Ok(folder::both(&output).lines().map(finding).collect())
    })
}

/// Arithmetic whose result is compared or shifted right before it is stored.
///
/// rust-hdl computes `(a + 1) == 0` in the width of `a`; its Verilog reads `(a + 32'h1) == 32'h0`
/// and never wraps. No tool warns, so this looks at the text: an operand in parentheses that
/// contains `+`, `-`, `*`, `~` or `<<`.
#[must_use]
pub fn compared_arithmetic(verilog: &str) -> Vec<Finding> {
    let mut line = 1;
    let mut all = Vec::new();
    for token in tokens(verilog) {
        if !token.is_blank() {
            all.push((token.text, line));
        }
        line += u32::try_from(token.text.matches('\n').count()).unwrap_or(0);
    }
    let text = |at: usize| all.get(at).map_or("", |t| t.0);
    let mut findings = Vec::new();
    for at in 1..all.len() {
        let end = match (text(at), text(at + 1)) {
            ("=" | "!" | "<" | ">", "=") | (">", ">") => at + 2,
            ("<" | ">", _) if !matches!(text(at - 1), "<" | ">") => at + 1,
            _ => continue,
        };
        let left = group(&all, at - 1, false);
        let right = if text(end) == ")" { &[] } else { group(&all, end, true) };
        let sums = |group: &[(&str, u32)]| {
            let mut depth = 0;
            group.windows(2).any(|pair| {
                depth += i32::from(pair[0].0 == "[") - i32::from(pair[0].0 == "]");
                depth == 0 && (matches!(pair[0].0, "+" | "-" | "*" | "~") || (pair[0].0 == "<" && pair[1].0 == "<"))
            })
        };
        if sums(left) || sums(right) {
            findings.push(Finding {
                tool: "racbot",
                kind: "COMPARED".into(),
                line: all[at].1,
                message: "arithmetic inside a comparison or shift; store it in a Local of its exact width first".into(),
                source: verilog.lines().nth(all[at].1 as usize - 1).unwrap_or("").into(),
            });
        }
    }
    findings
}

/// The tokens of the parenthesised group that begins or ends at `at`; empty if there is none.
fn group<'a, 'b>(all: &'a [(&'b str, u32)], at: usize, forward: bool) -> &'a [(&'b str, u32)] {
    let (open, close) = if forward { ("(", ")") } else { (")", "(") };
    let mut depth = 0;
    let mut here = at;
    while let Some((text, _)) = all.get(here) {
        depth += i32::from(*text == open) - i32::from(*text == close);
        if depth == 0 {
            return if here == at { &[] } else { &all[here.min(at)..=here.max(at)] };
        }
        let Some(next) = (if forward { here.checked_add(1) } else { here.checked_sub(1) }) else {
            break;
        };
        here = next;
    }
    &[]
}

/// The gate: all three tools and [`compared_arithmetic`] must find nothing that may hide a wrong circuit. Gives the harmless
/// findings.
///
/// # Errors
/// With the fatal findings, or if a tool is missing.
pub fn gate(name: &str, verilog: &str, top: &str) -> Result<Vec<Finding>, CosimError> {
    let mut all = verilator(name, verilog, top)?;
    all.extend(yosys(name, verilog, top)?);
    all.extend(icarus(name, verilog, top)?);
    all.extend(compared_arithmetic(verilog));
    let (fatal, harmless): (Vec<_>, Vec<_>) = all.into_iter().partition(Finding::is_fatal);
    if fatal.is_empty() {
        return Ok(harmless);
    }
    Err(CosimError::Lint { name: name.into(), findings: fatal.iter().map(ToString::to_string).collect() })
}

fn in_scratch<T>(
    name: &str,
    verilog: &str,
    work: impl FnOnce(&Path) -> Result<T, CosimError>,
) -> Result<T, CosimError> {
    let folder = folder::fresh(&folder::root(), &format!("{}-lint", super::verilated::plain(name)))?;
    folder::write(&folder.join("design.v"), verilog)?;
    let result = work(&folder);
    let _ = std::fs::remove_dir_all(&folder);
    result
}

/// `%Warning-WIDTH: design.v:12:7: message`, or `%Error: design.v:12:7: message`.
fn parse_verilator(said: &str, verilog: &str) -> Vec<Finding> {
    let lines: Vec<_> = verilog.lines().collect();
    let parse = |text: &str| {
        let (kind, rest) = match text.strip_prefix("%Warning") {
            Some(rest) => rest.strip_prefix('-').unwrap_or(rest).split_once(": ")?,
            None => ("ERROR", text.strip_prefix("%Error")?.split_once(": ")?.1),
        };
        let located = rest.strip_prefix("design.v:").and_then(|r| {
            let (line, rest) = r.split_once(':')?;
            let (_, message) = rest.split_once(": ")?;
            Some((line.parse().ok()?, message))
        });
        let (line, message): (u32, _) = located.unwrap_or((0, rest));
        let source = (line as usize).checked_sub(1).and_then(|n| lines.get(n)).copied().unwrap_or("");
        Some(Finding {
            tool: "verilator",
            kind: kind.into(),
            line,
            message: message.trim().into(),
            source: source.into(),
        })
    };
    said.lines().filter_map(parse).collect()
}
