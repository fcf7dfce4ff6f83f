//! What the switches of a configuration join, and which output drives each wire.

use super::NetlistFault;
use crate::configuration::Configuration;
use crate::device::{BelKind, ClassPip, Coding, Device, PipKind, TileId, WireId};

/// No wire.
const NONE: u32 = u32::MAX;
/// A wire whose driver was looked for and not found.
const FLOATING: u32 = u32::MAX - 1;

/// An output of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Output {
    /// Where the element stands.
    pub tile: TileId,
    /// What drives.
    pub kind: BelKind,
    /// Which of its kind in the tile.
    pub index: u8,
    /// Which pin of it, by its place among the element's pins.
    pub pin: u8,
}

/// What drives a wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// No switch leads to it.
    Unrouted,
    /// Switches lead to it, but no output drives them.
    Floating,
    /// This wire, an element's output.
    Wire(WireId),
}

/// The wires of a configuration, joined.
#[derive(Debug)]
pub struct Routing {
    /// Wires joined by gates have one representative.
    joined: Vec<u32>,
    /// For every representative, the wire that drives it.
    driver: Vec<u32>,
    /// For every wire, the output on it.
    outputs: Vec<u32>,
    list: Vec<Output>,
    memo: Vec<u32>,
    /// Wires behind a multiplexer that cannot choose nothing: that it chooses a wire says nothing.
    always: Vec<bool>,
    /// Switches that conduct, those without bits left out.
    pub switches: usize,
}

impl Routing {
    /// Reads all switches. Faults: wires with two drivers, cycles of gates, multiplexers with unknown bits.
    pub fn read(device: &Device, configuration: &Configuration, faults: &mut Vec<NetlistFault>) -> Self {
        let wires = device.wire_count();
        let mut routing = Self {
            joined: (0..wires as u32).collect(),
            driver: vec![NONE; wires],
            outputs: vec![NONE; wires],
            list: Vec::new(),
            memo: vec![NONE; wires],
            always: vec![false; wires],
            switches: 0,
        };
        routing.place_outputs(device);
        let mut edges = Vec::new();
        for (tile, _) in device.tiles() {
            routing.read_tile(device, configuration, tile, &mut edges, faults);
        }
        for (from, to) in edges {
            let root = routing.root(to);
            let before = routing.driver[root as usize];
            if before != NONE && before != from.0 {
                let wire = device.describe_wire(WireId(to.0));
                let drivers = [device.describe_wire(WireId(before)), device.describe_wire(from)];
                faults.push(NetlistFault::TwoDrivers { wire, drivers });
            }
            routing.driver[root as usize] = from.0;
        }
        for n in 0..wires {
            let root = routing.root(WireId(n as u32));
            if routing.outputs[n] != NONE && routing.driver[root as usize] != NONE {
                let drivers = [
                    device.describe_wire(WireId(n as u32)),
                    device.describe_wire(WireId(routing.driver[root as usize])),
                ];
                faults.push(NetlistFault::TwoDrivers { wire: device.describe_wire(WireId(n as u32)), drivers });
            }
        }
        routing
    }

    fn place_outputs(&mut self, device: &Device) {
        for (tile, _) in device.tiles() {
            for bel in &device.class(tile).bels {
                for (pin, found) in bel.pins.iter().enumerate().filter(|(_, pin)| pin.output) {
                    let Some(wire) = device.tile_wire(tile, found.wire) else { continue };
                    self.outputs[wire.0 as usize] = self.list.len() as u32;
                    self.list.push(Output { tile, kind: bel.kind, index: bel.index, pin: pin as u8 });
                }
            }
        }
    }

    fn read_tile(
        &mut self,
        device: &Device,
        configuration: &Configuration,
        tile: TileId,
        edges: &mut Vec<(WireId, WireId)>,
        faults: &mut Vec<NetlistFault>,
    ) {
        let class = device.class(tile);
        // The switches of a multiplexer follow each other: its bits are read once.
        let mut mux: Option<(u16, Option<u8>)> = None;
        for ClassPip { from, to, kind } in &class.pips {
            let conducts = match *kind {
                PipKind::Mux { attribute, choice, drive } => {
                    if mux.is_none_or(|(read, _)| read != attribute) {
                        let found = &class.attributes[usize::from(attribute)];
                        let pattern = configuration.pattern(device, tile, found);
                        let chosen = found.choices().iter().position(|choice| u64::from(choice.pattern) == pattern);
                        let driven = drive.is_none_or(|drive| is_set(device, configuration, tile, drive));
                        if chosen.is_none() {
                            faults.push(NetlistFault::unknown_pattern(device, tile, found, pattern));
                        }
                        if drive.is_none() && found.choice("NONE").is_none() {
                            device.tile_wire(tile, *to).into_iter().for_each(|to| self.always[to.0 as usize] = true);
                        }
                        mux = Some((attribute, chosen.filter(|_| driven).map(|choice| choice as u8)));
                    }
                    mux.is_some_and(|(_, chosen)| chosen == Some(choice))
                }
                _ => configuration.conducts(device, tile, *kind),
            };
            if !conducts {
                continue;
            }
            let (Some(from), Some(to)) = (device.tile_wire(tile, *from), device.tile_wire(tile, *to)) else { continue };
            if from == to {
                continue;
            }
            self.switches += usize::from(*kind != PipKind::Joined);
            if matches!(kind, PipKind::Gate { .. }) {
                let (one, other) = (self.root(from), self.root(to));
                if one == other {
                    let gate = [device.describe_wire(from), device.describe_wire(to)];
                    faults.push(NetlistFault::GateCycle { tile: device.describe_tile(tile), gate });
                } else {
                    self.joined[one as usize] = other;
                }
            } else {
                edges.push((from, to));
            }
        }
    }

    /// The representative of the wires that gates join with this one.
    fn root(&mut self, wire: WireId) -> u32 {
        let mut at = wire.0;
        while self.joined[at as usize] != at {
            let next = self.joined[at as usize];
            self.joined[at as usize] = self.joined[next as usize];
            at = next;
        }
        at
    }

    /// What drives a wire.
    ///
    /// # Errors
    /// The wire at which a ring of buffers drives itself.
    pub fn source(&mut self, wire: WireId) -> Result<Source, WireId> {
        let first = self.root(wire);
        if self.driver[first as usize] == NONE && self.outputs[wire.0 as usize] == NONE {
            return Ok(Source::Unrouted);
        }
        let (mut path, mut at) = (Vec::new(), first);
        let found = loop {
            if self.memo[at as usize] != NONE {
                break self.memo[at as usize];
            }
            if self.outputs[at as usize] != NONE {
                break at;
            }
            path.push(at);
            match self.driver[at as usize] {
                NONE => break FLOATING,
                from => at = self.root(WireId(from)),
            }
            if path.len() > self.driver.len() {
                return Err(wire);
            }
            // A ring comes back to a wire of this walk; walks are short, so looking back is cheap.
            if path.contains(&at) {
                return Err(WireId(at));
            }
        };
        for wire in path {
            self.memo[wire as usize] = found;
        }
        Ok(match found {
            FLOATING if self.always[wire.0 as usize] => Source::Unrouted,
            FLOATING => Source::Floating,
            _ => Source::Wire(WireId(found)),
        })
    }

    /// What drives `wire`; `None` for a wire that nothing drives.
    #[must_use]
    pub fn output(&self, wire: WireId) -> Option<Output> {
        self.list.get(self.outputs[wire.0 as usize] as usize).copied()
    }
}

fn is_set(device: &Device, configuration: &Configuration, tile: TileId, attribute: u16) -> bool {
    let attribute = &device.class(tile).attributes[usize::from(attribute)];
    let Coding::Number { inverted } = &attribute.coding else { return false };
    let stored = configuration.pattern(device, tile, attribute) & 1 == 1;
    stored ^ inverted.first().copied().unwrap_or(false)
}
