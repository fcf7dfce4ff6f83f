//! A routed net.

use super::at;
use super::terminals::Ends;
use crate::device::{PipId, WireId};
use crate::flow::fabric::Fabric;
use std::collections::BTreeMap;

/// A switch of a net, from a wire of the tree to a new one.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Branch {
    /// Wire of the tree that drives the switch.
    pub from: WireId,
    /// Wire that it leads to, new in the tree.
    pub to: WireId,
    /// Through this switch.
    pub pip: PipId,
}

/// A net's wires: branches in an order in which each starts at the source or where another ended.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Tree {
    /// Pass gates from the source outwards.
    pub branches: Vec<Branch>,
}

impl Tree {
    /// Wires that the net takes: none while it has no branch.
    pub(super) fn wires(&self, source: WireId) -> impl Iterator<Item = WireId> + '_ {
        let first = (!self.branches.is_empty()).then_some(source);
        first.into_iter().chain(self.branches.iter().map(|branch| branch.to))
    }

    /// Delay from the source to every sink.
    pub(super) fn delays(&self, fabric: &Fabric, ends: &Ends, delays: &mut [u32]) {
        let mut reached: BTreeMap<WireId, u32> = BTreeMap::from([(ends.source, 0)]);
        for branch in &self.branches {
            let time = reached.get(&branch.from).copied().unwrap_or(0) + u32::from(fabric.lanes[at(branch.to)].delay);
            reached.insert(branch.to, time);
        }
        for (sink, delay) in ends.sinks.iter().zip(delays) {
            *delay = reached.get(sink).copied().unwrap_or(0);
        }
    }
}
