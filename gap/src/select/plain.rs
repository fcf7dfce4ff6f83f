//! Selection where noise is not what limits the prediction.
//!
//! On hand-made recordings the residual left by every effect together is often several times the camera's noise: soft
//! rollers, flexing mounts, clocks. Priors in units of that noise then decide little, and a search for the last bit of
//! the objective ends in many parameters. Here an effect is worth naming for what it predicts on runs that it was not
//! fitted to, nothing else adjusted, and every further parameter has a price.

use estimation::parallel::numbered;

use super::{Selection, finish_bare, in_parts, is_material, placed, replace, stopped, undecided};
use crate::candidates::does_all;
use crate::problem::{Owner, Problem};
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use estimation::prior::{Penalised, Role};
use links::effect::Link;

/// Effects at most.
const MOST: usize = 8;
/// Parts of the runs that are held out in turn where a parameter belongs to a run.
const PARTS: usize = 5;

/// A candidate's promise.
struct Promise {
    candidate: usize,
    score: f64,
    /// Decrease of the held-out loss.
    explains: f64,
    parameters: usize,
    values: Vec<f64>,
}

/// The effects that predict held-out runs best, each worth its parameters; `small` admits those below their
/// materiality, beginning with those `known`. `None` if they close too little together.
pub(crate) fn plain(
    problem: &Problem,
    start: &State,
    known: &[Active],
    all: &[Active],
    thresholds: &Thresholds,
    small: bool,
) -> Option<Selection> {
    let from = start.active.len();
    let mut state = start.clone();
    let (before, n) = held_out(problem, &state);
    if !known.is_empty() {
        state.active.extend_from_slice(known);
        problem.fit(&mut state);
    }
    let mut refused: Vec<usize> = Vec::new();
    while state.active.len() - from < MOST {
        let Some(best) = best(problem, &state, all, thresholds, small, &refused) else { break };
        let (now, _) = held_out(problem, &state);
        let mut larger = state.clone();
        let mut active = placed(&all[best.candidate], &best.values);
        active.immaterial = small && !is_material(&active, &active.parameters());
        replace(&mut larger, active);
        problem.fit(&mut larger);
        let sound = larger.active[from..].iter().all(|a| !stopped(a));
        let cancelled = |i: usize| problem.is_cancelled(&larger, i, start, thresholds);
        let sound =
            sound && !problem.runs_away(&larger, &state, thresholds) && !(from..larger.active.len()).any(cancelled);
        if sound && held_out(problem, &larger).0 < (1.0 - 0.5 * thresholds.price) * now {
            state = larger;
        } else {
            refused.push(best.candidate);
        }
    }
    drop_idle(problem, &mut state, from, thresholds, small);
    // Of laws between which the data do not decide the first of the catalogue: friction before a bridge.
    let rank = |a: &Active| all.iter().position(|c| c.effect.name() == a.effect.name());
    for index in from..state.active.len() {
        let others = undecided(problem, &state, index, all, thresholds, thresholds.far_left).into_iter();
        if let Some(first) = others.min_by_key(|s| rank(&s.active[index]))
            && rank(&first.active[index]) < rank(&state.active[index])
        {
            state = first;
        }
    }
    let (after, _) = held_out(problem, &state);
    let enough = before - after >= thresholds.closes * (before - n).max(0.0);
    (state.active.len() > from && enough).then(|| finish_bare(problem, state, from, all, thresholds))
}

/// The candidate with the largest worth on held-out runs.
fn best(
    problem: &Problem,
    state: &State,
    all: &[Active],
    thresholds: &Thresholds,
    small: bool,
    refused: &[usize],
) -> Option<Promise> {
    let indices: Vec<usize> = (0..all.len())
        .filter(|c| {
            let a = &all[*c];
            let fits = !a.effect.probe() && !a.switched() && a.form.free.iter().all(|p| p.material.is_finite());
            let larger = |o: &Active| o.effect.name() == a.effect.name() && o.form.free.len() >= a.form.free.len();
            fits && !refused.contains(c)
                && !state
                    .active
                    .iter()
                    .any(|o| larger(o) || o.given && o.effect.name() == a.effect.name() || does_all(o, a))
        })
        .collect();
    let candidates: Vec<Active> = indices.iter().map(|c| all[*c].clone()).collect();
    let linear = problem.linearise(state, &candidates);
    let penalised = Penalised::new(&linear.equations, 1.0);
    let roles_with = |freed: &[usize]| -> Vec<Role> {
        linear
            .owners
            .iter()
            .enumerate()
            .map(|(column, owner)| match owner {
                Owner::Active(..) => Role::Free,
                _ if freed.contains(&column) => Role::Free,
                _ => Role::Out,
            })
            .collect()
    };
    let nuisance: Vec<bool> = linear
        .owners
        .iter()
        .map(|o| match o {
            Owner::Active(i, _) => state.active[*i].effect.nuisance(),
            Owner::Candidate(c, _) => candidates[*c].effect.nuisance(),
            Owner::Whole(_) => false,
        })
        .collect();
    let base = shared(&penalised, &roles_with(&[]), &nuisance);
    let by_parts = in_parts(&linear.equations, PARTS);
    let penalised_parts = Penalised::new(&by_parts, 1.0);
    let base_parts = penalised_parts.held_out(&roles_with(&[]));
    let total: f64 = base.iter().sum();
    let promise = |c: usize| {
        let a = &candidates[c];
        let columns = linear.of_candidate(c);
        if columns.iter().map(|j| penalised.information(*j)).any(|known| known.is_nan() || known <= 0.0) {
            return None;
        }
        let roles = roles_with(&columns);
        let fit = penalised.fit(&roles);
        let values: Vec<f64> = columns.iter().map(|j| fit.step[*j]).collect();
        let inside = a.form.free.iter().zip(&values).all(|(p, v)| *v >= p.bounds[0] && *v <= p.bounds[1]);
        if !inside || !(small || is_material(a, &values)) {
            return None;
        }
        let (without, with) = if a.effect.nuisance() {
            (&base_parts, penalised_parts.held_out(&roles))
        } else {
            (&base, shared(&penalised, &roles, &nuisance))
        };
        let differences: Vec<f64> = without.iter().zip(&with).map(|(a, b)| a - b).collect();
        let sum: f64 = differences.iter().sum();
        let spread = differences.iter().map(|d| d * d).sum::<f64>().sqrt();
        let parameters = a.form.free.len();
        let price = thresholds.price * total * parameters as f64;
        (sum >= price && sum >= thresholds.held_out_t * spread).then_some(Promise {
            candidate: indices[c],
            score: sum - price,
            explains: sum,
            parameters,
            values,
        })
    };
    let promises: Vec<Promise> = numbered(candidates.len(), &promise).into_iter().flatten().collect();
    let most = promises.iter().map(|p| p.score).fold(0.0, f64::max);
    // What is as good explains as much; a law of the drive does not leave far more, either.
    let laws = problem.link() == Link::Drive;
    let n: f64 = linear.equations.n();
    let left = |p: &Promise| ((total - p.explains) / n.max(1.0)).max(0.0).sqrt();
    let least = promises.iter().map(left).fold(f64::INFINITY, f64::min);
    let rank = |p: &Promise| (p.parameters, usize::from(all[p.candidate].effect.name() == "encoder-lag"), p.candidate);
    promises
        .into_iter()
        .filter(|p| p.score >= thresholds.as_good * most && !(laws && thresholds.decided(left(p), least)))
        .min_by_key(rank)
}

/// Held-out losses per cluster, each run predicted from the others; what belongs to a run is fitted on it.
fn shared(penalised: &Penalised, roles: &[Role], nuisance: &[bool]) -> Vec<f64> {
    let fit = penalised.fit(roles);
    let fixed = |(c, r): (usize, &Role)| if nuisance[c] && *r == Role::Free { Role::At(fit.step[c]) } else { *r };
    penalised.held_out(&roles.iter().enumerate().map(fixed).collect::<Vec<_>>())
}

/// Held-out sum of squares of a state whose effects are fitted, and the number of residuals.
pub(crate) fn held_out(problem: &Problem, state: &State) -> (f64, f64) {
    let (clusters, n) = losses(problem, state);
    (clusters.iter().sum(), n)
}

/// The same by clusters.
pub(super) fn losses(problem: &Problem, state: &State) -> (Vec<f64>, f64) {
    let linear = problem.linearise(state, &[]);
    let roles: Vec<Role> =
        linear.owners.iter().map(|o| if matches!(o, Owner::Active(..)) { Role::Free } else { Role::Out }).collect();
    let nuisance: Vec<bool> =
        linear.owners.iter().map(|o| matches!(o, Owner::Active(i, _) if state.active[*i].effect.nuisance())).collect();
    let losses = shared(&Penalised::new(&linear.equations, 1.0), &roles, &nuisance);
    let plain = losses.iter().zip(&linear.equations.clusters).map(|(l, c)| l / c.weight).collect();
    (plain, linear.equations.plain().1)
}

/// Drops, one by one, effects without which held-out runs are predicted as well.
fn drop_idle(problem: &Problem, state: &mut State, from: usize, thresholds: &Thresholds, small: bool) {
    loop {
        let (now, _) = held_out(problem, state);
        let tried = (from..state.active.len()).map(|index| {
            let mut smaller = state.clone();
            let removed = smaller.active.remove(index);
            problem.fit(&mut smaller);
            let idle = !small && !is_material(&removed, &removed.parameters());
            let price = thresholds.price * removed.form.free.len() as f64;
            let (without, _) = held_out(problem, &smaller);
            (if idle { 0.0 } else { without / now.max(1e-300) - 1.0 - 0.5 * price }, smaller)
        });
        match tried.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((worth, smaller)) if worth <= 0.0 => *state = smaller,
            _ => return,
        }
    }
}
