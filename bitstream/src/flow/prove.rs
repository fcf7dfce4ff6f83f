//! Proves that the circuit decoded from a configuration is the netlist that it was made from.
//!
//! Both circuits are cut at the nets that the flow says it drove from a place. Beginning at the pads, every net
//! that a proven function reads is proven in its turn: its function of cut nets is compared with that of the
//! netlist for **every** value of the cut nets (truth tables, complete). Flip-flops must have the same data, enable,
//! reset, reverse, clock and initial value, memories the same pins and contents, pads the same output, output
//! enable and electrics. The netlist has no loop of logic, so equality of all functions is equality of the
//! circuits: by induction over clocks and, within a clock, over the order of the logic.
//!
//! It shares nothing with placement, routing or the setting of bits: it sees the decoded circuit, the netlist
//! of yosys, and names.

mod circuits;
mod elements;

use super::constraints::Constraints;
use super::driver::Driver;
use super::netlist::{Net, Netlist, Signal};
use crate::device::Device;
use crate::netlist::{self, NetId};
use circuits::{Gate, Gold};
use std::collections::{BTreeMap, BTreeSet};

/// Most cut nets under a function; more are reported as not proven.
const WIDEST: usize = 14;

/// What was compared, and what differs.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Proof {
    /// Functions proven equal.
    pub functions: usize,
    /// Rows of truth tables compared.
    pub rows: u64,
    /// Cut nets under the widest function.
    pub widest: usize,
    /// Flip-flops proven.
    pub flip_flops: usize,
    /// Memories proven.
    pub memories: usize,
    /// Pads proven.
    pub pads: usize,
    /// Flip-flops of the netlist that no pad depends on.
    pub unobservable: Vec<String>,
    /// Everything that is not equal or not proven, by name.
    pub differences: Vec<String>,
}

impl Proof {
    /// Whether all is proven.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.differences.is_empty()
    }
}

/// Compares what was asked for with what the decoded bits do.
#[must_use]
pub fn prove(
    device: &Device,
    gold: &Netlist,
    constraints: &Constraints,
    drivers: &[Driver],
    gate: &netlist::Netlist,
) -> Proof {
    let gold_circuit = Gold::of(gold);
    let mut prover = Prover {
        gate: Gate::of(gate, gold, &gold_circuit, constraints, drivers),
        gold: gold_circuit,
        proof: Proof::default(),
        todo: Vec::new(),
        seen: BTreeSet::new(),
    };
    if let Some(net) = prover.gold.looped() {
        prover.proof.differences.push(format!("the netlist has a loop of logic at {}", gold.nets[net.index()]));
        return prover.proof;
    }
    if let Some(id) = prover.gate.looped() {
        prover.differ(format!("the decoded circuit has a loop of logic at {}", gate.nets[id.0 as usize]));
        return prover.proof;
    }
    prover.pads(device, gold, constraints, gate);
    while let Some(id) = prover.todo.pop() {
        prover.net(id, gold, gate);
    }
    prover.memories(gold, gate);
    let proven: BTreeSet<Net> = prover.seen.iter().filter_map(|id| prover.gate.names.get(id).copied()).collect();
    let unseen = gold.flip_flops.iter().filter(|flop| !proven.contains(&flop.output));
    prover.proof.unobservable = unseen.map(|flop| gold.nets[flop.output.index()].clone()).collect();
    prover.proof
}

struct Prover<'a> {
    gate: Gate<'a>,
    gold: Gold<'a>,
    proof: Proof,
    /// Nets of the decoded circuit whose functions are to be proven.
    todo: Vec<NetId>,
    seen: BTreeSet<NetId>,
}

impl Prover<'_> {
    fn differ(&mut self, what: String) {
        self.proof.differences.push(what);
    }

    /// Compares two functions for all values of the cut nets. A net of the netlist is looked into, cut or not: inside a
    /// slice it may go on without its name.
    fn same(&mut self, what: &str, gate: netlist::Signal, gold: Signal) -> bool {
        let mut open: BTreeSet<Net> = gold.net().into_iter().filter(|net| self.gold.is_logic(*net)).collect();
        let leaves = loop {
            let mut leaves: BTreeSet<Net> = BTreeSet::new();
            let mut read: BTreeSet<NetId> = BTreeSet::new();
            if let Err(fault) = self.gate.support(gate, &open, &mut leaves, &mut read) {
                self.differ(format!("{what}: {fault}"));
                return false;
            }
            self.gold.support(gold, &open, &self.gate.cuts, &mut leaves);
            // A leaf that is a function of other leaves is none: a table may stand inside a slice and outside.
            let thin: Vec<Net> = leaves.iter().copied().filter(|net| self.depends(*net, &open, &leaves)).collect();
            if thin.is_empty() {
                let fresh: Vec<NetId> = read.into_iter().filter(|id| self.seen.insert(*id)).collect();
                self.todo.extend(fresh);
                break leaves;
            }
            open.extend(thin);
        };
        if leaves.len() > WIDEST {
            self.differ(format!("{what}: not proven, a function of {} nets", leaves.len()));
            return false;
        }
        let leaves: Vec<Net> = leaves.into_iter().collect();
        let rows = 1_u64 << leaves.len();
        for row in 0..rows {
            let values: BTreeMap<Net, bool> =
                leaves.iter().enumerate().map(|(at, net)| (*net, row >> at & 1 == 1)).collect();
            if self.gate.value(gate, &open, &values) != self.gold.value(gold, &open, &values) {
                self.differ(format!("{what}: another function"));
                return false;
            }
        }
        self.proof.functions += 1;
        self.proof.rows += rows;
        self.proof.widest = self.proof.widest.max(leaves.len());
        true
    }

    /// Whether a leaf is a function of other leaves.
    fn depends(&self, net: Net, open: &BTreeSet<Net>, leaves: &BTreeSet<Net>) -> bool {
        if !self.gold.is_logic(net) {
            return false;
        }
        let (mut open, mut under) = (open.clone(), BTreeSet::new());
        open.insert(net);
        self.gold.support(Signal::of(net), &open, &self.gate.cuts, &mut under);
        under.iter().all(|other| leaves.contains(other))
    }

    /// Proves what drives a net of the decoded circuit.
    fn net(&mut self, id: NetId, gold: &Netlist, gate: &netlist::Netlist) {
        let Some(net) = self.gate.names.get(&id).copied() else { return };
        let name = format!("{} at {}", gold.nets[net.index()], gate.nets[id.0 as usize]);
        if let Some(flop) = self.gold.flip_flop(net) {
            let found = self.gate.flip_flop(id).copied();
            match found {
                Some(found) => self.flip_flop(&name, flop, &found, gold),
                None => self.differ(format!("{name}: is no flip-flop")),
            }
        } else if self.gold.is_logic(net) {
            if self.gate.is_element(id) {
                self.differ(format!("{name}: is no logic"));
            } else {
                self.same(&name, netlist::Signal::Net(id), Signal::of(net));
            }
        }
        // Pads and memories are compared as wholes.
    }
}
