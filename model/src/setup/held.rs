//! Speeds that no motor has: set points in the column of what was measured, as headers that were shifted by one give them.

use runs::robot::Robot;
use runs::{Columns, Log, is_from_speeds};

use super::Mistake;
use super::samples::MOST_TICKS;

/// Rows from which anything is said.
const FEWEST: usize = 200;
/// Share of the rows in which such a speed changes at most, and in which the duty of its wheel changes at least: where a bridge
/// is told something else that often, a speed that is measured moves with it, however coarse.
const CHANGES: [f64; 2] = [0.01, 0.25];
/// Share of the rows in which it is not 0 at least: a wheel that rests is one that stands still.
const TURNS: f64 = 0.5;

/// Rows, and those in which the speed of a wheel changes, its duty does, and it turns.
#[derive(Default)]
struct Rows {
    all: usize,
    speed: usize,
    duty: usize,
    turns: usize,
}

pub(super) fn mistakes(robot: &Robot, logs: &[Log]) -> Vec<Mistake> {
    if !is_from_speeds(robot) {
        return Vec::new();
    }
    let mut wheels: Vec<Rows> = (0..robot.wheel_count()).map(|_| Rows::default()).collect();
    for log in logs {
        let columns = Columns { duty: true, sensors: true, ..Columns::NONE };
        let run = log.part(0..log.len().min(MOST_TICKS), columns);
        for ((rows, speed), duty) in wheels.iter_mut().zip(&run.speed).zip(&run.duty) {
            let both = |k: &usize| speed[*k].is_finite() && duty[*k].is_finite();
            let sampled: Vec<usize> = (0..speed.len().min(duty.len())).filter(both).collect();
            let changes = |of: &[f64]| sampled.windows(2).filter(|k| of[k[0]] != of[k[1]]).count();
            rows.all += sampled.len();
            rows.speed += changes(speed);
            rows.duty += changes(duty);
            rows.turns += sampled.iter().filter(|k| speed[**k] != 0.0).count();
        }
    }
    let told = |(i, rows): (usize, &Rows)| {
        let share = |n: usize| n as f64 / rows.all.max(1) as f64;
        let held = rows.speed > 0 && share(rows.speed) <= CHANGES[0] && share(rows.duty) >= CHANGES[1];
        if rows.all < FEWEST || !held || share(rows.turns) < TURNS {
            return None;
        }
        let column = format!("speed_{}", i + 1);
        let what = format!(
            "it changes in {} of {} rows and duty_{} in {}: no motor holds its speed like that, it looks like a set point",
            rows.speed,
            rows.all,
            i + 1,
            rows.duty
        );
        let remedy = format!("write it as ref_{}; what was measured may stand under another header", i + 1);
        Some(Mistake::new("speed-asked-for", &column, what, remedy))
    };
    wheels.iter().enumerate().filter_map(told).collect()
}
