//! The netlist that yosys writes for this family, as types.
//!
//! Input is the JSON of `write_json` after `synth_xilinx -family xcv -flatten`: look-up tables,
//! carry multiplexers, flip-flops, block memories and buffers, joined by single-bit nets.

mod cells;

use super::FlowError;
use std::collections::BTreeMap;

/// A net: an index into [`Netlist::nets`].
#[derive(Clone, Copy, Debug, Eq, Hash, Ord, PartialEq, PartialOrd)]
pub struct Net(pub u32);

impl Net {
    /// Position in [`Netlist::nets`].
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// What stands at an input pin.
#[derive(Clone, Copy, Debug, Eq, Hash, Ord, PartialEq, PartialOrd)]
pub enum Signal {
    /// Tied to 0 or 1.
    Constant(bool),
    /// Nothing: any value will do.
    Open,
    /// A net, seen through an inverter or not.
    Wire {
        /// Who drives the pin.
        net: Net,
        /// Whether the pin sees the opposite.
        inverted: bool,
    },
}

impl Signal {
    /// The net without inversion.
    #[must_use]
    pub fn of(net: Net) -> Self {
        Self::Wire { net, inverted: false }
    }

    /// The net, if there is one.
    #[must_use]
    pub fn net(self) -> Option<Net> {
        if let Self::Wire { net, .. } = self { Some(net) } else { None }
    }

    /// The opposite; an open pin stays open.
    #[must_use]
    pub fn inverse(self) -> Self {
        match self {
            Self::Constant(value) => Self::Constant(!value),
            Self::Open => Self::Open,
            Self::Wire { net, inverted } => Self::Wire { net, inverted: !inverted },
        }
    }
}

/// A look-up table of up to four inputs; bit i of the table is the output for inputs i (first input lowest).
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Lut {
    /// Inputs, lowest index bit first.
    pub inputs: Vec<Signal>,
    /// Output for every input word.
    pub table: u16,
    /// The net that it drives.
    pub output: Net,
}

/// A D flip-flop with enable and one reset.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct FlipFlop {
    /// Name of the cell, by which proofs find it again.
    pub name: String,
    /// Clock net, after its buffer.
    pub clock: Net,
    /// Counts falling edges.
    pub falling: bool,
    /// Clock enable, active high.
    pub enable: Signal,
    /// What is stored at the edge.
    pub data: Signal,
    /// Reset or set, active high.
    pub reset: Signal,
    /// Value that `reset` forces.
    pub reset_value: bool,
    /// Whether `reset` acts without a clock.
    pub asynchronous: bool,
    /// Value after configuration; `None` if the source defines none.
    pub initial: Option<bool>,
    /// Net that Q drives.
    pub output: Net,
}

/// One port of a block memory.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct MemoryPort {
    /// Width of a word: 1, 2, 4, 8 or 16 bits.
    pub width: usize,
    /// Net that clocks the port, at its rising edge.
    pub clock: Net,
    /// Port enable.
    pub enable: Signal,
    /// Clears the output register.
    pub reset: Signal,
    /// Write enable.
    pub write: Signal,
    /// Word address, lowest bit first.
    pub address: Vec<Signal>,
    /// Data in, lowest bit first.
    pub data: Vec<Signal>,
    /// Data out, lowest bit first; `None` where nothing reads it.
    pub output: Vec<Option<Net>>,
}

/// A block memory of 4,096 bits.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Memory {
    /// Name of the cell.
    pub name: String,
    /// Ports A and B.
    pub ports: [Option<MemoryPort>; 2],
    /// Contents at configuration, 64 words of 64 bits, lowest first.
    pub contents: [u64; 64],
}

/// A pad of the package with its buffers.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Pad {
    /// Port of the design, `name` or `name[index]`.
    pub port: String,
    /// The net that the input buffer drives.
    pub input: Option<Net>,
    /// What the output buffer is given; `None` for an input.
    pub output: Option<Signal>,
    /// High: the output is off. Only with `output`.
    pub tristate: Signal,
}

/// Multiplexer of the carry: `output = select ? carry : data`.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct CarryMux {
    /// Propagate: 1 passes the carry on, 0 takes `data`.
    pub select: Signal,
    /// From the bit below, or into the chain.
    pub carry: Signal,
    /// Generate: the carry out where nothing is propagated.
    pub data: Signal,
    /// Carry out.
    pub output: Net,
}

/// Sum of a carry chain: `output = input ^ carry`.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct CarryXor {
    /// Half sum.
    pub input: Signal,
    /// From the bit below, or into the chain.
    pub carry: Signal,
    /// Sum of this bit.
    pub output: Net,
}

/// A multiplexer of two tables: `output = select ? high : low`.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct WideMux {
    /// Chooses `high` where it is 1.
    pub select: Signal,
    /// For select 0.
    pub low: Signal,
    /// For select 1.
    pub high: Signal,
    /// The net that the cell drives.
    pub output: Net,
    /// Second level (MUXF6).
    pub second: bool,
}

/// A flat netlist.
#[derive(Clone, Debug, Default)]
pub struct Netlist {
    /// Name of the top module.
    pub top: String,
    /// Names of nets, the shortest that the source has for each.
    pub nets: Vec<String>,
    /// Look-up tables and inverters.
    pub luts: Vec<Lut>,
    /// Carry multiplexers.
    pub carry_muxes: Vec<CarryMux>,
    /// Gates that add the carry to a sum.
    pub carry_xors: Vec<CarryXor>,
    /// Wide multiplexers.
    pub wide_muxes: Vec<WideMux>,
    /// FD cells of any kind, in the order of the file.
    pub flip_flops: Vec<FlipFlop>,
    /// Block memories.
    pub memories: Vec<Memory>,
    /// Buffers of inputs, outputs and both.
    pub pads: Vec<Pad>,
    /// Clock buffers: (input net, output net).
    pub clock_buffers: Vec<(Net, Net)>,
}

impl Netlist {
    /// Reads the JSON of yosys.
    ///
    /// # Errors
    /// Text that is no such JSON, a missing top module, or a cell that this family's flow does not know.
    pub fn from_yosys(text: &str, top: &str) -> Result<Self, FlowError> {
        let json: serde_json::Value = serde_json::from_str(text)
            .map_err(|error| FlowError::Netlist { what: format!("not the JSON of yosys: {error}") })?;
        let module = &json["modules"][top];
        if !module.is_object() {
            return Err(FlowError::Netlist { what: format!("no module {top}") });
        }
        let names = Names::of(module);
        cells::read(module, top, names)
    }

    /// A new net.
    pub fn add_net(&mut self, name: String) -> Net {
        self.nets.push(name);
        Net(u32::try_from(self.nets.len() - 1).expect("fewer than 2^32 nets"))
    }
}

/// Nets by the bit numbers of yosys.
struct Names {
    nets: BTreeMap<u64, Net>,
    names: Vec<String>,
}

impl Names {
    fn of(module: &serde_json::Value) -> Self {
        let mut best: BTreeMap<u64, String> = BTreeMap::new();
        for (name, net) in module["netnames"].as_object().into_iter().flatten() {
            let bits: Vec<_> = net["bits"].as_array().into_iter().flatten().collect();
            for (index, bit) in bits.iter().enumerate() {
                let Some(bit) = bit.as_u64() else { continue };
                let full = if bits.len() == 1 { name.clone() } else { format!("{name}[{index}]") };
                let rank = |name: &str| (name.starts_with('$'), name.len());
                let entry = best.entry(bit).or_insert_with(|| full.clone());
                if (rank(&full), full.as_str()) < (rank(entry), entry.as_str()) {
                    *entry = full;
                }
            }
        }
        let mut names = Self { nets: BTreeMap::new(), names: Vec::new() };
        for (bit, name) in best {
            names.add(bit, name);
        }
        names
    }

    fn add(&mut self, bit: u64, name: String) -> Net {
        let net = Net(u32::try_from(self.names.len()).expect("fewer than 2^32 nets"));
        self.names.push(name);
        self.nets.insert(bit, net);
        net
    }

    fn net(&mut self, bit: u64) -> Net {
        let known = self.nets.get(&bit).copied();
        known.unwrap_or_else(|| self.add(bit, format!("${bit}")))
    }
}
