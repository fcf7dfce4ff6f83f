//! Turns the other way than the camera's, on robots that hardly turn, or whose camera sees no headings: too little for the
//! comparison of ways and turns in [`super::camera`], and yet plain where the turns themselves are compared.

use nalgebra::{Matrix3, Vector3};
use runs::Log;
use runs::frames::wrap_angle;
use runs::geometry::Geometry;
use runs::robot::{Robot, Support};

use super::samples::Wheels;
use super::{Mistake, OTHER_SENSE_KIND};

/// Lengths of the stretches whose turns are compared, s: a robot that hardly turns takes long to turn by more than its
/// camera's noise, and in that time one that turns fast has no direction.
const STRETCHES_S: [f64; 2] = [1.0, 0.3];
/// Fewest of them that tell anything.
const FEWEST: usize = 20;
/// Share of the squared turns that turns by the counts must explain, beside what ways do, and of theirs that ways must
/// leave: of random turns none explain that much of 20.
const EXPLAINED: f64 = 0.5;
/// Camera's turns per turn by the counts that are those of turns the other way: a track in place of its half, or half of it,
/// makes half or twice as many of them, and noise of the counts fewer yet. On a small robot whose distance of the wheels from the
/// centre passed for their track they were -0.46.
const BACKWARDS: [f64; 2] = [-4.0, -0.25];
/// Way between frames, in distances of the outermost wheel from the centre, from which it has a direction.
const DIRECTION: f64 = 0.5;

/// What is said of a robot whose turns go the other way where its headings are those of its wheels.
pub(super) const OF_HEADINGS: [&str; 2] = ["robot-file", "wheels-slip"];

/// What turned between two frames: by the camera, and by the counts with the ways ahead and sideways.
type Turn = (f64, [f64; 3]);

pub(super) fn mistakes(robot: &Robot, logs: &[Log], before: &[Mistake]) -> Vec<Mistake> {
    let ways_alone = logs.iter().any(|log| log.layout().source.positions_only);
    // Turns of wheels that slip follow nothing; nor do ways that bend the other way than headings by the wheels, which then
    // agree where the robot drives straight alone.
    let said = ["encoder-order", OTHER_SENSE_KIND, "heading-clockwise", "heading-degrees", "camera-y-down"];
    let told = |m: &Mistake| said.contains(&m.kind) || OF_HEADINGS.contains(&m.kind) && !ways_alone;
    if before.iter().any(told) || robot.support != Support::Floor {
        return Vec::new();
    }
    let Some(geometry) = robot.geometry().ok() else { return Vec::new() };
    if ways_alone && !geometry.is_differential() {
        return Vec::new(); // others may go where they do not point
    }
    let shares = STRETCHES_S.into_iter().filter_map(|stretch_s| {
        per_turn(&logs.iter().flat_map(|log| of(robot, &geometry, log, stretch_s)).collect::<Vec<Turn>>())
    });
    let Some(share) = shares.into_iter().find(|share| (BACKWARDS[0]..BACKWARDS[1]).contains(share)) else {
        return Vec::new();
    };
    let what = format!("the robot turns {:.2} times as far as the counts say, the other way", -share);
    let dead = runs::is_dead_reckoning(robot);
    let (column, remedy) = match (dead, ways_alone) {
        (true, _) => {
            ("odom_theta", "change the sign of odom_theta, or of the camera's headings, whichever grows clockwise")
        }
        (_, true) => (
            "enc_1",
            "of two wheels enc_1 and enc_2 are swapped: the first [[wheel]] of `racbot init --track-mm` is the right one; \
             or the camera's y points down",
        ),
        (_, false) if robot.wheel_count() == 2 => (
            "enc_1",
            "enc_1 and enc_2 are swapped: the first [[wheel]] of `racbot init --track-mm` is the right one; or headings \
             grow clockwise",
        ),
        _ => ("cam_theta", "headings grow clockwise, or wheels are swapped: see the order of [[wheel]]"),
    };
    vec![Mistake { nameable: !dead, ..Mistake::new("turns-reversed", column, what, remedy.to_owned()) }]
}

/// Turns between frames that are at least `stretch_s` s apart; none where nothing counts the wheels.
fn of(robot: &Robot, geometry: &Geometry, log: &Log, stretch_s: f64) -> Vec<Turn> {
    let Some(wheels) = Wheels::of(robot, log) else { return Vec::new() };
    let ways_alone = log.layout().source.positions_only;
    let mut frames = Vec::new();
    for frame in log.camera() {
        if frames.last().is_none_or(|last: &&runs::Seen| frame.t - last.t >= stretch_s) {
            frames.push(frame);
        }
    }
    let twist = |from: f64, to: f64| wheels.turned(from, to).map(|turned| geometry.twist(&turned));
    if !ways_alone {
        let turn = |pair: &[&runs::Seen]| {
            let by_counts = twist(pair[0].t, pair[1].t).filter(|_| pair[1].t - pair[0].t < 2.0 * stretch_s)?;
            let seen = wrap_angle(pair[1].pose.theta - pair[0].pose.theta);
            Some((seen, [by_counts.omega, by_counts.vx, by_counts.vy]))
        };
        return frames.windows(2).filter_map(turn).collect();
    }
    let rim = geometry.wheels().iter().map(|w| w.x_m.hypot(w.y_m)).fold(0.0, f64::max);
    // Where a way goes, backwards where the wheels go backwards.
    let heading = |a: &runs::Seen, b: &runs::Seen| {
        let ahead = twist(a.t, b.t)?.vy;
        let [dx, dy] = [b.pose.x - a.pose.x, b.pose.y - a.pose.y];
        (dx.hypot(dy) > DIRECTION * rim && ahead.abs() > DIRECTION * rim)
            .then(|| f64::atan2(ahead.signum() * dy, ahead.signum() * dx))
    };
    let turn = |three: &[&runs::Seen]| {
        let [a, b, c] = three else { return None };
        let middles = [0.5 * (a.t + b.t), 0.5 * (b.t + c.t)];
        let by_counts = twist(middles[0], middles[1]).filter(|_| c.t - a.t < 4.0 * stretch_s)?;
        Some((wrap_angle(heading(b, c)? - heading(a, b)?), [by_counts.omega, by_counts.vx, by_counts.vy]))
    };
    frames.windows(3).filter_map(turn).collect()
}

/// The camera's turn per turn by the counts, beside what ways make of it; `None` where they explain too little.
fn per_turn(turns: &[Turn]) -> Option<f64> {
    if turns.len() < FEWEST {
        return None;
    }
    let (mut information, mut score, mut square) = (Matrix3::zeros(), Vector3::zeros(), 0.0);
    for (seen, row) in turns {
        let row = Vector3::from(*row);
        information += row * row.transpose();
        score += row * *seen;
        square += seen * seen;
    }
    let unit = information.diagonal().map(|x| x.sqrt().max(1e-300));
    let inverse = (information.component_div(&(unit * unit.transpose())) + Matrix3::identity() * 1e-9).try_inverse()?;
    let scaled = score.component_div(&unit);
    let all = inverse * scaled;
    let own = 1.0 / inverse[(0, 0)];
    let closes = all[0] * all[0] * own;
    let left = square - all.dot(&scaled);
    (own > EXPLAINED && closes > EXPLAINED * (closes + left)).then(|| all[0] / unit[0])
}
