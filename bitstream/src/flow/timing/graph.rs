//! The timing graph: nodes are nets and carries, arcs are ways through a part.

use super::delays::{
    BYPASS_SETUP, BYPASS_TO_CARRY, CARRY, CARRY_TO_OUTPUT, CLOCK_INSERTION, CLOCK_SKEW, CLOCK_TO_OUTPUT, ENABLE_SETUP,
    MEMORY_CONTROL_SETUP, MEMORY_SETUP, MEMORY_TO_OUTPUT, OUTPUT_SETUP, PAD_IN, PAD_OUT_FAST, PAD_OUT_SLOW,
    RESET_SETUP, TABLE, TABLE_SETUP, TABLE_TO_CARRY, TABLE_TO_SUM, WIDE, WIDE_SETUP,
};
use crate::flow::constraints::Constraints;
use crate::flow::logic::Logic;
use crate::flow::netlist::Net;
use crate::flow::nets::{Nets, Part, Pin};
use crate::flow::pack::{CarryIn, Packed, Shape, Slice};
use std::collections::BTreeMap;

/// What a path between registers should take at most, % of the period: the target of the gateware.
pub(super) const SHARE: u32 = 60;
/// What a path from or to a pad should leave, ps: about what the last bitstream left that aimed at slack alone (3.2 ns).
const RESERVE: u32 = 3_200;

/// A clock domain.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Clock {
    /// Port of its pad.
    pub port: String,
    /// What a path between registers may take, ps.
    pub period: u32,
}

/// Where an arc comes from.
#[derive(Clone, Copy, Debug)]
pub(super) enum From {
    /// A connection: index into the flat list of sinks.
    Connection(u32),
    /// Index of a place where a signal has an arrival time.
    Node(u32),
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    pub(super) from: From,
    pub(super) delay: u32,
}

/// A place where a path ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    pub(super) arc: Arc,
    /// Clock domain.
    pub(super) clock: u32,
    /// Due at this time after the clock, in ps.
    pub(super) due: u32,
}

/// Places with arrival times, and the delays between them.
#[derive(Clone, Debug)]
pub struct Graph {
    /// One for each clock net.
    pub clocks: Vec<Clock>,
    /// First connection of every general net.
    pub first: Vec<u32>,
    /// Driver node of every connection.
    pub(super) drivers: Vec<u32>,
    /// Arcs into every node.
    pub(super) into: Vec<Vec<Arc>>,
    /// Nodes where paths begin: (time, clock).
    pub(super) starts: Vec<Option<(u32, u32)>>,
    pub(super) ends: Vec<End>,
    /// Nodes in an order in which every arc goes forward.
    pub(super) order: Vec<u32>,
    /// For messages: net index of a node; carries name none.
    pub(super) names: Vec<Option<Net>>,
}

struct Builder {
    node_of: BTreeMap<Net, u32>,
    pins: BTreeMap<Pin, u32>,
    graph: Graph,
    domains: BTreeMap<Net, u32>,
}

impl Graph {
    /// Builds the graph.
    #[must_use]
    pub fn of(logic: &Logic, packed: &Packed, nets: &Nets, constraints: &Constraints) -> Self {
        let mut builder = Builder::new(nets);
        builder.clocks(logic, constraints);
        for (column, slices) in packed.columns.iter().enumerate() {
            let mut below = None;
            for (row, slice) in slices.slices.iter().enumerate() {
                below = builder.slice(Part::Slice(column as u32, row as u16), slice, below);
            }
        }
        builder.memories(logic);
        builder.pads(logic, constraints);
        let mut graph = builder.graph;
        graph.sort();
        graph
    }

    /// Number of connections: that of the wire delays which a report takes.
    #[must_use]
    pub fn connections(&self) -> usize {
        self.drivers.len()
    }

    /// The same graph with what placer and router aim at in place of what must be met: between registers [`SHARE`] of the
    /// period, at a pad [`RESERVE`] to spare. By slack alone the paths to pads, due long before the period ends, would get
    /// nearly all of the weight: of seeds 1 to 11 the slowest path between registers had a median of 19.5 ns, with these aims
    /// 18.6 ns; the least slack went from 3.2 to 2.5 ns.
    #[must_use]
    pub(crate) fn aims(&self) -> Self {
        let mut aims = self.clone();
        let aim = |clock: u32| self.clocks[clock as usize].period / 100 * SHARE;
        let whole = |clock: u32| self.clocks[clock as usize].period - CLOCK_SKEW;
        for end in &mut aims.ends {
            end.due = if end.due == whole(end.clock) { aim(end.clock) } else { end.due.saturating_sub(RESERVE) };
        }
        // Inputs come later than from any register, and may use what is left to the period but for the reserve.
        for (time, clock) in aims.starts.iter_mut().flatten().filter(|(time, _)| *time > MEMORY_TO_OUTPUT) {
            *time = time.saturating_sub(whole(*clock) - RESERVE - aim(*clock));
        }
        aims
    }

    /// Orders the nodes; a node on a loop of logic is left where it is.
    fn sort(&mut self) {
        let mut waits: Vec<u32> = self.into.iter().map(|arcs| arcs.len() as u32).collect();
        let mut readers: Vec<Vec<u32>> = vec![Vec::new(); self.into.len()];
        for (node, arcs) in self.into.iter().enumerate() {
            for arc in arcs {
                readers[self.driver(arc.from) as usize].push(node as u32);
            }
        }
        let mut order: Vec<u32> = (0..waits.len() as u32).filter(|node| waits[*node as usize] == 0).collect();
        let mut at = 0;
        while let Some(node) = order.get(at).copied() {
            at += 1;
            for reader in &readers[node as usize] {
                waits[*reader as usize] -= 1;
                if waits[*reader as usize] == 0 {
                    order.push(*reader);
                }
            }
        }
        self.order = order;
    }

    pub(super) fn driver(&self, from: From) -> u32 {
        match from {
            From::Node(node) => node,
            From::Connection(connection) => self.drivers[connection as usize],
        }
    }
}

impl Builder {
    fn new(nets: &Nets) -> Self {
        let mut graph = Graph {
            clocks: Vec::new(),
            first: Vec::new(),
            drivers: Vec::new(),
            into: Vec::new(),
            starts: Vec::new(),
            ends: Vec::new(),
            order: Vec::new(),
            names: Vec::new(),
        };
        let (mut node_of, mut pins) = (BTreeMap::new(), BTreeMap::new());
        for (index, routed) in nets.general.iter().enumerate() {
            node_of.insert(routed.net, index as u32);
            graph.first.push(graph.drivers.len() as u32);
            graph.into.push(Vec::new());
            graph.starts.push(None);
            graph.names.push(Some(routed.net));
            for sink in &routed.sinks {
                pins.insert(sink.clone(), graph.drivers.len() as u32);
                graph.drivers.push(index as u32);
            }
        }
        Self { node_of, pins, graph, domains: BTreeMap::new() }
    }

    /// Clock nets by their pads, with the period of each; 20 ns where nothing is said.
    fn clocks(&mut self, logic: &Logic, constraints: &Constraints) {
        for (from, to) in &logic.clock_buffers {
            let pad = logic.pads.iter().find(|pad| pad.input == Some(*from));
            let port = pad.map_or_else(|| logic.nets[from.index()].clone(), |pad| pad.port.clone());
            let period = constraints.periods.get(&port).copied().unwrap_or(20_000);
            self.domains.insert(*to, self.graph.clocks.len() as u32);
            self.graph.clocks.push(Clock { port, period });
        }
    }

    fn node(&mut self) -> u32 {
        self.graph.into.push(Vec::new());
        self.graph.starts.push(None);
        self.graph.names.push(None);
        self.graph.into.len() as u32 - 1
    }

    fn pin(&self, part: Part, name: &str) -> Option<From> {
        // The key owns its name, so that one map serves slices and memories.
        self.pins.get(&Pin { part, name: name.to_owned().into() }).map(|at| From::Connection(*at))
    }

    fn arc(&mut self, from: Option<From>, delay: u32, to: Option<u32>) {
        if let (Some(from), Some(to)) = (from, to) {
            self.graph.into[to as usize].push(Arc { from, delay });
        }
    }

    fn end(&mut self, from: Option<From>, delay: u32, clock: u32) {
        if let Some(from) = from {
            let due = self.graph.clocks[clock as usize].period - CLOCK_SKEW;
            self.graph.ends.push(End { arc: Arc { from, delay }, clock, due });
        }
    }

    /// Arcs of a slice; `below` is the carry of the slice under it. Returns its carry out.
    fn slice(&mut self, part: Part, slice: &Slice, below: Option<u32>) -> Option<u32> {
        const TABLES: [[&str; 4]; 2] = [["F1", "F2", "F3", "F4"], ["G1", "G2", "G3", "G4"]];
        let clock = slice.control.and_then(|control| self.domains.get(&control.clock).copied());
        let wide = slice.halves[0].shape == Shape::Wide;
        let mut carry = slice.carry.map(|source| {
            let node = self.node();
            match source {
                CarryIn::Bypass => self.arc(self.pin(part, "BX"), BYPASS_TO_CARRY, Some(node)),
                CarryIn::Below => self.arc(below.map(From::Node), 0, Some(node)),
            }
            node
        });
        for (half, content) in slice.halves.iter().enumerate() {
            let inputs: Vec<Option<From>> = TABLES[half].iter().map(|name| self.pin(part, name)).collect();
            let output = content.shows.and_then(|net| self.node_of.get(&net).copied());
            let through = content.flop.is_some_and(|flop| flop.through);
            let to_flop = clock.filter(|_| through);
            let (to_output, setup) = match content.shape {
                Shape::Table => (TABLE, TABLE_SETUP),
                Shape::Sum => (TABLE_TO_SUM, TABLE_TO_SUM + OUTPUT_SETUP),
                Shape::Wide => (WIDE, WIDE_SETUP),
            };
            for input in &inputs {
                self.arc(*input, to_output, output);
                to_flop.into_iter().for_each(|clock| self.end(*input, setup, clock));
            }
            if wide && half == 0 {
                let others = TABLES[1].iter().map(|name| self.pin(part, name)).chain([self.pin(part, "BX")]);
                for input in others.collect::<Vec<_>>() {
                    self.arc(input, WIDE, output);
                    to_flop.into_iter().for_each(|clock| self.end(input, WIDE_SETUP, clock));
                }
            }
            if let Some(carry_in) = carry {
                let from = Some(From::Node(carry_in));
                if content.shape == Shape::Sum {
                    self.arc(from, CARRY_TO_OUTPUT, output);
                    to_flop.into_iter().for_each(|clock| self.end(from, CARRY_TO_OUTPUT + OUTPUT_SETUP, clock));
                }
                let next = self.node();
                self.arc(from, CARRY, Some(next));
                for input in &inputs {
                    self.arc(*input, TABLE_TO_CARRY, Some(next));
                }
                let seen = content.carry_out.and_then(|net| self.node_of.get(&net).copied());
                self.arc(Some(From::Node(next)), CARRY_TO_OUTPUT, seen);
                carry = Some(next);
            }
            let Some(clock) = clock else { continue };
            if let Some(flop) = content.flop {
                if !flop.through {
                    self.end(self.pin(part, ["BX", "BY"][half]), BYPASS_SETUP, clock);
                }
                if let Some(node) = self.node_of.get(&flop.output) {
                    self.graph.starts[*node as usize] = Some((CLOCK_TO_OUTPUT, clock));
                }
            }
        }
        if let Some(clock) = clock {
            self.end(self.pin(part, "CE"), ENABLE_SETUP, clock);
            self.end(self.pin(part, "SR"), RESET_SETUP, clock);
            if slice.control.is_some_and(|control| control.reverse.net().is_some()) {
                self.end(self.pin(part, "BY"), RESET_SETUP, clock);
            }
        }
        carry
    }

    fn memories(&mut self, logic: &Logic) {
        for (index, memory) in logic.memories.iter().enumerate() {
            let part = Part::Memory(index as u32);
            for (port, side) in memory.ports.iter().zip(['A', 'B']) {
                let Some(port) = port else { continue };
                let Some(clock) = self.domains.get(&port.clock).copied() else { continue };
                for bit in 0..16 {
                    self.end(self.pin(part, &format!("ADDR{side}{bit}")), MEMORY_SETUP, clock);
                    self.end(self.pin(part, &format!("DI{side}{bit}")), MEMORY_SETUP, clock);
                }
                for name in ["EN", "RST", "WE"] {
                    self.end(self.pin(part, &format!("{name}{side}")), MEMORY_CONTROL_SETUP, clock);
                }
                for net in port.output.iter().flatten() {
                    if let Some(node) = self.node_of.get(net) {
                        self.graph.starts[*node as usize] = Some((MEMORY_TO_OUTPUT, clock));
                    }
                }
            }
        }
    }

    /// Pads: inputs come after the clock by its period less the offset; outputs are due by theirs. The first
    /// clock is the one that offsets speak of.
    fn pads(&mut self, logic: &Logic, constraints: &Constraints) {
        let Some(period) = self.graph.clocks.first().map(|clock| clock.period) else { return };
        for (index, pad) in logic.pads.iter().enumerate() {
            let part = Part::Pad(index as u32);
            let fast = constraints.pads.get(&pad.port).is_some_and(|pad| pad.fast);
            let delay = if fast { PAD_OUT_FAST } else { PAD_OUT_SLOW };
            if constraints.offset_in > 0 && !constraints.periods.contains_key(&pad.port) {
                let node = pad.input.and_then(|net| self.node_of.get(&net).copied());
                let at = period.saturating_sub(constraints.offset_in) + PAD_IN;
                node.into_iter().for_each(|node| self.graph.starts[node as usize] = Some((at, 0)));
            }
            if constraints.offset_out > 0 {
                for name in ["O", "T"] {
                    if let Some(from) = self.pin(part, name) {
                        let due = constraints.offset_out.saturating_sub(CLOCK_INSERTION);
                        self.graph.ends.push(End { arc: Arc { from, delay }, clock: 0, due });
                    }
                }
            }
        }
    }
}
