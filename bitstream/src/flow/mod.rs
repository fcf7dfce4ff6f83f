//! From a netlist to a bitstream: map, pack, place, route, set bits, prove them, and what it costs in time.

pub mod bits;
mod build;
pub mod constraints;
mod driver;
mod fabric;
pub mod floorplan;
pub mod logic;
pub mod netlist;
pub mod nets;
pub mod pack;
pub mod place;
mod progress;
pub mod prove;
pub mod reach;
pub mod route;
pub mod synthesis;
pub mod timing;

pub use build::{Built, Resources, build};
pub use driver::Driver;
pub use progress::{Progress, Stage};

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
        /// The line as it stands in the file.
        text: String,
    },
    /// A port that has no usable pin.
    #[error("port {port} {what}")]
    Pad {
        /// As the netlist calls it.
        port: String,
        /// What is wrong.
        what: String,
    },
    /// A net for which there is no way.
    #[error("there is no way for net {net}")]
    Unroutable {
        /// As the netlist calls it.
        net: String,
    },
    /// Nets that could not agree.
    #[error("{wires} wires are wanted by more than one net after {rounds} rounds; try another seed")]
    Congested {
        /// Rounds of negotiation.
        rounds: usize,
        /// Wires still shared.
        wires: usize,
    },
    /// Synthesis failed.
    #[error("synthesis: {what}")]
    Synthesis {
        /// What yosys said.
        what: String,
    },
    /// A rule of the device is broken: a fault of the flow.
    #[error("a fault of the flow: {0}")]
    Rule(#[from] route::RouteFault),
    /// The decoder finds faults in the flow's own bits: a fault of the flow.
    #[error("a fault of the flow: the bits decode with faults: {}", faults.join("; "))]
    Faulty {
        /// Messages of the decoder, one a fault.
        faults: Vec<String>,
    },
    /// The device is too small.
    #[error("the design needs {used} {what}, the device has {there}")]
    Full {
        /// The kind of place that ran out, in the plural.
        what: &'static str,
        /// How many the design needs.
        used: usize,
        /// How many the device has.
        there: usize,
    },
}
