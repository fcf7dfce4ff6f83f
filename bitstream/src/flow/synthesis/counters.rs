//! Counters that are loaded: `load ? word : count ± 1`, found in the design as an adder of one behind which a multiplexer stands.
//!
//! Yosys gives such a counter a table a bit in the carry chain, which only passes the bit on, and a second one for the
//! multiplexer. One is enough (`counter.v`).

use std::fmt::Write;
use std::ops::RangeInclusive;

/// How wide. Through a wider one the load runs for too long: 24 bits are 3.6 ns of carries, and they made the watchdog's counter
/// one of the three slowest paths. Narrower ones are often loaded by what is decoded late: from 4 bits on it was 33 tables
/// fewer, and their slowest path before placement 18.0 ns, where now it is 16.9 ns beside the kicker's.
const WIDTHS: RangeInclusive<u32> = 7..=16;

/// What it is loaded with.
#[derive(Clone, Copy, Eq, PartialEq)]
enum Word {
    Port,
    Fill(char),
}

/// One shape of such a counter.
struct Shape {
    width: u32,
    down: bool,
    /// Whether the multiplexer takes the sum for select 0.
    low: bool,
    word: Word,
}

impl Shape {
    fn all() -> impl Iterator<Item = Self> {
        let words = [Word::Port, Word::Fill('0'), Word::Fill('1')];
        WIDTHS.flat_map(move |width| {
            words.into_iter().flat_map(move |word| {
                [(false, false), (false, true), (true, false), (true, true)].map(|(down, low)| Self {
                    width,
                    down,
                    low,
                    word,
                })
            })
        })
    }

    fn name(&self) -> String {
        let word = match self.word {
            Word::Port => String::new(),
            Word::Fill(digit) => digit.to_string(),
        };
        let (way, side) = (if self.down { "down" } else { "up" }, if self.low { 'A' } else { 'B' });
        format!("count_{way}_{side}{word}_{}", self.width)
    }

    fn fill(&self) -> Option<String> {
        match self.word {
            Word::Port => None,
            Word::Fill(digit) => Some(digit.to_string().repeat(self.width as usize)),
        }
    }
}

/// The shapes to look for, as RTLIL.
pub(super) fn shapes() -> String {
    let mut text = String::new();
    for shape in Shape::all() {
        let (name, width) = (shape.name(), shape.width);
        let (sum, other) = if shape.low { ('A', 'B') } else { ('B', 'A') };
        let (port, word) = match shape.fill() {
            None => (format!("  wire width {width} input 4 \\D\n"), "\\D".to_owned()),
            Some(bits) => (String::new(), format!("{width}'{bits}")),
        };
        write!(
            text,
            "module \\{name}\n  wire width {width} input 1 \\Q\n  wire input 2 \\S\n  wire width {width} output 3 \\Y\n{port}  \
             wire width {width} \\sum\n  cell ${} \\adder\n    parameter \\A_SIGNED 0\n    parameter \\A_WIDTH {width}\n    \
             parameter \\B_SIGNED 0\n    parameter \\B_WIDTH 1\n    parameter \\Y_WIDTH {width}\n    connect \\A \\Q\n    \
             connect \\B 1'1\n    connect \\Y \\sum\n  end\n  cell $mux \\mux\n    parameter \\WIDTH {width}\n    \
             connect \\{sum} \\sum\n    connect \\{other} {word}\n    connect \\S \\S\n    connect \\Y \\Y\n  end\nend\n",
            if shape.down { "sub" } else { "add" },
        )
        .expect("memory");
    }
    text
}

/// What each of them becomes, as Verilog.
pub(super) fn map() -> String {
    let mut text = include_str!("counter.v").to_owned();
    for shape in Shape::all() {
        let (name, width) = (shape.name(), shape.width);
        let (port, word) = match shape.fill() {
            None => (format!("input [{}:0] D, ", width - 1), "D".to_owned()),
            Some(bits) => (String::new(), format!("{width}'b{bits}")),
        };
        writeln!(
            text,
            "module {name} (input [{0}:0] Q, {port}input S, output [{0}:0] Y);\n    loaded_counter #(.WIDTH({width}), \
             .DOWN({1})) _TECHMAP_REPLACE_ (.Q(Q), .D({word}), .load({2}S), .Y(Y));\nendmodule",
            width - 1,
            u32::from(shape.down),
            if shape.low { "" } else { "~" },
        )
        .expect("memory");
    }
    text
}
