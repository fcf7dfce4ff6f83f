//! What ends a simulation.

use driver::BusError;

/// A simulation that cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum FpgaError {
    /// A register could not be read or written.
    #[error(transparent)]
    Bus(#[from] BusError),
    /// The co-simulation.
    #[error(transparent)]
    Cosim(#[from] crate::cosim::CosimError),
    /// The circuit of a bitstream does not settle.
    #[error(transparent)]
    Circuit(#[from] bitstream::simulation::Unsettled),
    /// Frames that make no circuit.
    #[error("the frames make no circuit: {0}")]
    NoCircuit(String),
    /// The core cannot be emitted.
    #[error("the core cannot be emitted: {0}")]
    Emit(String),
    /// The host took too long.
    #[error(
        "{clocks} clocks went by since the control tick, more than the {quiet} in which encoders may stand still; use a longer control period"
    )]
    Late {
        /// Clocks since the tick.
        clocks: u64,
        /// Clocks in which encoders may stand still.
        quiet: u32,
    },
    /// A motion that no encoder could follow.
    #[error(
        "encoder {axis} would move {counts} counts in a control period of {period} clocks, faster than its filter can follow"
    )]
    TooFast {
        /// Axis, from 1.
        axis: usize,
        /// Counts in the period.
        counts: f64,
        /// Period in clocks.
        period: u32,
    },
}
