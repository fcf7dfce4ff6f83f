//! Pairs of tables under the slice's multiplexer (MUXF5).
//!
//! The second level (MUXF6) becomes a table: which of its inputs is which was not confirmed on real
//! files. A pair whose inputs are four or fewer becomes one table.

use super::{Logic, Table, tables};
use crate::flow::netlist::{Net, Signal, WideMux};
use std::collections::BTreeMap;

/// A pair of tables: `output = select ? high : low`.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Wide {
    /// Which table.
    pub select: Signal,
    /// For select 0: the G table.
    pub low: Table,
    /// For select 1: the F table.
    pub high: Table,
    /// The net that F5 drives.
    pub output: Net,
}

/// Turns the multiplexers into pairs or tables.
pub(super) fn build(logic: &mut Logic, muxes: &[WideMux]) {
    let mut pairs: BTreeMap<Net, Wide> = BTreeMap::new();
    for mux in muxes.iter().filter(|mux| !mux.second) {
        let table = |signal: Signal| match signal.net().and_then(|net| logic.tables.get(&net)) {
            Some(table) if matches!(signal, Signal::Wire { inverted: false, .. }) => table.clone(),
            _ => Table::of(signal),
        };
        let (low, high) = (table(mux.low), table(mux.high));
        match merged(mux.select, &low, &high) {
            Some(table) => drop(logic.tables.insert(mux.output, table)),
            None => drop(pairs.insert(mux.output, Wide { select: mux.select, low, high, output: mux.output })),
        }
    }
    for mux in muxes.iter().filter(|mux| mux.second) {
        // input word: low, high, select
        let table = tables::reduce(&[mux.low, mux.high, mux.select], 0b1100_1010);
        logic.tables.insert(mux.output, table);
    }
    logic.wides = pairs.into_values().collect();
}

/// The pair as one table, if it has at most four inputs.
fn merged(select: Signal, low: &Table, high: &Table) -> Option<Table> {
    let mut inputs: Vec<Net> = low.inputs.iter().chain(&high.inputs).copied().chain(select.net()).collect();
    inputs.sort_unstable();
    inputs.dedup();
    if inputs.len() > 4 {
        return None;
    }
    let word_of = |table: &Table, word: usize| {
        let inner = table
            .inputs
            .iter()
            .enumerate()
            .fold(0, |inner, (at, net)| inner | (word >> inputs.binary_search(net).expect("listed") & 1) << at);
        table.table >> inner & 1
    };
    let chosen = |word: usize| match select {
        Signal::Constant(value) => value,
        Signal::Open => false,
        Signal::Wire { net, inverted } => (word >> inputs.binary_search(&net).expect("listed") & 1 == 1) != inverted,
    };
    let table = (0..16).fold(0, |all, word| all | word_of(if chosen(word) { high } else { low }, word) << word);
    let signals: Vec<Signal> = inputs.iter().map(|net| Signal::of(*net)).collect();
    Some(tables::reduce(&signals, table))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_pair_is_one_table() {
        let (a, b, s) = (Net(0), Net(1), Net(2));
        let and = Table { inputs: vec![a, b], table: 0x8888 };
        let table = merged(Signal::of(s), &Table::constant(true), &and).unwrap();
        assert_eq!(table.inputs, [a, b, s]);
        // s ? a & b : 1
        assert_eq!(table.table & 0xFF, 0b1000_1111);
    }

    #[test]
    fn a_large_pair_stays() {
        let four = |first| Table { inputs: (first..first + 4).map(Net).collect(), table: 0x6996 };
        assert_eq!(merged(Signal::of(Net(9)), &four(0), &four(0)), None);
    }
}
