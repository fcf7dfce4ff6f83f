//! A 6-axis inertial sensor as a simulated sensor: what its registers say of how the robot moves.

mod chassis;
mod deviations;

pub use chassis::Chassis;
pub use deviations::ImuDeviations;

use std::collections::VecDeque;

use nalgebra::{Rotation3, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::plant::GRAVITY;

/// Largest register value; the sensor saturates there.
const FULL_SCALE: f64 = 32_768.0;
/// Temperature at which biases and scales are given, °C.
const REFERENCE_C: f64 = 25.0;

/// One of the two triads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triad {
    /// Largest value, rad/s or m/s².
    pub range: f64,
    /// Standard deviation of an axis' constant bias, rad/s or m/s².
    pub bias: f64,
    /// Standard deviation that the bias gains in a second, rad/s/√s or m/s²/√s.
    pub bias_walk: f64,
    /// Standard deviation of an axis' relative error of scale.
    pub scale: f64,
    /// Noise density, rad/s/√Hz or m/s²/√Hz, one-sided.
    pub noise_density: f64,
    /// Bias per °C, standard deviation over parts.
    pub bias_per_c: f64,
    /// Standard deviation of the angles between the chip's axes and the body's, rad: soldering and mounting.
    pub misalignment: f64,
    /// Amplitude of vibration per wheel speed (1/s or m/s² per rad/s), at the frequency rollers pass.
    pub vibration: f64,
}

/// A type of sensor, mounted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImuModel {
    /// Errors of the three rates of turn.
    pub gyro: Triad,
    /// Specific force on three axes, m/s².
    pub accelerometer: Triad,
    /// Readings a second.
    pub rate_hz: f64,
    /// Place of the chip in the body frame (right, forward, up), m.
    pub place: [f64; 3],
    /// Rollers on a wheel.
    pub rollers: f64,
    /// Temperature at start and after long, °C, and the time constant between, s.
    pub temperature: [f64; 3],
}

impl ImuModel {
    /// The ICM-42688-P (TDK data sheet DS-000347, typical values) at ±2000 °/s and ±16 g, read at `rate_hz`.
    ///
    /// Bias walk, misalignment and vibration are not in the sheet: the walk is of the order of such parts' in-run
    /// stability, 0.5° of mounting, and vibration is assumed.
    pub fn icm_42688_p(rate_hz: f64) -> Self {
        let degree = std::f64::consts::PI / 180.0;
        Self {
            gyro: Triad {
                range: 2000.0 * degree,
                bias: 0.5 * degree,
                bias_walk: 0.002 * degree,
                scale: 0.005,
                noise_density: 0.0028 * degree,
                bias_per_c: 0.005 * degree,
                misalignment: 0.5 * degree,
                vibration: 0.000_2,
            },
            accelerometer: Triad {
                range: 16.0 * GRAVITY,
                bias: 0.02 * GRAVITY,
                bias_walk: 0.000_02 * GRAVITY,
                scale: 0.005,
                noise_density: 70e-6 * GRAVITY,
                bias_per_c: 0.000_15 * GRAVITY,
                misalignment: 0.5 * degree,
                vibration: 0.01,
            },
            rate_hz,
            place: [0.0; 3],
            rollers: 15.0,
            temperature: [24.0, 38.0, 120.0],
        }
    }
}

/// What the chassis does at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// Angular velocity in the body frame, rad/s.
    pub omega: [f64; 3],
    /// Angular acceleration in the body frame, rad/s².
    pub omega_rate: [f64; 3],
    /// Acceleration of the chassis centre in the body frame, m/s².
    pub acceleration: [f64; 3],
    /// Gravity along the body's right and forward axes, m/s²: 0 on a level floor.
    pub downhill: [f64; 2],
    /// Mean of the wheels' absolute speeds, rad/s.
    pub wheel_speed: f64,
}

impl Motion {
    /// The motion a share of the way to another one.
    fn towards(&self, other: &Self, share: f64) -> Self {
        let mix = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| a[i] + share * (b[i] - a[i]));
        Self {
            omega: mix(self.omega, other.omega),
            omega_rate: mix(self.omega_rate, other.omega_rate),
            acceleration: mix(self.acceleration, other.acceleration),
            downhill: [0, 1].map(|i| self.downhill[i] + share * (other.downhill[i] - self.downhill[i])),
            wheel_speed: self.wheel_speed + share * (other.wheel_speed - self.wheel_speed),
        }
    }
}

/// A reading in SI units, as the driver makes them of registers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reading {
    /// rad/s.
    pub gyro: [f64; 3],
    /// Specific force: 9.81 upwards at rest, m/s².
    pub acceleration: [f64; 3],
    /// Of the chip, °C; biases drift with it.
    pub temperature_c: f64,
    /// Whether an axis is at its limit.
    pub saturated: bool,
}

/// A seeded sensor.
#[derive(Debug, Clone)]
pub struct Imu {
    model: ImuModel,
    rng: ChaCha8Rng,
    gyro: Part,
    accelerometer: Part,
    time: f64,
    phase: f64,
    deviations: ImuDeviations,
    /// What the chassis did in the last periods, newest first, as far back as readings are late.
    felt: VecDeque<Motion>,
}

#[derive(Debug, Clone)]
struct Part {
    triad: Triad,
    bias: Vector3<f64>,
    drift: Vector3<f64>,
    scale: Vector3<f64>,
    turned: Rotation3<f64>,
}

impl Imu {
    /// A part drawn from the type's tolerances; the same seed and motion give the same readings.
    pub fn new(model: ImuModel, seed: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let gyro = Part::new(model.gyro, &mut rng);
        let accelerometer = Part::new(model.accelerometer, &mut rng);
        let deviations = ImuDeviations::default();
        Self { model, rng, gyro, accelerometer, time: 0.0, phase: 0.0, deviations, felt: VecDeque::new() }
    }

    /// The same part with what a robot's file says of it.
    #[must_use]
    pub fn with_deviations(mut self, deviations: &ImuDeviations) -> Self {
        let turned = Rotation3::from_scaled_axis(Vector3::from(deviations.turned_rad)).inverse();
        for part in [&mut self.gyro, &mut self.accelerometer] {
            part.turned *= turned;
        }
        self.gyro.bias += Vector3::from(deviations.gyro_bias);
        self.gyro.scale = self.gyro.scale.map(|s| (1.0 + s) * (1.0 + deviations.gyro_scale) - 1.0);
        self.model.place.iter_mut().zip(deviations.moved_m).for_each(|(place, by)| *place += by);
        self.deviations = *deviations;
        self
    }

    /// The same part with noise of its own.
    #[must_use]
    pub fn with_noise(mut self, seed: u64) -> Self {
        self.rng = ChaCha8Rng::seed_from_u64(seed);
        self
    }

    /// The truth of the gyroscope, its deviations and tolerances together: relative scales, biases at the temperature of
    /// reference (rad/s), and its turn on the body, a rotation vector (rad).
    pub fn gyro_errors(&self) -> [[f64; 3]; 3] {
        let Part { scale, bias, turned, .. } = &self.gyro;
        [(*scale).into(), (*bias).into(), turned.inverse().scaled_axis().into()]
    }

    /// The turn of the accelerometer on the body, a rotation vector, rad, tolerance included.
    pub fn accelerometer_turn(&self) -> [f64; 3] {
        self.accelerometer.turned.inverse().scaled_axis().into()
    }

    /// What the chassis did when what is read now was measured.
    fn delayed(&mut self, motion: &Motion) -> Motion {
        let age = (self.deviations.latency_s * self.model.rate_hz).max(0.0);
        self.felt.push_front(*motion);
        self.felt.truncate(age as usize + 2);
        let at = |k: usize| self.felt.get(k).or(self.felt.back()).copied().unwrap_or(*motion);
        at(age as usize).towards(&at(age as usize + 1), age.fract())
    }

    /// The next reading, one period after the last.
    pub fn read(&mut self, motion: &Motion) -> Reading {
        let motion = &self.delayed(motion);
        let dt = 1.0 / self.model.rate_hz;
        self.time += dt;
        self.phase += motion.wheel_speed * self.model.rollers * dt;
        let [cold, warm, after] = self.model.temperature;
        let celsius = warm + (cold - warm) * (-self.time / after).exp();
        let (omega, rate) = (Vector3::from(motion.omega), Vector3::from(motion.omega_rate));
        let place = Vector3::from(self.model.place);
        let there = Vector3::from(motion.acceleration) + rate.cross(&place) + omega.cross(&omega.cross(&place));
        let [right, forward] = motion.downhill;
        let force = there - Vector3::new(right, forward, -GRAVITY);
        let shake = motion.wheel_speed * self.phase.sin();
        let (gyro, a) = self.gyro.read(omega, shake, celsius, dt, &mut self.rng);
        let (acceleration, b) = self.accelerometer.read(force, shake, celsius, dt, &mut self.rng);
        Reading { gyro, acceleration, temperature_c: (celsius * 132.48).round() / 132.48, saturated: a || b }
    }
}

impl Part {
    fn new(triad: Triad, rng: &mut ChaCha8Rng) -> Self {
        let mut drawn = |sd: f64| Vector3::from_fn(|_, _| sd * normal(rng));
        Self {
            triad,
            bias: drawn(triad.bias),
            drift: drawn(triad.bias_per_c),
            scale: drawn(triad.scale),
            turned: Rotation3::from_scaled_axis(drawn(triad.misalignment)),
        }
    }

    fn read(
        &mut self,
        truth: Vector3<f64>,
        shake: f64,
        celsius: f64,
        dt: f64,
        rng: &mut ChaCha8Rng,
    ) -> ([f64; 3], bool) {
        let triad = self.triad;
        self.bias += Vector3::from_fn(|_, _| triad.bias_walk * dt.sqrt() * normal(rng));
        // White noise of this density, averaged over a period.
        let noise = triad.noise_density * (0.5 / dt).sqrt();
        let seen = self.turned * truth;
        let lsb = triad.range / FULL_SCALE;
        let mut saturated = false;
        let values = std::array::from_fn(|i| {
            let bias = self.bias[i] + self.drift[i] * (celsius - REFERENCE_C);
            let value = seen[i] * (1.0 + self.scale[i]) + bias + triad.vibration * shake + noise * normal(rng);
            let word = (value / lsb).round();
            saturated |= !(-FULL_SCALE..FULL_SCALE).contains(&word);
            word.clamp(-FULL_SCALE, FULL_SCALE - 1.0) * lsb
        });
        (values, saturated)
    }
}

fn normal(rng: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(rng)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn readings(motion: Motion, seconds: f64, seed: u64) -> Vec<Reading> {
        let mut imu = Imu::new(ImuModel::icm_42688_p(1000.0), seed);
        (0..(seconds * 1000.0) as usize).map(|_| imu.read(&motion)).collect()
    }

    #[test]
    fn at_rest_it_feels_gravity_its_bias_and_its_noise() {
        let readings = readings(Motion::default(), 4.0, 3);
        let n = readings.len() as f64;
        let mean = readings.iter().map(|r| r.gyro[2]).sum::<f64>() / n;
        let sd = (readings.iter().map(|r| (r.gyro[2] - mean).powi(2)).sum::<f64>() / n).sqrt();
        // 2.8 m°/s/√Hz over 500 Hz, beside steps of 61 m°/s: 0.063 and 0.018 °/s.
        assert!((0.05..0.08).contains(&sd.to_degrees()), "{}", sd.to_degrees());
        assert!(mean.abs().to_degrees() < 2.0);
        let up = readings.iter().map(|r| r.acceleration[2]).sum::<f64>() / n;
        assert!((up - GRAVITY).abs() < 0.08 * GRAVITY, "{up}");
    }

    #[test]
    fn a_turn_beyond_the_range_saturates_and_says_so() {
        let fast = readings(Motion { omega: [0.0, 0.0, 40.0], ..Motion::default() }, 0.01, 1);
        assert!(fast.iter().all(|r| r.saturated && (r.gyro[2] - 2000.0_f64.to_radians()).abs() < 0.01));
        let slow = readings(Motion { omega: [0.0, 0.0, 20.0], ..Motion::default() }, 0.01, 1);
        assert!(slow.iter().all(|r| !r.saturated && (r.gyro[2] - 20.0).abs() < 0.4));
    }

    #[test]
    fn away_from_the_centre_a_turn_is_felt_outwards() {
        let model = ImuModel { place: [0.05, 0.0, 0.0], ..ImuModel::icm_42688_p(1000.0) };
        let mut imu = Imu::new(model, 4);
        let rest = imu.read(&Motion::default()).acceleration[0];
        let turning = imu.read(&Motion { omega: [0.0, 0.0, 10.0], ..Motion::default() }).acceleration[0];
        assert!((turning - rest + 5.0).abs() < 0.3, "{}", turning - rest);
    }
}
