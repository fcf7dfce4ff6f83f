//! Runs of one data set that are not of one robot as it was: another battery, load or floor, a camera set up anew.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use crate::problem::{Linear, Problem};
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use crate::units;
use estimation::normal_equations::solve;
use links::effect::{Effect, Parameter};
use links::pieces::Pieces;

/// How fast the wheels turned in each run: where every run has a level of its own, or a direction, what bends with the speed
/// is another size in each of them, though all are of one robot.
pub(super) struct Levels(Vec<Vec<[f64; 2]>>);

impl Levels {
    pub(super) fn of(pieces: &Pieces, runs: usize, thresholds: &Thresholds) -> Self {
        let [turns, ends] = thresholds.level;
        let mut speeds: Vec<Vec<Vec<f64>>> = vec![Vec::new(); runs];
        let mut ticks = vec![0; runs];
        pieces.iter().for_each(|s| ticks[s.run] += s.t.len());
        for s in pieces.iter() {
            let own = &mut speeds[s.run];
            own.resize_with(s.speed.len(), Vec::new);
            let every = ticks[s.run].div_ceil(thresholds.level_ticks).max(1);
            own.iter_mut().zip(&s.speed).for_each(|(own, speed)| own.extend(speed.iter().step_by(every)));
        }
        let fastest = speeds.iter().flatten().flatten().fold(0.0_f64, |most, w| most.max(w.abs()));
        let range = |mut wheel: Vec<f64>| {
            wheel.retain(|w| w.abs() > turns * fastest);
            wheel.sort_by(f64::total_cmp);
            let at = |share: f64| wheel.get((share * wheel.len() as f64) as usize).copied().unwrap_or(0.0);
            [at(ends), at(1.0 - ends)]
        };
        Self(speeds.into_iter().map(|run| run.into_iter().map(range).collect()).collect())
    }

    /// What is left of the differences of sizes, as a share of them, beside a law that bends with the level of the runs; all of
    /// it where they have no level of their own.
    fn beside_level(&self, of_runs: &[(usize, f64)], thresholds: &Thresholds) -> f64 {
        let ranges = |wheel: usize| of_runs.iter().filter_map(move |(run, _)| self.0.get(*run)?.get(wheel).copied());
        let middles = |wheel: usize| ranges(wheel).map(|[low, high]| 0.5 * (low + high)).collect::<Vec<f64>>();
        let wheels = self.0.first().map_or(0, Vec::len);
        let Some(levels) = (0..wheels).map(middles).max_by(|a, b| spread(a).total_cmp(&spread(b))) else { return 1.0 };
        let n = of_runs.len() as f64;
        let widths = (0..wheels).flat_map(ranges).map(|[low, high]| high - low).sum::<f64>() / (n * wheels as f64);
        if levels.len() < of_runs.len() || spread(&levels) < thresholds.levels_apart * widths {
            return 1.0;
        }
        let sizes = DVector::from_iterator(of_runs.len(), of_runs.iter().map(|(_, size)| *size));
        // A straight line, and a bend where there are runs enough; or the direction alone, as of runs that go one way each,
        // slow and fast: what brakes pulls them back either way.
        let powers = if of_runs.len() > 4 { 3 } else { 2 };
        let scale = levels.iter().fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
        let left = |law: DMatrix<f64>| {
            let fit = solve(&(law.transpose() * &law), &(law.transpose() * &sizes));
            spread((&sizes - law * fit).as_slice()) / spread(sizes.as_slice()).max(f64::MIN_POSITIVE)
        };
        let by_speed =
            left(DMatrix::from_fn(of_runs.len(), powers, |run, power| (levels[run] / scale).powi(power as i32)));
        let way = |run: usize, power: usize| if power == 0 { 1.0 } else { levels[run].signum() };
        by_speed.min(left(DMatrix::from_fn(of_runs.len(), 2, way))).min(beside_neighbours(&levels, sizes.as_slice()))
    }
}

/// Fewest runs that are compared with those next to them in level. Reasoned: batteries and loads in the order of levels by
/// chance are one in some hundred of so many.
const NEIGHBOURS: usize = 6;

/// What is left of sizes beside the straight line between the runs of the next lower and the next higher level the same way,
/// as a share of them: near rest a law of speed bends further than a parabola, and smoothly, while batteries and loads keep no
/// order. All of it where there are few.
fn beside_neighbours(levels: &[f64], sizes: &[f64]) -> f64 {
    let mut order: Vec<usize> = (0..levels.len()).collect();
    order.sort_by(|a, b| levels[*a].total_cmp(&levels[*b]));
    let beside = |three: &[usize]| {
        let [low, own, high] = [three[0], three[1], three[2]];
        let width = levels[high] - levels[low];
        let share = if width > 0.0 { (levels[own] - levels[low]) / width } else { 0.5 };
        (levels[low] * levels[high] > 0.0).then(|| sizes[own] - sizes[low] - share * (sizes[high] - sizes[low]))
    };
    let left: Vec<f64> = order.windows(3).filter_map(beside).collect();
    if left.len() < NEIGHBOURS {
        return 1.0;
    }
    spread(&left) / spread(sizes).max(f64::MIN_POSITIVE)
}

/// Greatest less least.
fn spread(of: &[f64]) -> f64 {
    let ends = of.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)]);
    ends[1] - ends[0]
}

/// How what is said begins.
pub(crate) const BEGINS: &str = "the runs differ";

/// Steps from what a straight line gives as the size in a run.
const STEPS: usize = 4;

/// An effect with a size for each run.
struct Sizes {
    active: Active,
    parameter: Parameter,
    parameters: usize,
    /// Size in each run.
    of_runs: Vec<(usize, f64)>,
    /// What one size for all closes, in squared residuals, and what one for each run closes beside that.
    common: f64,
    own: f64,
}

/// In which size of what the runs differ, if one for each run closes a good part of what one for all leaves of a link, what is
/// named fitted beside both. `state` has what is named; `levels` are asked for where runs may have levels of their own.
pub(super) fn said(
    problem: &Problem,
    state: &State,
    catalogue: &[Arc<dyn Effect>],
    runs: &[String],
    levels: Option<&dyn Fn() -> Levels>,
    thresholds: &Thresholds,
) -> Option<String> {
    // One run differs from none.
    if runs.len() < 2 {
        return None;
    }
    let few = |a: &Active| (1..=thresholds.differ_parameters).contains(&a.form.free.len()) && a.form.fixed.is_empty();
    let grows = |a: &Active| few(a) && !a.effect.probe() && !a.switched();
    let mut candidates = problem.candidates(state, catalogue);
    candidates.retain(grows);
    let linear = problem.linearise(state, &candidates);
    let (square, n) = (linear.equations.clusters.iter().map(|c| c.rr).sum::<f64>(), linear.equations.n());
    let named = state.fitted_on(problem.link()).into_iter().filter(|i| grows(&state.active[*i]));
    let own = named.map(|i| (linear.of_active(i), &state.active[i]));
    let others = candidates.iter().enumerate().map(|(c, a)| (linear.of_candidate(c), a));
    let mut numbers: Vec<usize> = linear.equations.clusters.iter().map(|c| c.run).collect();
    numbers.sort_unstable();
    numbers.dedup();
    if numbers.len() < 2 {
        return None;
    }
    let all = own.chain(others).filter_map(|(columns, a)| sizes(&linear, &numbers, &columns, a));
    // Each parameter of a richer form has a size in each run to pay for.
    let paid = |s: &Sizes| s.own + s.common - thresholds.costs[1] * (s.parameters * s.of_runs.len()) as f64;
    let best = all.reduce(|best, next| if paid(&next) > thresholds.differ_more * paid(&best) { next } else { best })?;
    let share = best.own / (square - best.common).max(f64::MIN_POSITIVE);
    let left = square - best.common - best.own;
    let variance = (left / n.max(1.0)).max(1.0) * thresholds.correlation(problem.link());
    let [low, high] = [f64::total_cmp, |a: &f64, b: &f64| b.total_cmp(a)]
        .map(|by| best.of_runs.iter().copied().min_by(|a, b| by(&a.1, &b.1)).unwrap_or_default());
    // Far from the noise any law that bends ways has another size in every run: then it must close most.
    let far = left > thresholds.far.powi(2) * n;
    let least = if far { 1.0 - thresholds.undecided } else { thresholds.undecided };
    if share < least
        || best.own < thresholds.strong * variance
        // What is far below the floor is the law's own inexactness, and what is named may look like it in some of the runs.
        || best.own < thresholds.undecided * n
        || !best.parameter.is_material(high.1 - low.1)
    {
        return None;
    }
    // What follows the level of the runs is the law, not another machine.
    if levels.is_some_and(|levels| levels().beside_level(&best.of_runs, thresholds) < thresholds.undecided) {
        return None;
    }
    let told = if best.of_runs.len() > thresholds.differ_told { vec![low, high] } else { best.of_runs.clone() };
    let value = |(run, x): &(usize, f64)| {
        let unknown = String::new();
        let x = in_run(problem, state, &best, *run).unwrap_or(*x);
        format!("{} in {}", units::value(&best.parameter.name, x), runs.get(*run).unwrap_or(&unknown))
    };
    let structure = format!(
        "{BEGINS}: {} ({}) of about {} closes {:.0} % of what one size for all of them leaves; another battery, load, floor or \
         camera in some of them? Runs that belong together want a data set of their own",
        best.active.effect.name(),
        units::label(&best.parameter.name),
        told.iter().map(value).collect::<Vec<_>>().join(", "),
        100.0 * share.min(1.0),
    );
    Some(structure)
}

/// The sizes of an effect in each run of these `numbers`, all else that is named fitted beside it; `None` where not every
/// run tells them.
fn sizes(linear: &Linear, numbers: &[usize], columns: &[usize], active: &Active) -> Option<Sizes> {
    let m = columns.len();
    let beside: Vec<usize> = linear.active().into_iter().filter(|c| !columns.contains(c)).collect();
    let fit = |groups: usize, of: &dyn Fn(usize) -> usize| {
        let size = beside.len() + groups * m;
        let (mut jj, mut jr) = (DMatrix::zeros(size, size), DVector::zeros(size));
        for c in &linear.equations.clusters {
            let first = beside.len() + of(c.run) * m;
            let own = columns.iter().enumerate().map(|(p, column)| (first + p, *column));
            let all: Vec<(usize, usize)> = beside.iter().copied().enumerate().chain(own).collect();
            for (p, of) in &all {
                jr[*p] += c.jr[*of];
                for (q, other) in &all {
                    jj[(*p, *q)] += c.jj[(*of, *other)];
                }
            }
        }
        let tells = (beside.len()..size).all(|p| jj[(p, p)] > 0.0);
        let step = solve(&jj, &jr);
        tells.then(|| (step.dot(&jr), step))
    };
    let (common, _) = fit(1, &|_| 0)?;
    let (separate, step) = fit(numbers.len(), &|run| numbers.binary_search(&run).unwrap_or(0))?;
    let own = separate - common;
    let of = |group: usize, p: usize| step[beside.len() + group * m + p];
    let spread = |p: usize| {
        let of = || (0..numbers.len()).map(|group| of(group, p));
        of().fold(f64::NEG_INFINITY, f64::max) - of().fold(f64::INFINITY, f64::min)
    };
    let in_sizes = |p: &usize| spread(*p) / active.form.free[*p].material;
    let worst = (0..m).max_by(|a, b| in_sizes(a).total_cmp(&in_sizes(b)))?;
    let parameter = active.form.free[worst].clone();
    let now = active.values.get(&parameter.name);
    let bounded = |x: f64| (now + x).clamp(parameter.bounds[0], parameter.bounds[1]);
    let of_runs = numbers.iter().enumerate().map(|(group, run)| (*run, bounded(of(group, worst)))).collect();
    Some(Sizes { active: active.clone(), parameter, parameters: m, of_runs, common, own })
}

/// The size in one run, all else as it is: a payload, say, divides what a straight line takes for a factor.
fn in_run(problem: &Problem, state: &State, sizes: &Sizes, run: usize) -> Option<f64> {
    let mut state = state.clone();
    let own = |a: &Active| a.effect.name() == sizes.active.effect.name() && a.form.wheels == sizes.active.form.wheels;
    let named = state.fitted_on(problem.link()).into_iter().find(|i| own(&state.active[*i]));
    let index = named.unwrap_or_else(|| {
        state.active.push(sizes.active.clone());
        state.active.len() - 1
    });
    let mut least: Option<(f64, f64)> = None;
    for _ in 0..=STEPS {
        let linear = problem.linearise(&state, &[]);
        let equations = linear.equations.of_run(run);
        let left: f64 = equations.clusters.iter().map(|c| c.rr).sum();
        if least.is_some_and(|(least, _)| left >= least) {
            break;
        }
        let active = &mut state.active[index];
        least = Some((left, active.values.get(&sizes.parameter.name)));
        for (p, x) in active.form.free.iter().zip(equations.solve(&linear.of_active(index)).iter()) {
            let next = (active.values.get(&p.name) + x).clamp(p.bounds[0], p.bounds[1]);
            active.values.set(&p.name, next);
        }
    }
    least.map(|(_, size)| size)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sizes of runs of which each has its range of speed, and the share that is left beside their level.
    fn left(runs: &[([f64; 2], f64)]) -> f64 {
        let levels = Levels(runs.iter().map(|(range, _)| vec![*range]).collect());
        let sizes: Vec<_> = runs.iter().enumerate().map(|(run, (_, size))| (run, *size)).collect();
        levels.beside_level(&sizes, &Thresholds::default())
    }

    #[test]
    fn what_follows_the_level_of_the_runs_is_no_difference_of_them() {
        let step = |k: usize| [1.0 + 2.0 * k as f64, 3.0 + 5.0 * k as f64];
        let bent = |k: usize| 1.0 + 0.5 * k as f64 + 0.1 * (k * k) as f64;
        let of = |size: &dyn Fn(usize) -> f64| left(&(0..8).map(|k| (step(k % 4), size(k))).collect::<Vec<_>>());
        assert!(of(&|k| bent(k % 4)) < 0.1);
        // The same levels, once with another battery, beside the bend as well.
        assert!(of(&|k| if k < 4 { 0.0 } else { 1.0 }) > 0.9 && of(&|k| bent(k % 4) + (2 * (k / 4)) as f64) > 0.3);
        // One way and the other, once each, tell nothing; to and fro in each run they do.
        assert!(left(&[([1.0, 3.0], 0.0), ([-3.0, -1.0], 1.0)]) < 1e-6);
        // Slow ramps and steps, both ways: what has one size each way goes with the way.
        let ways = |fast: f64| {
            left(&[([1.0, 29.0], 1.0), ([-29.0, -1.0], -1.0), ([20.0, 40.0], fast), ([-40.0, -20.0], -fast)])
        };
        assert!(ways(1.0) < 1e-6 && ways(1.1) < 0.2, "{}", ways(1.1));
        assert!(left(&[([-3.0, 3.1], 0.0), ([-2.0, 2.0], 1.0), ([-3.0, 3.0], 1.1)]) == 1.0);
    }

    /// A friction that the model lacks makes a motor's constant look smaller by one over the speed, either way.
    #[test]
    fn what_bends_near_rest_follows_the_level_as_well() {
        let steps = [1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0, 9.0];
        let runs = |size: &dyn Fn(usize, f64) -> f64| {
            let one_way = |way: f64| steps.into_iter().map(move |s| ([way * s - 0.1, way * s + 0.1], way * s));
            let all = one_way(1.0).chain(one_way(-1.0)).enumerate();
            left(&all.map(|(k, (range, level))| (range, size(k, level))).collect::<Vec<_>>())
        };
        let bent = runs(&|_, level| -1.0 / level.abs());
        assert!(bent < 0.2, "{bent}");
        let two_batteries = runs(&|k, level| f64::from(u8::from(k % 3 == 1)) - 1.0 / level.abs());
        assert!(two_batteries > 0.4, "{two_batteries}");
    }
}
