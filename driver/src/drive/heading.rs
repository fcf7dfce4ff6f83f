//! The inertial sensor in the loop: its readings, its silence, and the heading's rate controlled on it.

use crate::imu::{FROZEN_READINGS, Imu, Repeats, Words};
use model::imu::Reading;
use runs::frames::Twist;

/// Integral gain of the heading's rate, 1/s: slower than the wheels' speed loop (some 30 ms) by a factor of three, so that
/// the two do not fight.
const INTEGRAL_PER_S: f64 = 10.0;
/// Largest correction, as a share of what is asked for, and beside it, rad/s: 10° of common skew and wheels that slip a
/// little; what is more is no matter of a rate.
const LIMIT_SHARE: f64 = 0.3;
const LIMIT: f64 = 0.5;
/// Readings that fail one after the other until the sensor is taken for gone.
const SILENT: usize = 20;

/// The sensor, tick by tick.
#[derive(Clone, Debug)]
pub(super) struct Feel {
    imu: Imu,
    repeats: Repeats,
    sequence: Option<u32>,
    silent: usize,
    reading: Option<Reading>,
    gone: Option<f64>,
    correction: f64,
}

impl Feel {
    pub(super) fn new(imu: Imu) -> Self {
        Self { imu, repeats: Repeats::default(), sequence: None, silent: 0, reading: None, gone: None, correction: 0.0 }
    }

    /// Words of a snapshot; the same tick may be seen twice.
    pub(super) fn see(&mut self, words: &Words, sequence: u32) {
        if self.sequence.replace(sequence) == Some(sequence) {
            return;
        }
        let equal = self.repeats.see(words);
        self.reading = self.imu.reading(words).filter(|_| equal < FROZEN_READINGS);
        self.silent = if self.reading.is_some() { 0 } else { self.silent + 1 };
    }

    /// What the sensor said at this tick, bias included; for the log.
    pub(super) fn reading(&self) -> Option<Reading> {
        self.reading
    }

    /// The same without the bias that was measured at rest.
    pub(super) fn corrected(&self) -> Option<Reading> {
        let bias = self.imu.bias();
        self.reading.map(|reading| Reading { gyro: [0, 1, 2].map(|i| reading.gyro[i] - bias[i]), ..reading })
    }

    /// Since when the sensor has been silent.
    pub(super) fn gone(&mut self, t: f64) -> Option<f64> {
        if self.silent < SILENT {
            self.gone = None;
        } else if self.gone.is_none() {
            self.gone = Some(t);
        }
        self.gone
    }

    /// The rate of turn to command, where `wanted` is asked for.
    pub(super) fn steer(&mut self, wanted: Option<Twist>, dt: f64) -> f64 {
        let asked = wanted.map_or(0.0, |twist| twist.omega);
        let felt = self.corrected().filter(|reading| !reading.saturated && self.imu.steers());
        let (Some(_), Some(reading)) = (wanted, felt) else {
            self.correction = 0.0;
            return asked;
        };
        let limit = LIMIT + LIMIT_SHARE * asked.abs();
        self.correction += INTEGRAL_PER_S * dt * (asked - reading.gyro[2]);
        self.correction = self.correction.clamp(-limit, limit);
        asked + self.correction
    }
}
