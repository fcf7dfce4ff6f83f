//! Columns of counts and speeds that hold something else: a clock, an angle, a state.

use runs::robot::{Robot, Support};
use runs::{CountSource, Log};

use super::samples::Wheels;
use super::{Mistake, short};

/// Speed of a rim that no wheel on a floor has, m/s: that of sound.
const SOUND: f64 = 340.0;
/// Share of the rows that may be faster, as single rows that were read wrong.
const FEW: f64 = 0.01;
/// Counts a second of a clock, with its unit.
const CLOCKS: [(f64, &str); 3] = [(1e3, "milliseconds"), (1e6, "microseconds"), (1e9, "nanoseconds")];
/// By how much of the log, and of the counts, two clocks part at most: drives begin and end, or go at a speed of their own.
const SAME: f64 = 0.005;

pub(super) fn mistakes(robot: &Robot, logs: &[Log]) -> Vec<Mistake> {
    let counted = |log: &&Log| log.layout().source.counts == CountSource::Encoders;
    let all: Vec<(bool, Wheels)> =
        logs.iter().filter_map(|log| Some((counted(&log), Wheels::of(robot, log)?))).collect();
    let each = |wheel: usize| clock(robot, &all, wheel).or_else(|| too_fast(robot, &all, wheel));
    (0..robot.wheel_count()).filter_map(each).collect()
}

/// Counts that are the time, in every log.
fn clock(robot: &Robot, all: &[(bool, Wheels)], wheel: usize) -> Option<Mistake> {
    let is = |unit: f64| {
        all.iter().all(|(counted, wheels)| {
            let (t, angle) = (&wheels.t, &wheels.angle[wheel]);
            let (last, per_rad) = (t.len() - 1, robot.counts_per_wheel_rad());
            let whole = t[last] - t[0];
            let off = |k: usize| ((angle[k] - angle[0]) * per_rad / unit - (t[k] - t[0])).abs();
            *counted && (0..=last).all(|k| off(k) <= SAME * whole)
        })
    };
    let (_, unit) = CLOCKS.into_iter().find(|(unit, _)| !all.is_empty() && is(*unit))?;
    let column = format!("enc_{}", wheel + 1);
    let what = format!("it is a clock in {unit}, the same as t, and no counts");
    let remedy = "give the column of the encoder, or leave it out".to_owned();
    Some(Mistake::new("counts-are-time", &column, what, remedy))
}

/// Speeds that no wheel has.
fn too_fast(robot: &Robot, all: &[(bool, Wheels)], wheel: usize) -> Option<Mistake> {
    if robot.support != Support::Floor || runs::is_dead_reckoning(robot) || !robot.lacks(&["wheel_radius_m"]).is_empty()
    {
        return None;
    }
    let speeds = |wheels: &Wheels| -> Vec<f64> {
        let steps = wheels.t.windows(2).zip(wheels.angle[wheel].windows(2));
        steps.map(|(t, a)| ((a[1] - a[0]) / (t[1] - t[0])).abs()).collect()
    };
    let mut speeds: Vec<f64> = all.iter().flat_map(|(_, wheels)| speeds(wheels)).collect();
    speeds.sort_by(f64::total_cmp);
    let fast = *speeds.get((speeds.len() as f64 * (1.0 - FEW)) as usize)?;
    let rim = fast * robot.wheel_radius_m;
    if rim < SOUND {
        return None;
    }
    let counted = all.iter().any(|(counted, _)| *counted);
    let column = format!("{}_{}", if counted { "enc" } else { "speed" }, wheel + 1);
    let what = format!("the wheel turns at {} rad/s, its rim at {} m/s: faster than sound", short(fast), short(rim));
    let remedy = "it is an angle, a state or a raw reading and no speed, or in another unit: give the column that it is in, with \
                  its unit"
        .to_owned();
    Some(Mistake::new("too-fast", &column, what, remedy))
}
