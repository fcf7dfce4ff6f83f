//! The search for the cheapest way from a net's tree to its next sink.

use super::terminals::Ends;
use super::tree::{Branch, Tree};
use super::{GATES, JOINED, at};
use crate::device::{Device, PipId, WireFamily, WireId};
use crate::flow::fabric::{Fabric, Way};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Mark of a wire that was not reached.
const NONE: u32 = u32::MAX;
/// Lowest cost of a cell's distance on the way, in 1/256 of a price: what the search may hope for.
const HOPE_PRICE: u64 = 2 * 256;
/// Lowest time of a cell's distance, in ps: a hex wire over six cells, less a tenth.
const HOPE_TIME: u64 = 102;

/// What a ps weighs against 1/256 of a price: a single-length wire costs 10 × 256 or 320 × 8.
const TIME: u64 = 8;

/// Who uses which wire, and how dear it has become.
pub(super) struct Congestion {
    users: Vec<u16>,
    /// Extra price of the past, in 1/16.
    past: Vec<u32>,
    pressure: u64,
}

impl Congestion {
    pub(super) fn new(wires: usize, pressure: u64) -> Self {
        Self { users: vec![0; wires], past: vec![0; wires], pressure }
    }

    pub(super) fn enter(&mut self, wire: WireId) {
        self.users[at(wire)] += 1;
    }

    pub(super) fn leave(&mut self, wire: WireId) {
        self.users[at(wire)] -= 1;
    }

    pub(super) fn is_shared(&self, wire: WireId) -> bool {
        self.users[at(wire)] > 1
    }

    pub(super) fn shared(&self) -> usize {
        self.users.iter().filter(|users| **users > 1).count()
    }

    /// After a round: shared wires become dearer for ever, sharing dearer for all. Says how many are shared.
    pub(super) fn settle(&mut self, growth: u64, most: u64) -> usize {
        for (users, past) in self.users.iter().zip(&mut self.past) {
            *past += 16 * u32::from(users.saturating_sub(1));
        }
        self.pressure = (self.pressure * growth / 16 + 1).min(most);
        self.shared()
    }

    /// Sharing costs so much again; what was shared before stays dear.
    pub(super) fn relax(&mut self, pressure: u64) {
        self.pressure = pressure;
    }

    /// The price of taking a wire, in 1/256.
    fn price(&self, wire: u32, base: u16) -> u64 {
        let wire = wire as usize;
        let base = u64::from(base) * 256 * u64::from(16 + self.past[wire]) / 16;
        base + base * u64::from(self.users[wire]) * self.pressure / 16
    }
}

/// What is known of a wire while a search runs.
#[derive(Clone, Copy)]
struct Mark {
    cost: u64,
    from: u32,
    pip: PipId,
    /// Pass gates in series since the last driver.
    gates: u8,
    /// Single-length wires joined so far, on this way and in the group it starts from.
    joined: u8,
    /// Group of joined wires that it starts from; 0 is a new one or none.
    group: u16,
}

const FRESH: Mark = Mark { cost: u64::MAX, from: NONE, pip: PipId(NONE), gates: 0, joined: 0, group: 0 };

pub(super) struct Search<'a> {
    fabric: &'a Fabric,
    marks: Vec<Mark>,
    touched: Vec<u32>,
    in_tree: Vec<bool>,
    /// Wires of pins that nets end at: nobody else goes there.
    pins: Vec<bool>,
    heap: BinaryHeap<(Reverse<u64>, Reverse<u32>)>,
}

/// A wire of the tree that grows.
struct Grown {
    wire: u32,
    gates: u8,
    group: u16,
    /// Delay from the source, in ps.
    time: u64,
}

impl<'a> Search<'a> {
    pub(super) fn new(fabric: &'a Fabric) -> Self {
        let wires = fabric.wires();
        Self {
            fabric,
            marks: vec![FRESH; wires],
            touched: Vec::new(),
            in_tree: vec![false; wires],
            pins: vec![false; wires],
            heap: BinaryHeap::new(),
        }
    }

    /// Keeps these wires for the nets that end there.
    pub(super) fn reserve(&mut self, wires: impl Iterator<Item = u32>) {
        wires.for_each(|wire| self.pins[wire as usize] = true);
    }

    /// A tree for a net; `weights` say how critical every sink is, 0 to 255.
    pub(super) fn tree(&mut self, ends: &Ends, weights: &[u16], congestion: &Congestion) -> Option<Tree> {
        let mut order: Vec<usize> = (0..ends.sinks.len()).collect();
        let source = &self.fabric.lanes[at(ends.source)];
        let from = (source.columns.0, source.rows.0);
        order.sort_by_key(|sink| {
            let wire = ends.sinks[*sink];
            (Reverse(weights[*sink] / 32), self.fabric.distance(wire.0, from), *sink)
        });
        let mut tree = Tree::default();
        let mut grown = vec![Grown { wire: ends.source.0, gates: 0, group: 0, time: 0 }];
        // Wires of every group of joined single-length wires; group 0 is none.
        let mut groups = vec![0_u8];
        self.in_tree[at(ends.source)] = true;
        let mut complete = true;
        for sink in order {
            let target = ends.sinks[sink].0;
            if self.in_tree[target as usize] {
                continue;
            }
            let found = self.extend(target, u64::from(weights[sink]).min(250), &grown, &groups, congestion);
            if found {
                self.take(target, &mut tree, &mut grown, &mut groups);
            }
            self.touched.drain(..).for_each(|wire| self.marks[wire as usize] = FRESH);
            self.heap.clear();
            if !found {
                complete = false;
                break;
            }
        }
        grown.iter().for_each(|grown| self.in_tree[grown.wire as usize] = false);
        complete.then_some(tree)
    }

    fn extend(&mut self, target: u32, weight: u64, grown: &[Grown], groups: &[u8], congestion: &Congestion) -> bool {
        let lane = &self.fabric.lanes[target as usize];
        let goal = (lane.columns.0, lane.rows.0);
        let fabric = self.fabric;
        let hope = move |wire: u32| {
            let cells = u64::from(fabric.distance(wire, goal).saturating_sub(1));
            cells * (weight * HOPE_TIME * TIME + (256 - weight) * HOPE_PRICE)
        };
        for grown in grown {
            let joined = groups[usize::from(grown.group)];
            let cost = weight * grown.time * TIME;
            let mark = Mark { cost, gates: grown.gates, joined, group: grown.group, ..FRESH };
            self.marks[grown.wire as usize] = mark;
            self.touched.push(grown.wire);
            self.heap.push((Reverse(cost + hope(grown.wire)), Reverse(grown.wire)));
        }
        while let Some((Reverse(key), Reverse(wire))) = self.heap.pop() {
            if wire == target {
                return true;
            }
            let mark = self.marks[wire as usize];
            if mark.cost + hope(wire) < key {
                continue;
            }
            for (to, pip, way) in fabric.arcs(wire) {
                let index = to as usize;
                let lane = &fabric.lanes[index];
                let clock = matches!(lane.family, WireFamily::ClockLeaf | WireFamily::ClockRoot);
                if (self.pins[index] && to != target) || self.in_tree[index] || clock {
                    continue;
                }
                let (gates, joined, group) = match way {
                    Way::Driven if lane.family != WireFamily::Single => (0, 0, 0),
                    Way::Driven | Way::Entry => (0, 1, 0),
                    Way::Gate => (mark.gates + 1, mark.joined + 1, mark.group),
                };
                if gates > GATES || joined > JOINED {
                    continue;
                }
                let step = weight * u64::from(lane.delay) * TIME + (256 - weight) * congestion.price(to, lane.price);
                let cost = mark.cost + step;
                let old = &mut self.marks[index];
                if cost < old.cost {
                    if old.cost == u64::MAX {
                        self.touched.push(to);
                    }
                    *old = Mark { cost, from: wire, pip, gates, joined, group };
                    self.heap.push((Reverse(cost + hope(to)), Reverse(to)));
                }
            }
        }
        false
    }

    /// Adds the way found to the tree.
    fn take(&mut self, target: u32, tree: &mut Tree, grown: &mut Vec<Grown>, groups: &mut Vec<u8>) {
        let mut way = Vec::new();
        let mut wire = target;
        while !self.in_tree[wire as usize] {
            let mark = self.marks[wire as usize];
            way.push(wire);
            wire = mark.from;
        }
        let mut group = 0;
        let start = grown.iter().find(|grown| grown.wire == wire);
        let mut time = start.map_or(0, |grown| grown.time);
        for wire in way.into_iter().rev() {
            let mark = self.marks[wire as usize];
            group = match (mark.joined, mark.gates) {
                (0, _) => 0,
                (_, 0) => {
                    groups.push(0);
                    groups.len() as u16 - 1
                }
                _ if group == 0 => mark.group,
                _ => group,
            };
            if group > 0 {
                groups[usize::from(group)] += 1;
            }
            tree.branches.push(Branch { from: WireId(mark.from), to: WireId(wire), pip: mark.pip });
            time += u64::from(self.fabric.lanes[wire as usize].delay);
            grown.push(Grown { wire, gates: mark.gates, group, time });
            self.in_tree[wire as usize] = true;
        }
    }

    /// The tree of a clock: breadth first through the clock's own wires.
    pub(super) fn clock_tree(&mut self, device: &Device, ends: &Ends) -> Option<Tree> {
        let mut from: std::collections::BTreeMap<u32, Branch> = std::collections::BTreeMap::new();
        let mut queue = std::collections::VecDeque::from([ends.source.0]);
        let sinks: std::collections::BTreeSet<u32> = ends.sinks.iter().map(|sink| sink.0).collect();
        while let Some(wire) = queue.pop_front() {
            for arc in device.arcs(WireId(wire)) {
                let to = arc.to.0;
                let clock = matches!(device.wire(arc.to).family, WireFamily::ClockLeaf | WireFamily::ClockRoot);
                if to == ends.source.0 || from.contains_key(&to) || !(clock || sinks.contains(&to)) {
                    continue;
                }
                from.insert(to, Branch { from: WireId(wire), to: arc.to, pip: arc.pip });
                if clock {
                    queue.push_back(to);
                }
            }
        }
        let mut tree = Tree::default();
        let mut taken = std::collections::BTreeSet::from([ends.source.0]);
        for sink in sinks {
            let (mut way, mut wire) = (Vec::new(), sink);
            while !taken.contains(&wire) {
                let branch = *from.get(&wire)?;
                way.push(branch);
                wire = branch.from.0;
            }
            for branch in way.into_iter().rev() {
                taken.insert(branch.to.0);
                tree.branches.push(branch);
            }
        }
        Some(tree)
    }
}
