//! What turns far more lightly than its file has it, or more heavily.
//!
//! Accelerations go with the inverse of what is moved, and a straight line through the file's value ends where a tenth of
//! it is moved: it closes next to nothing of the gap that a file with ten times the inertia opens, and whatever bends
//! speeds a little, or nothing, was named there. A load that the file lacks is a straight line's, but not beside a friction
//! that it lacks, too, where each drive is one step: each of the two by itself closes what the other undoes.

use std::sync::Arc;

use estimation::parallel::each;

use super::simpler::simpler;
use super::{Selection, is_material, plain, stopped, without};
use crate::problem::Problem;
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use links::effect::{Effect, Link, Parameter};

/// Value of the first parameter of what has one; of an inertia what it has more than the file's, in the file's.
fn value(a: &Active) -> Option<f64> {
    a.form.free.first().map(|p| a.values.get(&p.name))
}

fn weighs_more(inertia: &Active, thresholds: &Thresholds) -> bool {
    value(inertia).is_some_and(|scale| scale > thresholds.heavier[1] - 1.0)
}

/// Whether an inertia that is so much heavier is named: without it what else was found from there is no better a guess than
/// what was found from the file's.
pub(crate) fn is_heavier(problem: &Problem, start: &State, named: &[Active], thresholds: &Thresholds) -> bool {
    named.iter().any(|a| a.is_named() && weighs_more(a, thresholds) && problem.changes_inertia(start, a))
}

/// A drive explained from an inertia on that is heavier than the file's; nothing where that explains little.
pub(crate) fn heavier(
    problem: &Problem,
    start: &State,
    catalogue: &[Arc<dyn Effect>],
    thresholds: &Thresholds,
) -> Option<Selection> {
    let all = problem.candidates(start, catalogue);
    let from = thresholds.heavier[0] - 1.0;
    let laws = begun(problem, start, &all, thresholds, |p| (p.bounds[1] > from).then_some(from));
    let inertia = laws.first().filter(|a| weighs_more(a, thresholds))?.clone();
    let found = plain(problem, start, &laws, &all, thresholds, false)?;
    let mut found = simpler(problem, start, found, &all, &problem.in_place(start, catalogue), thresholds);
    // What the wrong inertia opens is no measure of what two laws beside the right one may undo of each other.
    let mut beside = start.clone();
    beside.active.push(inertia);
    let rank = |a: &Active| all.iter().position(|c| c.effect.name() == a.effect.name());
    loop {
        let from = start.active.len();
        let undone = |i: &usize| {
            let own = &found.state.active[*i];
            own.effect.name() != beside.active[from].effect.name()
                && problem.is_cancelled(&found.state, *i, &beside, thresholds)
        };
        let worst = (from..found.state.active.len()).filter(undone).max_by_key(|i| rank(&found.state.active[*i]));
        let Some(name) = worst.map(|i| found.state.active[i].effect.name().to_owned()) else { return Some(found) };
        found = without(problem, &found, from, |a| a.effect.name() != name, &all, thresholds);
    }
}

/// An inertia that by itself, or with one law of one parameter beside it, closes a good part of the gap of a drive that is
/// far from its noise, fitted from its lightest on; nothing where none does. Friction alone makes the drive look weak, and
/// so what it moves look heavy: a tenth of the inertia behind an unknown friction of a tenth of the stall torque leaves
/// most of the gap without that friction.
pub(super) fn lighter(problem: &Problem, start: &State, all: &[Active], thresholds: &Thresholds) -> Vec<Active> {
    begun(problem, start, all, thresholds, |p| (p.bounds[0] < thresholds.lighter[0] - 1.0).then_some(p.bounds[0]))
}

/// The same of an inertia that is fitted from a value of its own on, and ends on that side of the file's.
fn begun(
    problem: &Problem,
    start: &State,
    all: &[Active],
    thresholds: &Thresholds,
    from_value: impl Fn(&Parameter) -> Option<f64>,
) -> Vec<Active> {
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
    for inertia in inertias {
        let p = &inertia.form.free[0];
        let Some(value) = from_value(p) else { continue };
        let mut begun = inertia.clone();
        begun.values.set(&p.name, value);
        tried.push(vec![begun.clone()]);
        tried.extend(others.iter().map(|other| vec![begun.clone(), (*other).clone()]));
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
        let same_side = value(&found[0]).zip(value(&laws[0])).is_some_and(|(now, begun)| now * begun > 0.0);
        let sound = same_side && found.iter().all(|a| is_material(a, &a.parameters()) && !stopped(a));
        let closes = square - left >= thresholds.closes * square;
        (sound && closes && !problem.runs_away(&state, start, thresholds)).then(|| (left, found.to_vec()))
    });
    // Of forms that are one on a machine with one axis the first.
    let better = |a: (f64, Vec<Active>), b: (f64, Vec<Active>)| if b.0 < thresholds.as_good * a.0 { b } else { a };
    fitted.into_iter().flatten().reduce(better).map_or_else(Vec::new, |(_, laws)| laws)
}

/// What was found with far less inertia than the file's, which a straight line would lose again; nothing without.
pub(super) fn kept(problem: &Problem, start: &State, known: &[Active], thresholds: &Thresholds) -> Vec<Active> {
    let [reached, half] = thresholds.lighter.map(|inertia| inertia - 1.0);
    let far = |a: &Active| {
        a.form.free.len() == 1 && value(a).is_some_and(|scale| scale < half) && a.form.free[0].bounds[0] < reached
    };
    let found = known.iter().any(|a| far(a) && problem.changes_inertia(start, a));
    if found { known.to_vec() } else { Vec::new() }
}
