//! Logs in which the camera sees a robot stand whose wheels turn: it was lifted, or held, or the camera lost it.

use runs::Log;
use runs::frames::wrap_angle;
use runs::robot::{Robot, Support};

use super::samples::{FEWEST, Sample, of_camera};
use super::{Mistake, short};

/// Length of a stretch, s: long against the camera's noise.
const STRETCH_S: f64 = 0.6;
/// Way that the camera sees of a robot that stands, in that of its rims: wheels that slip most on soft floors still took a robot
/// 0.22 of what they turned, and the noise of a camera makes 0.02.
const STANDS: f64 = 0.1;
/// Way of one of the others at least: where all see a tenth of the way, it is the camera's unit or the encoders' counts.
const GOES: f64 = 0.2;

/// What the camera sees of a robot's motion, in what its wheels turn, and of its way alone; `None` where they hardly turn.
fn seen(robot: &Robot, log: &Log) -> Option<[f64; 2]> {
    let rim = robot.geometry().ok()?.wheels().iter().map(|w| w.x_m.hypot(w.y_m)).fold(0.0, f64::max);
    let turned = |s: &Sample| robot.wheel_radius_m * s.turned.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
    let way = |s: &Sample| s.from.distance(s.to);
    let goes = |s: &Sample| way(s) + rim * wrap_angle(s.to.theta - s.from.theta).abs();
    let samples = of_camera(robot, log, STRETCH_S);
    let usual = samples.iter().map(turned).sum::<f64>() / samples.len().max(1) as f64;
    let driven: Vec<&Sample> = samples.iter().filter(|s| turned(s) > usual && usual > 0.0).collect();
    let sum = |of: &dyn Fn(&Sample) -> f64| driven.iter().map(|s| of(s)).sum::<f64>();
    (driven.len() >= FEWEST).then(|| [sum(&goes) / sum(&turned), sum(&way) / sum(&turned)])
}

/// Such logs among others in which the robot goes: one of them makes the file look like that of another robot.
pub(super) fn mistakes(robot: &Robot, logs: &[Log]) -> Vec<Mistake> {
    if robot.support != Support::Floor || runs::is_dead_reckoning(robot) {
        return Vec::new();
    }
    let seen: Vec<(&str, [f64; 2])> =
        logs.iter().filter_map(|log| Some((log.name.as_str(), seen(robot, log)?))).collect();
    let (stand, go): (Vec<_>, Vec<_>) = seen.iter().partition(|(_, [share, _])| *share < STANDS);
    let farthest = go.iter().map(|(_, [_, way])| *way).fold(0.0, f64::max);
    if stand.is_empty() || farthest < GOES {
        return Vec::new();
    }
    let names: Vec<&str> = stand.iter().map(|(name, _)| *name).collect();
    let most = stand.iter().map(|(_, [share, _])| *share).fold(0.0, f64::max);
    let what = format!(
        "in {} ({} of {} logs that show it) the camera sees the robot stand, or go less than {} of what its wheels turn: it was \
         lifted or held, or the camera lost it",
        names.join(", "),
        names.len(),
        seen.len(),
        short(most.max(0.01))
    );
    let remedy = format!("leave out {}, or compare it by itself with support = \"blocks\"", names.join(", "));
    vec![Mistake::new("robot-stands", "cam_x", what, remedy)]
}
