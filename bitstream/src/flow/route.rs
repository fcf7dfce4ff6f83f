//! Routes nets through the device by negotiated congestion (PathFinder), with time.
//!
//! Every net becomes a tree of wires. In the first rounds nets may share wires; a shared wire grows dearer
//! from round to round until none is shared. A connection on a slow path pays for time, the others for
//! congestion.
//!
//! The rules of the device's pass gates are kept while searching: the vendor's tools never go through more than
//! seven gates in series from where a net is driven into single-length wires, nor join more than fifteen such
//! wires (counted in 22 files of the card's maker). Here the limits are [`GATES`] and [`JOINED`].

mod rules;
mod search;
mod terminals;
mod tree;

pub use rules::{Extremes, RouteFault, check};
pub use terminals::Terminals;
pub(crate) use terminals::element;
pub use tree::{Branch, Tree};

use super::FlowError;
use super::fabric::Fabric;
pub use super::fabric::GATES;
use super::nets::Routed;
use super::place::{Design, Placement, weights};
use super::reach::Reach;
use super::timing::Report;
use super::{Progress, Stage};
use crate::device::{Device, WireId};
use search::{Congestion, Search};

/// Most single-length wires joined by pass gates.
pub const JOINED: u8 = 15;
/// Rounds after which a design counts as not routable.
const ROUNDS: usize = 80;
/// What a shared wire costs more in the first round, in 1/16 of its price for each net too many.
const FIRST_PRESSURE: u64 = 8;
/// How the pressure grows, in 1/16 a round.
const PRESSURE_GROWTH: u64 = 22;
/// Largest pressure.
const LAST_PRESSURE: u64 = 1 << 20;
/// Rounds once no wire is shared any more, and the pressure that each routing without shared wires is left with: slow
/// connections go through wires that others took first, and the best such routing counts. Of one placement the slowest path came
/// from 18.28 to 17.96 ns; with twice the rounds and three times the pressure to 18.04; of two placements nothing was gained.
const FURTHER: usize = 20;
const RELAXED: u64 = 64;

/// Power of the weights of slow connections. Of one placement of three seeds the slowest path came to 23.1, 24.1 and
/// 25.4 ns with the fifth, to 22.8, 23.8 and 23.4 ns with the third.
const POWER: u32 = 3;
/// A net with a connection of this weight is routed again in every round, shared or not. On the same placements that
/// left the slowest path as it was; up to a fifteenth fewer ends lay above 60 % of the period.
const URGENT: u16 = 200;

/// A routed design.
#[derive(Clone, Debug)]
pub struct Routing {
    /// Wires of every general net, in the order of `Nets::general`.
    pub general: Vec<Tree>,
    /// Wires of every clock net, in the order of `Nets::clocks`.
    pub clocks: Vec<Tree>,
    /// Wire delay of every connection, in ps.
    pub delays: Vec<u32>,
    /// Rounds until no wire was shared.
    pub rounds: usize,
}

impl Routing {
    /// Routes a placed design.
    ///
    /// # Errors
    /// A pin that the device does not have, or wires that stay shared.
    pub fn of(
        device: &Device,
        design: &Design<'_>,
        placement: &Placement,
        progress: &mut Progress<'_>,
    ) -> Result<Self, FlowError> {
        let terminals = Terminals::of(device, design, placement)?;
        let fabric = Fabric::of(device);
        let mut search = Search::new(&fabric);
        let mut congestion = Congestion::new(fabric.wires(), FIRST_PRESSURE);
        let reserved = terminals.general.iter().flat_map(|net| &net.sinks).map(|wire| wire.0);
        search.reserve(reserved);
        let clocks = Self::clocks(device, design, &terminals, &mut search)?;
        let mut general = vec![Tree::default(); terminals.general.len()];
        let mut delays = placement.estimate(design.nets, &Reach::of(device));
        let mut order: Vec<usize> = (0..general.len()).collect();
        order.sort_by_key(|net| (std::cmp::Reverse(terminals.general[*net].sinks.len()), *net));
        let aims = design.graph.aims();
        let mut best: Option<(i64, Self)> = None;
        let mut round = 0;
        while round < best.as_ref().map_or(ROUNDS, |(_, first)| first.rounds + FURTHER) {
            let weights = weights(&Report::of(&aims, &delays).criticality, POWER);
            for net in &order {
                let first = design.graph.first[*net] as usize;
                let ends = &terminals.general[*net];
                let urgent = weights[first..first + ends.sinks.len()].iter().any(|weight| *weight >= URGENT);
                let shared = || general[*net].wires(ends.source).any(|wire| congestion.is_shared(wire));
                if !(round == 0 || urgent || shared()) {
                    continue;
                }
                general[*net].wires(ends.source).for_each(|wire| congestion.leave(wire));
                let tree = search
                    .tree(ends, &weights[first..], &congestion)
                    .ok_or_else(|| FlowError::Unroutable { net: name(design, &design.nets.general[*net]) })?;
                tree.wires(ends.source).for_each(|wire| congestion.enter(wire));
                general[*net] = tree;
            }
            for (net, tree) in general.iter().enumerate() {
                let first = design.graph.first[net] as usize;
                tree.delays(&fabric, &terminals.general[net], &mut delays[first..]);
            }
            let left = congestion.settle(PRESSURE_GROWTH, LAST_PRESSURE);
            round += 1;
            progress.tell(Stage::Route, percent(left, general.len()), || format!("round {round}: {left} wires shared"));
            if left > 0 {
                continue;
            }
            let missed = Report::of(&aims, &delays).misses() + Report::of(design.graph, &delays).inside_misses();
            if best.as_ref().is_none_or(|(least, _)| missed < *least) {
                let rounds = best.as_ref().map_or(round, |(_, first)| first.rounds);
                best = Some((
                    missed,
                    Self { general: general.clone(), clocks: clocks.clone(), delays: delays.clone(), rounds },
                ));
            }
            congestion.relax(RELAXED);
        }
        best.map(|(_, routing)| routing)
            .ok_or_else(|| FlowError::Congested { rounds: ROUNDS, wires: congestion.shared() })
    }

    fn clocks(
        device: &Device,
        design: &Design<'_>,
        terminals: &Terminals,
        search: &mut Search<'_>,
    ) -> Result<Vec<Tree>, FlowError> {
        let tree = |(index, ends): (usize, &terminals::Ends)| {
            search
                .clock_tree(device, ends)
                .ok_or_else(|| FlowError::Unroutable { net: name(design, &design.nets.clocks[index]) })
        };
        terminals.clocks.iter().enumerate().map(tree).collect()
    }

    /// Wires in use, clocks apart.
    #[must_use]
    pub fn used(&self, terminals: &Terminals) -> usize {
        self.general.iter().zip(&terminals.general).map(|(tree, ends)| tree.wires(ends.source).count()).sum()
    }
}

fn name(design: &Design<'_>, routed: &Routed) -> String {
    design.logic.nets[routed.net.index()].clone()
}

fn percent(left: usize, nets: usize) -> u32 {
    // Sharing falls about by a third a round: the logarithm is the work that remains.
    let bits = |number: usize| usize::BITS - number.leading_zeros();
    100 - (bits(left) * 100 / bits(8 * nets.max(1))).min(100)
}

/// A wire as an index.
fn at(wire: WireId) -> usize {
    wire.0 as usize
}
