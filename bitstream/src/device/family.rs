//! Families of wires.

/// What a wire is: its length and its place in the interconnect.
///
/// Lengths: Xilinx DS001 (Spartan-II data sheet), "Local Routing" and "General Purpose Routing".
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum WireFamily {
    /// Root of a global clock: output of its buffer.
    ClockRoot,
    /// A global clock in a half row.
    ClockLeaf,
    /// Single-length wire: to the next cell, both ways through pass gates.
    Single,
    /// What a single-length wire drives on.
    SingleBuffer,
    /// Hex wire: six cells, taken off at three and six, driven at either end.
    Hex,
    /// Hex wire that is driven at one end only.
    HexOneWay,
    /// What a hex wire drives on.
    HexBuffer,
    /// Long wire across the device, horizontal.
    LongHorizontal,
    /// Long wire across the device, vertical.
    LongVertical,
    /// Bus of a block RAM column.
    BlockRamBus,
    /// Output multiplexer of a logic block, with its direct connections to the neighbours.
    OutputMux,
    /// Input multiplexer of an element.
    Input,
    /// Output of an element.
    Output,
    /// Anything else: the PCI clock enable, stand-ins at the rim.
    Other,
}

impl WireFamily {
    /// By the wire's name up to its index in brackets.
    pub(super) fn of(name: &str) -> Self {
        let stem = name.split('[').next().unwrap_or(name);
        let starts = |prefix: &str| stem.starts_with(prefix);
        match stem {
            "GCLK_ROOT" => Self::ClockRoot,
            "GCLK" => Self::ClockLeaf,
            _ if starts("SINGLE_") && stem.ends_with("_BUF") => Self::SingleBuffer,
            _ if starts("SINGLE_") => Self::Single,
            _ if starts("HEX_") && stem.ends_with("_BUF") => Self::HexBuffer,
            _ if starts("HEX_H") || starts("HEX_V") => Self::Hex,
            _ if starts("HEX_") => Self::HexOneWay,
            "LH" => Self::LongHorizontal,
            "LV" => Self::LongVertical,
            _ if starts("BRAM_QUAD") => Self::BlockRamBus,
            _ if starts("OMUX") => Self::OutputMux,
            _ if starts("IMUX_") => Self::Input,
            _ if starts("OUT_") => Self::Output,
            _ => Self::Other,
        }
    }
}
