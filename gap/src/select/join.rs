//! One effect in place of two that together look like it.

use super::{Selection, finish, settle, stopped};
use crate::problem::Problem;
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use links::effect::Link;

/// Effects that are tried in place of two.
const JOINTS: usize = 3;

/// Replaces two effects by one that looks like both together: of explanations that cannot be told apart the simplest
/// is named.
pub(super) fn join(
    problem: &Problem,
    start: &State,
    mut best: Selection,
    from: usize,
    all: &[Active],
    thresholds: &Thresholds,
) -> (Selection, bool) {
    let mut changed = false;
    while let Some(simpler) = joined(problem, start, &best, from, all, thresholds) {
        best = simpler;
        changed = true;
    }
    (best, changed)
}

fn joined(
    problem: &Problem,
    start: &State,
    best: &Selection,
    from: usize,
    all: &[Active],
    thresholds: &Thresholds,
) -> Option<Selection> {
    let active = &best.state.active;
    let design = &best.design;
    let named: Vec<usize> = (from..active.len()).filter(|i| active[*i].is_named()).collect();
    let pairs = named.iter().enumerate().flat_map(|(i, a)| named[i + 1..].iter().map(move |b| [*a, *b]));
    for [a, b] in pairs {
        let most = active[a].form.free.len() + active[b].form.free.len();
        // What either adds to the other.
        let added = design.own_part(a, b).min(design.own_part(b, a));
        let fits = |c: &usize| {
            let candidate = &all[*c];
            // Another form of one of the two may do what both do: friction of the other sense is this one beside a weight.
            let others = active.iter().enumerate().filter(|(i, _)| *i != a && *i != b);
            let named = others.into_iter().any(|(_, o)| o.effect.name() == candidate.effect.name());
            candidate.form.free.len() < most && !named && !candidate.effect.probe() && !candidate.switched()
        };
        let left = |c: usize| (design.left_by(c, &[a, b])[1], c);
        let mut alike: Vec<(f64, usize)> = (0..all.len()).filter(fits).map(left).collect();
        // A heavier robot looks like weaker motors with less to turn than the file has. Accelerations go with the inverse of
        // what is moved, which no straight line beside motors that are a quarter weaker promises.
        let moves = |law: &Active| problem.link() == Link::Drive && problem.changes_inertia(start, law);
        let is_either = |c: usize| [a, b].iter().any(|i| active[*i].effect.name() == all[c].effect.name());
        let less = |law: &Active| moves(law) && law.form.free.first().is_some_and(|p| law.values.get(&p.name) < 0.0);
        let moved = less(&active[a]) || less(&active[b]);
        let heavier = |c: usize| moved && !is_either(c) && moves(&all[c]);
        alike.retain(|(left, c)| *left < thresholds.does_both * added || heavier(*c));
        alike.sort_by(|x, y| x.0.total_cmp(&y.0));
        for (_, c) in alike.into_iter().take(JOINTS) {
            let mut without = best.state.clone();
            without.active.remove(b);
            let mut state = without.clone();
            without.active.remove(a);
            state.active[a] = all[c].clone();
            let settled = settle(problem, &mut state, all, thresholds);
            let alternative = finish(state, settled, from, thresholds);
            // What is adjusted beside both is as much larger in the torque of a heavier robot.
            let other = if heavier(c) { &without } else { &best.state };
            let sound = alternative.state.active[a].worth() && !stopped(&alternative.state.active[a]);
            if sound
                && alternative.against(best) < thresholds.doubtful.max(thresholds.tie(added))
                && !problem.runs_away(&alternative.state, other, thresholds)
            {
                return Some(alternative);
            }
        }
    }
    None
}
