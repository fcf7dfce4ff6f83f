//! Simulated annealing in whole numbers.

use super::grid::{COLUMNS, FREE, Grid, MEMORY_SITES, ROWS, Site};
use super::{Design, Placement};
use crate::flow::Progress;
use crate::flow::nets::Part;
use crate::flow::reach::Reach;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Moves a temperature for every movable part.
const MOVES: usize = 30;
/// A net of more pins is everywhere anyway and does not count.
const WIDEST: usize = 400;
/// What a unit of wire length weighs against 256 ps of a critical connection.
const LENGTH: i64 = 96;
/// What 256 ps of a critical connection weigh: this times its weight (0..=255), over 64.
const TIME: i64 = 160;

/// A net as the placer sees it: movable parts and their weights.
struct PlacedNet {
    source: Part,
    sinks: Vec<Part>,
    /// First connection of the net.
    first: usize,
    /// Larger nets need more wire than half their box: 1/64 units.
    factor: i64,
}

struct Annealer<'a, 'b> {
    design: &'a Design<'b>,
    reach: &'a Reach,
    placement: &'a mut Placement,
    grid: Grid,
    nets: Vec<PlacedNet>,
    /// Nets of every column, then of every memory.
    nets_of: Vec<Vec<u32>>,
    costs: Vec<i64>,
    weights: Vec<u16>,
    stamp: Vec<u32>,
    now: u32,
    random: ChaCha8Rng,
    /// Power of the weights: all connections count at first, in the end the slowest.
    power: u32,
}

/// Anneals a placement.
pub(super) fn anneal(
    design: &Design<'_>,
    placement: &mut Placement,
    reach: &Reach,
    seed: u64,
    progress: &mut Progress<'_>,
) {
    let mut annealer = Annealer::new(design, placement, reach, seed);
    let parts = annealer.nets_of.len();
    if parts == 0 {
        return;
    }
    let logs = logarithms();
    annealer.recount();
    let mut temperature = annealer.first_temperature();
    let mut window = 45_i64;
    let floor = LENGTH * 64 / 40;
    let total = steps(temperature, floor);
    let mut step = 0;
    while temperature > floor {
        let mut accepted = 0_usize;
        let tries = MOVES * parts;
        for _ in 0..tries {
            accepted += usize::from(annealer.try_move(temperature, window, &logs));
        }
        let share = (accepted * 1_000 / tries) as i64;
        window = (window * (1_000 - 440 + share) / 1_000).clamp(1, 45);
        temperature = temperature * cooling(share) / 1_000;
        step += 1;
        progress.tell(super::STAGE, (step * 100 / total).min(99) as u32, || {
            format!(
                "temperature {temperature}, {share} of 1000 moves taken, cost {}",
                annealer.costs.iter().sum::<i64>()
            )
        });
        annealer.power = 2 + (step * 7 / total).min(6) as u32;
        annealer.recount();
    }
    for _ in 0..4 * MOVES * parts {
        annealer.try_move(0, 2, &logs);
    }
}

/// How much of the temperature stays, in 1/1000, for this share of moves taken (VPR's schedule).
fn cooling(share: i64) -> i64 {
    match share {
        961.. => 500,
        801.. => 900,
        151.. => 950,
        _ => 850,
    }
}

/// About how many temperatures there will be.
fn steps(temperature: i64, floor: i64) -> usize {
    let (mut steps, mut now) = (1, temperature);
    while now > floor {
        now = now * 930 / 1_000;
        steps += 1;
    }
    steps
}

/// −ln(i / 4096) in 1/1024, from sums of (1 − x)ⁿ/n: the same on every machine.
fn logarithms() -> Vec<i64> {
    let mut table = vec![i64::MAX / (1 << 40)];
    for index in 1..4_096_i64 {
        // Halve the range until x is near 1; every halving adds ln 2 = 0.693147….
        let (mut x, mut sum) = (index << 18, 0_i64);
        while x < 1 << 29 {
            x <<= 1;
            sum += 744_261_118;
        }
        let one = 1_i64 << 30;
        let (rest, mut power, mut series) = (one - x, one, 0_i64);
        for n in 1..40 {
            power = (power * rest) >> 30;
            series += power / n;
        }
        table.push((sum + series) >> 20);
    }
    table
}

impl<'a, 'b> Annealer<'a, 'b> {
    fn new(design: &'a Design<'b>, placement: &'a mut Placement, reach: &'a Reach, seed: u64) -> Self {
        let mut grid = Grid::new();
        for (column, site) in placement.columns.iter().enumerate() {
            Grid::run(*site, design.packed.columns[column].slices.len()).for_each(|site| grid.set(site, column as u32));
        }
        let columns = placement.columns.len();
        let mut nets_of = vec![Vec::new(); columns + placement.memories.len()];
        let mut nets = Vec::new();
        for (index, routed) in design.nets.general.iter().enumerate() {
            if routed.sinks.len() > WIDEST {
                continue;
            }
            let sinks: Vec<Part> = routed.sinks.iter().map(|sink| sink.part).collect();
            for part in sinks.iter().chain([&routed.source.part]) {
                let owner = match part {
                    Part::Slice(column, _) => *column as usize,
                    Part::Memory(memory) => columns + *memory as usize,
                    Part::Pad(_) | Part::Clock(_) => continue,
                };
                let list: &mut Vec<u32> = &mut nets_of[owner];
                if list.last() != Some(&(nets.len() as u32)) {
                    list.push(nets.len() as u32);
                }
            }
            let factor = 64 + 2 * (sinks.len() as i64 - 2).clamp(0, 30);
            let first = design.graph.first[index] as usize;
            nets.push(PlacedNet { source: routed.source.part, sinks, first, factor });
        }
        nets_of.iter_mut().for_each(Vec::dedup);
        let (costs, stamp) = (vec![0; nets.len()], vec![0; nets.len()]);
        let random = ChaCha8Rng::seed_from_u64(seed);
        Self {
            design,
            reach,
            placement,
            grid,
            nets,
            nets_of,
            costs,
            weights: Vec::new(),
            stamp,
            now: 0,
            random,
            power: 2,
        }
    }

    /// New weights from the present placement's timing, and all costs anew.
    fn recount(&mut self) {
        self.weights = self.design.weights(&self.placement.estimate(self.design.nets, self.reach), self.power);
        for net in 0..self.nets.len() {
            self.costs[net] = self.cost(net);
        }
    }

    fn cost(&self, net: usize) -> i64 {
        let net = &self.nets[net];
        let from = self.placement.at(net.source);
        let (mut low, mut high) = (from, from);
        let mut time = 0;
        for (offset, sink) in net.sinks.iter().enumerate() {
            let at = self.placement.at(*sink);
            low = (low.0.min(at.0), low.1.min(at.1));
            high = (high.0.max(at.0), high.1.max(at.1));
            time += i64::from(self.reach.delay(from, at)) * i64::from(self.weights[net.first + offset]);
        }
        let length = i64::from(high.0 - low.0) + i64::from(high.1 - low.1);
        length * net.factor * LENGTH / 64 + time * TIME / 16_384
    }

    /// A temperature at which most moves are taken: twice the mean change of random moves.
    fn first_temperature(&mut self) -> i64 {
        let none = vec![0; 4_096];
        let (before, tries) = (self.costs.clone(), 500);
        let mut sum = 0;
        for _ in 0..tries {
            let old: i64 = self.costs.iter().sum();
            // Every move is taken at zero cost of acceptance.
            self.try_move(i64::MAX / (1 << 24), 45, &none);
            sum += (self.costs.iter().sum::<i64>() - old).abs();
        }
        drop(before);
        2 * sum / tries
    }

    fn below(&mut self, limit: u64) -> u64 {
        // The bias of the remainder is below 2^-50.
        self.random.next_u64() % limit
    }

    fn try_move(&mut self, temperature: i64, window: i64, logs: &[i64]) -> bool {
        let part = self.below(self.nets_of.len() as u64) as usize;
        let columns = self.placement.columns.len();
        if part >= columns {
            self.move_memory(part - columns, temperature, logs)
        } else {
            self.move_column(part, temperature, window, logs)
        }
    }

    fn step(&mut self, from: u8, window: i64, low: u8, high: u8) -> Option<u8> {
        let to = i64::from(from) + self.below(2 * window as u64 + 1) as i64 - window;
        (i64::from(low)..=i64::from(high)).contains(&to).then_some(to as u8)
    }

    fn move_column(&mut self, part: usize, temperature: i64, window: i64, logs: &[i64]) -> bool {
        let old = self.placement.columns[part];
        let height = self.design.packed.columns[part].slices.len();
        let Some(column) = self.step(old.column, window, *COLUMNS.start(), *COLUMNS.end()) else { return false };
        let Some(row) = self.step(old.row, window, 1, ROWS + 1 - height as u8) else { return false };
        let new = Site { column, slice: self.below(2) as u8, row };
        let overlaps =
            (new.column, new.slice) == (old.column, old.slice) && usize::from(new.row.abs_diff(old.row)) < height;
        if overlaps && height == 1 {
            return false;
        }
        // Who stands there goes to the places that become free, lowest to lowest.
        let there: Vec<Site> = Grid::run(new, height).filter(|site| self.grid.tenant(*site) != part as u32).collect();
        let here: Vec<Site> = Grid::run(old, height)
            .filter(|site| !overlaps || !(new.row..new.row + height as u8).contains(&site.row))
            .collect();
        let mut moves = vec![(part, new)];
        for (from, to) in there.iter().zip(&here) {
            let tenant = self.grid.tenant(*from);
            if tenant == FREE {
                continue;
            }
            if self.design.packed.columns[tenant as usize].slices.len() > 1 {
                return false;
            }
            moves.push((tenant as usize, *to));
        }
        let olds: Vec<(usize, Site)> = moves.iter().map(|(part, _)| (*part, self.placement.columns[*part])).collect();
        let affected = self.affected(moves.iter().map(|(part, _)| *part));
        moves.iter().for_each(|(part, site)| self.placement.columns[*part] = *site);
        if !self.decide(&affected, temperature, logs) {
            olds.into_iter().for_each(|(part, site)| self.placement.columns[part] = site);
            return false;
        }
        Grid::run(old, height).for_each(|site| self.grid.set(site, FREE));
        moves.iter().skip(1).for_each(|(part, site)| self.grid.set(*site, *part as u32));
        Grid::run(new, height).for_each(|site| self.grid.set(site, part as u32));
        true
    }

    fn move_memory(&mut self, memory: usize, temperature: i64, logs: &[i64]) -> bool {
        let columns = self.placement.columns.len();
        let old = self.placement.memories[memory];
        let new = self.below(MEMORY_SITES.len() as u64) as usize;
        let other = self.placement.memories.iter().position(|site| *site == new);
        if new == old {
            return false;
        }
        let affected = self.affected([columns + memory].into_iter().chain(other.map(|other| columns + other)));
        self.placement.memories[memory] = new;
        other.into_iter().for_each(|other| self.placement.memories[other] = old);
        if self.decide(&affected, temperature, logs) {
            return true;
        }
        self.placement.memories[memory] = old;
        other.into_iter().for_each(|other| self.placement.memories[other] = new);
        false
    }

    fn affected(&mut self, parts: impl Iterator<Item = usize>) -> Vec<u32> {
        self.now += 1;
        let mut nets = Vec::new();
        for part in parts {
            for net in &self.nets_of[part] {
                if self.stamp[*net as usize] != self.now {
                    self.stamp[*net as usize] = self.now;
                    nets.push(*net);
                }
            }
        }
        nets
    }

    /// Takes the move that stands in the placement, or not.
    fn decide(&mut self, affected: &[u32], temperature: i64, logs: &[i64]) -> bool {
        let costs: Vec<i64> = affected.iter().map(|net| self.cost(*net as usize)).collect();
        let change: i64 = affected.iter().zip(&costs).map(|(net, cost)| cost - self.costs[*net as usize]).sum();
        let draw = logs[(self.random.next_u64() >> 52) as usize];
        let taken = change <= 0
            || (temperature > 0 && change <= temperature.saturating_mul(draw) / 1_024)
            || temperature >= i64::MAX / (1 << 24);
        if taken {
            affected.iter().zip(costs).for_each(|(net, cost)| self.costs[*net as usize] = cost);
        }
        taken
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_holds_logarithms() {
        let table = logarithms();
        for index in [1, 2, 100, 2_048, 4_095] {
            let expected = -(index as f64 / 4_096.0).ln() * 1_024.0;
            assert!((table[index] as f64 - expected).abs() < 2.0, "{index}: {} {expected}", table[index]);
        }
    }
}
