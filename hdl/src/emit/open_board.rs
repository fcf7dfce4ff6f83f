//! The same core on an open board: Lattice's iCE40-HX8K breakout, for which open tools make a bitstream.
//!
//! ```text
//!  12 MHz ─┬─► PLL ─► 33 MHz ─► core ◄── local bus ── serial_host ◄── rx   USB chip of the board
//!          └─────── crystal ──► clock monitor                   └──► tx
//! ```
//!
//! Two modules: `rac_hx8k` with the PLL, and `rac_hx8k_logic`, everything else, which simulators run.
//! Header pins are given to the core's ports in their order. Pull-ups as on the 4I65: an open
//! emergency stop stops, and so does a PLL without lock.

use super::ports::{Direction, PortError, Ports};
use fixed_kin::registers::BOARD_HX8K;
use std::fmt::Write as _;

/// Name of the top and of the files.
pub const NAME: &str = "rac_hx8k";

/// 12 MHz · 88 / 32 = 33 MHz: the serial port counts on it.
const PLL: &str = ".FEEDBACK_PATH(\"SIMPLE\"), .DIVR(4'd0), .DIVF(7'd87), .DIVQ(3'd5), .FILTER_RANGE(3'd1)";

/// Pins of the board's own parts.
const OWN: [(&str, &str); 3] = [("clk_12", "J3"), ("rx", "B10"), ("tx", "B12")];
/// The eight LEDs, high = on.
const LEDS: [&str; 8] = ["B5", "B4", "A2", "A1", "C5", "C4", "B3", "C3"];
/// Free pins of the headers with banks 1 and 2, row by row, from the power pins on.
const HEADER: [&str; 44] = [
    "C16", "D16", "E16", "F16", "G16", "H16", "J15", "G14", "K14", "K15", "M16", "N16", "P16", "B16", "D14", "D15",
    "E14", "F15", "G15", "H14", "F14", "J14", "K16", "L16", "M15", "P15", "R15", "T1", "R2", "R3", "T5", "T6", "T7",
    "T9", "P8", "T10", "T11", "N10", "N12", "T13", "T15", "R16", "T2", "T3",
];

/// Ports of the core that the serial host and the board take.
const TAKEN: [&str; 13] = [
    "board",
    "clock_hz",
    "lclk",
    "synclk",
    "ads_n",
    "blast_n",
    "lw_r",
    "lad_in",
    "lad_out",
    "lad_drive",
    "ready_n",
    "led_n",
    "emergency_stop",
];

/// Why the core cannot go on the board.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum OpenBoardError {
    /// The core's header cannot be read.
    #[error(transparent)]
    Ports(#[from] PortError),
    /// More ports than pins.
    #[error("the core's ports need {needed} pins of the headers, the table has {}; add to it", HEADER.len())]
    Pins {
        /// How many.
        needed: usize,
    },
}

/// A port that goes to the headers.
struct Line {
    name: String,
    width: u32,
    output: bool,
}

fn lines(core: &str, name: &str) -> Result<Vec<Line>, OpenBoardError> {
    let ports = Ports::parse(core, name, &[])?;
    let mut lines: Vec<Line> = vec![Line { name: "emergency_stop".into(), width: 1, output: false }];
    let free = ports.list.iter().filter(|port| !TAKEN.contains(&port.name.as_str()));
    lines.extend(free.map(|port| Line {
        name: port.name.clone(),
        width: port.width,
        output: port.direction == Direction::Out,
    }));
    let needed = lines.iter().map(|line| line.width as usize).sum();
    if needed > HEADER.len() { Err(OpenBoardError::Pins { needed }) } else { Ok(lines) }
}

/// The two modules; `host` is the name of the serial host's module.
///
/// # Errors
/// If the core's ports do not fit the board.
pub fn top(core: &str, core_name: &str, host: &str) -> Result<String, OpenBoardError> {
    let lines = lines(core, core_name)?;
    let (mut header, mut pins) = (String::new(), String::new());
    for (port, word) in super::top::identity(&BOARD_HX8K) {
        let _ = write!(pins, ",\n        .{port}({word})");
    }
    let mut through = String::new();
    for line in &lines {
        let direction = if line.output { "output" } else { "input" };
        let range = if line.width == 1 { String::new() } else { format!("[{}:0] ", line.width - 1) };
        let _ = write!(header, ",\n    {direction} wire {range}{}", line.name);
        let stop = line.name == "emergency_stop";
        let _ = write!(through, ",\n        .{0}({0}{1})", line.name, if stop { " | ~locked" } else { "" });
        let _ = write!(pins, ",\n        .{0}({0})", line.name);
    }
    Ok(format!(
        "module {NAME} (\n    input wire clk_12,\n    input wire rx,\n    output wire tx,\n    output wire [7:0] led{header}\n);\n\n\
         \x20   wire clock;\n    wire locked;\n\n\
         \x20   SB_PLL40_CORE #({PLL}) pll (\n\
         \x20       .REFERENCECLK(clk_12), .PLLOUTGLOBAL(clock), .LOCK(locked), .RESETB(1'b1), .BYPASS(1'b0)\n    );\n\n\
         \x20   {NAME}_logic board (\n        .clock(clock),\n        .crystal(clk_12),\n        .rx(rx),\n        .tx(tx),\n        .led(led){through}\n    );\nendmodule\n\n\
         module {NAME}_logic (\n    input wire clock,\n    input wire crystal,\n    input wire rx,\n    output wire tx,\n    output wire [7:0] led{header}\n);\n\n\
         \x20   wire ads_n;\n    wire blast_n;\n    wire lw_r;\n    wire ready_n;\n    wire lad_drive;\n\
         \x20   wire [31:0] to_core;\n    wire [31:0] from_core;\n    wire [7:0] led_n;\n    assign led = ~led_n;\n\n\
         \x20   {host} host (\n        .clock(clock),\n        .rx(rx),\n        .tx(tx),\n        .ads_n(ads_n),\n        .blast_n(blast_n),\n\
         \x20       .lw_r(lw_r),\n        .to_core(to_core),\n        .from_core(from_core),\n        .ready_n(ready_n)\n    );\n\n\
         \x20   {core_name} core (\n        .lclk(clock),\n        .synclk(crystal),\n        .ads_n(ads_n),\n        .blast_n(blast_n),\n\
         \x20       .lw_r(lw_r),\n        .lad_in(to_core),\n        .lad_out(from_core),\n        .lad_drive(lad_drive),\n        .ready_n(ready_n),\n        .led_n(led_n){pins}\n    );\nendmodule\n"
    ))
}

/// `rac_hx8k.pcf`: the pins.
///
/// # Errors
/// As [`top`].
pub fn constraints(core: &str, core_name: &str) -> Result<String, OpenBoardError> {
    let mut text = format!(
        "# {NAME}: the core on Lattice's iCE40-HX8K breakout board (ct256).\n\
         # Written from hdl/src/emit/open_board.rs; do not edit.\n\
         set_frequency clk_12 12\n"
    );
    for (port, pin) in OWN {
        let _ = writeln!(text, "set_io {port} {pin}");
    }
    for (index, pin) in LEDS.iter().enumerate() {
        let _ = writeln!(text, "set_io led[{index}] {pin}");
    }
    let mut free = HEADER.iter();
    for line in lines(core, core_name)? {
        let pull = if line.output { "" } else { "-pullup yes " };
        for bit in 0..line.width {
            let name = if line.width == 1 { line.name.clone() } else { format!("{}[{bit}]", line.name) };
            let pin = free.next().ok_or(OpenBoardError::Pins { needed: HEADER.len() + 1 })?;
            let _ = writeln!(text, "set_io {pull}{name} {pin}");
        }
    }
    Ok(text)
}
