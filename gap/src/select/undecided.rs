//! Laws of the drive between which a recording far from its noise does not decide.

use estimation::parallel::each;

use super::{is_material, stopped};
use crate::problem::Problem;
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use links::effect::Link;

pub(crate) const LATENCY: &str = "actuation-latency";

/// The state with an effect replaced by each other one, of no more parameters, that leaves hardly more: where much is
/// left whatever is named, no law is exact and a little more or less of it says nothing. In the order of the catalogue;
/// nothing where less than `far` floors are left, or on the link of geometry, whose laws are exact.
pub(crate) fn undecided(
    problem: &Problem,
    state: &State,
    index: usize,
    all: &[Active],
    thresholds: &Thresholds,
    far: f64,
) -> Vec<State> {
    let excess = |state: &State| {
        let (square, n) = problem.linearise_nothing(state).plain();
        (square - n, n)
    };
    let (left, n) = excess(state);
    if problem.link() != Link::Drive || left + n < far.powi(2) * n {
        return Vec::new();
    }
    let own = &state.active[index];
    let mut without = state.clone();
    without.active.remove(index);
    let mut found: Vec<State> = Vec::new();
    for other in all {
        let name = other.effect.name();
        let known = state.active.iter().any(|a| a.effect.name() == name)
            || found.iter().any(|s| s.active[index].effect.name() == name);
        let linear = !other.switched() && other.form.free.iter().all(|p| p.material.is_finite());
        if known || other.effect.probe() || !linear || other.form.free.len() > own.form.free.len() {
            continue;
        }
        let mut replaced = state.clone();
        replaced.active[index] = other.clone();
        problem.fit(&mut replaced);
        let a = &replaced.active[index];
        let sound =
            is_material(a, &a.parameters()) && !stopped(a) && !problem.runs_away(&replaced, &without, thresholds);
        if sound && excess(&replaced).0 < (1.0 + thresholds.undecided) * left {
            found.push(replaced);
        }
    }
    found
}

/// Ratio of the latencies from the best of which one is fitted.
const RATIO: f64 = 1.4;

/// What a latency does in place of an effect of the drive.
pub(crate) enum Late {
    /// Nothing near it.
    Less,
    /// It is in doubt which of them it is.
    Doubtful,
    /// The same.
    Even,
}

/// Whether duties that act late do what an effect does, each fitted with nothing adjusted beside it. Torques that come and
/// go by steps are no straight line in a latency, which promises too little to be tried among the others: of axes at 50 Hz
/// half a row was twice the inertia, and three rows six times as much.
pub(crate) fn late_in_place(
    problem: &Problem,
    state: &State,
    index: usize,
    all: &[Active],
    thresholds: &Thresholds,
) -> Late {
    let is_known = |name: &str| state.active.iter().any(|a| a.effect.name() == name);
    let is_late = |a: &&Active| a.effect.name() == LATENCY && a.form.free[0].bounds[1] > 0.0;
    let Some(latency) = all.iter().find(is_late).filter(|_| problem.link() == Link::Drive && !is_known(LATENCY)) else {
        return Late::Less;
    };
    let square = |state: &State| problem.linearise_nothing(state).plain().0;
    let fitted = |mut state: State| {
        problem.fit(&mut state);
        let left = square(&state);
        (state, left)
    };
    let p = &latency.form.free[0];
    let values: Vec<f64> =
        std::iter::successors(Some(p.material), |v| Some(RATIO * v)).take_while(|v| *v < p.bounds[1]).collect();
    let begun = |value: &f64| {
        let mut begun = state.clone();
        begun.active[index] = latency.clone();
        begun.active[index].values.set(&p.name, *value);
        (square(&begun), begun)
    };
    let Some((_, begun)) = each(&values, &begun).into_iter().min_by(|a, b| a.0.total_cmp(&b.0)) else {
        return Late::Less;
    };
    let (late, left) = fitted(begun);
    let own = fitted(state.clone()).1;
    let mut without = state.clone();
    without.active.remove(index);
    let (without, before) = fitted(without);
    let found = &late.active[index];
    let sound =
        is_material(found, &found.parameters()) && !stopped(found) && !problem.runs_away(&late, &without, thresholds);
    let [more, gain] = [left - own, before - own].map(|square| square / thresholds.drive_correlation);
    let within_a_row = || {
        let model = without.drive(None);
        let follows_s = model.felt_inertia() / model.axes[0].braking(model.gear_ratio);
        follows_s <= thresholds.hidden_rows / state.robot.control_rate_hz
    };
    let unseen = problem.changes_inertia(&without, &state.active[index]) && within_a_row();
    let own_law = if unseen { thresholds.late_law * gain } else { 0.0 };
    let tie = thresholds.tied(gain).max(own_law);
    match more {
        _ if !sound => Late::Less,
        more if more < tie => Late::Even,
        more if more < tie.max(thresholds.doubtful) => Late::Doubtful,
        _ => Late::Less,
    }
}
