//! Selection: which effects must be named for a link, and which are there but immaterial.

mod bench;
mod rivals;

use std::sync::Arc;

use rayon::prelude::*;

use crate::effect::{Effect, Link};
use crate::options::Thresholds;
use crate::problem::{Owner, Problem};
use crate::state::{Active, State};

pub use bench::{Bench, Trial, candidates, is_material};
pub use rivals::{Rivals, figures, rivals, sign_flip};

/// Largest number of effects named on one link.
const MOST: usize = 5;
/// Candidates among which all pairs and triples are tried.
const SHORT_LIST: usize = 9;
/// Rounds of relinearisation while the named effects still move.
const ROUNDS: usize = 3;
/// Standard deviations of the named effects' laws that another effect must explain more than.
const LAW_SIGMAS: f64 = 2.0;
/// A removal that costs more than this in the linear approximation is not tried.
const FAR: f64 = 40.0;

/// Outcome of a selection.
pub struct Selection {
    /// The state with the named (and the freed immaterial) effects.
    pub state: State,
    /// Linearised about it.
    pub bench: Bench,
    /// Sum of squares left, in units of the assumed noise.
    pub loss: f64,
    /// Penalty of what is held near zero, and cost of what is named.
    pub costs: f64,
}

impl Selection {
    /// Difference of the objectives of two selections, under one variance; negative if this is
    /// the better one.
    fn against(&self, other: &Self) -> f64 {
        let variance = self.bench.variance.min(other.bench.variance);
        (self.loss - other.loss) / variance + self.costs - other.costs
    }
}

/// Selects the effects of one link.
pub fn select(problem: &Problem, start: &State, catalogue: &[Arc<dyn Effect>], thresholds: &Thresholds) -> Selection {
    let all = candidates(start, catalogue, problem.link());
    let first = Bench::new(problem, start, &all, thresholds);
    let mut best = forward(problem, &first, &[], &all, thresholds);
    // Pairs and triples that a greedy search may have missed, from the first linearisation.
    let greedy: Vec<(String, Vec<usize>)> = names_of(&best, start.active.len());
    for subset in short_subsets(&first, thresholds) {
        let own: Vec<(String, Vec<usize>)> = subset
            .iter()
            .map(|c| (first.candidates[*c].effect.name().to_owned(), first.candidates[*c].form.wheels.clone()))
            .collect();
        let same = own.len() == greedy.len() && own.iter().all(|n| greedy.contains(n));
        if same || own.len() > greedy.len().max(1) {
            continue;
        }
        let other = forward(problem, &first, &subset, &all, thresholds);
        if other.against(&best) < -2.0 {
            best = other;
        }
        break;
    }
    let best = backward(problem, best, start.active.len(), &all, thresholds);
    let (best, changed) = swap(problem, best, start.active.len(), &all, thresholds);
    if changed { backward(problem, best, start.active.len(), &all, thresholds) } else { best }
}

/// The one effect that explains most where nothing may be adjusted but what is tiny: for a gap that matters
/// although every adjustment that closes it is immaterial by itself.
pub fn single(
    problem: &Problem,
    start: &State,
    catalogue: &[Arc<dyn Effect>],
    thresholds: &Thresholds,
) -> Option<Selection> {
    let all = candidates(start, catalogue, problem.link());
    let narrow = thresholds.narrow();
    let bench = Bench::new(problem, start, &all, &narrow);
    let best = next(problem.link(), &bench, &narrow).filter(|t| t.material)?;
    let mut state = start.clone();
    state.active.push(placed(&bench.candidates[best.candidate], &best.values));
    let settled = settle(problem, &mut state, &all, thresholds);
    let found = finish(state, settled, start.active.len(), thresholds);
    found.state.active.last().is_some_and(Active::worth).then_some(found)
}

/// Replaces each effect by whatever explains the same better, or as well and comes earlier in the
/// catalogue.
fn swap(
    problem: &Problem,
    mut best: Selection,
    from: usize,
    all: &[Active],
    thresholds: &Thresholds,
) -> (Selection, bool) {
    let mut changed = false;
    for index in from..best.state.active.len() {
        let mut without = best.state.clone();
        let own = without.active.remove(index);
        let rank = |name: &str| all.iter().position(|c| c.effect.name() == name).unwrap_or(usize::MAX);
        let bench = Bench::new(problem, &without, all, thresholds);
        let trials = bench.trials(thresholds);
        let gain_of_own = trials
            .iter()
            .filter(|t| bench.candidates[t.candidate].effect.name() == own.effect.name())
            .map(|t| t.gain)
            .fold(0.0, f64::max);
        let mut tried: Vec<&str> = vec![own.effect.name()];
        for t in &trials {
            let candidate = &bench.candidates[t.candidate];
            let name = candidate.effect.name();
            if t.gain < gain_of_own - 12.0 - 0.1 * gain_of_own.abs() || tried.len() > 3 {
                break;
            }
            if tried.contains(&name) || !t.material || best.state.active.iter().any(|a| a.effect.name() == name) {
                continue;
            }
            tried.push(name);
            let mut state = without.clone();
            state.active.insert(index, placed(candidate, &t.values));
            let settled = settle(problem, &mut state, all, thresholds);
            let rival = finish(state, settled, from, thresholds);
            let simpler = rank(name) < rank(own.effect.name()) && candidate.form.free.len() <= own.form.free.len();
            let tie = thresholds.tie(gain_of_own);
            let needed = if simpler { tie } else { -tie };
            if rival.against(&best) < needed {
                best = rival;
                changed = true;
                break;
            }
        }
    }
    (best, changed)
}

fn names_of(selection: &Selection, first: usize) -> Vec<(String, Vec<usize>)> {
    selection.state.active[first..].iter().map(|a| (a.effect.name().to_owned(), a.form.wheels.clone())).collect()
}

/// The best pair and the best triple by the linear objective, best first.
fn short_subsets(bench: &Bench, thresholds: &Thresholds) -> Vec<Vec<usize>> {
    let trials = bench.trials(thresholds);
    let mut list: Vec<usize> = Vec::new();
    for t in trials.iter().filter(|t| t.gain > 0.0) {
        let name = bench.candidates[t.candidate].effect.name();
        if list.iter().filter(|c| bench.candidates[**c].effect.name() == name).count() < 2 {
            list.push(t.candidate);
        }
        if list.len() == SHORT_LIST {
            break;
        }
    }
    let mut subsets: Vec<Vec<usize>> = Vec::new();
    for (i, a) in list.iter().enumerate() {
        for (j, b) in list.iter().enumerate().skip(i + 1) {
            subsets.push(vec![*a, *b]);
            for c in list.iter().skip(j + 1) {
                subsets.push(vec![*a, *b, *c]);
            }
        }
    }
    let distinct = |s: &Vec<usize>| {
        s.iter().enumerate().all(|(i, a)| {
            s.iter().skip(i + 1).all(|b| bench.candidates[*a].effect.name() != bench.candidates[*b].effect.name())
        })
    };
    let mut rated: Vec<(f64, Vec<usize>)> = subsets
        .into_par_iter()
        .filter(distinct)
        .filter_map(|s| {
            let fit = bench.fit(&s);
            let sound = s.iter().all(|c| {
                let v = bench.values(&fit, *c);
                bench.within_bounds(*c, &v, &fit) && bench.material(*c, &v)
            });
            sound.then(|| (bench.objective(&fit, &s, thresholds), s))
        })
        .collect();
    rated.sort_by(|a, b| a.0.total_cmp(&b.0));
    rated.into_iter().map(|r| r.1).take(1).collect()
}

/// Adds effects one after the other, beginning with `given` ones.
fn forward(problem: &Problem, first: &Bench, given: &[usize], all: &[Active], thresholds: &Thresholds) -> Selection {
    let mut state = first.state.clone();
    if !given.is_empty() {
        let fit = first.fit(given);
        for c in given {
            state.active.push(placed(&first.candidates[*c], &first.values(&fit, *c)));
        }
    }
    let from = first.state.active.len();
    let mut bench = None;
    loop {
        let current = if state.active.len() == from {
            Bench::new(problem, &first.state, all, thresholds)
        } else {
            settle(problem, &mut state, all, thresholds)
        };
        let bench_now = bench.insert(current);
        if state.active.len() - from >= MOST {
            break;
        }
        let Some(next) = next(problem.link(), bench_now, thresholds) else { break };
        let mut active = placed(&bench_now.candidates[next.candidate], &next.values);
        active.immaterial = !next.material;
        // A richer form of the same effect takes its place.
        state.active.retain(|a| a.given || a.effect.name() != active.effect.name());
        state.active.push(active);
    }
    let bench = bench.unwrap_or_else(|| Bench::new(problem, &state, all, thresholds));
    finish(state, bench, from, thresholds)
}

fn finish(state: State, bench: Bench, from: usize, thresholds: &Thresholds) -> Selection {
    let fit = bench.base();
    let costs: f64 = state.active[from..].iter().filter(|a| !a.given).map(|a| thresholds.cost(a.form.free.len())).sum();
    Selection { loss: bench.linear.gram.loss_after(&fit.step), costs: fit.penalty + costs, state, bench }
}

fn placed(candidate: &Active, values: &[f64]) -> Active {
    let mut active = candidate.clone();
    for (p, v) in candidate.form.free.iter().zip(values) {
        active.values.set(&p.name, v.clamp(p.bounds[0], p.bounds[1]));
    }
    active
}

/// Refits the active effects together with everything held near zero.
fn settle(problem: &Problem, state: &mut State, all: &[Active], thresholds: &Thresholds) -> Bench {
    problem.fit(state);
    let mut bench = Bench::new(problem, state, all, thresholds);
    for _ in 1..ROUNDS {
        let fit = bench.base();
        let mut largest = 0.0_f64;
        let mut trial = state.clone();
        for (j, owner) in bench.linear.owners.iter().enumerate() {
            let Owner::Active(index, parameter) = owner else { continue };
            let p = &state.active[*index].form.free[*parameter];
            let now = state.active[*index].values.get(&p.name);
            let next = (now + fit.step[j]).clamp(p.bounds[0], p.bounds[1]);
            largest = largest.max((next - now).abs() / p.scale);
            trial.active[*index].values.set(&p.name, next);
        }
        if largest < 0.02 {
            break;
        }
        let next = Bench::new(problem, &trial, all, thresholds);
        let (a, b) = (bench.base(), next.base());
        let before = bench.linear.gram.loss_after(&a.step) + a.penalty * bench.variance;
        let after = next.linear.gram.loss_after(&b.step) + b.penalty * bench.variance;
        if !after.is_finite() || after > before * 1.05 {
            break;
        }
        *state = trial;
        bench = next;
    }
    bench
}

/// The next effect to add, if any passes the gates.
fn next(link: Link, bench: &Bench, thresholds: &Thresholds) -> Option<Trial> {
    let trials = bench.trials(thresholds);
    let without = bench.held_out(&[]);
    let left_by_laws = bench.left_by_laws();
    for t in trials.into_iter().take(8) {
        if t.gain < thresholds.gain {
            return None;
        }
        // What is too small to be named brings no parameter along that nothing holds.
        let loose = |p: &crate::effect::Parameter| p.material.is_infinite();
        if !t.material && bench.candidates[t.candidate].form.free.iter().any(loose) {
            continue;
        }
        let with = bench.held_out(&[t.candidate]);
        // What is more than noise: an effect must explain a share of that.
        let n = bench.linear.gram.n();
        let passes = |without: &[f64], with: &[f64], t_needed: f64| {
            let total: f64 = without.iter().sum();
            let differences: Vec<f64> = without.iter().zip(with).map(|(a, b)| a - b).collect();
            let sum: f64 = differences.iter().sum();
            let spread = differences.iter().map(|d| d * d).sum::<f64>().sqrt();
            let excess = (total - n).max(0.0);
            sum >= thresholds.share(link) * total
                && sum >= thresholds.share_of_excess * excess
                && sum >= t_needed * spread
                && sum >= LAW_SIGMAS * LAW_SIGMAS * left_by_laws
        };
        let strong = t.gain > 50.0;
        let by_run = passes(&without, &with, thresholds.held_out_t * if strong { 0.5 } else { 1.0 });
        // What happens in one run only cannot be predicted from the others, but from its own parts.
        let harmless: f64 = without.iter().zip(&with).map(|(a, b)| a - b).sum();
        let by_block = strong
            && harmless > -0.01 * without.iter().sum::<f64>()
            && passes(&bench.held_out_blocks(&[]), &bench.held_out_blocks(&[t.candidate]), 1.0);
        if !by_run && !by_block {
            continue;
        }
        return Some(t);
    }
    None
}

/// Drops effects whose removal costs little, and replaces forms by simpler ones.
fn backward(problem: &Problem, mut best: Selection, from: usize, all: &[Active], thresholds: &Thresholds) -> Selection {
    loop {
        let mut improved = false;
        for index in (from..best.state.active.len()).rev() {
            let mut smaller = best.state.clone();
            let removed = smaller.active.remove(index);
            let mut rivals: Vec<State> = Vec::new();
            // Far from worthwhile in the linear approximation is not worth a refit.
            if best.bench.loss_without(index, &[], thresholds) < FAR {
                rivals.push(smaller.clone());
            }
            // Simpler forms of the same effect, from the same values.
            for c in all.iter().filter(|c| c.effect.name() == removed.effect.name()) {
                if c.form.free.len() < removed.form.free.len()
                    && c.form.free.iter().all(|p| removed.values.find(&p.name).is_some())
                {
                    let values: Vec<f64> = c.form.free.iter().map(|p| removed.values.get(&p.name)).collect();
                    let keep: Vec<String> = c.form.free.iter().map(|p| p.name.clone()).collect();
                    if is_material(c, &values) && best.bench.loss_without(index, &keep, thresholds) < FAR {
                        let mut s = smaller.clone();
                        s.active.push(placed(c, &values));
                        rivals.push(s);
                    }
                }
            }
            for mut rival in rivals {
                let bench = settle(problem, &mut rival, all, thresholds);
                let rival = finish(rival, bench, from, thresholds);
                if rival.against(&best) < thresholds.slack {
                    best = rival;
                    improved = true;
                    break;
                }
            }
            if improved {
                break;
            }
        }
        if !improved {
            return best;
        }
    }
}
