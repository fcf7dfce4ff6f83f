//! Pin and timing constraints for Xilinx ISE, from the board table.

use crate::board::{Assignment, Board, BoardError, Buffer};
use std::fmt::Write as _;

/// Setup of the bus signals before LCLK, in nanoseconds, as Mesa constrains the same card.
const OFFSET_IN_NS: &str = "19.5";
/// LCLK to valid bus outputs.
const OFFSET_OUT_NS: &str = "24";

/// The text of `name.ucf`.
///
/// # Errors
/// If the board table contradicts itself.
pub fn ucf(board: &Board, name: &str) -> Result<String, BoardError> {
    board.check()?;
    let mut text = format!(
        "# {name}: {}\n\
         # XC2S200-PQ208. Written from hdl/src/board.rs; do not edit.\n\n",
        board.name
    );
    for assignment in &board.assignments {
        if let Buffer::Clock { period_ns } = assignment.buffer {
            let net = assignment.net();
            let _ = writeln!(text, "NET \"{net}\" TNM_NET = \"{net}\";");
            let _ = writeln!(text, "TIMESPEC \"TS_{net}\" = PERIOD \"{net}\" {period_ns} ns HIGH 50%;");
        }
    }
    let _ = writeln!(text, "OFFSET = IN {OFFSET_IN_NS} ns BEFORE \"lclk\";");
    let _ = writeln!(text, "OFFSET = OUT {OFFSET_OUT_NS} ns AFTER \"lclk\";\n");
    for assignment in &board.assignments {
        text += &net(assignment);
    }
    Ok(text)
}

fn net(assignment: &Assignment) -> String {
    let edges = |fast| if fast { "FAST" } else { "SLOW" };
    let buffer = match assignment.buffer {
        Buffer::Clock { .. } | Buffer::Input => String::new(),
        Buffer::PulledUp => " | PULLUP".into(),
        Buffer::Output { drive_ma, fast } | Buffer::Bidirectional { drive_ma, fast } => {
            format!(" | DRIVE = {drive_ma} | SLEW = {}", edges(fast))
        }
    };
    let place = assignment.place;
    let remark = place.connector().map_or_else(String::new, |(connector, pin)| format!("  # {connector:?} pin {pin}"));
    format!("NET \"{}\" LOC = \"P{}\" | IOSTANDARD = LVTTL{buffer};{remark}\n", assignment.net(), place.pin())
}
