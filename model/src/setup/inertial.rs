//! Units, signs and axes of an inertial sensor: its turns beside those of the wheels, and gravity.

use std::f64::consts::PI;

use super::samples::Wheels;
use super::{Mistake, OTHER_SENSE_KIND, near, short};
use crate::plant::GRAVITY;
use runs::robot::Robot;
use runs::{Columns, Log};

/// Length of a stretch, s: long against the delay of a sensor.
const STRETCH_S: f64 = 0.15;
/// Stretches of a log at most.
const MOST: usize = 4000;
/// Turn by the wheels, rad, in all logs together, from which there is something to compare.
const ENOUGH_RAD: f64 = 1.0;
/// Share of an axis' squares that must follow from the wheels before anything is said of it.
const FOLLOWS: f64 = 0.8;
/// Stretches that gravity is taken from: starts and stops make out nothing of their median.
const FEWEST: usize = 10;
/// Share of gravity that the axis along it has at least.
const UPRIGHT: f64 = 0.9;

const GYRO: [&str; 3] = ["gyro_x", "gyro_y", "gyro_z"];
const ACCELERATION: [&str; 3] = ["acc_x", "acc_y", "acc_z"];

/// What wheels and sensor did in a stretch.
struct Stretch {
    /// Turn by the wheels, rad.
    turn: f64,
    /// Mean of each axis, as logged; NaN where one has no sample.
    gyro: [f64; 3],
    acceleration: [f64; 3],
}

pub(super) fn mistakes(robot: &Robot, logs: &[Log], before: &[Mistake]) -> Vec<Mistake> {
    let stretches: Vec<Stretch> = logs.iter().flat_map(|log| stretches(robot, log)).collect();
    let mut found: Vec<Mistake> = Vec::new();
    // Where the wheels are wrong, the sensor is not to blame.
    if !before.iter().any(|m| ["encoder-order", OTHER_SENSE_KIND, "robot-file"].contains(&m.kind)) {
        found.extend(turns(&stretches));
    }
    found.extend(gravity(&stretches));
    found
}

fn stretches(robot: &Robot, log: &Log) -> Vec<Stretch> {
    let layout = log.layout();
    if layout.gyro.is_none() && layout.acceleration.is_none() {
        return Vec::new();
    }
    let (Some(wheels), Ok(geometry)) = (Wheels::of(robot, log), robot.geometry()) else { return Vec::new() };
    let run = log.part(0..log.len().min(200_000), Columns { sensors: true, ..Columns::NONE });
    let mut out = Vec::new();
    let mut first = 0;
    while first < run.len() && out.len() < MOST {
        let next = first + run.t[first..].partition_point(|t| *t < run.t[first] + STRETCH_S);
        let mean = |axes: &Option<[Vec<f64>; 3]>| {
            let Some(axes) = axes else { return [f64::NAN; 3] };
            [0, 1, 2].map(|i| {
                let there = axes[i][first..next].iter().filter(|x| x.is_finite());
                let (sum, n) = there.fold((0.0, 0.0), |(sum, n), x| (sum + x, n + 1.0));
                sum / n
            })
        };
        if next < run.len()
            && let Some(turned) = wheels.turned(run.t[first], run.t[next])
        {
            let lasted = run.t[next] - run.t[first];
            out.push(Stretch {
                turn: geometry.twist(&turned).omega,
                gyro: mean(&run.gyro).map(|rate| rate * lasted),
                acceleration: mean(&run.acceleration),
            });
        }
        first = next.max(first + 1);
    }
    out
}

/// Slope of an axis over the wheels' turn, beside a bias, and the share of its squares that follows.
fn follows(stretches: &[Stretch], axis: usize) -> Option<(f64, f64)> {
    let there: Vec<&Stretch> = stretches.iter().filter(|s| s.gyro[axis].is_finite()).collect();
    let n = there.len() as f64;
    if there.iter().map(|s| s.turn.abs()).sum::<f64>() < ENOUGH_RAD {
        return None;
    }
    let mean = |of: &dyn Fn(&Stretch) -> f64| there.iter().map(|s| of(s)).sum::<f64>() / n;
    let (turn, gyro) = (mean(&|s| s.turn), mean(&|s| s.gyro[axis]));
    let product = |a: &dyn Fn(&Stretch) -> f64, b: &dyn Fn(&Stretch) -> f64| mean(&|s| a(s) * b(s));
    let (wheel, own) = (|s: &Stretch| s.turn - turn, |s: &Stretch| s.gyro[axis] - gyro);
    let (ww, wg, gg) = (product(&wheel, &wheel), product(&wheel, &own), product(&own, &own));
    (ww > 0.0 && gg > 0.0).then(|| (wg / ww, wg * wg / (ww * gg)))
}

/// Factors by which a rate is logged in another unit, and what to multiply by.
const UNITS: [(f64, &str, &str); 3] = [
    (180.0 / PI, "degrees per second", "0.0174533"),
    (180e3 / PI, "thousandths of a degree per second", "0.0000174533"),
    (PI / 180.0, "radians turned into radians twice", "57.29578"),
];

fn turns(stretches: &[Stretch]) -> Vec<Mistake> {
    let axes: Vec<Option<(f64, f64)>> = (0..3).map(|axis| follows(stretches, axis)).collect();
    let best = (0..3).filter_map(|axis| Some((axis, axes[axis]?))).filter(|(_, (_, share))| *share > FOLLOWS);
    // A little of a turn is in every axis: the one with the most is it.
    let Some((axis, (slope, _))) = best.max_by(|a, b| a.1.0.abs().total_cmp(&b.1.0.abs())) else { return Vec::new() };
    let column = GYRO[axis];
    let mut found = Vec::new();
    if axis != 2 {
        let sign = if slope < 0.0 { "-" } else { "" };
        let what = format!("it follows the robot's turn ({} of the wheels'), which is about z", short(slope));
        let from = ["x", "y", "z"][axis];
        let remedy = format!(
            "write this column as gyro_z{}, or where the card reads the sensor, [imu] axes with \"{sign}{from}\" in the \
             third place",
            if slope < 0.0 { " with its sign changed" } else { "" }
        );
        found.push(Mistake::new("gyro-axes", column, what, remedy));
    } else if slope < 0.0 {
        let what = format!("it is {} times the turn by the wheels: it grows clockwise", short(slope));
        let remedy = "change its sign: turns are counter-clockwise, seen from above; a sensor that lies upside down has \
                      axes such as [\"y\", \"x\", \"-z\"] in [imu]";
        found.push(Mistake::new("gyro-sign", column, what, remedy.to_owned()));
    }
    if let Some((_, unit, factor)) = UNITS.iter().find(|(ratio, ..)| near(slope.abs(), *ratio)) {
        let what = format!("it is {} times the turn by the wheels: {unit}", short(slope.abs()));
        let remedy = format!("write rad/s (times {factor}), or name the unit to `racbot convert`");
        found.push(Mistake::new("gyro-unit", column, what, remedy));
    }
    found
}

fn gravity(stretches: &[Stretch]) -> Vec<Mistake> {
    let whole = stretches.iter().filter(|s| s.acceleration.iter().all(|x| x.is_finite()));
    let whole: Vec<&Stretch> = whole.collect();
    if whole.len() < FEWEST {
        return Vec::new();
    }
    let mean = [0, 1, 2].map(|i| {
        let mut axis: Vec<f64> = whole.iter().map(|s| s.acceleration[i]).collect();
        let middle = axis.len() / 2;
        *axis.select_nth_unstable_by(middle, f64::total_cmp).1
    });
    let norm = mean.iter().map(|x| x * x).sum::<f64>().sqrt();
    let mut found = Vec::new();
    let Some(axis) = (0..3).find(|i| mean[*i].abs() > UPRIGHT * norm) else { return found };
    let column = ACCELERATION[axis];
    // Without gravity, as some drivers log it, there is nothing to tell.
    let units = [(1.0, "g", "9.80665"), (1000.0, "thousandths of g", "0.00980665")];
    let unit = units.iter().find(|(of, ..)| near(norm, *of));
    if let Some((_, unit, factor)) = unit {
        let what = format!("it is {} most of the time, where gravity is 9.81 m/s²: {unit}", short(mean[axis]));
        let remedy =
            format!("write m/s² (acc_x, acc_y and acc_z times {factor}), or name the unit to `racbot convert`");
        found.push(Mistake::new("acc-unit", column, what, remedy));
    }
    if unit.is_none() && !near(norm, GRAVITY) {
        return found;
    }
    if axis != 2 {
        let what = format!("gravity is along it ({} of {})", short(mean[axis]), short(norm));
        let remedy = "swap the columns so that acc_z points up, or mend [imu] axes where the card reads the sensor";
        found.push(Mistake::new("acc-axes", column, what, remedy.to_owned()));
    } else if mean[2] < 0.0 {
        let what = format!("it is {} most of the time: the force that holds the robot points up", short(mean[2]));
        let remedy =
            "change the signs of all three, or, if the sensor lies upside down, those of acc_z and of one other";
        found.push(Mistake::new("acc-sign", column, what, remedy.to_owned()));
    }
    found
}
