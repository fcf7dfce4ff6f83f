//! The design in the terms of the device: tables without constants or inverters, carry chains, pairs of
//! tables under a multiplexer, flip-flops.
//!
//! Inverters and constants vanish into tables and into the inverters that most pins of the device have;
//! what is left at a pin is what its hardware takes.

mod chains;
mod tables;
mod wide;

pub use chains::{Chain, ChainBit, Data};
pub use wide::Wide;

use super::FlowError;
use super::netlist::{FlipFlop, Lut, Memory, Net, Netlist, Pad, Signal};
use std::collections::BTreeMap;

/// A table at one place of a slice: nets as inputs, bit i of `table` is the output for input word i.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Table {
    /// Inputs, lowest index bit first; at most four.
    pub inputs: Vec<Net>,
    /// Output for every word of inputs, repeated over inputs that are not there.
    pub table: u16,
}

impl Table {
    /// The same value for every input word.
    #[must_use]
    pub fn constant(value: bool) -> Self {
        Self { inputs: Vec::new(), table: if value { 0xFFFF } else { 0 } }
    }

    /// A signal as it is: a table of one input or of none.
    #[must_use]
    pub fn of(signal: Signal) -> Self {
        match signal {
            Signal::Constant(value) => Self::constant(value),
            Signal::Open => Self::constant(false),
            Signal::Wire { net, inverted } => Self { inputs: vec![net], table: if inverted { 0x5555 } else { 0xAAAA } },
        }
    }

    /// The same function of other inputs: `pins[i]` is where input i goes (0..4).
    #[must_use]
    pub fn permuted(&self, pins: &[usize]) -> u16 {
        let mut table = 0;
        for word in 0..16_usize {
            let inner = pins.iter().enumerate().fold(0, |inner, (input, pin)| inner | (word >> pin & 1) << input);
            table |= (self.table >> inner & 1) << word;
        }
        table
    }
}

/// A mapped design.
#[derive(Clone, Debug, Default)]
pub struct Logic {
    /// Names of nets.
    pub nets: Vec<String>,
    /// Tables that stand alone, by the net that they drive.
    pub tables: BTreeMap<Net, Table>,
    /// Carry chains.
    pub chains: Vec<Chain>,
    /// Pairs of tables under a multiplexer.
    pub wides: Vec<Wide>,
    /// In the order of the netlist; an index into them stays valid through the flow.
    pub flip_flops: Vec<FlipFlop>,
    /// Block memories.
    pub memories: Vec<Memory>,
    /// With their flip-flops, standards and nets.
    pub pads: Vec<Pad>,
    /// Clock buffers: (net of the pad, net of the clock).
    pub clock_buffers: Vec<(Net, Net)>,
    /// The net that is always 0, if a pin needs one.
    pub ground: Option<Net>,
}

impl Logic {
    /// Maps a netlist.
    ///
    /// # Errors
    /// A carry chain that the device cannot form, or a loop of inverters.
    pub fn of(mut netlist: Netlist) -> Result<Self, FlowError> {
        let luts = std::mem::take(&mut netlist.luts);
        let mut logic = Self { nets: netlist.nets.clone(), ..Self::default() };
        let aliases = tables::simplify(&mut logic, luts, &netlist)?;
        let resolve = |signal: Signal| aliases.resolve(signal);
        for flop in &mut netlist.flip_flops {
            (flop.data, flop.enable, flop.reset) = (resolve(flop.data), resolve(flop.enable), resolve(flop.reset));
        }
        for pad in &mut netlist.pads {
            pad.output = pad.output.map(resolve);
            pad.tristate = resolve(pad.tristate);
        }
        for port in netlist.memories.iter_mut().flat_map(|memory| memory.ports.iter_mut().flatten()) {
            (port.enable, port.reset, port.write) = (resolve(port.enable), resolve(port.reset), resolve(port.write));
            for signal in port.address.iter_mut().chain(&mut port.data) {
                *signal = logic.plain(resolve(*signal));
            }
        }
        for mux in &mut netlist.wide_muxes {
            (mux.select, mux.low, mux.high) = (resolve(mux.select), resolve(mux.low), resolve(mux.high));
        }
        for mux in &mut netlist.carry_muxes {
            (mux.select, mux.carry, mux.data) = (resolve(mux.select), resolve(mux.carry), resolve(mux.data));
        }
        for xor in &mut netlist.carry_xors {
            (xor.input, xor.carry) = (resolve(xor.input), resolve(xor.carry));
        }
        logic.flip_flops = netlist.flip_flops;
        logic.memories = netlist.memories;
        logic.pads = netlist.pads;
        logic.clock_buffers = netlist.clock_buffers;
        wide::build(&mut logic, &netlist.wide_muxes);
        chains::build(&mut logic, netlist.carry_muxes, netlist.carry_xors)?;
        logic.sweep();
        Ok(logic)
    }

    /// A pin without an inverter: a net, a floating pin (which is 1), or the net that is always 0.
    fn plain(&mut self, signal: Signal) -> Signal {
        match signal {
            Signal::Constant(false) => Signal::of(self.ground_net()),
            Signal::Wire { net, inverted: true } => {
                let name = format!("{}$not", self.nets[net.index()]);
                let known = self.tables.iter().find(|(_, table)| table.inputs == [net] && table.table == 0x5555);
                if let Some((output, _)) = known {
                    return Signal::of(*output);
                }
                let output = self.add_net(name);
                self.tables.insert(output, Table::of(signal));
                Signal::of(output)
            }
            Signal::Constant(true) | Signal::Open | Signal::Wire { .. } => signal,
        }
    }

    fn ground_net(&mut self) -> Net {
        if let Some(net) = self.ground {
            return net;
        }
        let net = self.add_net("$ground".into());
        self.tables.insert(net, Table::constant(false));
        self.ground = Some(net);
        net
    }

    fn add_net(&mut self, name: String) -> Net {
        self.nets.push(name);
        Net(u32::try_from(self.nets.len() - 1).expect("fewer than 2^32 nets"))
    }

    /// How many pins read every net, tables apart.
    fn uses(&self) -> Vec<u32> {
        let mut uses = vec![0; self.nets.len()];
        let mut read = |signal: Signal| {
            if let Some(net) = signal.net() {
                uses[net.index()] += 1;
            }
        };
        for flop in &self.flip_flops {
            [flop.data, flop.enable, flop.reset].into_iter().for_each(&mut read);
        }
        for pad in &self.pads {
            pad.output.into_iter().chain([pad.tristate]).for_each(&mut read);
        }
        for port in self.memories.iter().flat_map(|memory| memory.ports.iter().flatten()) {
            [port.enable, port.reset, port.write].into_iter().for_each(&mut read);
            port.address.iter().chain(&port.data).copied().for_each(&mut read);
        }
        for wide in &self.wides {
            read(wide.select);
            wide.low.inputs.iter().chain(&wide.high.inputs).for_each(|net| read(Signal::of(*net)));
        }
        for chain in &self.chains {
            read(chain.carry);
            for bit in &chain.bits {
                bit.table.inputs.iter().for_each(|net| read(Signal::of(*net)));
                if let Data::Pin(net) = bit.data {
                    read(Signal::of(net));
                }
            }
        }
        uses
    }

    /// Drops tables that nothing reads, and lets a chain's table show its output where it can.
    fn sweep(&mut self) {
        let mut uses = self.uses();
        for table in self.tables.values() {
            table.inputs.iter().for_each(|net| uses[net.index()] += 1);
        }
        loop {
            let dead: Vec<Net> = self.tables.keys().copied().filter(|net| uses[net.index()] == 0).collect();
            if dead.is_empty() {
                break;
            }
            for net in dead {
                let table = self.tables.remove(&net).expect("listed");
                table.inputs.iter().for_each(|net| uses[net.index()] -= 1);
            }
        }
        for bit in self.chains.iter_mut().flat_map(|chain| &mut chain.bits) {
            let Some(net) = bit.shows.take() else { continue };
            let same = self.tables.get(&net).is_some_and(|table| *table == bit.table);
            if bit.sum.is_none() && same {
                self.tables.remove(&net);
                bit.shows = Some(net);
            }
        }
    }
}

/// Nets that are another signal under a second name.
pub(crate) struct Aliases(BTreeMap<Net, Signal>);

impl Aliases {
    /// The signal behind all its names.
    pub(crate) fn resolve(&self, mut signal: Signal) -> Signal {
        while let Signal::Wire { net, inverted } = signal {
            let Some(next) = self.0.get(&net) else { break };
            signal = if inverted { next.inverse() } else { *next };
        }
        signal
    }
}

/// A look-up table of the netlist before it is simplified.
pub(crate) type Raw = Lut;
