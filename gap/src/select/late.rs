//! Readings of an inertial sensor that are older than the time in which the robot's rates change.
//!
//! The turn between two nodes is a straight line in the age of the readings as long as the rate goes on as it did. A robot
//! that is steered by hand changes it within a node's interval, and from there on the line closes next to nothing: of
//! readings 70 ms old a third of the age was named, or nothing. The age is then looked for from several on.

use estimation::parallel::each;

use super::{is_material, stopped};
use crate::problem::Problem;
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use links::inertial::NODES_S;

/// Distance of the ages that are tried, s. Counts that were read a row early or late even out between two rows, so that each
/// row has a minimum of its own: of a log at 50 Hz none is missed.
const APART_S: f64 = 0.25 * NODES_S;

/// An age of the readings, or of the counts, beyond the reach of the straight line that by itself closes a good part of the
/// gap, fitted from the best of several on; nothing where none does.
pub(super) fn late(problem: &Problem, start: &State, all: &[Active], thresholds: &Thresholds) -> Option<Active> {
    let age = problem.age(all)?;
    let p = &age.form.free[0];
    let steps = ((p.bounds[1] - p.bounds[0]) / APART_S).round() as usize;
    let begun = |k: usize| {
        let mut begun = age.clone();
        begun.values.set(&p.name, p.bounds[0] + k as f64 * APART_S);
        let mut state = start.clone();
        state.active.push(begun);
        state
    };
    let tried: Vec<State> = (1..steps).map(begun).collect();
    let square = |state: &State| problem.linearise_nothing(state).plain().0;
    let left = each(&tried, &square);
    let best = (0..left.len()).min_by(|a, b| left[*a].total_cmp(&left[*b]))?;
    let mut state = tried[best].clone();
    problem.fit(&mut state);
    let found = &state.active[start.active.len()];
    let far = found.values.get(&p.name).abs() > 0.5 * NODES_S;
    let sound = far && is_material(found, &found.parameters()) && !stopped(found);
    let before = square(start);
    (sound && before - square(&state) >= thresholds.closes * before).then(|| found.clone())
}
