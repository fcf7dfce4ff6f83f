//! What a placement costs, and what a move changes of it: only the pins that moved are looked at.

use crate::flow::nets::Part;
use crate::flow::place::{Design, Placement};
use crate::flow::reach::Reach;

/// A net of more pins is everywhere anyway and does not count.
const WIDEST: usize = 400;
/// What a unit of wire length weighs against 256 ps of a critical connection.
const LENGTH: i64 = 96;

/// What 256 ps of a critical connection weigh: this times its weight (0..=255), over 64. Of 160, 480 and
/// 1,280, tried on one to three seeds, the last gave longer wires and less slack at pads.
pub(super) const TIME: i64 = 480;

/// Lowest and highest column, lowest and highest row.
type Bounds = [u8; 4];

/// A net as the placer sees it.
struct PlacedNet {
    /// First of its pins, which is its source.
    pin: usize,
    /// Readers.
    sinks: usize,
    /// First connection.
    connection: usize,
    /// Larger nets need more wire than half their box: 1/64 units.
    factor: i64,
    bounds: Bounds,
    /// Sum of delays times weights.
    time: i64,
}

/// A pin of a part that moves.
#[derive(Clone, Copy)]
struct PartPin {
    net: u32,
    pin: u32,
    /// Rows above the part's lowest.
    up: u8,
}

/// A net that a move touches.
struct Touched {
    net: u32,
    bounds: Bounds,
    time: i64,
    /// The source moved: all delays are new.
    moved: bool,
    /// A pin left the edge of the box.
    shrinks: bool,
}

/// The costs of a placement.
pub(super) struct Costs<'a> {
    reach: &'a Reach,
    nets: Vec<PlacedNet>,
    /// Where every pin is.
    at: Vec<(u8, u8)>,
    /// Pins of every column, then of every memory.
    pins_of: Vec<Vec<PartPin>>,
    weights: Vec<u16>,
    touched: Vec<Touched>,
    /// For every net its place in `touched`, if it is this move's.
    slots: Vec<(u32, u32)>,
    now: u32,
    before: Vec<(u32, (u8, u8))>,
    /// What time weighs: [`TIME`], and more in the end.
    pub(super) weigh: i64,
}

impl<'a> Costs<'a> {
    pub(super) fn new(design: &Design<'_>, placement: &Placement, reach: &'a Reach) -> Self {
        let columns = placement.columns.len();
        let mut costs = Self {
            reach,
            nets: Vec::new(),
            at: Vec::new(),
            pins_of: vec![Vec::new(); columns + placement.memories.len()],
            weights: Vec::new(),
            touched: Vec::new(),
            slots: Vec::new(),
            now: 0,
            before: Vec::new(),
            weigh: TIME,
        };
        for (index, routed) in design.nets.general.iter().enumerate().filter(|(_, routed)| routed.sinks.len() <= WIDEST)
        {
            let (net, sinks) = (costs.nets.len() as u32, routed.sinks.len());
            let factor = 64 + 2 * (sinks as i64 - 2).clamp(0, 30);
            let connection = design.graph.first[index] as usize;
            let pin = costs.at.len();
            costs.nets.push(PlacedNet { pin, sinks, connection, factor, bounds: [0; 4], time: 0 });
            for part in std::iter::once(routed.source.part).chain(routed.sinks.iter().map(|sink| sink.part)) {
                let pin = costs.at.len() as u32;
                costs.at.push(placement.at(part));
                match part {
                    Part::Slice(column, row) => {
                        costs.pins_of[column as usize].push(PartPin { net, pin, up: row as u8 });
                    }
                    Part::Memory(memory) => {
                        costs.pins_of[columns + memory as usize].push(PartPin { net, pin, up: 0 });
                    }
                    Part::Pad(_) | Part::Clock(_) => {}
                }
            }
        }
        costs.slots = vec![(0, 0); costs.nets.len()];
        costs
    }

    /// Parts that can move.
    pub(super) fn parts(&self) -> usize {
        self.pins_of.len()
    }

    /// All costs anew, with new weights.
    pub(super) fn recount(&mut self, weights: Vec<u16>) {
        let counted = !self.weights.is_empty();
        for net in 0..self.nets.len() {
            // What moves changed step by step is what stands there.
            debug_assert!(!counted || self.nets[net].bounds == self.bounds(net));
            debug_assert!(!counted || self.nets[net].time == self.time(net));
        }
        self.weights = weights;
        for net in 0..self.nets.len() {
            self.nets[net].bounds = self.bounds(net);
            self.nets[net].time = self.time(net);
        }
    }

    /// The whole cost.
    pub(super) fn total(&self) -> i64 {
        self.nets.iter().map(|net| length(net.factor, net.bounds) + net.time * self.weigh / 16_384).sum()
    }

    fn bounds(&self, net: usize) -> Bounds {
        let net = &self.nets[net];
        let mut bounds = [u8::MAX, 0, u8::MAX, 0];
        for at in &self.at[net.pin..=net.pin + net.sinks] {
            widen(&mut bounds, *at);
        }
        bounds
    }

    fn time(&self, net: usize) -> i64 {
        let net = &self.nets[net];
        let from = self.at[net.pin];
        let sinks = &self.at[net.pin + 1..=net.pin + net.sinks];
        let weights = &self.weights[net.connection..net.connection + net.sinks];
        sinks.iter().zip(weights).map(|(to, weight)| i64::from(self.reach.delay(from, *to)) * i64::from(*weight)).sum()
    }

    /// Moves a part, for the present move.
    pub(super) fn shift(&mut self, part: usize, to: (u8, u8)) {
        if self.before.is_empty() {
            self.now += 1;
            self.touched.clear();
        }
        let Self { reach, nets, at, pins_of, weights, touched, slots, now, before, .. } = self;
        for PartPin { net, pin, up } in &pins_of[part] {
            let (old, new) = (at[*pin as usize], (to.0, to.1 + up));
            before.push((*pin, old));
            at[*pin as usize] = new;
            let home = &nets[*net as usize];
            let slot = &mut slots[*net as usize];
            if slot.0 != *now {
                *slot = (*now, touched.len() as u32);
                touched.push(Touched { net: *net, bounds: home.bounds, time: home.time, moved: false, shrinks: false });
            }
            let entry = &mut touched[slot.1 as usize];
            if home.pin == *pin as usize {
                entry.moved = true;
            } else {
                let from = at[home.pin];
                let change = i64::from(reach.delay(from, new)) - i64::from(reach.delay(from, old));
                entry.time += change * i64::from(weights[home.connection + *pin as usize - home.pin - 1]);
            }
            let edges = home.bounds;
            entry.shrinks |= old.0 == edges[0] || old.0 == edges[1] || old.1 == edges[2] || old.1 == edges[3];
            widen(&mut entry.bounds, new);
        }
    }

    /// What the present move changes.
    pub(super) fn change(&mut self) -> i64 {
        let mut touched = std::mem::take(&mut self.touched);
        let (mut lengths, mut times) = (0, 0);
        for entry in &mut touched {
            let at = entry.net as usize;
            if entry.shrinks {
                entry.bounds = self.bounds(at);
            }
            if entry.moved {
                entry.time = self.time(at);
            }
            let net = &self.nets[at];
            lengths += length(net.factor, entry.bounds) - length(net.factor, net.bounds);
            times += entry.time - net.time;
        }
        self.touched = touched;
        lengths + times * self.weigh / 16_384
    }

    /// Takes the present move.
    pub(super) fn take(&mut self) {
        for entry in self.touched.drain(..) {
            let net = &mut self.nets[entry.net as usize];
            (net.bounds, net.time) = (entry.bounds, entry.time);
        }
        self.before.clear();
    }

    /// Undoes the present move.
    pub(super) fn leave(&mut self) {
        // A part that moved twice is back where it was first.
        for (pin, at) in self.before.drain(..).rev() {
            self.at[pin as usize] = at;
        }
    }
}

fn widen(bounds: &mut Bounds, at: (u8, u8)) {
    *bounds = [bounds[0].min(at.0), bounds[1].max(at.0), bounds[2].min(at.1), bounds[3].max(at.1)];
}

fn length(factor: i64, bounds: Bounds) -> i64 {
    let cells = i64::from(bounds[1] - bounds[0]) + i64::from(bounds[3] - bounds[2]);
    cells * factor * LENGTH / 64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_widens_and_costs_its_two_sides() {
        let mut bounds = [5, 5, 7, 7];
        widen(&mut bounds, (3, 9));
        assert_eq!(bounds, [3, 5, 7, 9]);
        assert_eq!(length(64, bounds), 4 * LENGTH);
    }
}
