//! Whether single frames tell what is wrong with wheels, or only the way of several seconds.
//!
//! Within a second a radius that is a per cent off moves a slow robot by no more than its poses err. Over several seconds it
//! does, and the wheels' own wandering counts, too: how much of that there is, is what every effect at once leaves.

use std::sync::Arc;

use nalgebra::DVector;

use super::gaps::agreement;
use super::order::cabled;
use super::question::Question;
use super::truth::everything;
use super::workflow::Workflow;
use crate::problem::{Linear, Problem};
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use links::effect::{Effect, Link, Parameter, Sizes};
use links::motion::{Errors, MotionLink, Ways};
use links::pieces::Pieces;

/// Effects of the wheels that any robot may have, whose sizes single frames must tell.
const WHEELS: [&str; 2] = ["body-radius", "wheel-radius"];
/// Groups of frames in a window of single frames.
const GROUPS: f64 = 2.0;
/// Sizes that matter within which each of all effects is held as they are fitted together: look-alikes share what they do.
const LOOSELY: f64 = 30.0;

/// Ways that tell of the wheels what single frames do not, where those give no effect a name: their length, s, and errors.
///
/// Whatever the file says of them, all effects are looked for, so that a file as it was written is compared as it was found.
pub(super) fn beyond_frames(
    question: &Question,
    pieces: &Pieces,
    crossed: Option<&(Active, f64)>,
) -> Option<(f64, Ways)> {
    let mut bare = question.filed();
    bare.active.retain(cabled);
    bare.active.extend(crossed.map(|(active, _)| active.clone()));
    let frames = MotionLink::new(pieces, question.noise, question.window_s);
    let ways = ways(&frames, &bare, &question.catalogue, &question.options.thresholds)?;
    let frames = question.motion_link(pieces, None);
    let mut workflow = Workflow::new(question, &frames, None, crossed.cloned(), Vec::new());
    workflow.start = bare;
    let before = workflow.findings.named.len();
    workflow.motion();
    (workflow.findings.named.len() == before).then_some(ways)
}

/// Length of windows, s, and what wheels and poses part by in them. `None` where single frames tell what matters of the wheels,
/// where ways do not tell much more, and where wheels wander by much more than matters: those slip.
fn ways(
    link: &MotionLink,
    start: &State,
    catalogue: &[Arc<dyn Effect>],
    thresholds: &Thresholds,
) -> Option<(f64, Ways)> {
    if link.is_empty() || link.axes() < 3 {
        return None;
    }
    let problem = Problem::Motion(link);
    let mut state = start.clone();
    state.active.iter_mut().for_each(|a| a.given = true);
    state.active.extend(everything(&problem, &state, catalogue));
    // A straight line tells most data sets apart.
    let linear = problem.linearise(&state, &[]);
    let mut step = DVector::zeros(linear.owners.len());
    for (c, x) in linear.active().into_iter().zip(linear.step(&state, &held).iter()) {
        step[c] = *x;
    }
    let tells = |least: &[f64]| least.iter().all(|least| *least < thresholds.seen);
    if tells(&least(&linear, &state, linear.equations.loss_after(&step), thresholds)) {
        return None;
    }
    problem.fit_held(&mut state, &held);
    let frames = least_of(&problem, &state, thresholds);
    if tells(&frames) {
        return None;
    }
    let [number, shortest, longest] = thresholds.ways;
    let window_s = link.window_s * (link.len() as f64 / number).clamp(shortest, longest);
    let together_s = link.window_s / GROUPS;
    let rim_m = Sizes::of(&state.robot).rim_m;
    let along = |ways: Option<Ways>| MotionLink::new(link.pieces, link.noise, window_s).along(ways);
    let part = |ways: Option<Ways>, state: &State| along(ways).part(&state.motion(None), together_s, rim_m);
    let first = part(None, &state)?;
    let long = along(Some(first));
    Problem::Motion(&long).fit_held(&mut state, &held);
    let ways = part(Some(first), &state)?;
    let (square, n) = Problem::Motion(&along(Some(ways))).linearise_nothing(&state).plain();
    // What is rare and large is in the floor as well.
    let ways = ways.times((square / n.max(1.0)).sqrt());
    let rolled = link.pieces.speed() * state.robot.wheel_radius_m * link.window_s;
    let Errors { axis_m, heading_rad } = ways.wander.times(rolled.sqrt());
    let [way, turn] = agreement(link, thresholds);
    let beyond = [axis_m / way, heading_rad / turn];
    if beyond.iter().zip(thresholds.wanders).any(|(beyond, most)| *beyond > most) {
        return None;
    }
    let ways = ways.beyond(beyond);
    let along = least_of(&Problem::Motion(&along(Some(ways))), &state, thresholds);
    let better = |(frames, along): (&f64, &f64)| *frames >= thresholds.seen && thresholds.tells_more * along < *frames;
    frames.iter().zip(&along).any(better).then_some((window_s, ways))
}

/// What is said of such a comparison.
pub(super) fn said(window_s: f64, ways: &Ways) -> String {
    format!(
        "Wheels and poses were compared along ways of {window_s:.0} s: in single seconds nothing small shows of these wheels. \
         Over a metre rolled they wander by {:.1} mm and {:.2} degrees beside every effect, and so much is their noise.",
        1e3 * ways.wander.axis_m,
        ways.wander.heading_rad.to_degrees()
    )
}

fn least_of(problem: &Problem, state: &State, thresholds: &Thresholds) -> Vec<f64> {
    let linear = problem.linearise(state, &[]);
    let square = linear.equations.plain().0;
    least(&linear, state, square, thresholds)
}

/// Sizes from which effects of the wheels would have a name beside what all effects leave, in those that matter.
fn least(linear: &Linear, state: &State, square: f64, thresholds: &Thresholds) -> Vec<f64> {
    let n = linear.equations.plain().1;
    let needed = (thresholds.share_of_excess * (square - n).max(0.0))
        .max(thresholds.share(Link::Motion) * square)
        .max(thresholds.gain + thresholds.cost(1));
    let information = linear.equations.information();
    let of = |name: &&str| {
        let index = state.active.iter().position(|a| !a.given && a.effect.name() == *name)?;
        let known: f64 = linear.of_active(index).iter().map(|c| information[(*c, *c)]).sum();
        Some((needed / known).sqrt() / state.active[index].form.free[0].material)
    };
    WHEELS.iter().filter_map(of).collect()
}

/// Information on a parameter by how far it is held.
fn held(p: &Parameter) -> f64 {
    if p.material.is_finite() { (LOOSELY * p.material).powi(-2) } else { 0.0 }
}
