//! What closes little beside what nothing explains.

use super::left::Left;
use super::simpler::bare;
use crate::problem::Problem;
use crate::state::State;
use crate::thresholds::Thresholds;
use estimation::statistics::median;
use links::effect::Link;

/// The named effect that closes least beside what all of them leave above the noise, and which share of that it closes, each
/// fitted with nothing adjusted; `None` where every one closes enough. Where wheels slip, much is left whatever is named, and
/// every law that bends ways a little closes a part of it; slip itself does not, whose law leaves most of it. On the drive other laws are tried in its place, see
/// [`undecided`](super::undecided).
pub(crate) fn dwarfed(
    problem: &Problem,
    state: &State,
    start: &State,
    thresholds: &Thresholds,
) -> Option<(usize, f64)> {
    let from = start.active.len();
    let named: Vec<usize> = (from..state.active.len()).filter(|i| state.active[*i].is_named()).collect();
    if problem.link() != Link::Motion || named.is_empty() {
        return None;
    }
    let kept = |without: Option<usize>| {
        bare(problem, start, named.iter().filter(|i| Some(**i) != without).map(|i| &state.active[*i]))
    };
    let whole = kept(None);
    let left = Left::of(problem, &whole);
    // A push, or a start on which wheels slipped, is in a few windows; what no law explains is in most of them.
    let sizes = problem.linearise_nothing(&whole);
    let mut each: Vec<f64> = left.clusters.iter().zip(&sizes.clusters).map(|(left, c)| left / c.n.max(1.0)).collect();
    let floors = median(&mut each).sqrt();
    if floors < thresholds.dwarfs {
        return None;
    }
    // Beside that much what closes less than it leaves is no answer.
    let least = if floors < thresholds.far_open { thresholds.undecided } else { 1.0 };
    let share = |i: &usize| (*i, (Left::of(problem, &kept(Some(*i))).sum() - left.sum()) / left.excess());
    let bends = |i: &&usize| !state.active[**i].together && state.active[**i].effect.name() != "wheel-slip";
    let alone = named.iter().filter(bends).map(share);
    alone.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, share)| *share < least)
}
