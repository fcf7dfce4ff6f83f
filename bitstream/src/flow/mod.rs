//! From a netlist to a bitstream: map, pack, place, route, set bits, and what it costs in time.

pub mod constraints;
pub mod logic;
pub mod netlist;
pub mod nets;
pub mod pack;
pub mod timing;

use thiserror::Error;

/// Slices of the device.
pub const SLICES: usize = 2_352;

/// Why a design has no bitstream.
#[derive(Debug, Error)]
pub enum FlowError {
    /// The netlist is not one that the flow understands.
    #[error("netlist: {what}")]
    Netlist {
        /// What is wrong, and where.
        what: String,
    },
    /// A line of the constraint file is not understood.
    #[error("constraints, line {line}: `{text}` is not understood")]
    Constraint {
        /// Number of the line, from 1.
        line: usize,
        /// The line.
        text: String,
    },
    /// The device is too small.
    #[error("the design needs {used} {what}, the device has {there}")]
    Full {
        /// Of what.
        what: &'static str,
        /// Needed.
        used: usize,
        /// There are.
        there: usize,
    },
}
