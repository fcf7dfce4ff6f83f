//! Laws of which one takes back what another does, where another one in its place does not.

use estimation::parallel::each;

use super::left::Left;
use super::simpler::{bare, first_of_least, is_sound, laws};
use super::{Selection, finish_bare};
use crate::problem::Problem;
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use links::effect::Link;

/// What is named on the drive, another law of no more parameters in place of one of them so that none undoes most of another,
/// where that leaves as little; the effect at `undone` stays if it may. Motors of less torque are braked less by their
/// back-EMF, too: with a friction that does that, they are motors of more resistance, or a heavier robot.
pub(crate) fn not_undone(
    problem: &Problem,
    found: &Selection,
    undone: usize,
    start: &State,
    all: &[Active],
    thresholds: &Thresholds,
) -> Option<Selection> {
    let from = start.active.len();
    let (now, stays) = (&found.state.active, &found.state.active[undone]);
    let named: Vec<&Active> = now[from..].iter().filter(|a| a.is_named()).collect();
    if problem.link() != Link::Drive {
        return None;
    }
    let left = Left::fitted(problem, &bare(problem, start, named.iter().copied()));
    let is_undone = |a: &Active| std::ptr::eq(a, stays);
    let mut places: Vec<usize> = (0..named.len()).collect();
    places.sort_by_key(|i| is_undone(named[*i]));
    let mut tried: Vec<(usize, Active)> = Vec::new();
    for place in places {
        let may = |a: &Active| {
            let is_new = !named.iter().any(|n| n.effect.name() == a.effect.name());
            let plain = !a.switched() && a.form.free.iter().all(|p| p.material.is_finite());
            is_new && plain && a.form.free.len() <= named[place].form.free.len()
        };
        tried.extend(laws(problem, start, all, may).into_iter().map(|law| (place, law)));
    }
    let fitted = each(&tried, &|(place, law)| {
        let others = named.iter().enumerate().filter(|(i, _)| i != place).map(|(_, a)| *a);
        let state = bare(problem, start, others.chain(std::iter::once(law)));
        let now = Left::fitted(problem, &state);
        let as_good = now.is_hardly_more(&left, thresholds) && is_sound(problem, start, &state, thresholds);
        as_good.then_some((state, now))
    });
    let state = first_of_least(fitted.into_iter().flatten().collect(), thresholds)?;
    Some(finish_bare(problem, state, from, all, thresholds))
}
