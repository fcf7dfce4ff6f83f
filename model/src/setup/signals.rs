//! Speeds of the wheels in short spans of a log, and what was asked of them there.

use runs::robot::Robot;
use runs::{Columns, Log, Run};

use super::samples::Wheels;

/// Length over which a speed is taken, s.
const SPAN_S: f64 = 0.05;

/// Speeds and what was asked for at the same time.
pub(super) struct Signals {
    /// Name of the log.
    pub(super) log: String,
    /// Distance of two samples, s.
    pub(super) span_s: f64,
    /// Wheel speeds, rad/s by robot.toml, `[wheel][sample]`.
    pub(super) speed: Vec<Vec<f64>>,
    /// Accelerations, rad/s².
    pub(super) acceleration: Vec<Vec<f64>>,
    pub(super) reference: Vec<Vec<f64>>,
    pub(super) duty: Vec<Vec<f64>>,
    /// Motor currents, A, if they were logged.
    pub(super) current: Vec<Vec<f64>>,
    pub(super) command: Vec<[f64; 3]>,
    pub(super) supply: Vec<f64>,
    /// Supply at each sample, V: the file's where none was logged.
    pub(super) volts: Vec<f64>,
}

pub(super) fn signals(robot: &Robot, log: &Log) -> Option<Signals> {
    signals_late(robot, log, 0)
}

/// The same with the duties, and the volts that they are a share of, so many rows before what was measured.
pub(super) fn signals_late(robot: &Robot, log: &Log, rows: usize) -> Option<Signals> {
    let wheels = Wheels::of(robot, log)?;
    let columns = Columns { command: true, reference: true, duty: true, supply: true, sensors: true, ..Columns::NONE };
    let run: Run = log.part(0..log.len().min(200_000), columns);
    let n = robot.wheel_count();
    let span = SPAN_S.max(2.0 * log.tick_s()?);
    let mut out = Signals {
        log: log.name.to_string(),
        span_s: span,
        speed: vec![Vec::new(); n],
        acceleration: vec![Vec::new(); n],
        reference: vec![Vec::new(); if run.reference.len() == n { n } else { 0 }],
        duty: vec![Vec::new(); if run.duty.len() == n { n } else { 0 }],
        current: vec![Vec::new(); if run.current.len() == n { n } else { 0 }],
        command: Vec::new(),
        volts: Vec::new(),
        supply: run.supply_v.iter().flatten().copied().filter(|v| v.is_finite()).collect(),
    };
    let (first, last) = (*wheels.t.first()?, *wheels.t.last()?);
    let held = |column: &[f64], from: usize, to: usize| {
        let values: Vec<f64> = column[from..=to].iter().copied().filter(|v| v.is_finite()).collect();
        values.iter().sum::<f64>() / values.len() as f64
    };
    let number = ((last - first) / span).floor().min(4000.0) as usize;
    for k in 1..number.saturating_sub(1) {
        let t = first + k as f64 * span;
        let row = |t: f64| run.t.partition_point(|x| *x <= t).saturating_sub(1).min(run.len() - 1);
        let (a, b) = (row(t - 0.5 * span), row(t + 0.5 * span));
        let [set_a, set_b] = [a, b].map(|row| row.saturating_sub(rows));
        let (Some(back), Some(here), Some(ahead)) = (
            wheels.turned(t - 1.0 * span, t),
            wheels.turned(t - 0.5 * span, t + 0.5 * span),
            wheels.turned(t, t + span),
        ) else {
            continue;
        };
        for i in 0..n {
            out.speed[i].push(here[i] / span);
            out.acceleration[i].push((ahead[i] - back[i]) / (span * span));
        }
        for (slot, column) in out.reference.iter_mut().zip(&run.reference) {
            slot.push(held(column, a, b));
        }
        for (slot, column) in out.duty.iter_mut().zip(&run.duty) {
            slot.push(held(column, set_a, set_b));
        }
        for (slot, column) in out.current.iter_mut().zip(&run.current) {
            slot.push(held(column, a, b));
        }
        out.volts.push(run.supply_v.as_ref().map_or(robot.supply_v, |supply| held(supply, set_a, set_b)));
        if let Some(command) = &run.command {
            out.command.push([0, 1, 2].map(|j| held(&command[j], a, b)));
        }
    }
    Some(out)
}
