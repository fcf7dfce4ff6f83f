//! Carry chains: runs of carry multiplexers and sums that go up a column, two bits a slice.
//!
//! A slice has one setting for where its generate inputs come from, so bits are looked at in pairs.

use super::{Logic, Table};
use crate::flow::FlowError;
use crate::flow::netlist::{CarryMux, CarryXor, Net, Signal};
use std::collections::{BTreeMap, BTreeSet};

/// Slices in a column of the device, and so the longest run of a chain.
pub(crate) const COLUMN_SLICES: usize = 28;

/// What a carry multiplexer gives when its select is 0.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Data {
    /// Ground.
    Zero,
    /// Supply.
    One,
    /// The first input pin of the table, joined to this net.
    Pin(Net),
}

/// A LUT with the carry multiplexer and exclusive-or beside it.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct ChainBit {
    /// The half sum, which is also the select of the carry.
    pub table: Table,
    /// Whether the carry multiplexer listens to the table; else the carry passes.
    pub selects: bool,
    /// What is generated.
    pub data: Data,
    /// The net of the sum, table ^ carry.
    pub sum: Option<Net>,
    /// The net of the carry out.
    pub carry: Option<Net>,
    /// The same, where something beside the chain reads it.
    pub carry_out: Option<Net>,
    /// The net of the table's own output, where the chain's slice shows it.
    pub shows: Option<Net>,
}

/// A chain: bits from the lowest, two a slice.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Chain {
    /// Carry into the first bit.
    pub carry: Signal,
    /// Lowest first: two a slice, upwards.
    pub bits: Vec<ChainBit>,
}

/// Forms the chains.
pub(super) fn build(logic: &mut Logic, muxes: Vec<CarryMux>, xors: Vec<CarryXor>) -> Result<(), FlowError> {
    let outputs: BTreeSet<Net> = muxes.iter().map(|mux| mux.output).collect();
    let mut by_carry: BTreeMap<Signal, Vec<CarryMux>> = BTreeMap::new();
    for mux in muxes {
        by_carry.entry(mux.carry).or_default().push(mux);
    }
    let mut sums: BTreeMap<Signal, Vec<CarryXor>> = BTreeMap::new();
    for xor in xors {
        sums.entry(xor.carry).or_default().push(xor);
    }
    let mut builder = Builder { logic, by_carry, sums, carried: BTreeSet::new() };
    // Chains begin at carries that no multiplexer makes, then where a carry has a second reader.
    let starts: Vec<Signal> = builder.by_carry.keys().copied().collect();
    for start in starts.iter().filter(|start| start.net().is_none_or(|net| !outputs.contains(&net))) {
        while builder.by_carry.contains_key(start) {
            builder.chain(*start);
        }
    }
    while let Some(start) = builder.by_carry.keys().next().copied() {
        if !start.net().is_some_and(|net| builder.carried.contains(&net)) {
            return Err(FlowError::Netlist { what: "a carry chain that goes round in a circle".into() });
        }
        builder.chain(start);
    }
    builder.lone_sums();
    builder.mark_outputs();
    Ok(())
}

struct Builder<'a> {
    logic: &'a mut Logic,
    by_carry: BTreeMap<Signal, Vec<CarryMux>>,
    sums: BTreeMap<Signal, Vec<CarryXor>>,
    /// Carries that chains make.
    carried: BTreeSet<Net>,
}

/// A bit before its slice is known.
struct Loose {
    select: Signal,
    data: Option<Signal>,
    sum: Option<Net>,
    carry: Option<Net>,
}

impl Builder<'_> {
    /// Takes a chain from this carry on.
    fn chain(&mut self, start: Signal) {
        let mut loose = Vec::new();
        let mut carry = start;
        while let Some(mux) = self.take(carry) {
            let sum = self.take_sum(carry, Some(mux.select));
            let data = if mux.data == Signal::Open { Signal::Constant(false) } else { mux.data };
            loose.push(Loose { select: mux.select, data: Some(data), sum, carry: Some(mux.output) });
            self.carried.insert(mux.output);
            carry = Signal::of(mux.output);
        }
        if let Some(xor) = self.sums.get_mut(&carry).and_then(Vec::pop) {
            loose.push(Loose { select: xor.input, data: None, sum: Some(xor.output), carry: None });
        }
        let mut carry = start;
        for run in loose.chunks(2 * COLUMN_SLICES) {
            let bits: Vec<ChainBit> = run.chunks(2).flat_map(|pair| self.pair(pair)).collect();
            self.logic.chains.push(Chain { carry, bits });
            carry = run.last().and_then(|bit| bit.carry).map_or(Signal::Open, Signal::of);
        }
    }

    fn take(&mut self, carry: Signal) -> Option<CarryMux> {
        let muxes = self.by_carry.get_mut(&carry)?;
        let mux = muxes.remove(0);
        if muxes.is_empty() {
            self.by_carry.remove(&carry);
        }
        Some(mux)
    }

    fn take_sum(&mut self, carry: Signal, select: Option<Signal>) -> Option<Net> {
        let sums = self.sums.get_mut(&carry)?;
        let at = sums.iter().position(|xor| Some(xor.input) == select)?;
        Some(sums.remove(at).output)
    }

    /// Bits of one slice, whose data pins must agree.
    fn pair(&mut self, pair: &[Loose]) -> Vec<ChainBit> {
        let constant = |bit: &Loose| match bit.data {
            Some(Signal::Constant(value)) => Some(value),
            _ => None,
        };
        let wired = pair.iter().any(|bit| bit.data.is_some_and(|data| data.net().is_some()));
        let mixed = pair.iter().filter_map(constant).collect::<BTreeSet<_>>().len() > 1;
        pair.iter().map(|bit| self.bit(bit, wired || mixed)).collect()
    }

    fn bit(&mut self, bit: &Loose, by_pin: bool) -> ChainBit {
        let tabled = bit.select.net().and_then(|net| self.logic.tables.get(&net));
        let mut table = match (tabled, bit.select) {
            (Some(table), Signal::Wire { inverted: false, .. }) => table.clone(),
            _ => Table::of(bit.select),
        };
        let data = match bit.data {
            Some(Signal::Constant(value)) if !by_pin => {
                if value {
                    Data::One
                } else {
                    Data::Zero
                }
            }
            Some(signal) => match self.logic.plain(signal) {
                Signal::Wire { net, .. } => Data::Pin(net),
                _ => Data::One,
            },
            None => Data::Zero,
        };
        // The pin of the data must be an input of the table already, or free.
        let full = table.inputs.len() == 4;
        let taken = match data {
            Data::Pin(net) => full && !table.inputs.contains(&net),
            _ => full && by_pin && bit.data.is_some(),
        };
        if taken {
            table = Table::of(bit.select);
        }
        ChainBit {
            table,
            selects: bit.data.is_some(),
            data,
            sum: bit.sum,
            carry: bit.carry,
            carry_out: bit.carry,
            shows: bit.select.net(),
        }
    }

    /// Sums whose carry is no chain's: tables.
    fn lone_sums(&mut self) {
        for xor in std::mem::take(&mut self.sums).into_values().flatten() {
            let table = super::tables::reduce(&[xor.input, xor.carry], 0b0110);
            self.logic.tables.insert(xor.output, table);
        }
    }

    /// Leaves a carry's net only where something beside its chain reads it.
    fn mark_outputs(&mut self) {
        let mut uses = self.logic.uses();
        for table in self.logic.tables.values() {
            table.inputs.iter().for_each(|net| uses[net.index()] += 1);
        }
        for bit in self.logic.chains.iter_mut().flat_map(|chain| &mut chain.bits) {
            bit.carry_out = bit.carry_out.filter(|net| uses[net.index()] > 0);
        }
    }
}
