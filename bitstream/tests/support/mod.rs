//! Small designs by hand: elements set one by one, wires found by breadth-first search, and a simulator of netlists.

use bitstream::configuration::Configuration;
use bitstream::device::{BelKind, Device, PadSite, TileId, WireId};
use bitstream::element::{Driver, InputBuffer, Io};
use bitstream::netlist::{CellKind, NetId, Netlist, NetlistFault, Signal, extract};
use std::collections::{HashMap, HashSet, VecDeque};

/// A design that is being made.
pub(crate) struct Design {
    pub(crate) device: &'static Device,
    pub(crate) configuration: Configuration,
    /// Wires taken, with the net's first wire.
    taken: HashMap<WireId, WireId>,
}

impl Design {
    pub(crate) fn new() -> Self {
        let device = Device::xc2s200();
        Self { device, configuration: Configuration::blank(device), taken: HashMap::new() }
    }

    pub(crate) fn clb(&self, column: u8, row: u8) -> TileId {
        self.device.tile_at("CLB", column, row).expect("a logic block")
    }

    pub(crate) fn slice_pin(&self, tile: TileId, index: u8, pin: &str) -> WireId {
        self.device.pin(tile, BelKind::Slice, index, pin).expect("a pin")
    }

    fn site(&self, pin: u8) -> (TileId, u8, PadSite) {
        let site = self.device.pad(pin).expect("a pin").site;
        let PadSite::Io { tile, index, .. } = site else { panic!("P{pin} is no input/output") };
        (tile, index, site)
    }

    /// Makes a pin an input; its wire.
    pub(crate) fn input(&mut self, pin: u8) -> WireId {
        let (tile, index, site) = self.site(pin);
        let io = Io { input: InputBuffer::Cmos, ..Io::default() };
        io.write(self.device, &mut self.configuration, site).expect("a pad");
        self.device.pin(tile, BelKind::Io, index, "I").expect("a pin")
    }

    /// Makes a pin an output of a wire, always on.
    pub(crate) fn output(&mut self, pin: u8, from: WireId) {
        let (tile, index, site) = self.site(pin);
        let standard = self.device.standard("LVTTL.12").expect("a standard");
        let io = Io { driver: Driver::of(standard, false), invert_o: false, invert_t: true, ..Io::default() };
        io.write(self.device, &mut self.configuration, site).expect("a pad");
        let to = self.device.pin(tile, BelKind::Io, index, "O").expect("a pin");
        self.route(from, to);
    }

    /// Joins two wires by the fewest switches that no other net has.
    pub(crate) fn route(&mut self, from: WireId, to: WireId) {
        let mut came: HashMap<WireId, (WireId, bitstream::device::PipId)> = HashMap::new();
        let mut queue: VecDeque<WireId> =
            self.taken.iter().filter(|(_, net)| **net == from).map(|(wire, _)| *wire).collect();
        queue.make_contiguous().sort_unstable();
        queue.push_front(from);
        let mut seen: HashSet<WireId> = queue.iter().copied().collect();
        while let Some(wire) = queue.pop_front() {
            if wire == to {
                break;
            }
            for arc in self.device.arcs(wire) {
                let free = self.taken.get(&arc.to).is_none_or(|net| *net == from);
                if free && seen.insert(arc.to) {
                    came.insert(arc.to, (wire, arc.pip));
                    queue.push_back(arc.to);
                }
            }
        }
        let mut at = to;
        self.taken.insert(from, from);
        while let Some((before, pip)) = came.get(&at) {
            self.configuration.set_pip(self.device, *pip);
            self.taken.insert(at, from);
            at = *before;
        }
        assert_eq!(self.taken.get(&at), Some(&from), "no way to {}", self.device.describe_wire(to));
    }

    pub(crate) fn netlist(&self) -> Result<Netlist, Vec<NetlistFault>> {
        extract(self.device, &self.configuration)
    }

    pub(crate) fn simulate(&self) -> Simulator {
        Simulator::new(self.netlist().expect("a circuit"))
    }
}

/// Runs a netlist with one clock, by names of pads.
pub(crate) struct Simulator {
    pub(crate) netlist: Netlist,
    values: Vec<bool>,
    stored: HashMap<u32, u16>,
}

impl Simulator {
    pub(crate) fn new(netlist: Netlist) -> Self {
        let mut simulator = Self { values: vec![false; netlist.nets.len()], stored: HashMap::new(), netlist };
        for cell in &simulator.netlist.cells {
            match &cell.kind {
                CellKind::FlipFlop(register) => simulator.values[register.output.0 as usize] = register.init,
                CellKind::Shift { init, output, .. } | CellKind::Ram { init, output, .. } => {
                    simulator.stored.insert(output.0, *init);
                }
                _ => {}
            }
        }
        simulator.settle();
        simulator
    }

    pub(crate) fn set(&mut self, pin: u8, value: bool) {
        // An input on which nothing depends is not in the netlist.
        let Some(net) = self.netlist.pads.iter().find(|pad| pad.pin == Some(pin)).and_then(|pad| pad.input) else {
            return;
        };
        self.values[net.0 as usize] = value;
        self.settle();
    }

    pub(crate) fn get(&self, pin: u8) -> bool {
        let pad = self.netlist.pads.iter().find(|pad| pad.pin == Some(pin)).expect("a pad");
        let (data, off) = pad.output.expect("an output");
        assert!(!self.value(off), "P{pin} is off");
        self.value(data)
    }

    fn value(&self, signal: Signal) -> bool {
        let net = |net: NetId| self.values[net.0 as usize];
        match signal {
            Signal::Zero => false,
            Signal::One => true,
            Signal::Net(found) => net(found),
            Signal::Not(found) => !net(found),
        }
    }

    fn index(&self, inputs: &[Signal; 4]) -> u32 {
        inputs.iter().enumerate().fold(0, |index, (n, input)| index | u32::from(self.value(*input)) << n)
    }

    /// Evaluates until nothing changes; asynchronous resets act here.
    fn settle(&mut self) {
        for _ in 0..self.netlist.cells.len() + 2 {
            let mut changes = Vec::new();
            for cell in &self.netlist.cells {
                let (output, value) = match &cell.kind {
                    CellKind::Alias { input, output } => (*output, self.value(*input)),
                    CellKind::Lut { table, inputs, output } => (*output, table >> self.index(inputs) & 1 == 1),
                    CellKind::Mux { select, one, zero, output, .. } => {
                        (*output, self.value(if self.value(*select) { *one } else { *zero }))
                    }
                    CellKind::Xor { inputs, output } => (*output, self.value(inputs[0]) ^ self.value(inputs[1])),
                    CellKind::And { inputs, output } => (*output, self.value(inputs[0]) & self.value(inputs[1])),
                    CellKind::Bus { drivers, output } => {
                        (*output, drivers.iter().all(|(data, off)| self.value(*off) || self.value(*data)))
                    }
                    CellKind::Shift { address, output, .. } | CellKind::Ram { read_address: address, output, .. } => {
                        (*output, self.stored[&output.0] >> self.index(address) & 1 == 1)
                    }
                    CellKind::FlipFlop(register) if !register.synchronous => {
                        if self.value(register.reset) {
                            (register.output, register.init)
                        } else if self.value(register.reverse) {
                            (register.output, !register.init)
                        } else {
                            continue;
                        }
                    }
                    _ => continue,
                };
                if self.values[output.0 as usize] != value {
                    changes.push((output, value));
                }
            }
            if changes.is_empty() {
                return;
            }
            for (output, value) in changes {
                self.values[output.0 as usize] = value;
            }
        }
        panic!("the circuit does not settle");
    }

    /// An edge at a pin that is a clock: rising or falling.
    pub(crate) fn edge(&mut self, pin: u8, rising: bool) {
        let pad = self.netlist.pads.iter().find(|pad| pad.pin == Some(pin)).expect("a pad");
        let net = pad.input.expect("an input");
        let clocks: Vec<bool> = self.netlist.cells.iter().map(|cell| self.clock_of(&cell.kind)).collect();
        let mut changes: Vec<(NetId, bool)> = Vec::new();
        let old = Self { netlist: Netlist::default(), values: self.values.clone(), stored: HashMap::new() };
        self.values[net.0 as usize] = rising;
        self.settle_clock();
        let mut stored = Vec::new();
        for (cell, was) in self.netlist.cells.iter().zip(clocks) {
            if was || !self.clock_of(&cell.kind) {
                continue;
            }
            match &cell.kind {
                CellKind::FlipFlop(register) => {
                    let value = if old.value(register.reset) {
                        register.init
                    } else if old.value(register.reverse) {
                        !register.init
                    } else if old.value(register.enable) {
                        old.value(register.data)
                    } else {
                        continue;
                    };
                    changes.push((register.output, value));
                }
                CellKind::Shift { data, enable, output, .. } if old.value(*enable) => {
                    stored.push((output.0, self.stored[&output.0] << 1 | u16::from(old.value(*data))));
                }
                CellKind::Ram { write_address, data, enables, output, .. }
                    if enables.iter().all(|enable| old.value(*enable)) =>
                {
                    let at = old.index(write_address);
                    let bits = self.stored[&output.0] & !(1 << at) | u16::from(old.value(*data)) << at;
                    stored.push((output.0, bits));
                }
                _ => {}
            }
        }
        for (net, value) in changes {
            self.values[net.0 as usize] = value;
        }
        self.stored.extend(stored);
        self.settle();
    }

    fn clock_of(&self, kind: &CellKind) -> bool {
        match kind {
            CellKind::FlipFlop(register) => self.value(register.clock),
            CellKind::Shift { clock, .. } | CellKind::Ram { clock, .. } => self.value(*clock),
            _ => false,
        }
    }

    /// Only what a clock goes through before it reaches a register.
    fn settle_clock(&mut self) {
        for _ in 0..4 {
            let mut changes = Vec::new();
            for cell in &self.netlist.cells {
                if let CellKind::Alias { input, output } = &cell.kind {
                    changes.push((*output, self.value(*input)));
                }
            }
            for (output, value) in changes {
                self.values[output.0 as usize] = value;
            }
        }
    }
}
