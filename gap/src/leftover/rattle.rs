//! Rotors that rattle in the play of their gears.
//!
//! A loop that is stiff enough for a robot drives a rotor alone from flank to flank at hundreds of hertz. Newton's law
//! for the robot says nothing of that, and taken for noise it would hide everything; but the encoder sits on the rotor,
//! and what it does beyond the robot's motion is the play, and what the wheel shakes along.

use std::sync::Arc;

use runs::is_from_speeds;
use runs::robot::Robot;

use crate::thresholds::Thresholds;
use estimation::statistics::median;
use links::drive::{AxisModel, DriveModel};
use links::segment::Segment;

/// Counts by which second differences of a steady wheel may differ from 0, twice.
const QUANTISATION: f64 = 4.0;
/// Width of the steps that are one, in the least: one of ten counts is rounded to ten or eleven.
const STEP_WIDTH: f64 = 1.15;
/// Share of all steps that are the least one, from which that is what the encoder counts.
const STEPS: f64 = 0.1;
/// Ticks longer than this, s, do not show what happens at hundreds of hertz.
const LONGEST_TICK_S: f64 = 0.004;
/// Ticks about a tick over which rattling is told from single knocks.
const NEAR: usize = 15;
/// Share of the places of a rotor between its flanks that are looked at, the same on either side.
const MIDDLE: f64 = 0.9;
/// Length of the mean that is the robot's motion, s.
const SMOOTHING_S: f64 = 0.03;

/// An encoder beside the robot's motion.
#[derive(Debug, Clone, Copy)]
struct Place {
    /// rad at the wheel.
    angle: f32,
    /// Of the wheel, rad/s, without its sign.
    speed: f32,
}

/// Whether places are as much larger as the wheel is faster: counts that were read at other times than their rows, or
/// again in the next row, are off by what the wheel turned meanwhile. Play is as wide at any speed.
fn grows_with_speed(places: &mut [Place]) -> bool {
    places.sort_by(|a, b| a.speed.total_cmp(&b.speed));
    let (slow, fast) = places.split_at(places.len() / 2);
    let usual = |half: &[Place], of: &dyn Fn(&Place) -> f32| {
        let mut all: Vec<f64> = half.iter().map(|p| f64::from(of(p))).collect();
        median(&mut all)
    };
    let grows = |of: &dyn Fn(&Place) -> f32| usual(fast, of) / usual(slow, of).max(f64::MIN_POSITIVE);
    // In the middle, in ratios, between no growth and the speed's.
    let (size, speed) = (grows(&|p| p.angle.abs()), grows(&|p| p.speed));
    !slow.is_empty() && size * size > speed && size > 1.0
}

/// What rotors shake by: wheel (from 0), rad at the motor shaft.
pub(crate) fn rattle(
    segments: impl Iterator<Item = Arc<Segment>>,
    robot: &Robot,
    model: &DriveModel,
    thresholds: &Thresholds,
) -> Vec<(usize, f64)> {
    // Speeds do not tell what a count is, and what a firmware makes of counts is its own.
    if is_from_speeds(robot) {
        return Vec::new();
    }
    let count = 1.0 / robot.counts_per_wheel_rad();
    let Some(mechanics) = model.mechanics() else { return Vec::new() };
    let response = (0..robot.wheel_count())
        .map(|i| mechanics.response.row(i).iter().map(|x| x.abs()).sum::<f64>())
        .fold(0.0, f64::max);
    let [beyond, share, often] = thresholds.rattles;
    let stall = |a: &AxisModel| model.gear_ratio * a.torque_constant * robot.supply_v / a.resistance;
    let most = beyond * model.axes.iter().map(stall).fold(0.0, f64::max) * response;
    let n = robot.wheel_count();
    let (mut all, mut ticks) = (vec![Vec::new(); n], 0);
    for s in segments.filter(|s| s.angle.len() == n && s.t.len() > 4 * NEAR) {
        ticks += s.t.len();
        for (wheel, places) in all.iter_mut().enumerate() {
            places.extend(between_flanks(&s, wheel, count, most, share));
        }
    }
    let mut found = Vec::new();
    for (wheel, places) in all.iter_mut().enumerate() {
        if (places.len() as f64) < often * ticks as f64 || places.is_empty() || grows_with_speed(places) {
            continue;
        }
        places.sort_by(|a, b| a.angle.total_cmp(&b.angle));
        let at = |share: f64| f64::from(places[((places.len() - 1) as f64 * share) as usize].angle);
        let play = (at(0.5 + 0.5 * MIDDLE) - at(0.5 - 0.5 * MIDDLE)) * model.gear_ratio;
        if play >= thresholds.shakes {
            found.push((wheel, play));
        }
    }
    found
}

/// The step in which an angle was logged, rad, if it shows: of angles in radians nobody may know what the encoder counts, and
/// its map has a finer number.
fn step_of(angle: &[f64]) -> f64 {
    let mut steps: Vec<f64> = angle.windows(2).map(|a| (a[1] - a[0]).abs()).filter(|step| *step > 0.0).collect();
    steps.sort_by(f64::total_cmp);
    let Some(least) = steps.get(steps.len() / 100).map(|least| least * STEP_WIDTH) else { return 0.0 };
    let same = steps.partition_point(|step| *step <= least);
    if same as f64 >= STEPS * steps.len() as f64 { least } else { 0.0 }
}

/// Where the encoder is beside the robot's motion while it rattles.
fn between_flanks(s: &Segment, wheel: usize, count: f64, most: f64, share: f64) -> Vec<Place> {
    let angle = &s.angle[wheel];
    let count = count.max(step_of(angle));
    let n = angle.len();
    let tick = (s.t[n - 1] - s.t[0]) / (n - 1) as f64;
    if tick > LONGEST_TICK_S {
        return Vec::new();
    }
    // Stamps that differ from row to row may be as wrong as that: what a turning wheel then seems to do is theirs.
    let apart: Vec<f64> = s.t.windows(2).map(|t| t[1] - t[0]).collect();
    let uneven = apart.windows(2).map(|h| (h[1] - h[0]).abs()).sum::<f64>() / (n - 2) as f64;
    let is_beyond = |k: usize| {
        let (h, g) = (apart[k - 1], apart[k]);
        let (before, after) = ((angle[k] - angle[k - 1]) / h, (angle[k + 1] - angle[k]) / g);
        let speed = (angle[k + 1] - angle[k - 1]).abs() / (h + g);
        let shorter = h.min(g);
        let by_stamps = speed * uneven.max((g - h).abs()) / shorter;
        (after - before).abs() > QUANTISATION * count / shorter + 0.5 * most * (h + g) + by_stamps
    };
    let beyond: Vec<bool> = (0..n).map(|k| k > 0 && k + 1 < n && is_beyond(k)).collect();
    let half = ((0.5 * SMOOTHING_S / tick).round() as usize).max(4);
    let window: Vec<f64> = (0..=2 * half)
        .map(|j| (std::f64::consts::PI * (j as f64 + 1.0) / (2 * half + 2) as f64).sin().powi(2))
        .collect();
    let total: f64 = window.iter().sum();
    let edge = half.max(NEAR);
    let mut near = beyond[..(2 * edge).min(n)].iter().filter(|b| **b).count();
    (edge..n.saturating_sub(edge))
        .filter_map(|k| {
            if k > edge {
                near += usize::from(beyond[k + edge - 1]);
                near -= usize::from(beyond[k - edge - 1]);
            }
            (near as f64 > share * 2.0 * edge as f64).then(|| {
                let mean: f64 = window.iter().zip(&angle[k - half..]).map(|(w, a)| w * a).sum::<f64>() / total;
                let speed = (angle[k + half] - angle[k - half]) / (s.t[k + half] - s.t[k - half]);
                Place { angle: (angle[k] - mean) as f32, speed: speed.abs() as f32 }
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rattle(segment: Segment, robot: &Robot, model: &DriveModel) -> Vec<(usize, f64)> {
        super::rattle(std::iter::once(Arc::new(segment)), robot, model, &Thresholds::default())
    }

    /// A wheel that speeds up, its encoder moved by `jitter` of the tick, in counts.
    fn segment(robot: &Robot, jitter: impl Fn(usize) -> f64) -> Segment {
        let n = 2000;
        let t: Vec<f64> = (0..n).map(|k| 1e-3 * k as f64).collect();
        let scale = robot.counts_per_wheel_rad();
        let angle = |k: usize| ((10.0 * t[k] * t[k] * scale + jitter(k)).floor()) / scale;
        let wheel: Vec<f64> = (0..n).map(angle).collect();
        Segment { angle: vec![wheel; robot.wheel_count()], t, ..Segment::default() }
    }

    #[test]
    fn stamps_that_jitter_are_no_play() {
        let robot = Robot::racbot();
        let model = DriveModel::new(&robot);
        let scale = robot.counts_per_wheel_rad();
        // Rows every 2 ms, each stamped as much as a millisecond late by a bus, and every fifth 8 ms after the last.
        let mut state = 1_u32;
        let mut random = move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1_u32 << 24)
        };
        let (mut t, mut angle, mut now) = (Vec::new(), Vec::new(), 0.0);
        for k in 0..2000 {
            now += if k % 5 == 0 { 8e-3 } else { 2e-3 };
            t.push(now + 1e-3 * random());
            angle.push((40.0 * now * scale).floor() / scale);
        }
        let turning = Segment { angle: vec![angle; robot.wheel_count()], t, ..Segment::default() };
        assert!(rattle(turning, &robot, &model).is_empty());
    }

    #[test]
    fn counts_read_at_other_times_than_their_rows_are_no_play() {
        let robot = Robot::racbot();
        let model = DriveModel::new(&robot);
        let scale = robot.counts_per_wheel_rad();
        let random =
            |k: usize| f64::from((k as u32).wrapping_mul(2_654_435_769).wrapping_mul(1 + k as u32) >> 8) / 16_777_216.0;
        // Up to a tick early or late, at 20 rad/s² from rest; the same as of the mean speed is a rotor that rattles.
        let turned = |k: usize| 20.0 * 1e-3 * k as f64 * 1e-3;
        let late = segment(&robot, |k| scale * turned(k) * (2.0 * random(k) - 1.0));
        assert!(rattle(late, &robot, &model).is_empty());
        let rattling = segment(&robot, |k| scale * turned(1000) * (2.0 * random(k) - 1.0));
        assert_eq!(rattle(rattling, &robot, &model).len(), robot.wheel_count());
    }

    /// A shaft that swings through less than a count a tick, of whose encoder the file has ten times as many counts.
    #[test]
    fn a_coarser_encoder_than_the_file_has_is_no_play() {
        let robot = Robot::racbot();
        let model = DriveModel::new(&robot);
        let step = 40.0 / robot.counts_per_wheel_rad();
        let t: Vec<f64> = (0..4000).map(|k| 1e-3 * f64::from(k)).collect();
        let angle: Vec<f64> = t.iter().map(|t| (4.0 * (3.0 * t).sin() / step).round() * step).collect();
        let turning = Segment { angle: vec![angle; robot.wheel_count()], t, ..Segment::default() };
        assert!(rattle(turning, &robot, &model).is_empty());
    }

    #[test]
    fn the_play_a_rotor_rattles_in_is_measured() {
        let robot = Robot::racbot();
        let model = DriveModel::new(&robot);
        let play = 0.1;
        let width = play / robot.gear_ratio * robot.counts_per_wheel_rad();
        let bouncing = segment(&robot, |k| width * ((k as f64 / 3.7).fract() - 0.5));
        let found = rattle(bouncing, &robot, &model);
        assert_eq!(found.len(), robot.wheel_count());
        for (_, found) in found {
            assert!((found / play - 1.0).abs() < 0.15, "{found}");
        }
        let knocks = segment(&robot, |k| if k % 200 == 0 { width } else { 0.0 });
        assert!(rattle(knocks, &robot, &model).is_empty());
        assert!(rattle(segment(&robot, |_| 0.0), &robot, &model).is_empty());
    }
}
