//! The circuit that a configuration makes: tables, multiplexers, flip-flops, memories and pads, joined by nets.
//!
//! Extraction begins at the pads that can drive and goes backwards, so what no pad depends on is not in it.
//! What each cell does is in its own documentation; nets have names of places: `X12Y3_S0_XQ` is the output XQ of
//! slice 0 of the logic block in column 12, row 3.

mod buses;
mod extract;
mod fault;
mod pads;
mod routing;
mod slices;

pub use extract::extract;
pub use fault::NetlistFault;
pub use routing::{Output, Routing, Source};

use crate::element::{Dll, Io, PortWidth};

/// A net, index into [`Netlist::nets`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NetId(pub u32);

/// What an input of a cell sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Signal {
    /// 0.
    Zero,
    /// 1, as every input that is not routed.
    One,
    /// What some pin drives.
    Net(NetId),
    /// The inverse of a net.
    Not(NetId),
}

impl Signal {
    /// Through an inverter, or not.
    #[must_use]
    pub fn inverted(self, invert: bool) -> Self {
        match self {
            _ if !invert => self,
            Self::Zero => Self::One,
            Self::One => Self::Zero,
            Self::Net(net) => Self::Not(net),
            Self::Not(net) => Self::Net(net),
        }
    }
}

/// A cell: its place, for messages, and what it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// Name of the place: `X12Y3_S0`.
    pub place: String,
    /// What the configuration makes of the place, with its contents.
    pub kind: CellKind,
}

/// What the bits make of a site.
#[derive(Clone, Debug, PartialEq)]
pub enum CellKind {
    /// A table of 16 bits: bit {3, 2, 1, 0 of the inputs} is the output.
    Lut {
        /// Output for inputs of this value, bit by bit.
        table: u16,
        /// Inputs 0..4, which are F1..F4 or G1..G4.
        inputs: [Signal; 4],
        /// The net that it drives.
        output: NetId,
    },
    /// Another name of a signal: the output of an element that passes it on.
    Alias {
        /// What it stands for.
        input: Signal,
        /// Its other name.
        output: NetId,
    },
    /// select ? one : zero.
    Mux {
        /// What it is in the slice.
        role: MuxRole,
        /// Which of the two inputs passes.
        select: Signal,
        /// Passed when `select` is 1.
        one: Signal,
        /// Passed when `select` is 0.
        zero: Signal,
        /// The net that it drives.
        output: NetId,
    },
    /// Exclusive or, of a table and the carry.
    Xor {
        /// What its pins read, the lower first.
        inputs: [Signal; 2],
        /// The net that it drives.
        output: NetId,
    },
    /// And, of the two inputs of a table: for multipliers.
    And {
        /// What its pins read, the lower first.
        inputs: [Signal; 2],
        /// The net that it drives.
        output: NetId,
    },
    /// A flip-flop or latch.
    FlipFlop(FlipFlop),
    /// A shift register of 16 bits, read at an address.
    Shift {
        /// Bits after configuration, newest first.
        init: u16,
        /// Which bit is read: 0 is the newest.
        address: [Signal; 4],
        /// Shifted in.
        data: Signal,
        /// Clock; shifts at its rising edge.
        clock: Signal,
        /// Shifts while 1.
        enable: Signal,
        /// The bit read.
        output: NetId,
    },
    /// A RAM of 16 bits, written at a clock edge and read at once.
    Ram {
        /// Bits after configuration.
        init: u16,
        /// Where it writes.
        write_address: [Signal; 4],
        /// Where it reads.
        read_address: [Signal; 4],
        /// Bit that is stored.
        data: Signal,
        /// Clock; writes at its rising edge.
        clock: Signal,
        /// Writes while all of these are 1.
        enables: [Signal; 2],
        /// The bit read.
        output: NetId,
    },
    /// A bus of three-state buffers. Drivers that disagree give 0, and a bus that nobody drives is 1 here; on silicon
    /// neither is promised, so no design rests on it.
    Bus {
        /// Buffers: what they drive, and 1 while they are off.
        drivers: Vec<(Signal, Signal)>,
        /// Net that all of them drive.
        output: NetId,
    },
    /// 4096 bits behind two ports.
    BlockRam(Box<Memory>),
    /// A delay-locked loop.
    Dll(Box<Loop>),
    /// A global clock buffer.
    ClockBuffer {
        /// CLKIN, from a pad or a net.
        input: Signal,
        /// Passes it while 1.
        enable: Signal,
        /// The output while not enabled.
        idle: bool,
        /// The clock out.
        output: NetId,
    },
}

/// What a multiplexer is in its slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MuxRole {
    /// Of two tables.
    F5,
    /// Of two F5.
    F6,
    /// A carry multiplexer, MUXCY.
    Carry,
}

/// A flip-flop or latch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FlipFlop {
    /// What is stored at the edge.
    pub data: Signal,
    /// Clock: the rising edge, or of a latch the level 1.
    pub clock: Signal,
    /// Takes data while 1.
    pub enable: Signal,
    /// Sets it to `init` while 1.
    pub reset: Signal,
    /// Sets it to the opposite of `init` while 1; `reset` wins.
    pub reverse: Signal,
    /// Reset and reverse act at the clock; otherwise at once.
    pub synchronous: bool,
    /// Transparent while the clock is high, in place of an edge.
    pub latch: bool,
    /// Value after configuration.
    pub init: bool,
    /// The net that it drives.
    pub output: NetId,
}

/// 4096 bits behind two ports.
#[derive(Clone, Debug, PartialEq)]
pub struct Memory {
    /// Ports A and B.
    pub ports: [MemoryPort; 2],
    /// Contents after configuration, 4,096 bits.
    pub contents: Vec<bool>,
}

/// A port of a block RAM.
#[derive(Clone, Debug, PartialEq)]
pub struct MemoryPort {
    /// Words and width.
    pub width: PortWidth,
    /// Clock, rising edge.
    pub clock: Signal,
    /// Nothing happens while 0.
    pub enable: Signal,
    /// Writes while 1; the output shows what is written.
    pub write: Signal,
    /// The output becomes 0 while 1.
    pub reset: Signal,
    /// Address pins 0..12; the upper ones are the address of a word.
    pub address: Vec<Signal>,
    /// Data in, as wide as the port.
    pub data: Vec<Signal>,
    /// Data out, those bits that something uses.
    pub output: Vec<Option<NetId>>,
}

/// A delay-locked loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Loop {
    /// How it is set.
    pub setting: Dll,
    /// CLKIN, from a pad or a net.
    pub clock: Signal,
    /// CLKFB, by which the delay is set.
    pub feedback: Signal,
    /// Starts anew while 1.
    pub reset: Signal,
    /// Outputs that something uses, by name of the pin.
    pub outputs: Vec<(&'static str, NetId)>,
}

/// A pad of the package.
#[derive(Clone, Debug, PartialEq)]
pub struct PadUse {
    /// Pin of the package; none if this pad is not bonded.
    pub pin: Option<u8>,
    /// Name of the ports: `P12`, or of a pad that is not bonded its place.
    pub name: String,
    /// What comes in, if something uses it.
    pub input: Option<NetId>,
    /// What goes out, and 1 while the driver is off; none for inputs.
    pub output: Option<(Signal, Signal)>,
    /// How the block is set; none for clock pads.
    pub io: Option<Io>,
}

/// A circuit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Netlist {
    /// Names of the nets.
    pub nets: Vec<String>,
    /// One for each element in use.
    pub cells: Vec<Cell>,
    /// Pads that are used, by pin.
    pub pads: Vec<PadUse>,
}
