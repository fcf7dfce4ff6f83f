//! One effect in place of two that together look like it.

use super::{Selection, finish, settle, stopped};
use crate::problem::Problem;
use crate::state::Active;
use crate::thresholds::Thresholds;

/// Effects that are tried in place of two.
const JOINTS: usize = 3;

/// Replaces two effects by one that looks like both together: of explanations that cannot be told apart the simplest
/// is named.
pub(super) fn join(
    problem: &Problem,
    mut best: Selection,
    from: usize,
    all: &[Active],
    thresholds: &Thresholds,
) -> (Selection, bool) {
    let mut changed = false;
    while let Some(simpler) = joined(problem, &best, from, all, thresholds) {
        best = simpler;
        changed = true;
    }
    (best, changed)
}

fn joined(
    problem: &Problem,
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
        alike.retain(|(left, _)| *left < thresholds.does_both * added);
        alike.sort_by(|x, y| x.0.total_cmp(&y.0));
        for (_, c) in alike.into_iter().take(JOINTS) {
            let mut state = best.state.clone();
            state.active.remove(b);
            state.active[a] = all[c].clone();
            let settled = settle(problem, &mut state, all, thresholds);
            let alternative = finish(state, settled, from, thresholds);
            let sound = alternative.state.active[a].worth() && !stopped(&alternative.state.active[a]);
            if sound
                && alternative.against(best) < thresholds.doubtful.max(thresholds.tie(added))
                && !problem.runs_away(&alternative.state, &best.state, thresholds)
            {
                return Some(alternative);
            }
        }
    }
    None
}
