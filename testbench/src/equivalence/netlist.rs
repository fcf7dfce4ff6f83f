//! The netlist that the bits are proven against, as a circuit without memory: gates of its cells, flip-flops and block
//! memories as inputs.

use super::json::{Bit, Module};
use super::miter::{Miter, ONE, Side, ZERO};
use bitstream::flow::netlist::{FlipFlop, Net, Netlist, Signal};
use std::collections::{BTreeMap, HashMap};

/// What a name of the text has become.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub(super) enum Became {
    FlipFlop(usize),
    Constant(bool),
}

/// See the module.
pub(super) struct Gates {
    pub(super) netlist: Netlist,
    became: HashMap<String, Became>,
    /// Pad by port, index into the netlist's.
    pub(super) pads: BTreeMap<String, usize>,
}

impl Gates {
    pub(super) fn of(json: &str, top: &str) -> Result<Self, String> {
        let netlist = Netlist::from_yosys(json, top).map_err(|error| error.to_string())?;
        let module = Module::parse(json, top)?;
        let nets: HashMap<&str, Net> =
            netlist.nets.iter().enumerate().map(|(at, name)| (name.as_str(), Net(at as u32))).collect();
        let flip_flops: HashMap<Net, usize> =
            netlist.flip_flops.iter().enumerate().map(|(at, flop)| (flop.output, at)).collect();
        // The reader keeps one name of a net: it leads to the others.
        let mut kept: HashMap<&Bit, Net> = HashMap::new();
        for (name, bit) in module.names() {
            if let Some(net) = nets.get(name.as_str()) {
                kept.insert(bit, *net);
            }
        }
        let became = module.names().filter_map(|(name, bit)| {
            let became = match bit {
                Bit::Constant(value) if value == "0" || value == "1" => Became::Constant(value == "1"),
                bit => Became::FlipFlop(*flip_flops.get(kept.get(bit)?)?),
            };
            Some((name, became))
        });
        let became = became.collect();
        let pads = netlist.pads.iter().enumerate().map(|(at, pad)| (pad.port.clone(), at)).collect();
        Ok(Self { netlist, became, pads })
    }

    pub(super) fn became(&self, name: &str) -> Option<Became> {
        self.became.get(name).copied()
    }

    /// The signal that shows a flip-flop, or its constant.
    pub(super) fn shows(&self, became: Became) -> String {
        match became {
            Became::FlipFlop(at) => signal(Signal::of(self.netlist.flip_flops[at].output)),
            Became::Constant(value) => if value { ONE } else { ZERO }.to_owned(),
        }
    }

    /// The signal of its next state.
    pub(super) fn next(&self, became: Became) -> String {
        match became {
            Became::FlipFlop(at) => format!("next{at}"),
            Became::Constant(_) => self.shows(became),
        }
    }

    /// The port whose pad clocks a net.
    pub(super) fn clock(&self, net: Net) -> Option<&str> {
        let (from, _) = self.netlist.clock_buffers.iter().find(|(_, to)| *to == net)?;
        let pad = self.netlist.pads.iter().find(|pad| pad.input == Some(*from))?;
        Some(&pad.port)
    }

    /// Builds inputs and gates.
    pub(super) fn build(&self, miter: &mut Miter) -> Result<(), String> {
        let netlist = &self.netlist;
        let own = Side::Netlist;
        netlist.pads.iter().filter_map(|pad| pad.input).for_each(|net| miter.input(&signal(Signal::of(net))));
        for port in netlist.memories.iter().flat_map(|memory| memory.ports.iter().flatten()) {
            port.output.iter().flatten().for_each(|net| miter.input(&signal(Signal::of(*net))));
        }
        for lut in &netlist.luts {
            let rows: Vec<String> = (0..1_usize << lut.inputs.len())
                .filter(|word| lut.table >> word & 1 == 1)
                .map(|word| (0..lut.inputs.len()).map(|input| if word >> input & 1 == 1 { '1' } else { '0' }).collect())
                .collect();
            let rows: Vec<&str> = rows.iter().map(String::as_str).collect();
            let inputs = lut.inputs.iter().enumerate();
            let inputs: Vec<String> = inputs.map(|(at, input)| pin(miter, *input, lut.output, at)).collect();
            let inputs: Vec<&str> = inputs.iter().map(String::as_str).collect();
            miter.gate(own, &inputs, &signal(Signal::of(lut.output)), &rows);
        }
        let three = |inputs: [Signal; 3], output: Net, rows: &[&str], miter: &mut Miter| {
            let inputs: [String; 3] = std::array::from_fn(|at| pin(miter, inputs[at], output, at));
            miter.gate(own, &inputs.each_ref().map(String::as_str), &signal(Signal::of(output)), rows);
        };
        for mux in &netlist.carry_muxes {
            three([mux.select, mux.carry, mux.data], mux.output, &["11-", "0-1"], miter);
        }
        for mux in &netlist.wide_muxes {
            three([mux.select, mux.high, mux.low], mux.output, &["11-", "0-1"], miter);
        }
        for xor in &netlist.carry_xors {
            let inputs = [pin(miter, xor.input, xor.output, 0), pin(miter, xor.carry, xor.output, 1)];
            let output = signal(Signal::of(xor.output));
            miter.gate(own, &inputs.each_ref().map(String::as_str), &output, &["10", "01"]);
        }
        for (at, flop) in netlist.flip_flops.iter().enumerate() {
            self.flip_flop(miter, at, flop)?;
        }
        Ok(())
    }

    fn flip_flop(&self, miter: &mut Miter, at: usize, flop: &FlipFlop) -> Result<(), String> {
        if flop.asynchronous || flop.falling {
            return Err(format!("{}: this proof knows rising clocks and synchronous resets", flop.name));
        }
        let pins = [flop.enable, flop.data, flop.reset];
        let [enable, data, reset]: [String; 3] = std::array::from_fn(|at| pin(miter, pins[at], flop.output, at));
        let shown = signal(Signal::of(flop.output));
        miter.input(&shown);
        let taken = miter.fresh(Side::Netlist, &[&enable, &data, &shown], &["11-", "0-1"]);
        let rows: &[&str] = if flop.reset_value { &["1-", "-1"] } else { &["10"] };
        miter.gate(Side::Netlist, &[&taken, &reset], &format!("next{at}"), rows);
        Ok(())
    }
}

/// The signal at a pin of the cell that drives `owner`; where nothing is joined to it, an input of its own.
fn pin(miter: &mut Miter, at: Signal, owner: Net, index: usize) -> String {
    if at == Signal::Open {
        let open = format!("open{}_{index}", owner.0);
        miter.input(&open);
        return open;
    }
    signal(at)
}

/// The signal at a pin that something is joined to.
pub(super) fn signal(signal: Signal) -> String {
    match signal {
        Signal::Constant(false) => ZERO.into(),
        Signal::Constant(true) => ONE.into(),
        // No gate drives this: a point that reads it is not proven.
        Signal::Open => "nothing".into(),
        Signal::Wire { net, inverted: false } => format!("n{}", net.0),
        Signal::Wire { inverted: true, .. } => unreachable!("the reader puts no inverter before a pin"),
    }
}
