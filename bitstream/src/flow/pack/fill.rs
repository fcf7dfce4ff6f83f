//! Pairs halves into slices: flip-flops by control set, tables by the nets that they share.

use super::slice::{Bypass, Control, Half, Slice};
use super::{Column, Packer, control, half_of};
use crate::flow::netlist::{Net, Signal};
use std::collections::{BTreeMap, BTreeSet};

/// Nets with more pins than this say nothing about who belongs together.
const COMMON: usize = 40;

/// A place for a half: column, slice in it, half.
type Place = (usize, usize, usize);

/// Gives every table and flip-flop that is left a place, in `room` slices where that can be.
pub(super) fn fill(packer: &mut Packer, room: usize) {
    let mut fill = Fill { sharers: BTreeMap::new(), pins: vec![0; packer.logic.nets.len()], packer };
    fill.count();
    let (mut units, lone) = fill.units();
    let lone = fill.fill_carriers(lone);
    units.extend(lone);
    let tables = fill.by_control(units);
    let tables = fill.fill_halves(tables);
    let tables = fill.fill_kin(tables, room);
    fill.pair_tables(tables);
}

/// A half that looks for a slice.
#[derive(Clone)]
struct Unit {
    half: Option<(Net, Half)>,
    flop: Option<usize>,
}

struct Fill<'a, 'b> {
    packer: &'a mut Packer<'b>,
    /// How many pins a net has.
    pins: Vec<usize>,
    /// Slices that touch a net.
    sharers: BTreeMap<Net, Vec<Place>>,
}

impl Fill<'_, '_> {
    fn count(&mut self) {
        let logic = self.packer.logic;
        let pins = &mut self.pins;
        let mut add = |net: Net| pins[net.index()] += 1;
        for (net, table) in &logic.tables {
            add(*net);
            table.inputs.iter().copied().for_each(&mut add);
        }
        for flop in &logic.flip_flops {
            add(flop.output);
            [flop.data, flop.enable, flop.reset].into_iter().filter_map(Signal::net).for_each(&mut add);
        }
        for slice in self.packer.columns.iter().flat_map(|column| &column.slices) {
            for half in &slice.halves {
                half.pins.iter().flatten().copied().for_each(&mut add);
            }
        }
        for column in 0..self.packer.columns.len() {
            self.share(column);
        }
    }

    /// Notes which nets the slices of a column touch.
    fn share(&mut self, column: usize) {
        for (row, slice) in self.packer.columns[column].slices.iter().enumerate() {
            let mut nets: Vec<Net> = slice.sinks().iter().chain(&slice.sources()).map(|pin| pin.1).collect();
            nets.sort_unstable();
            nets.dedup();
            for net in nets {
                self.sharers.entry(net).or_default().push((column, row, 0));
            }
        }
    }

    /// Tables, each with a flip-flop on its output if there is one; and the other flip-flops.
    fn units(&mut self) -> (Vec<Unit>, Vec<Unit>) {
        let logic = self.packer.logic;
        let mut by_data: BTreeMap<Net, Vec<usize>> = BTreeMap::new();
        for index in std::mem::take(&mut self.packer.left).into_iter().rev() {
            match logic.flip_flops[index].data {
                Signal::Wire { net, inverted: false } if logic.tables.contains_key(&net) => {
                    by_data.entry(net).or_default().push(index);
                }
                _ => self.packer.left.push(index),
            }
        }
        let mut units = Vec::new();
        for (net, table) in &logic.tables {
            let flop = by_data.get_mut(net).and_then(Vec::pop);
            units.push(Unit { half: Some((*net, half_of(*net, table))), flop });
        }
        let mut left = std::mem::take(&mut self.packer.left);
        left.extend(by_data.into_values().flatten());
        left.sort_unstable();
        (units, left.into_iter().map(|index| Unit { half: None, flop: Some(index) }).collect())
    }

    fn nets(&self, unit: &Unit) -> Vec<Net> {
        let mut nets = Vec::new();
        if let Some((net, half)) = &unit.half {
            nets.push(*net);
            nets.extend(half.pins.iter().flatten());
        }
        if let Some(index) = unit.flop {
            let flop = &self.packer.logic.flip_flops[index];
            nets.push(flop.output);
            nets.extend(flop.data.net());
        }
        nets.sort_unstable();
        nets.dedup();
        nets.retain(|net| self.pins[net.index()] <= COMMON);
        nets
    }

    /// How much two lists of nets have in common; a net of few pins counts more.
    fn affinity(&self, some: &[Net], others: &[Net]) -> usize {
        let shared = some.iter().filter(|net| others.binary_search(net).is_ok());
        shared.map(|net| 256 / self.pins[net.index()].max(2)).sum()
    }

    /// Puts lone flip-flops into chains and pairs with the same control set that they are joined to.
    fn fill_carriers(&mut self, lone: Vec<Unit>) -> Vec<Unit> {
        let mut left = Vec::new();
        for unit in lone {
            let index = unit.flop.expect("a flip-flop");
            let flop = &self.packer.logic.flip_flops[index];
            let places: BTreeSet<Place> =
                self.nets(&unit).iter().filter_map(|net| self.sharers.get(net)).flatten().copied().collect();
            let fits = places.into_iter().any(|(column, row, _)| {
                let slice = &mut self.packer.columns[column].slices[row];
                slice.control.is_some() && (0..2).any(|half| slice.add_flop(half, index, flop, false))
            });
            if !fits {
                left.push(unit);
            }
        }
        left
    }

    /// Pairs units with flip-flops of the same control set; returns those without a flip-flop.
    fn by_control(&mut self, units: Vec<Unit>) -> Vec<Unit> {
        let mut groups: BTreeMap<Control, Vec<Unit>> = BTreeMap::new();
        let mut tables = Vec::new();
        for unit in units {
            match unit.flop {
                Some(index) => {
                    groups.entry(control(&self.packer.logic.flip_flops[index]).0).or_default().push(unit);
                }
                None => tables.push(unit),
            }
        }
        for mut group in groups.into_values() {
            // Those with a table first: they may stand in either half of a slice with a reverse.
            group.sort_by_key(|unit| unit.half.is_none());
            let mut nets: Vec<Vec<Net>> = group.iter().map(|unit| self.nets(unit)).collect();
            while !group.is_empty() {
                let (first, own) = (group.pop().expect("not empty"), nets.pop().expect("one a unit"));
                let mut slice = Slice::default();
                self.put(&mut slice, 0, &first);
                let best = (0..group.len()).max_by_key(|other| {
                    let fits = self.put(&mut slice.clone(), 1, &group[*other]);
                    (fits, self.affinity(&own, &nets[*other]), std::cmp::Reverse(*other))
                });
                if let Some(other) = best.filter(|other| self.put(&mut slice.clone(), 1, &group[*other])) {
                    let second = group.remove(other);
                    nets.remove(other);
                    self.put(&mut slice, 1, &second);
                }
                self.packer.columns.push(Column { slices: vec![slice] });
                self.share(self.packer.columns.len() - 1);
            }
        }
        tables
    }

    /// Puts a unit into a half; says whether it fits.
    fn put(&self, slice: &mut Slice, half: usize, unit: &Unit) -> bool {
        if !slice.halves[half].is_empty() {
            return false;
        }
        let through = unit.half.is_some();
        if let Some((_, content)) = &unit.half {
            slice.halves[half] = content.clone();
        }
        unit.flop.is_none_or(|index| slice.add_flop(half, index, &self.packer.logic.flip_flops[index], through))
    }

    /// Puts tables into free halves of slices that they are joined to.
    fn fill_halves(&mut self, tables: Vec<Unit>) -> Vec<Unit> {
        let mut left = Vec::new();
        for unit in tables {
            let mut scores: BTreeMap<Place, usize> = BTreeMap::new();
            for net in self.nets(&unit) {
                for place in self.sharers.get(&net).into_iter().flatten() {
                    *scores.entry(*place).or_default() += 256 / self.pins[net.index()].max(2);
                }
            }
            let free = |place: &Place| {
                let slice = &self.packer.columns[place.0].slices[place.1];
                (0..2).rev().find(|half| is_open(slice, *half))
            };
            let best = scores.iter().filter_map(|(place, score)| Some((*score, *place, free(place)?)));
            let best = best.max_by_key(|(score, place, _)| (*score, std::cmp::Reverse(*place)));
            let Some((_, (column, row, _), half)) = best else {
                left.push(unit);
                continue;
            };
            let (_, content) = unit.half.expect("a table");
            self.add_table((column, row, half), content);
        }
        left
    }

    /// Puts a table into an open half, beside the flip-flop that may stand there.
    fn add_table(&mut self, (column, row, half): Place, content: Half) {
        let target = &mut self.packer.columns[column].slices[row].halves[half];
        let flop = target.flop;
        *target = content;
        target.flop = flop;
    }

    /// Where pairs of their own would take more slices than there are, tables go to open halves of slices that they are
    /// not joined to: those whose nets have the most alike names, which the placer has near by. Only as many as must:
    /// strangers in a slice pull it two ways.
    fn fill_kin(&mut self, mut tables: Vec<Unit>, room: usize) -> Vec<Unit> {
        let used: usize = self.packer.columns.iter().map(|column| column.slices.len()).sum();
        let fits = |tables: &[Unit]| used + tables.len().div_ceil(2) <= room;
        if fits(&tables) {
            return tables;
        }
        let logic = self.packer.logic;
        let mut open: Vec<(Place, &str)> = Vec::new();
        for (at, column) in self.packer.columns.iter().enumerate() {
            for (row, slice) in column.slices.iter().enumerate() {
                let halves = (0..2).filter(|half| is_open(slice, *half));
                let name = slice.sources().first().map_or("", |(_, net)| logic.nets[net.index()].as_str());
                open.extend(halves.map(|half| ((at, row, half), name)));
            }
        }
        while !fits(&tables) && !open.is_empty() {
            let Some((_, content)) = tables.pop().and_then(|unit| unit.half) else { break };
            let own = content.shows.map_or("", |net| logic.nets[net.index()].as_str());
            let alike = |name: &str| own.bytes().zip(name.bytes()).take_while(|(a, b)| a == b).count();
            let best = (0..open.len()).max_by_key(|index| (alike(open[*index].1), std::cmp::Reverse(*index)));
            let (place, _) = open.swap_remove(best.expect("one is open"));
            self.add_table(place, content);
        }
        tables
    }

    /// Pairs the tables that are left.
    fn pair_tables(&mut self, mut tables: Vec<Unit>) {
        let mut nets: Vec<Vec<Net>> = tables.iter().map(|unit| self.nets(unit)).collect();
        while let (Some(first), Some(own)) = (tables.pop(), nets.pop()) {
            let mut slice = Slice::default();
            self.put(&mut slice, 0, &first);
            let best = (0..tables.len()).max_by_key(|other| self.affinity(&own, &nets[*other]));
            if let Some(other) = best {
                nets.remove(other);
                let second = tables.remove(other);
                self.put(&mut slice, 1, &second);
            }
            self.packer.columns.push(Column { slices: vec![slice] });
        }
    }
}

/// Whether a half has room for a table whose output is seen.
fn is_open(slice: &Slice, half: usize) -> bool {
    let content = &slice.halves[half];
    // A carry runs through every table of its slice; a pair takes both.
    !content.tabled
        && slice.carry.is_none()
        && content.flop.is_none_or(|flop| !flop.through)
        && !matches!(slice.bypass[0], Bypass::Select(_))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::logic::{Logic, Table};
    use crate::flow::netlist::FlipFlop;

    /// Two flip-flops of different control sets and three tables, none joined to another.
    fn strangers() -> Logic {
        let mut logic = Logic { nets: (0..20).map(|net| format!("n{net}")).collect(), ..Logic::default() };
        let net = Net;
        let joined = |index| Signal::Wire { net: Net(index), inverted: false };
        for index in 0..2 {
            logic.flip_flops.push(FlipFlop {
                name: format!("flop{index}"),
                clock: net(index),
                falling: false,
                enable: Signal::Open,
                data: joined(2 + index),
                reset: Signal::Open,
                reset_value: false,
                asynchronous: false,
                initial: Some(false),
                output: net(4 + index),
            });
        }
        for index in 0..3 {
            logic.tables.insert(net(6 + index), Table::of(joined(10 + index)));
        }
        logic
    }

    #[test]
    fn tables_stand_among_strangers_only_where_there_is_no_room() {
        let logic = strangers();
        for (room, slices) in [(10, 4), (4, 4), (3, 3), (2, 2), (1, 2)] {
            let mut packer = Packer { logic: &logic, columns: Vec::new(), left: vec![0, 1] };
            fill(&mut packer, room);
            assert_eq!(packer.columns.len(), slices, "{room}");
            let halves = || packer.columns.iter().flat_map(|c| &c.slices).flat_map(|slice| &slice.halves);
            assert_eq!(halves().filter(|half| half.tabled).count(), 3);
            assert_eq!(halves().filter(|half| half.flop.is_some_and(|flop| !flop.through)).count(), 2);
        }
    }
}
