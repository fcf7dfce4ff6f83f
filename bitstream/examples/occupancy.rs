//! Where tables and slices go: tables by what they are for, open halves by what keeps them open, both by block.
//!
//! ```sh
//! cargo run --release -p bitstream --example occupancy -- netlist.json TOP
//! ```

use bitstream::flow::logic::{Logic, Table};
use bitstream::flow::netlist::{Net, Netlist};
use bitstream::flow::pack::{Bypass, Packed, Slice};
use std::collections::{BTreeMap, BTreeSet};

/// What a table under a multiplexer or in a chain is, beside its function.
fn kind(table: &Table, alone: &BTreeSet<(Vec<Net>, u16)>) -> &'static str {
    match table.inputs.len() {
        0 => "a constant",
        1 => "passes one input on",
        _ if alone.contains(&(table.inputs.clone(), table.table)) => "stands alone as well",
        _ => "a function of its own",
    }
}

/// Why a half has no table; `None` if it has one.
fn open(slice: &Slice, half: usize) -> Option<&'static str> {
    let content = &slice.halves[half];
    match (content.tabled, slice.carry.is_some(), content.flop) {
        (true, ..) => None,
        (_, true, _) => Some("the end of a carry chain"),
        (_, _, None) if matches!(slice.bypass[0], Bypass::Select(_)) => Some("under a multiplexer"),
        (_, _, None) => Some("empty"),
        (_, _, Some(_)) => Some("a flip-flop by the bypass"),
    }
}

fn print(title: &str, counts: BTreeMap<String, usize>) {
    let mut sorted: Vec<_> = counts.into_iter().collect();
    sorted.sort_by_key(|(name, count)| (std::cmp::Reverse(*count), name.clone()));
    println!("{title}: {}", sorted.iter().map(|(_, count)| count).sum::<usize>());
    sorted.iter().for_each(|(name, count)| println!("{count:7}  {name}"));
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let json = std::fs::read_to_string(&arguments[0]).expect("a file");
    let netlist = Netlist::from_yosys(&json, &arguments[1]).expect("a netlist");
    println!(
        "cells: {} tables and inverters, {} carries, {} sums, {} multiplexers of tables, {} flip-flops",
        netlist.luts.len(),
        netlist.carry_muxes.len(),
        netlist.carry_xors.len(),
        netlist.wide_muxes.len(),
        netlist.flip_flops.len()
    );
    let logic = Logic::of(netlist).expect("logic");
    let packed = Packed::of(&logic).expect("slices");
    let alone: BTreeSet<(Vec<Net>, u16)> =
        logic.tables.values().map(|table| (table.inputs.clone(), table.table)).collect();
    let mut tables: BTreeMap<String, usize> = BTreeMap::new();
    for table in logic.tables.values() {
        *tables.entry(format!("alone, {} inputs", table.inputs.len())).or_default() += 1;
    }
    for wide in &logic.wides {
        for table in [&wide.low, &wide.high] {
            *tables.entry(format!("under a multiplexer: {}", kind(table, &alone))).or_default() += 1;
        }
    }
    for bit in logic.chains.iter().flat_map(|chain| &chain.bits) {
        *tables.entry(format!("in a carry chain: {}", kind(&bit.table, &alone))).or_default() += 1;
    }
    print("tables", tables);
    let mut halves: BTreeMap<String, usize> = BTreeMap::new();
    let mut blocks: BTreeMap<String, usize> = BTreeMap::new();
    let mut controls = BTreeSet::new();
    for slice in packed.slices() {
        (0..2).filter_map(|half| open(slice, half)).for_each(|why| *halves.entry(why.to_owned()).or_default() += 1);
        controls.extend(slice.control);
        let nets = slice.sources().into_iter().map(|(_, net)| &logic.nets[net.index()]);
        let name = nets.filter(|name| name.starts_with("core.")).min();
        let name = name.map_or("(no name of the source)".to_owned(), |name| {
            name.split(['.', '[']).take(2).collect::<Vec<_>>().join(".")
        });
        *blocks.entry(name).or_default() += 1;
    }
    print("halves without a table", halves);
    println!("control sets: {}", controls.len());
    print("slices", blocks);
}
