//! What turns far more lightly than its file has it.
//!
//! Accelerations go with the inverse of what is moved, and a straight line through the file's value ends where a tenth of
//! it is moved: it closes next to nothing of the gap that a file with ten times the inertia opens, and whatever bends
//! speeds a little, or nothing, was named there.

use estimation::parallel::each;

use super::{is_material, stopped};
use crate::problem::Problem;
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use links::effect::Link;

/// Inertia left of the file's, below which a straight line through it does not reach.
const STRAIGHT: f64 = 0.1;
/// Scale of the file's inertia from which what was found is kept so: half of it is less than any margin is.
const HALF: f64 = -0.5;

/// An inertia that by itself, or with one law of one parameter beside it, closes a good part of the gap of a drive that is
/// far from its noise, fitted from its lightest on; nothing where none does. Friction alone makes the drive look weak, and
/// so what it moves look heavy: a tenth of the inertia behind an unknown friction of a tenth of the stall torque leaves
/// most of the gap without that friction.
pub(super) fn lighter(problem: &Problem, start: &State, all: &[Active], thresholds: &Thresholds) -> Vec<Active> {
    let (square, n) = problem.linearise_nothing(start).plain();
    if problem.link() != Link::Drive || square < thresholds.far_left.powi(2) * n {
        return Vec::new();
    }
    let known = |a: &Active| start.active.iter().any(|o| o.effect.name() == a.effect.name());
    let plain = |a: &&Active| {
        let free = &a.form.free;
        !a.effect.probe() && !a.switched() && free.len() == 1 && free[0].material.is_finite() && !known(a)
    };
    let (inertias, others): (Vec<&Active>, Vec<&Active>) =
        all.iter().filter(plain).partition(|a| problem.changes_inertia(start, a));
    let mut tried: Vec<Vec<Active>> = Vec::new();
    for inertia in inertias.into_iter().filter(|a| a.form.free[0].bounds[0] < STRAIGHT - 1.0) {
        let p = &inertia.form.free[0];
        let mut lightest = inertia.clone();
        lightest.values.set(&p.name, p.bounds[0]);
        tried.push(vec![lightest.clone()]);
        tried.extend(others.iter().map(|other| vec![lightest.clone(), (*other).clone()]));
    }
    let from = start.active.len();
    let fitted = each(&tried, &|laws| {
        let mut state = start.clone();
        state.active.extend_from_slice(laws);
        // From so far it takes more steps than one fit has.
        problem.fit(&mut state);
        problem.fit(&mut state);
        let (left, _) = problem.linearise_nothing(&state).plain();
        let found = &state.active[from..];
        let is_lighter = found[0].values.get(&found[0].form.free[0].name) < 0.0;
        let sound = is_lighter && found.iter().all(|a| is_material(a, &a.parameters()) && !stopped(a));
        let closes = square - left >= thresholds.closes * square;
        (sound && closes && !problem.runs_away(&state, start, thresholds)).then(|| (left, found.to_vec()))
    });
    // Of forms that are one on a machine with one axis the first.
    let better = |a: (f64, Vec<Active>), b: (f64, Vec<Active>)| if b.0 < thresholds.as_good * a.0 { b } else { a };
    fitted.into_iter().flatten().reduce(better).map_or_else(Vec::new, |(_, laws)| laws)
}

/// What was found with far less inertia than the file's, which a straight line would lose again; nothing without.
pub(super) fn kept(problem: &Problem, start: &State, known: &[Active]) -> Vec<Active> {
    let far = |a: &Active| {
        let p = &a.form.free[0];
        a.form.free.len() == 1 && a.values.get(&p.name) < HALF && p.bounds[0] < STRAIGHT - 1.0
    };
    let found = known.iter().any(|a| !a.form.free.is_empty() && far(a) && problem.changes_inertia(start, a));
    if found { known.to_vec() } else { Vec::new() }
}
