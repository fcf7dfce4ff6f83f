//! Small designs by hand: elements set one by one, and wires found by breadth-first search.

use bitstream::configuration::Configuration;
use bitstream::device::{BelKind, Device, PadSite, TileId, WireId};
use bitstream::element::{Driver, InputBuffer, Io};
use bitstream::netlist::{Netlist, NetlistFault, extract};
use bitstream::simulation::Simulator;
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

    pub(crate) fn simulate(&self) -> Run {
        let netlist = self.netlist().expect("a circuit");
        let simulator = Simulator::new(&netlist).expect("it settles");
        Run { netlist, simulator }
    }
}

/// A circuit that runs, by pins.
pub(crate) struct Run {
    pub(crate) netlist: Netlist,
    simulator: Simulator,
}

impl Run {
    pub(crate) fn set(&mut self, pin: u8, value: bool) {
        // An input on which nothing depends is not in the netlist.
        if let Some(pad) = self.simulator.pad(pin) {
            self.simulator.set(pad, value);
            self.simulator.settle().expect("it settles");
        }
    }

    pub(crate) fn get(&self, pin: u8) -> bool {
        let pad = self.simulator.pad(pin).expect("a pad");
        self.simulator.driven(pad).unwrap_or_else(|| panic!("P{pin} is off"))
    }
}
