//! What a pose knows at best, where it was smoothed before it was logged.
//!
//! Poses from SLAM, a filter or a spline follow each other without any scatter, and so the scatter of neighbours says
//! nothing of them: they err by millimetres or centimetres that last for seconds. That shows against the wheels alone,
//! once everything about wheels, marker and clocks is fitted that can be.

use std::sync::Arc;

use estimation::statistics::median;

use super::gaps::agreement;
use crate::problem::Problem;
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use links::effect::{Effect, Link};
use links::motion::{MotionLink, WindowResiduals};

/// Floors that a window leaves beside every effect from which neighbouring poses do not tell their noise: the scatter
/// of motion capture is exceeded 1.3 to 6 times by rollers and contacts (nine recordings of three machines), that of a
/// pose by SLAM some 400 times.
const BEYOND_WHEELS: f64 = 10.0;
/// What matters in a window, in the scatter of neighbouring poses, from which they are too smooth for a tracker: a league's
/// camera has 13 at most, motion capture 10 to 20, poses by SLAM 800.
const FINER: f64 = 30.0;
/// The same from which no tracker is so fine, however far wheels and poses part: a video of 30 frames a second that was
/// smoothed and laid on 100 rows a second had 240.
const FINEST: f64 = 150.0;
/// Residuals that the error of such a pose makes in a window, along one axis: a drift and a bend. Their median RMS is
/// 0.83 of the standard deviation.
const MEDIAN_OF_TWO: f64 = 0.832_6;

/// Standard deviations of a pose (m, m, rad) whose neighbours scatter less than it errs, none above what matters: beyond
/// that wheels and pose do not agree, whatever the pose is. `None` where neighbours tell its noise, and where wheels and
/// pose part so far that neither can be believed.
pub(super) fn smoothed(
    link: &MotionLink,
    start: &State,
    catalogue: &[Arc<dyn Effect>],
    thresholds: &Thresholds,
) -> Option<[f64; 3]> {
    let ([way, turn], [x, y, theta]) = (agreement(link, thresholds), link.noise);
    let headings = link.axes() == 3;
    // A camera whose noise is near what matters tells it: what its frames and the wheels leave then is the robot's.
    let finer = [(x.max(y), way), (theta, turn)].map(|(noise, matters)| FINER * noise <= matters);
    let smooth = finer[0] || headings && finer[1];
    if link.is_empty() || !smooth || all(&link.residuals(&start.motion(None)), link) <= BEYOND_WHEELS {
        return None;
    }
    let problem = Problem::Motion(link);
    let mut state = start.clone();
    state.active.iter_mut().for_each(|a| a.given = true);
    let free = everything(&problem, &state, catalogue);
    // One linear step tells most recordings apart.
    let linear = problem.linearise(&state, &free);
    let columns: Vec<usize> = (0..linear.owners.len()).collect();
    let step = linear.equations.solve(&columns);
    let left = |c: &estimation::normal_equations::Cluster| (c.loss_after(&step) / c.n.max(1.0)).max(0.0).sqrt();
    if median(&mut linear.equations.clusters.iter().map(left).collect::<Vec<f64>>()) <= BEYOND_WHEELS {
        return None;
    }
    state.active.extend(free);
    problem.fit(&mut state);
    let left = link.residuals(&state.motion(None));
    let placed = typical(&left, &[(0, x), (1, y)]);
    let pointed = if headings { typical(&left, &[(2, theta)]) } else { 0.0 };
    let beyond = finer[0] && placed > BEYOND_WHEELS * x.max(y) || finer[1] && pointed > BEYOND_WHEELS * theta;
    // Where wheels slip they part from any pose, but no tracker is that fine.
    let finest = FINEST * x.max(y) <= way;
    if !beyond || !finest && (placed > thresholds.far * way || pointed > thresholds.far * turn) {
        return None;
    }
    let known = |noise: f64, errs: f64, matters: f64| noise.max(errs.min(matters));
    let heading = if headings { known(theta, pointed, turn) } else { theta };
    Some([known(x, placed, way), known(y, placed, way), heading])
}

/// What is said of such a floor.
pub(super) fn said(before: [f64; 3], now: [f64; 3]) -> String {
    let mut parts = Vec::new();
    if now[..2] != before[..2] {
        let [now, before] = [now, before].map(|noise| 1e3 * noise[0].max(noise[1]));
        parts.push(format!("{now:.1} mm where neighbouring ones scatter by {before:.2}"));
    }
    if now[2] != before[2] {
        let [now, before] = [now[2], before[2]].map(f64::to_degrees);
        parts.push(format!("{now:.2} degrees where neighbouring ones scatter by {before:.3}"));
    }
    format!(
        "the poses were smoothed or come from a map: whatever is fitted, the wheels leave {} or more. That is taken as \
         what they know, and nothing smaller is told",
        parts.join(" and ")
    )
}

/// All effects of wheels, marker and clocks at once, each in its largest form.
pub(super) fn everything(problem: &Problem, state: &State, catalogue: &[Arc<dyn Effect>]) -> Vec<Active> {
    let mut all: Vec<Active> = Vec::new();
    for a in problem.candidates(state, catalogue) {
        let grows = a.effect.link() == Link::Motion && !a.effect.probe() && !a.switched() && !a.form.free.is_empty();
        if !grows {
            continue;
        }
        match all.iter_mut().find(|b| b.effect.name() == a.effect.name()) {
            Some(b) if b.form.free.len() >= a.form.free.len() => {}
            Some(b) => *b = a,
            None => all.push(a),
        }
    }
    all
}

/// Typical RMS of a window over all axes, in floors.
fn all(windows: &[WindowResiduals], link: &MotionLink) -> f64 {
    typical(windows, &[(0, 1.0), (1, 1.0), (2, 1.0)][..link.axes()])
}

/// Standard deviation of residuals in some axes, each in a unit of its own, by the window in the middle.
fn typical(windows: &[WindowResiduals], axes: &[(usize, f64)]) -> f64 {
    let rms = |w: &WindowResiduals| {
        let used = w.residuals.iter().zip(&w.weights).filter(|(_, weight)| **weight > 0.0);
        estimation::statistics::rms(used.flat_map(|(r, _)| axes.iter().map(|(i, unit)| r[*i] * unit)))
    };
    median(&mut windows.iter().map(rms).collect::<Vec<f64>>()) / MEDIAN_OF_TWO
}
