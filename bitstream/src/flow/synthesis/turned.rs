//! Sums that become differences by turning bits over, `s ? ~(~a + b) : a + b`: a sum or, as `~(~a + b)` is `a − b`, a difference.
//!
//! As it is written it takes a table a bit before the chain and one after it. The device's chain adds or takes off by one bit that
//! turns the second operand over and goes into the carry, and both are free.

use std::fmt::Write;
use std::ops::RangeInclusive;

/// How wide. Shorter ones are tables.
const WIDTHS: RangeInclusive<u32> = 4..=32;

fn name(width: u32) -> String {
    format!("turned_sum_{width}")
}

/// A cell of one input and one output word, or of two.
fn cell(kind: &str, width: u32, pins: [&str; 3]) -> String {
    let [a, b, y] = pins;
    let mut text = format!("  cell ${kind} \\{y}_{kind}\n");
    let mut operand = |pin: char, net: &str| {
        write!(
            text,
            "    parameter \\{pin}_SIGNED 0\n    parameter \\{pin}_WIDTH {width}\n    connect \\{pin} \\{net}\n"
        )
        .expect("memory");
    };
    operand('A', a);
    if !b.is_empty() {
        operand('B', b);
    }
    text + &format!("    parameter \\Y_WIDTH {width}\n    connect \\Y \\{y}\n  end\n")
}

/// A multiplexer, `\S ? high : low`.
fn choice(width: u32, [low, high, y]: [&str; 3]) -> String {
    format!(
        "  cell $mux \\{y}_mux\n    parameter \\WIDTH {width}\n    connect \\A \\{low}\n    connect \\B \\{high}\n    connect \\S \
         \\S\n    connect \\Y \\{y}\n  end\n"
    )
}

/// The shapes to look for, as RTLIL.
pub(super) fn shapes() -> String {
    WIDTHS.fold(String::new(), |text, width| {
        let wires: String = ["A input 1", "B input 2", "Y output 4", "turned", "left", "sum", "turned_back"]
            .map(|wire| {
                let (wire, port) = wire.split_once(' ').unwrap_or((wire, ""));
                format!("  wire width {width} {port} \\{wire}\n")
            })
            .concat();
        let cells = [
            cell("not", width, ["A", "", "turned"]),
            choice(width, ["A", "turned", "left"]),
            cell("add", width, ["left", "B", "sum"]),
            cell("not", width, ["sum", "", "turned_back"]),
            choice(width, ["sum", "turned_back", "Y"]),
        ];
        text + &format!("module \\{}\n{wires}  wire input 3 \\S\n{}end\n", name(width), cells.concat())
    })
}

/// What each of them becomes, as Verilog.
pub(super) fn map() -> String {
    WIDTHS.fold(String::new(), |text, width| {
        let word = format!("[{}:0]", width - 1);
        text + &format!(
            "module {} (input {word} A, B, input S, output {word} Y);\n    wire {word} half, carry;\n    \\$alu \
             #(.A_SIGNED(0), .B_SIGNED(0), .A_WIDTH({width}), .B_WIDTH({width}), .Y_WIDTH({width}))\n        \
             _TECHMAP_REPLACE_ (.A(A), .B(B), .CI(S), .BI(S), .X(half), .Y(Y), .CO(carry));\nendmodule\n",
            name(width)
        )
    })
}
