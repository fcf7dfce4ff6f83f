//! Simulated annealing in whole numbers.

mod cost;

use super::grid::{COLUMNS, FREE, Grid, MEMORY_SITES, ROWS, Site};
use super::{Design, Placement, weights};
use crate::flow::Progress;
use crate::flow::reach::Reach;
use crate::flow::timing::{Graph, Report};
use cost::{Costs, TIME};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Moves a temperature for every movable part. On one gateware 100 made the wires 5 to 7 % shorter than 30, and 300 another
/// 3 to 4 %; 70 take about as long as the router.
const MOVES: usize = 70;
/// The first temperature is this times twice the mean change of a move. From twice alone the first moves were taken
/// only where they gain, which froze most of the first placement: wires were 10 to 15 % longer.
const HOT: i64 = 10;
/// At this temperature fewer than one of twenty moves is taken.
const COLD: i64 = 20;
/// How far a move may go at first, in cells: anywhere.
const FAR: i64 = 45;
/// Largest power of the weights.
const POWER: i64 = 8;

/// A temperature at which every move is taken.
const ANY: i64 = i64::MAX / (1 << 24);

/// Rounds after the last temperature, each with new weights; the best placement is kept. From one to the next the slowest path
/// goes up and down by half a nanosecond, as this wire or that takes another way: on one netlist the best of 12 was 0.1 ns above
/// its aim, that of 100 was 0.2 ns below. They take half as long again as all before.
const ROUNDS: i64 = 100;
/// After this many of them nothing is taken that costs.
const WARM_ROUNDS: i64 = 80;
/// Their first temperature, which falls in equal steps.
const WARM: i64 = 10;
/// How far their moves go, in cells.
const NEAR: i64 = 4;
/// What time weighs in the last of them, against its weight before.
const URGENT: i64 = 3;

struct Annealer<'a, 'b> {
    design: &'a Design<'b>,
    /// What paths should take.
    aims: Graph,
    reach: &'a Reach,
    placement: &'a mut Placement,
    grid: Grid,
    costs: Costs<'a>,
    random: ChaCha8Rng,
    /// −ln(i / 4096) in 1/1024.
    logs: Vec<i64>,
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
    let parts = annealer.costs.parts();
    if parts == 0 {
        return;
    }
    annealer.recount();
    let mut temperature = annealer.first_temperature();
    let mut window = FAR;
    let total = steps(temperature);
    let mut step = 0;
    while temperature > COLD {
        let tries = MOVES * parts;
        let accepted = annealer.moves(tries, temperature, window);
        let share = (accepted * 1_000 / tries) as i64;
        window = (window * (1_000 - 440 + share) / 1_000).clamp(1, FAR);
        temperature = temperature * cooling(share) / 1_000;
        step += 1;
        progress.tell(super::STAGE, (step * 100 / total).min(99) as u32, || {
            format!("temperature {temperature}, {share} of 1000 moves taken, cost {}", annealer.costs.total())
        });
        annealer.power = (1 + (POWER - 1) * (FAR - window) / (FAR - 1)) as u32;
        annealer.recount();
    }
    annealer.finish(parts);
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
fn steps(temperature: i64) -> usize {
    let (mut steps, mut now) = (1, temperature);
    while now > COLD {
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
        let costs = Costs::new(design, placement, reach);
        let random = ChaCha8Rng::seed_from_u64(seed);
        Self { design, aims: design.graph.aims(), reach, placement, grid, costs, random, logs: logarithms(), power: 1 }
    }

    /// New weights from the present placement's timing, and all costs anew.
    fn recount(&mut self) {
        let shares = self.report().criticality;
        self.costs.recount(weights(&shares, self.power));
    }

    /// Rounds that look at the slowest paths; the best placement stays.
    fn finish(&mut self, parts: usize) {
        let mut best = (self.missed(), self.placement.clone());
        for round in 0..ROUNDS {
            let warm = round.min(WARM_ROUNDS);
            self.costs.weigh = TIME * (WARM_ROUNDS + (URGENT - 1) * warm) / WARM_ROUNDS;
            self.recount();
            self.moves(MOVES * parts, WARM * (WARM_ROUNDS - warm) / WARM_ROUNDS, NEAR);
            let missed = self.missed();
            if missed < best.0 {
                best = (missed, self.placement.clone());
            }
        }
        *self.placement = best.1;
    }

    /// By how much the slowest path of all and the slowest between registers miss what they should take, ps. Both count: a pad's
    /// path that stays where it is would else hide what is won between registers.
    fn missed(&self) -> i64 {
        let whole = Report::of(self.design.graph, &self.placement.estimate(self.design.nets, self.reach));
        self.report().misses() + whole.inside_misses()
    }

    /// The placement's timing, against what it should be.
    fn report(&self) -> Report {
        Report::of(&self.aims, &self.placement.estimate(self.design.nets, self.reach))
    }

    /// Tries so many moves; says how many were taken.
    fn moves(&mut self, tries: usize, temperature: i64, window: i64) -> usize {
        (0..tries).filter(|_| self.try_move(temperature, window)).count()
    }

    /// A temperature at which many moves are taken, from the mean change of random moves.
    fn first_temperature(&mut self) -> i64 {
        let tries = 500;
        let mut sum = 0;
        let mut old = self.costs.total();
        for _ in 0..tries {
            self.try_move(ANY, FAR);
            let new = self.costs.total();
            sum += (new - old).abs();
            old = new;
        }
        HOT * 2 * sum / tries
    }

    fn below(&mut self, limit: u64) -> u64 {
        // The bias of the remainder is below 2^-50.
        self.random.next_u64() % limit
    }

    fn try_move(&mut self, temperature: i64, window: i64) -> bool {
        let part = self.below(self.costs.parts() as u64) as usize;
        let columns = self.placement.columns.len();
        if part >= columns {
            self.move_memory(part - columns, temperature)
        } else {
            self.move_column(part, temperature, window)
        }
    }

    fn step(&mut self, from: u8, window: i64, low: u8, high: u8) -> Option<u8> {
        let to = i64::from(from) + self.below(2 * window as u64 + 1) as i64 - window;
        (i64::from(low)..=i64::from(high)).contains(&to).then_some(to as u8)
    }

    fn move_column(&mut self, part: usize, temperature: i64, window: i64) -> bool {
        let old = self.placement.columns[part];
        let height = self.design.packed.columns[part].slices.len();
        let Some(column) = self.step(old.column, window, *COLUMNS.start(), *COLUMNS.end()) else { return false };
        let Some(row) = self.step(old.row, window, 1, ROWS + 1 - height as u8) else { return false };
        let new = Site { column, slice: self.below(2) as u8, row };
        if new == old {
            return false;
        }
        if height == 1 {
            return self.swap_single(part, old, new, temperature);
        }
        let overlaps =
            (new.column, new.slice) == (old.column, old.slice) && usize::from(new.row.abs_diff(old.row)) < height;
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
        moves.iter().for_each(|(part, site)| self.costs.shift(*part, (site.column, site.row)));
        if !self.decide(temperature) {
            return false;
        }
        moves.iter().for_each(|(part, site)| self.placement.columns[*part] = *site);
        Grid::run(old, height).for_each(|site| self.grid.set(site, FREE));
        moves.iter().skip(1).for_each(|(part, site)| self.grid.set(*site, *part as u32));
        Grid::run(new, height).for_each(|site| self.grid.set(site, part as u32));
        true
    }

    /// Moves a single slice to a place that is free or has another, which goes where the first was.
    fn swap_single(&mut self, part: usize, old: Site, new: Site, temperature: i64) -> bool {
        let tenant = self.grid.tenant(new);
        if tenant != FREE && self.design.packed.columns[tenant as usize].slices.len() > 1 {
            return false;
        }
        self.costs.shift(part, (new.column, new.row));
        if tenant != FREE {
            self.costs.shift(tenant as usize, (old.column, old.row));
        }
        if !self.decide(temperature) {
            return false;
        }
        self.placement.columns[part] = new;
        self.grid.set(new, part as u32);
        self.grid.set(old, tenant);
        if tenant != FREE {
            self.placement.columns[tenant as usize] = old;
        }
        true
    }

    fn move_memory(&mut self, memory: usize, temperature: i64) -> bool {
        let columns = self.placement.columns.len();
        let old = self.placement.memories[memory];
        let new = self.below(MEMORY_SITES.len() as u64) as usize;
        let other = self.placement.memories.iter().position(|site| *site == new);
        if new == old {
            return false;
        }
        let place = |site: usize| (MEMORY_SITES[site].0, MEMORY_SITES[site].1 + 1);
        self.costs.shift(columns + memory, place(new));
        other.into_iter().for_each(|other| self.costs.shift(columns + other, place(old)));
        if !self.decide(temperature) {
            return false;
        }
        self.placement.memories[memory] = new;
        other.into_iter().for_each(|other| self.placement.memories[other] = old);
        true
    }

    /// Takes the move that stands in the costs, or not.
    fn decide(&mut self, temperature: i64) -> bool {
        let change = self.costs.change();
        let draw = self.logs[(self.random.next_u64() >> 52) as usize];
        let taken = change <= 0
            || (temperature > 0 && change <= temperature.saturating_mul(draw) / 1_024)
            || temperature >= ANY;
        if taken {
            self.costs.take();
        } else {
            self.costs.leave();
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
