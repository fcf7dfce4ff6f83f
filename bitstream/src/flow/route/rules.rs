//! What every routed design must keep: one net a wire, and the limits of pass gates.

use super::terminals::Terminals;
use super::tree::Tree;
use super::{GATES, JOINED, Routing};
use crate::device::{Device, PipId, PipKind, WireFamily, WireId};
use std::collections::BTreeMap;
use thiserror::Error;

/// A broken rule.
#[derive(Clone, Debug, Eq, Error, PartialEq)]
pub enum RouteFault {
    /// Two nets on a wire, or one twice.
    #[error("{wire} is driven by nets {first} and {second}")]
    Shared {
        /// Tile and name of what two nets drive.
        wire: String,
        /// A net's number.
        first: usize,
        /// Another's, or the same.
        second: usize,
    },
    /// A branch that starts where its net is not.
    #[error("net {net} starts a branch at {wire}, which it does not reach")]
    Loose {
        /// The net's number.
        net: usize,
        /// Tile and name of where the branch starts.
        wire: String,
    },
    /// A sink that the net does not reach.
    #[error("net {net} does not reach {wire}")]
    Open {
        /// The net's number.
        net: usize,
        /// Tile and name of the pin that waits for it.
        wire: String,
    },
    /// Too many pass gates in series.
    #[error("net {net} goes through {gates} pass gates in series")]
    Gates {
        /// The net's number.
        net: usize,
        /// How many.
        gates: u8,
    },
    /// Too many single-length wires joined.
    #[error("net {net} joins {wires} single-length wires by pass gates")]
    Joined {
        /// The net's number.
        net: usize,
        /// How many.
        wires: u8,
    },
}

/// The largest figures of a design.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Extremes {
    /// Pass gates in series.
    pub gates: u8,
    /// Wires joined by them.
    pub joined: u8,
}

/// Checks a routing, and says how near to the limits it came.
///
/// # Errors
/// The first broken rule.
pub fn check(device: &Device, routing: &Routing, terminals: &Terminals) -> Result<Extremes, RouteFault> {
    let mut owners: BTreeMap<WireId, usize> = BTreeMap::new();
    let mut extremes = Extremes::default();
    let trees = routing.general.iter().chain(&routing.clocks);
    for (net, (tree, ends)) in trees.zip(terminals.general.iter().chain(&terminals.clocks)).enumerate() {
        for wire in tree.wires(ends.source) {
            if let Some(first) = owners.insert(wire, net) {
                return Err(RouteFault::Shared { wire: device.describe_wire(wire), first, second: net });
            }
        }
        if let Some(open) = ends.sinks.iter().find(|sink| owners.get(sink) != Some(&net)) {
            return Err(RouteFault::Open { net, wire: device.describe_wire(*open) });
        }
        let found = gates(device, net, tree, ends.source)?;
        extremes.gates = extremes.gates.max(found.gates);
        extremes.joined = extremes.joined.max(found.joined);
    }
    Ok(extremes)
}

fn gates(device: &Device, net: usize, tree: &Tree, source: WireId) -> Result<Extremes, RouteFault> {
    let is_gate = |pip: PipId| device.pip(pip).is_some_and(|pip| matches!(pip.kind, PipKind::Gate { .. }));
    let mut state: BTreeMap<WireId, (u8, WireId)> = BTreeMap::from([(source, (0, source))]);
    let mut sizes: BTreeMap<WireId, u8> = BTreeMap::new();
    let mut extremes = Extremes::default();
    for branch in &tree.branches {
        let Some((depth, root)) = state.get(&branch.from).copied() else {
            return Err(RouteFault::Loose { net, wire: device.describe_wire(branch.from) });
        };
        let (depth, root) = if is_gate(branch.pip) { (depth + 1, root) } else { (0, branch.to) };
        state.insert(branch.to, (depth, root));
        if device.wire(branch.to).family == WireFamily::Single {
            let size = sizes.entry(root).or_default();
            *size += 1;
            extremes.joined = extremes.joined.max(*size);
        }
        extremes.gates = extremes.gates.max(depth);
    }
    if extremes.gates > GATES {
        return Err(RouteFault::Gates { net, gates: extremes.gates });
    }
    if extremes.joined > JOINED {
        return Err(RouteFault::Joined { net, wires: extremes.joined });
    }
    Ok(extremes)
}
