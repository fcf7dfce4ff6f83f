//! The two circuits, each as functions of cut nets.

use crate::flow::constraints::Constraints;
use crate::flow::driver::Driver;
use crate::flow::netlist::{CarryMux, CarryXor, FlipFlop, Lut, Net, Netlist, Signal, WideMux};
use crate::netlist::{self, CellKind, NetId};
use std::collections::{BTreeMap, BTreeSet};

/// Logic of the netlist.
enum Logic<'a> {
    Lut(&'a Lut),
    Carry(&'a CarryMux),
    Xor(&'a CarryXor),
    Wide(&'a WideMux),
}

/// The netlist that was the input of the flow.
pub(super) struct Gold<'a> {
    logic: BTreeMap<Net, Logic<'a>>,
    flip_flops: BTreeMap<Net, &'a FlipFlop>,
}

impl<'a> Gold<'a> {
    pub(super) fn of(netlist: &'a Netlist) -> Self {
        let mut logic: BTreeMap<Net, Logic<'a>> = BTreeMap::new();
        logic.extend(netlist.luts.iter().map(|lut| (lut.output, Logic::Lut(lut))));
        logic.extend(netlist.carry_muxes.iter().map(|mux| (mux.output, Logic::Carry(mux))));
        logic.extend(netlist.carry_xors.iter().map(|xor| (xor.output, Logic::Xor(xor))));
        logic.extend(netlist.wide_muxes.iter().map(|mux| (mux.output, Logic::Wide(mux))));
        let flip_flops = netlist.flip_flops.iter().map(|flop| (flop.output, flop)).collect();
        Self { logic, flip_flops }
    }

    pub(super) fn is_logic(&self, net: Net) -> bool {
        self.logic.contains_key(&net)
    }

    pub(super) fn flip_flop(&self, net: Net) -> Option<&'a FlipFlop> {
        self.flip_flops.get(&net).copied()
    }

    fn inputs(&self, net: Net) -> Vec<Signal> {
        match self.logic.get(&net) {
            None => Vec::new(),
            Some(Logic::Lut(lut)) => lut.inputs.clone(),
            Some(Logic::Carry(mux)) => vec![mux.select, mux.carry, mux.data],
            Some(Logic::Xor(xor)) => vec![xor.input, xor.carry],
            Some(Logic::Wide(mux)) => vec![mux.select, mux.low, mux.high],
        }
    }

    /// A net on a loop of logic, if there is one.
    pub(super) fn looped(&self) -> Option<Net> {
        let read =
            |net| self.inputs(net).into_iter().filter_map(Signal::net).filter(|net| self.is_logic(*net)).collect();
        looped(self.logic.keys().copied(), read)
    }

    /// Nets under a signal at which it is cut; nets in `open` are looked into.
    pub(super) fn support(&self, of: Signal, open: &BTreeSet<Net>, cuts: &BTreeSet<Net>, leaves: &mut BTreeSet<Net>) {
        let Some(net) = of.net() else { return };
        if self.is_logic(net) && (open.contains(&net) || !cuts.contains(&net)) {
            for input in self.inputs(net) {
                self.support(input, open, cuts, leaves);
            }
        } else {
            leaves.insert(net);
        }
    }

    pub(super) fn value(&self, of: Signal, open: &BTreeSet<Net>, values: &BTreeMap<Net, bool>) -> bool {
        let (net, inverted) = match of {
            Signal::Constant(value) => return value,
            Signal::Open => return false,
            Signal::Wire { net, inverted } => (net, inverted),
        };
        let known = if open.contains(&net) { None } else { values.get(&net).copied() };
        let value = |signal: Signal| self.value(signal, open, values);
        known.unwrap_or_else(|| match &self.logic.get(&net) {
            None => values.get(&net).copied().unwrap_or(false),
            Some(Logic::Lut(lut)) => {
                let word =
                    lut.inputs.iter().enumerate().fold(0, |word, (at, input)| word | usize::from(value(*input)) << at);
                lut.table >> word & 1 == 1
            }
            Some(Logic::Carry(mux)) => value(if value(mux.select) { mux.carry } else { mux.data }),
            Some(Logic::Xor(xor)) => value(xor.input) != value(xor.carry),
            Some(Logic::Wide(mux)) => value(if value(mux.select) { mux.high } else { mux.low }),
        }) != inverted
    }
}

/// The circuit that was decoded.
pub(super) struct Gate<'a> {
    cells: BTreeMap<NetId, &'a CellKind>,
    /// Nets that have a name in the netlist.
    pub(super) names: BTreeMap<NetId, Net>,
    /// Logic of the netlist that has a place.
    pub(super) cuts: BTreeSet<Net>,
}

impl<'a> Gate<'a> {
    pub(super) fn of(
        gate: &'a netlist::Netlist,
        netlist: &Netlist,
        gold: &Gold<'_>,
        constraints: &Constraints,
        drivers: &[Driver],
    ) -> Self {
        let mut cells: BTreeMap<NetId, &CellKind> = BTreeMap::new();
        for cell in &gate.cells {
            for output in outputs(&cell.kind) {
                cells.insert(output, &cell.kind);
            }
        }
        let by_name: BTreeMap<&str, Net> =
            netlist.nets.iter().enumerate().map(|(at, name)| (name.as_str(), Net(at as u32))).collect();
        let by_place: BTreeMap<String, Net> = drivers
            .iter()
            .filter_map(|driver| {
                let element = match driver.element.as_str() {
                    "BRAM" => "RAM".to_owned(),
                    slice => format!("S{}", slice.trim_start_matches("SLICE[").trim_end_matches(']')),
                };
                let place = format!("X{}Y{}_{element}_{}", driver.at.0, driver.at.1, driver.pin);
                Some((place, *by_name.get(driver.net.as_str())?))
            })
            .collect();
        let mut names = BTreeMap::new();
        for (at, name) in gate.nets.iter().enumerate() {
            by_place.get(name).map(|net| names.insert(NetId(at as u32), *net));
        }
        for pad in &gate.pads {
            let port = pad.pin.and_then(|pin| constraints.pads.iter().find(|(_, pad)| pad.pin == pin));
            let found = port.and_then(|(port, _)| netlist.pads.iter().find(|pad| pad.port == *port));
            if let (Some(id), Some(net)) = (pad.input, found.and_then(|pad| pad.input)) {
                names.insert(id, net);
            }
        }
        let cuts = names.values().copied().filter(|net| gold.is_logic(*net)).collect();
        Self { cells, names, cuts }
    }

    /// A net on a loop of logic, if there is one: nothing else here looks for an end of it.
    pub(super) fn looped(&self) -> Option<NetId> {
        let logic = |id: &NetId| self.cells.contains_key(id) && !self.is_element(*id);
        let read = |id| {
            let nets = inputs(self.cells[&id]).into_iter().filter_map(|signal| match signal {
                netlist::Signal::Net(id) | netlist::Signal::Not(id) => Some(id),
                netlist::Signal::Zero | netlist::Signal::One => None,
            });
            nets.filter(logic).collect()
        };
        looped(self.cells.keys().copied().filter(logic), read)
    }

    pub(super) fn flip_flop(&self, id: NetId) -> Option<&'a netlist::FlipFlop> {
        match self.cells.get(&id) {
            Some(CellKind::FlipFlop(flop)) => Some(flop),
            _ => None,
        }
    }

    /// Whether something drives the net that is no logic.
    pub(super) fn is_element(&self, id: NetId) -> bool {
        !self.cells.get(&id).is_some_and(|kind| {
            matches!(
                kind,
                CellKind::Alias { .. }
                    | CellKind::Lut { .. }
                    | CellKind::Mux { .. }
                    | CellKind::Xor { .. }
                    | CellKind::And { .. }
            )
        })
    }

    /// The clock buffer's input after a clock, as a net.
    pub(super) fn clock(&self, signal: netlist::Signal) -> Option<Net> {
        let netlist::Signal::Net(id) = signal else { return None };
        match self.cells.get(&id) {
            Some(CellKind::ClockBuffer { input, enable: netlist::Signal::One, .. }) => self.alias(*input),
            _ => None,
        }
    }

    fn alias(&self, signal: netlist::Signal) -> Option<Net> {
        let netlist::Signal::Net(id) = signal else { return None };
        match self.cells.get(&id) {
            Some(CellKind::Alias { input, .. }) => self.alias(*input),
            Some(CellKind::Lut { table: 0xAAAA, inputs, .. }) => self.alias(inputs[0]),
            _ => self.names.get(&id).copied(),
        }
    }

    /// Cut nets under a signal, and the decoded nets that stand for them.
    pub(super) fn support(
        &self,
        of: netlist::Signal,
        open: &BTreeSet<Net>,
        leaves: &mut BTreeSet<Net>,
        read: &mut BTreeSet<NetId>,
    ) -> Result<(), String> {
        let (netlist::Signal::Net(id) | netlist::Signal::Not(id)) = of else { return Ok(()) };
        if let Some(net) = self.leaf(id, open) {
            leaves.insert(net);
            read.insert(id);
            return Ok(());
        }
        match self.cells.get(&id) {
            Some(kind) if !self.is_element(id) => {
                inputs(kind).into_iter().try_for_each(|input| self.support(input, open, leaves, read))
            }
            _ => Err("reads a net of no name in the netlist".into()),
        }
    }

    /// The net for which a decoded net stands, if it is not looked into.
    fn leaf(&self, id: NetId, open: &BTreeSet<Net>) -> Option<Net> {
        let net = self.names.get(&id).copied()?;
        (!open.contains(&net) || self.is_element(id)).then_some(net)
    }

    pub(super) fn value(&self, of: netlist::Signal, open: &BTreeSet<Net>, values: &BTreeMap<Net, bool>) -> bool {
        let (id, inverted) = match of {
            netlist::Signal::Zero => return false,
            netlist::Signal::One => return true,
            netlist::Signal::Net(id) => (id, false),
            netlist::Signal::Not(id) => (id, true),
        };
        if let Some(net) = self.leaf(id, open) {
            return values.get(&net).copied().unwrap_or(false) != inverted;
        }
        let value = |signal: netlist::Signal| self.value(signal, open, values);
        let found = match self.cells.get(&id) {
            Some(CellKind::Lut { table, inputs, .. }) => {
                let word =
                    inputs.iter().enumerate().fold(0, |word, (at, input)| word | usize::from(value(*input)) << at);
                table >> word & 1 == 1
            }
            Some(CellKind::Alias { input, .. }) => value(*input),
            Some(CellKind::Mux { select, one, zero, .. }) => value(if value(*select) { *one } else { *zero }),
            Some(CellKind::Xor { inputs: [one, other], .. }) => value(*one) != value(*other),
            Some(CellKind::And { inputs: [one, other], .. }) => value(*one) && value(*other),
            _ => false,
        };
        found != inverted
    }
}

/// A node that reads itself, at once or through others, among all that `starts` lead to.
fn looped<N: Copy + Ord>(starts: impl Iterator<Item = N>, read: impl Fn(N) -> Vec<N>) -> Option<N> {
    // Whether a node is done; those that are not are being visited.
    let mut done: BTreeMap<N, bool> = BTreeMap::new();
    for start in starts {
        let mut stack = vec![(start, false)];
        while let Some((node, left)) = stack.pop() {
            if left {
                done.insert(node, true);
                continue;
            }
            if done.contains_key(&node) {
                continue;
            }
            done.insert(node, false);
            stack.push((node, true));
            for input in read(node) {
                match done.get(&input) {
                    Some(false) => return Some(input),
                    Some(true) => {}
                    None => stack.push((input, false)),
                }
            }
        }
    }
    None
}

fn inputs(kind: &CellKind) -> Vec<netlist::Signal> {
    match kind {
        CellKind::Alias { input, .. } => vec![*input],
        CellKind::Lut { inputs, .. } => inputs.to_vec(),
        CellKind::Mux { select, one, zero, .. } => vec![*select, *one, *zero],
        CellKind::Xor { inputs, .. } | CellKind::And { inputs, .. } => inputs.to_vec(),
        _ => Vec::new(),
    }
}

fn outputs(kind: &CellKind) -> Vec<NetId> {
    match kind {
        CellKind::Alias { output, .. }
        | CellKind::Lut { output, .. }
        | CellKind::Mux { output, .. }
        | CellKind::Xor { output, .. }
        | CellKind::And { output, .. }
        | CellKind::Shift { output, .. }
        | CellKind::Ram { output, .. }
        | CellKind::Bus { output, .. }
        | CellKind::ClockBuffer { output, .. } => vec![*output],
        CellKind::FlipFlop(flop) => vec![flop.output],
        CellKind::BlockRam(memory) => {
            memory.ports.iter().flat_map(|port| port.output.iter().flatten().copied()).collect()
        }
        CellKind::Dll(dll) => dll.outputs.iter().map(|output| output.1).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::looped;

    #[test]
    fn a_loop_is_found_and_a_net_that_is_read_twice_is_none() {
        let among = |reads: &'static [&'static [usize]]| looped(0..reads.len(), |node| reads[node].to_vec());
        assert_eq!(among(&[&[1, 2], &[3], &[1, 3], &[]]), None);
        assert_eq!(among(&[&[0]]), Some(0));
        assert!(among(&[&[], &[2], &[0, 3], &[1]]).is_some());
    }
}
