//! Laws of the drive between which a recording far from its noise does not decide.

use super::{is_material, stopped};
use crate::problem::Problem;
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use links::effect::Link;

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
