//! What a model's wheels say that an inertial sensor on the body goes through.

use model::plant::GRAVITY;

use super::Sensor;
use crate::motion::{MotionModel, Path};
use crate::segment::{SMOOTHING_S, Segment, smooth_speeds};

/// Distance of the sums that an accelerometer needs, s: short against the smoothing of the wheels' speeds.
const SUMMED_S: f64 = 0.005;

/// Sums along a segment under one model, at every tick.
pub(super) struct Ride<'a> {
    segment: &'a Segment,
    /// Heading from the first tick, rad.
    heading: Vec<f64>,
    /// Speed and its sums at every so many ticks; empty where no accelerometer asks.
    moved: Vec<Moved>,
    every: usize,
}

/// Speed of the body and what turning adds to its acceleration, summed from the first tick.
#[derive(Debug, Clone, Copy, Default)]
struct Moved {
    velocity: [f64; 2],
    omega: f64,
    /// ∫ ω v, m/s.
    across: [f64; 2],
    /// ∫ ω², rad²/s.
    outwards: f64,
    /// ∫ gravity along the body's axes, m/s.
    fallen: [f64; 2],
}

impl<'a> Ride<'a> {
    pub(super) fn new(path: &Path, model: &MotionModel, segment: &'a Segment, forces: bool) -> Self {
        let columns = path.columns();
        let mut heading = Vec::with_capacity(segment.t.len());
        let mut sum = 0.0;
        heading.push(sum);
        for turned in path.turned().chunks_exact(columns.len()) {
            sum += turned.iter().zip(columns).map(|(x, c)| x * c[2]).sum::<f64>();
            heading.push(sum);
        }
        let tick = (segment.t[segment.t.len() - 1] - segment.t[0]) / (segment.t.len() - 1) as f64;
        let every = ((SUMMED_S / tick) as usize).max(1);
        let moved = if forces { Self::moved(path, model, segment, every) } else { Vec::new() };
        Self { segment, heading, moved, every }
    }

    fn moved(path: &Path, model: &MotionModel, segment: &Segment, every: usize) -> Vec<Moved> {
        let changed: Vec<Vec<f64>>;
        let speed = if !model.changes_angles() {
            &segment.speed
        } else {
            changed = smooth_speeds(&segment.t, path.angles(), SMOOTHING_S);
            &changed
        };
        let columns = path.columns();
        let slope = model.slope_rad.map(|slope| GRAVITY * slope);
        let mut pulled = [0.0; 2];
        let mut out: Vec<Moved> = Vec::with_capacity(segment.t.len() / every + 1);
        for k in (0..segment.t.len()).step_by(every) {
            let mut twist = [0.0; 3];
            for (column, speed) in columns.iter().zip(speed) {
                twist.iter_mut().zip(column).for_each(|(sum, c)| *sum += c * speed[k]);
            }
            let [x, y, omega] = twist;
            let before = out.last().copied().unwrap_or_default();
            let dt = if k > 0 { segment.t[k] - segment.t[k - every] } else { 0.0 };
            let mean = |a: f64, b: f64| 0.5 * dt * (a + b);
            let across = [0, 1].map(|i| before.across[i] + mean(omega * twist[i], before.omega * before.velocity[i]));
            let outwards = before.outwards + mean(omega * omega, before.omega * before.omega);
            let mut fallen = before.fallen;
            if slope != [0.0; 2] {
                let (s, c) = segment.heading[k].sin_cos();
                let now = [c * slope[0] + s * slope[1], c * slope[1] - s * slope[0]];
                fallen = [0, 1].map(|i| before.fallen[i] + mean(now[i], pulled[i]));
                pulled = now;
            }
            out.push(Moved { velocity: [x, y], omega, across, outwards, fallen });
        }
        out
    }

    /// What the axes of a sensor gain from tick `from` to tick `to` at their stamps: turns of the gyroscope, rad, and
    /// speeds of the accelerometer on a floor of the model's slope, m/s.
    pub(super) fn gained(&self, sensor: &Sensor, delay_s: f64, from: usize, to: usize) -> [f64; 6] {
        let t = &self.segment.t;
        let lasted = t[to] - t[from];
        let [from, to] = [from, to].map(|k| t[k] - delay_s);
        let turned = sensor.seen([0.0, 0.0, self.heading_at(to) - self.heading_at(from)]);
        let gyro = [0, 1, 2].map(|i| (1.0 + sensor.gyro_scale) * turned[i] + sensor.gyro_bias[i] * lasted);
        if self.moved.len() < 2 {
            return [gyro[0], gyro[1], gyro[2], 0.0, 0.0, 0.0];
        }
        let at = [from, to].map(|time| self.moved_place(time));
        let m = |get: fn(&Moved) -> f64| {
            let [a, b] = at.map(|(j, share)| {
                let [a, b] = [j, j + 1].map(|j| get(&self.moved[j]));
                a + share * (b - a)
            });
            b - a
        };
        let ([px, py], spun, outwards) = (sensor.place_m, m(|m| m.omega), m(|m| m.outwards));
        let x = m(|m| m.velocity[0] - m.across[1] - m.fallen[0]) - px * outwards - py * spun;
        let y = m(|m| m.velocity[1] + m.across[0] - m.fallen[1]) - py * outwards + px * spun;
        let force = sensor.seen([x, y, 0.0]);
        [gyro[0], gyro[1], gyro[2], force[0], force[1], force[2]]
    }

    fn heading_at(&self, time: f64) -> f64 {
        let t = &self.segment.t;
        let k = self.segment.tick_at(time);
        let share = ((time - t[k]) / (t[k + 1] - t[k])).clamp(0.0, 1.0);
        self.heading[k] + share * (self.heading[k + 1] - self.heading[k])
    }

    /// The sums round a time, and how far between them.
    fn moved_place(&self, time: f64) -> (usize, f64) {
        let t = &self.segment.t;
        let j = (self.segment.tick_at(time) / self.every).min(self.moved.len() - 2);
        let [a, b] = [j, j + 1].map(|j| t[j * self.every]);
        (j, ((time - a) / (b - a)).clamp(0.0, 1.0))
    }
}
