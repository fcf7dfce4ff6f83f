//! Tables without constants, inverters, doubled or idle inputs.

use super::{Aliases, Logic, Raw, Table};
use crate::flow::FlowError;
use crate::flow::netlist::{Net, Netlist, Signal};
use std::collections::BTreeMap;

/// Simplifies all tables of the netlist into `logic.tables`, and returns what became of the others.
pub(super) fn simplify(logic: &mut Logic, luts: Vec<Raw>, netlist: &Netlist) -> Result<Aliases, FlowError> {
    let mut aliases = Aliases(BTreeMap::new());
    let mut left = luts;
    loop {
        let before = left.len();
        let mut next = Vec::with_capacity(before);
        for mut lut in left {
            lut.inputs = lut.inputs.iter().map(|signal| aliases.resolve(*signal)).collect();
            let table = reduce(&lut.inputs, lut.table);
            let alias = match (&table.inputs[..], table.table) {
                ([], word) => Signal::Constant(word & 1 == 1),
                ([net], word) => Signal::Wire { net: *net, inverted: word & 1 == 1 },
                _ => {
                    lut.inputs = table.inputs.iter().map(|net| Signal::of(*net)).collect();
                    lut.table = table.table;
                    next.push(lut);
                    continue;
                }
            };
            if alias.net() == Some(lut.output) {
                let what = format!("net {} drives itself", netlist.nets[lut.output.index()]);
                return Err(FlowError::Netlist { what });
            }
            aliases.0.insert(lut.output, alias);
        }
        left = next;
        if left.len() == before {
            break;
        }
    }
    for lut in left {
        logic.tables.insert(lut.output, reduce(&lut.inputs, lut.table));
    }
    Ok(aliases)
}

/// A function of signals as one of distinct nets that all matter.
pub(super) fn reduce(inputs: &[Signal], table: u16) -> Table {
    let mut nets: Vec<Net> = inputs.iter().filter_map(|signal| signal.net()).collect();
    nets.sort_unstable();
    nets.dedup();
    let value = |word: usize| {
        let inner = inputs.iter().enumerate().fold(0, |inner, (at, signal)| {
            let bit = match signal {
                Signal::Constant(value) => *value,
                Signal::Open => false,
                Signal::Wire { net, inverted } => {
                    let from = nets.binary_search(net).expect("listed");
                    (word >> from & 1 == 1) != *inverted
                }
            };
            inner | usize::from(bit) << at
        });
        table >> inner & 1 == 1
    };
    let of = |word: usize| value(word & ((1 << nets.len()) - 1));
    let full = (0..16).fold(0, |full, word| full | u16::from(of(word)) << word);
    without_idle(nets, full)
}

fn without_idle(mut nets: Vec<Net>, mut table: u16) -> Table {
    for at in (0..nets.len()).rev() {
        let matters = (0..16).any(|word: usize| (table >> word & 1) != (table >> (word ^ 1 << at) & 1));
        if !matters {
            nets.remove(at);
            // Words of fewer inputs: a zero goes where the idle input was.
            let narrow = |word: usize| word & ((1 << at) - 1) | (word >> at) << (at + 1);
            table = (0..16).fold(0, |new, word| new | (table >> (narrow(word) & 15) & 1) << word);
        }
    }
    Table { inputs: nets, table }
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: Net = Net(3);
    const B: Net = Net(5);

    #[test]
    fn an_inverter_goes_into_the_table() {
        // and(not a, b)
        let table = reduce(&[Signal::of(A).inverse(), Signal::of(B)], 0b1000);
        assert_eq!(table, Table { inputs: vec![A, B], table: 0x4444 });
    }

    #[test]
    fn constants_and_doubled_inputs_vanish() {
        // xor of three, the last constant 1: xnor
        let table = reduce(&[Signal::of(B), Signal::of(A), Signal::Constant(true)], 0b1001_0110);
        assert_eq!(table, Table { inputs: vec![A, B], table: 0x9999 });
        assert_eq!(reduce(&[Signal::of(A), Signal::of(A)], 0b0110), Table::constant(false));
    }

    #[test]
    fn an_input_that_does_not_matter_is_not_routed() {
        // i1 ? i0 : i0
        let table = reduce(&[Signal::of(A), Signal::of(B)], 0b1010);
        assert_eq!(table, Table { inputs: vec![A], table: 0xAAAA });
        let high = reduce(&[Signal::of(A), Signal::of(B), Signal::of(Net(7))], 0b1111_0000);
        assert_eq!(high, Table { inputs: vec![Net(7)], table: 0xAAAA });
    }

    #[test]
    fn inputs_may_go_to_any_pins() {
        let and = Table { inputs: vec![A, B], table: 0x8888 };
        // a on pin 3, b on pin 0
        assert_eq!(and.permuted(&[3, 0]), 0xAA00);
    }
}
