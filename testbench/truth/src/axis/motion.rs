//! An axis in motion: the bridge, the motor, dry friction that holds, the load.

use rand::RngExt;

use super::drives::Drive;
use super::{Axis, Logger};
use crate::noise::{Stream, stream};

/// What happened, row by row.
pub(super) struct Recording {
    /// s.
    pub(super) t: Vec<f64>,
    /// −1 to 1, as commanded from the row's time on.
    pub(super) duties: Vec<f64>,
    /// rad.
    pub(super) angles: Vec<f64>,
    /// At the bridge, V.
    pub(super) supplies: Vec<f64>,
}

/// Steps of the integration in a mechanical time constant.
const FINE: f64 = 60.0;
/// Gain of the speed loop, full duties per no-load speed, and its reset time in mechanical time constants.
const LOOP: [f64; 2] = [3.0, 0.7];

impl Axis {
    /// Voltage share that the bridge makes of a duty.
    fn bridge(&self, duty: f64) -> f64 {
        let kept = (duty.abs() - self.dead_band).max(0.0) * duty.signum();
        kept * (1.0 + self.curvature * (kept.abs() - 1.0))
    }

    /// Current of the motor (A) and the supply's voltage at the bridge.
    fn current(&self, share: f64, speed: f64) -> (f64, f64) {
        let braking = self.gear * self.constant * speed * (1.0 - self.coasting * (1.0 - share.abs()));
        // The bridge takes the motor's current from the source for its share of the time.
        let r = self.resistance_ohm;
        let supply =
            (self.supply_v + self.source_ohm * share * braking / r) / (1.0 + self.source_ohm * share * share / r);
        (((share * supply - braking) / r).clamp(-self.limit_a, self.limit_a), supply)
    }

    /// Angle and speed a step later, and the supply.
    fn step(&self, (angle, speed): (f64, f64), share: f64, h: f64) -> ((f64, f64), f64) {
        let (current, supply) = self.current(share, speed);
        let gravity = self.gravity[0] * angle.sin() + self.gravity[1] * angle.cos();
        let cogging = self.cogging[0] * (self.cogging[1] * self.gear * angle).sin();
        let pull = self.gear * self.constant * current + gravity + self.hanging + cogging
            - (self.viscous + self.quadratic * speed.abs()) * speed;
        let sense = if speed == 0.0 { pull } else { speed };
        let rest = self.stribeck[0] * (-(speed / self.stribeck[1]).powi(2)).exp();
        let dry = self.dry[usize::from(sense < 0.0)] + rest;
        let held = speed == 0.0 && pull.abs() <= dry;
        let next = if held { 0.0 } else { speed + h * (pull - dry * sense.signum()) / self.inertia() };
        // Friction stops what it would turn round.
        let next = if speed * next < 0.0 { 0.0 } else { next };
        ((angle + 0.5 * h * (speed + next), next), supply)
    }
}

/// Drives the axis.
pub(super) fn record(axis: &Axis, logger: &Logger, drive: &Drive, seed: u64, number: u32) -> Recording {
    let mut rng = stream(seed, Stream::Electronics(number));
    let rows = drive.wanted.len();
    let mut out = Recording { t: Vec::new(), duties: Vec::new(), angles: Vec::new(), supplies: Vec::new() };
    out.t.extend((0..=rows).map(|k| k as f64 * logger.row_s + logger.jitter_s * rng.random_range(-1.0..1.0)));
    let finest = axis.time_constant() / FINE;
    let mut state = (rng.random_range(-3.0..3.0), 0.0);
    let mut integral = 0.0;
    let quantum = std::f64::consts::TAU / logger.counts;
    // A speed loop sees counts, over as many rows as give it some.
    let span = 2 + (quantum / (0.01 * axis.no_load() * logger.row_s)).min(20.0) as usize;
    for k in 0..rows {
        out.angles.push(state.0);
        let duty = if drive.closed {
            let counted = |a: f64| (a / quantum).floor() * quantum;
            let before = k.saturating_sub(span);
            let passed = (out.t[k] - out.t[before]).max(logger.row_s);
            let error = (drive.wanted[k] * axis.no_load() - (counted(state.0) - counted(out.angles[before])) / passed)
                / axis.no_load();
            let reset = LOOP[1] * axis.time_constant();
            let asked = LOOP[0] * error + integral;
            if asked.abs() < 1.0 {
                integral += LOOP[0] * error * logger.row_s / reset;
            }
            asked.clamp(-1.0, 1.0)
        } else {
            drive.wanted[k]
        };
        let duty = logger.duty_steps.map_or(duty, |steps| (duty * steps).round() / steps);
        out.duties.push(duty);
        let mut supply = axis.supply_v;
        let mut t = out.t[k];
        let steps = ((out.t[k + 1] - t) / finest).ceil().max(8.0);
        let h = (out.t[k + 1] - t) / steps;
        for s in 0..steps as usize {
            // The duty that was commanded a latency ago.
            let since = t + 0.5 * h - axis.latency_s;
            let row = (0..=k).rev().find(|r| out.t[*r] <= since);
            let share = axis.bridge(row.map_or(0.0, |r| out.duties[r]));
            let (next, volts) = axis.step(state, share, h);
            if s == 0 {
                supply = volts;
            }
            (state, t) = (next, t + h);
        }
        out.supplies.push(supply);
    }
    out.t.truncate(rows);
    out
}
