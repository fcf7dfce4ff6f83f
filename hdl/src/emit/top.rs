//! The top module: joins the core to the card's pins.
//!
//! ```text
//!              top                          rust-hdl cannot say "high impedance" for a whole bus
//!        +-------------------+              that some other block drives, so the core has the
//! lad <--+--/ lad_drive      |              three wires and this file the switch
//!        |  <-- lad_out  core|
//!        |  --> lad_in       |
//! pwm[3:0] <-- pwm_0..pwm_3  |              a core may have vectors or single bits
//!        +-------------------+
//! ```

use super::ports::{Direction, PortError, Ports};
use super::verilog;
use crate::board::{Board, BoardError, Buffer};
use fixed_kin::registers::Target;
use rust_hdl::prelude::Block;
use std::collections::BTreeSet;

/// Why core and board do not fit.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TopError {
    /// The board table is no table.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// The core's header cannot be read.
    #[error(transparent)]
    Ports(#[from] PortError),
    /// A board port without a core port.
    #[error(
        "the board has `{port}`, but the core has not {wanted}; add the port to the core or remove it from the board table"
    )]
    NotInCore {
        /// The board's port.
        port: String,
        /// What would have fitted.
        wanted: String,
    },
    /// A core port without pins.
    #[error("the core has `{port}`, but the board has no pin for it; add it to the board table")]
    NotOnBoard {
        /// The core's port.
        port: String,
    },
}

/// The whole chip: top module and core, as one file.
///
/// # Errors
/// If core and board do not fit.
///
/// # Panics
/// If rust-hdl finds the core badly connected.
pub fn chip<B: Block>(core: &B, board: &Board, top: &str) -> Result<String, TopError> {
    let core_name = format!("{top}_core");
    let modules = verilog::modules(core, &core_name);
    let ports = Ports::parse(&modules, &core_name, &[])?;
    Ok(verilog::file(top, &[&wrapper(board, top, &core_name, &ports)?, &modules]))
}

/// The top module for a core with these ports.
///
/// # Errors
/// If core and board do not fit.
pub fn wrapper(board: &Board, top: &str, core: &str, ports: &Ports) -> Result<String, TopError> {
    let (mut header, mut body, mut pins) = (Vec::new(), String::new(), Vec::new());
    let mut used = BTreeSet::new();
    for (port, width) in board.check()? {
        let buffer = board.port(&port)[0].buffer;
        let range = width.map_or_else(String::new, |w| format!("[{}:0] ", w - 1));
        let kind = match buffer {
            Buffer::Bidirectional { .. } => "inout",
            Buffer::Output { .. } => "output",
            _ => "input",
        };
        header.push(format!("{kind} wire {range}{port}"));
        let bits = u32::from(width.unwrap_or(1));
        let connections = if let Buffer::Bidirectional { .. } = buffer {
            body += &format!(
                "    wire {range}{port}_out;\n    wire {port}_drive;\n    \
                 assign {port} = {port}_drive ? {port}_out : {bits}'bz;\n\n"
            );
            let mut all = connect(ports, &port, &format!("{port}_in"), &port, Direction::In, bits)?;
            let inside = |suffix: &str, bits| {
                let name = format!("{port}_{suffix}");
                connect(ports, &port, &name, &name, Direction::Out, bits)
            };
            all.extend(inside("out", bits)?);
            all.extend(inside("drive", 1)?);
            all
        } else {
            let direction = if buffer.drives() { Direction::Out } else { Direction::In };
            // rust-hdl's blocks call their clock `clock`; on the card it is LCLK.
            let alias = port == "lclk" && ports.get("lclk").is_none();
            let name = if alias { "clock" } else { &port };
            connect(ports, &port, name, &port, direction, bits)?
        };
        for (core_port, net) in connections {
            pins.push(format!(".{core_port}({net})"));
            used.insert(core_port);
        }
    }
    for (name, word) in identity(&board.target) {
        if ports.get(name).is_some() {
            pins.push(format!(".{name}({word})"));
            used.insert(name.to_owned());
        }
    }
    if let Some(port) = ports.list.iter().find(|p| !used.contains(&p.name)) {
        return Err(TopError::NotOnBoard { port: port.name.clone() });
    }
    body += &pull_ups(board)?;
    let separator = ",\n    ";
    Ok(format!(
        "module {top} (\n    {}\n);\n\n{body}    {core} core (\n        {}\n    );\nendmodule\n",
        header.join(separator),
        pins.join(",\n        ")
    ))
}

/// What the constraints do on the card, for simulators: a pin that nobody drives is high, not unknown.
fn pull_ups(board: &Board) -> Result<String, TopError> {
    let mut lines = String::new();
    for (port, width) in board.check()? {
        if board.port(&port)[0].buffer == Buffer::PulledUp {
            let nets =
                width.map_or_else(|| vec![port.clone()], |w| (0..w).map(|bit| format!("{port}[{bit}]")).collect());
            lines.extend(nets.iter().map(|net| format!("    pullup ({net});\n")));
        }
    }
    if lines.is_empty() {
        return Ok(lines);
    }
    Ok(format!("`ifndef SYNTHESIS\n    // synthesis translate_off\n{lines}    // synthesis translate_on\n`endif\n\n"))
}

/// The constants by which a core says what board it is on: port and value.
pub(super) fn identity(target: &Target) -> [(&'static str, String); 2] {
    [("board", format!("32'h{:08x}", target.word)), ("clock_hz", format!("32'd{}", target.clock_hz))]
}

/// Core ports for a net: one of the same width, or one bit each.
fn connect(
    ports: &Ports,
    board_port: &str,
    name: &str,
    net: &str,
    direction: Direction,
    bits: u32,
) -> Result<Vec<(String, String)>, TopError> {
    let fits = |name: &str, width| ports.get(name).is_some_and(|p| p.width == width && p.direction == direction);
    if fits(name, bits) {
        return Ok(vec![(name.into(), net.into())]);
    }
    let bit = |n| (format!("{name}_{n}"), format!("{net}[{n}]"));
    let single: Vec<_> = (0..bits).map(bit).collect();
    if bits > 1 && single.iter().all(|(name, _)| fits(name, 1)) {
        return Ok(single);
    }
    let way = if direction == Direction::In { "input" } else { "output" };
    let singles = if bits > 1 { format!(" nor {way}s `{name}_0` to `{name}_{}`", bits - 1) } else { String::new() };
    Err(TopError::NotInCore { port: board_port.into(), wanted: format!("an {way} `{name}` of {bits} bit(s){singles}") })
}
