//! What is wrong with a configuration, and where.

use crate::configuration::AttributeError;
use crate::device::{Attribute, Device, TileId};

/// A fault of a configuration that keeps it from being a circuit.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NetlistFault {
    /// Bits of a multiplexer that stand for nothing.
    #[error("{0}")]
    Attribute(#[from] AttributeError),
    /// Two outputs against each other.
    #[error("{wire} is driven by {} and by {}: the two would fight", drivers[0], drivers[1])]
    TwoDrivers {
        /// Tile and name of where it was found.
        wire: String,
        /// What drives it.
        drivers: [String; 2],
    },
    /// Pass gates in a ring.
    #[error("in {tile} the gate between {} and {} closes a ring of pass gates", gate[0], gate[1])]
    GateCycle {
        /// The tile of the gate.
        tile: String,
        /// Its wires.
        gate: [String; 2],
    },
    /// A ring of buffers that drives itself.
    #[error("{wire} drives itself through a ring of switches; no output stands in the ring")]
    Loop {
        /// A wire of the ring.
        wire: String,
    },
    /// Switches that lead to an input, with nothing at their beginning.
    #[error("input {pin} of {element} hangs on {wire}, which no output drives")]
    Floating {
        /// The element, with its tile.
        element: String,
        /// Which input.
        pin: String,
        /// The input's wire.
        wire: String,
    },
    /// An element in a mode whose behaviour is not known.
    #[error("{element} {what}, whose behaviour is not known well enough to simulate")]
    Unsupported {
        /// The element, with its tile.
        element: String,
        /// What it does.
        what: String,
    },
}

impl NetlistFault {
    pub(super) fn unknown_pattern(device: &Device, tile: TileId, attribute: &Attribute, pattern: u64) -> Self {
        Self::Attribute(crate::configuration::bad_pattern(device, tile, attribute, pattern))
    }
}
