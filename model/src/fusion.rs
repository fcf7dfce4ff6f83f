//! Odometry and the overhead camera together.

use std::collections::VecDeque;

use nalgebra::{Matrix3, Vector3};

use crate::measurement::Measurement;
use crate::odometry::{DEFAULT_WHEEL_VARIANCE, Estimate, Increment, Odometer};
use runs::frames::{Pose, Twist, wrap_angle};
use runs::geometry::Geometry;
use runs::robot::Robot;

/// How late a measurement that says when it was taken may come, s: a picture at 10 Hz that is read out, sent and matched
/// while the next ones wait takes 0.3 s. What is older is worth no more than the odometry since.
pub(crate) const MEMORY_S: f64 = 0.4;

/// What the filter is told about its sensors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FusionOptions {
    /// From exposure to delivery, s.
    pub latency_s: f64,
    /// Standard deviations of a camera pose (m, m, rad).
    pub camera_noise: [f64; 3],
    /// Variance of a wheel's angle per angle turned, rad²/rad.
    pub wheel_variance: f64,
    /// Largest normalised innovation squared that is believed. 16.27 is the 99.9 % quantile of χ²
    /// with three degrees of freedom: one good frame in a thousand is lost.
    pub gate: f64,
    /// After this many refused frames in a row the camera is right and the filter starts anew:
    /// somebody has carried the robot away.
    pub refusals_before_restart: u32,
}

impl FusionOptions {
    /// What a robot's file says, or the figures of the example data sets.
    pub fn of(robot: &Robot) -> Self {
        Self {
            latency_s: robot.camera_latency_s,
            camera_noise: robot.camera_noise.unwrap_or([0.0015, 0.0015, 0.5_f64.to_radians()]),
            wheel_variance: DEFAULT_WHEEL_VARIANCE,
            gate: 16.27,
            refusals_before_restart: 30,
        }
    }
}

impl FusionOptions {
    /// For a robot whose geometry is not calibrated: skew of some degrees is no random walk, but a
    /// filter that trusts odometry a hundred times less follows the camera nevertheless.
    #[must_use]
    pub fn uncalibrated(self) -> Self {
        Self { wheel_variance: 100.0 * self.wheel_variance, ..self }
    }
}

/// What became of a camera frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Correction {
    /// Believed; normalised innovation squared, χ² with three degrees of freedom if all is well.
    Accepted(f64),
    /// Outside the gate.
    Refused(f64),
    /// Taken as the new truth after too many refusals.
    Restarted,
    /// Exposed before the filter's memory, or not finite.
    Unusable,
}

/// One tick of the past.
#[derive(Debug, Clone, Copy)]
struct Past {
    t: f64,
    /// Estimate at `t`.
    estimate: Estimate,
    /// How the robot came here from the tick before.
    increment: Increment,
}

/// Extended Kalman filter on the pose (Jazwinski 1970): odometry predicts, the camera corrects.
///
/// A frame is worth its pose at the time of exposure. The filter goes back to that time in its
/// history, corrects there and repeats the odometry since: recalculation, the exact method for
/// delayed measurements in Larsen, Andersen, Ravn and Poulsen (CDC 1998). Outliers are gated by the
/// normalised innovation squared (Bar-Shalom, Li and Kirubarajan 2001, section 5.4), whose mean is
/// also the test of consistency. Lost frames need nothing: the covariance grows until the next one.
#[derive(Debug, Clone)]
pub struct Fusion {
    options: FusionOptions,
    odometer: Odometer,
    now: Estimate,
    history: VecDeque<Past>,
    refused: u32,
}

impl Fusion {
    /// A filter that starts from an estimate, at counts 0.
    pub fn new(geometry: &Geometry, counts_per_wheel_rad: f64, options: FusionOptions, start: Estimate) -> Self {
        let odometer = Odometer::new(geometry, counts_per_wheel_rad, options.wheel_variance);
        Self { options, odometer, now: start, history: VecDeque::new(), refused: 0 }
    }

    /// Takes these counts as where the robot stands.
    pub fn reset_counts(&mut self, counts: &[i64]) {
        self.odometer.reset(counts);
    }

    /// One control tick at time `t` (s, increasing), with the cumulative counts.
    pub fn predict(&mut self, t: f64, counts: &[i64]) {
        let increment = self.odometer.increment(counts);
        self.now = self.now.moved(&increment);
        self.history.push_back(Past { t, estimate: self.now, increment });
        let oldest = t - self.options.latency_s.max(MEMORY_S);
        // One tick before the exposure stays, so that there is something to interpolate from.
        while self.history.len() > 2 && self.history[1].t < oldest - 1e-9 {
            self.history.pop_front();
        }
    }

    /// A frame that was delivered at time `t`, after the prediction for that tick.
    pub fn correct(&mut self, t: f64, seen: impl Into<Measurement>) -> Correction {
        let seen = seen.into();
        let exposed = seen.taken.map_or(t - self.options.latency_s, |taken| taken.min(t));
        let first = self.history.front().map_or(f64::INFINITY, |p| p.t);
        let Some(alone) = seen.alone(self.options.camera_noise).filter(|_| exposed >= first - 1e-9) else {
            return Correction::Unusable;
        };
        // The last tick at or before the exposure, and the part of the next one that belongs before.
        let base = self.history.partition_point(|p| p.t <= exposed + 1e-9).max(1) - 1;
        let from = self.history[base];
        let share =
            self.history.get(base + 1).map_or(0.0, |next| ((exposed - from.t) / (next.t - from.t)).clamp(0.0, 1.0));
        let (before, after) = self.history.get(base + 1).map_or((None, None), |next| {
            (Some(part(&next.increment, share)), Some(part(&next.increment, 1.0 - share)))
        });
        let prior = before.map_or(from.estimate, |increment| from.estimate.moved(&increment));
        let (at, noise) = (alone.pose, alone.covariance);
        let innovation =
            Vector3::new(at.x - prior.pose.x, at.y - prior.pose.y, wrap_angle(at.theta - prior.pose.theta));
        let Some(inverse) = (prior.covariance + noise).try_inverse() else { return Correction::Unusable };
        let nis = (innovation.transpose() * inverse * innovation)[0];
        let restart = self.refused + 1 >= self.options.refusals_before_restart;
        let far = nis > self.options.gate && seen.prediction.is_none();
        let anew = seen.replaces || far && restart;
        if far && !anew {
            self.refused += 1;
            return Correction::Refused(nis);
        }
        let (posterior, verdict) = if anew {
            (alone, Correction::Restarted)
        } else {
            let gain = prior.covariance * inverse;
            let change = gain * innovation;
            let p = prior.pose;
            let pose = Pose::new(p.x + change.x, p.y + change.y, p.theta + change.z);
            // Joseph form: stays symmetric and positive.
            let keep = Matrix3::identity() - gain;
            let covariance = keep * prior.covariance * keep.transpose() + gain * noise * gain.transpose();
            (Estimate { pose, covariance }, Correction::Accepted(nis))
        };
        self.refused = 0;
        self.repeat_from(base, posterior, after);
        verdict
    }

    /// The odometry after a correction between tick `base` and the next.
    fn repeat_from(&mut self, base: usize, corrected: Estimate, rest: Option<Increment>) {
        // Ticks before the exposure keep what was known then; nobody asks for them again but the
        // next frame, which is later.
        let mut estimate = corrected;
        let mut rest = rest;
        for past in self.history.iter_mut().skip(base + 1) {
            estimate = estimate.moved(&rest.take().unwrap_or(past.increment));
            past.estimate = estimate;
        }
        if base + 1 >= self.history.len()
            && let Some(last) = self.history.back_mut()
        {
            last.estimate = estimate;
        }
        self.now = estimate;
    }

    /// Pose and covariance now.
    pub fn estimate(&self) -> Estimate {
        self.now
    }

    /// Pose now.
    pub fn pose(&self) -> Pose {
        self.now.pose
    }
}

/// A share of an increment: constant twist, noise in proportion.
fn part(increment: &Increment, share: f64) -> Increment {
    let m = increment.moved;
    Increment {
        moved: Twist::new(m.vx * share, m.vy * share, m.omega * share),
        covariance: increment.covariance * share,
    }
}

#[cfg(test)]
mod tests;
