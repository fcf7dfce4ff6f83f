//! What the loop knows of a tick, in the units of a run, and the `robot.toml` beside it.

use crate::{Scale, Settings, Snapshot};
use fixed_kin::AXES;
use fixed_kin::control::SetPointMode;
use fixed_kin::format::{Format, Speed};
use fixed_kin::recording::{RecordedWords, SetPointWords};
use model::imu::Reading;
use runs::Tick;
use runs::frames::{Pose, Twist, wrap_angle};
use runs::robot::Robot;

/// Decimals of a logged number: finer than any LSB of the card, so that words survive the log.
const DECIMALS: f64 = 1e9;
/// Decimals of a camera pose: the noise is a thousand times larger.
const CAMERA_DECIMALS: f64 = 1e6;

fn rounded(value: f64, decimals: f64) -> f64 {
    (value * decimals).round() / decimals
}

/// A tick on its way to the file; plain data without a heap.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// Time, s.
    pub t: f64,
    /// Commanded body twist as the card got it: m/s, m/s, rad/s.
    pub command: [f64; 3],
    /// Wheel speed set points, rad/s.
    pub reference: [f64; AXES],
    /// Cumulative counts.
    pub counts: [i64; AXES],
    /// −1 to 1, of full drive.
    pub duty: [f64; AXES],
    /// Measured wheel speeds, rad/s.
    pub measured: [f64; AXES],
    /// Supply, V; NaN where nobody measures it.
    pub supply_v: f64,
    /// Camera pose that came at this tick.
    pub camera: Option<Pose>,
    /// What the inertial sensor said, bias included.
    pub imu: Option<Reading>,
}

impl Sample {
    /// A tick as the card saw it, rounded for the log.
    #[must_use]
    pub fn of(t: f64, command: Twist, seen: &Snapshot, counts: [i64; AXES], scale: &Scale, supply_v: f64) -> Self {
        // What the card got, to the last bit.
        let command = scale.twist(scale.twist_words(command));
        Self {
            t: rounded(t, DECIMALS),
            command: [command.vx, command.vy, command.omega].map(|v| rounded(v, DECIMALS)),
            reference: seen.references.map(|word| rounded(scale.speed(word), DECIMALS)),
            counts,
            duty: seen.duties.map(|word| rounded(f64::from(word), DECIMALS)),
            measured: seen.speeds.map(|word| rounded(scale.speed(word), DECIMALS)),
            supply_v,
            camera: None,
            imu: None,
        }
    }

    /// With what the camera delivered.
    #[must_use]
    pub fn with_camera(mut self, seen: Option<Pose>) -> Self {
        self.camera = seen.map(|pose| {
            let [x, y, theta] = [pose.x, pose.y, wrap_angle(pose.theta)].map(|v| rounded(v, CAMERA_DECIMALS));
            Pose::new(x, y, theta)
        });
        self
    }

    /// With what the inertial sensor said.
    #[must_use]
    pub fn with_imu(mut self, felt: Option<&Reading>) -> Self {
        self.imu = felt.map(|reading| Reading {
            gyro: reading.gyro.map(|v| rounded(v, DECIMALS)),
            acceleration: reading.acceleration.map(|v| rounded(v, DECIMALS)),
            temperature_c: rounded(reading.temperature_c, CAMERA_DECIMALS),
            ..*reading
        });
        self
    }

    /// As a tick of a run with so many wheels; `counts` is the space it needs.
    pub(super) fn tick<'a>(&'a self, wheels: usize, counts: &'a mut [Option<i64>; AXES]) -> Tick<'a> {
        *counts = self.counts.map(Some);
        Tick {
            t: self.t,
            command: self.command,
            reference: &self.reference[..wheels],
            counts: &counts[..wheels],
            duty: &self.duty[..wheels],
            measured: &self.measured[..wheels],
            supply_v: self.supply_v,
            camera: self.camera,
            gyro: self.imu.map_or([f64::NAN; 3], |imu| imu.gyro),
            acceleration: self.imu.map_or([f64::NAN; 3], |imu| imu.acceleration),
            imu_temp: self.imu.map_or(f64::NAN, |imu| imu.temperature_c),
            ..Tick::default()
        }
    }
}

/// The robot as the log's `robot.toml` describes it: what the controller believes, and the words in
/// which the card computed.
#[must_use]
pub fn logged_robot(believed: &Robot, scale: &Scale, settings: &Settings) -> Robot {
    let configuration = scale.configuration();
    let set_points =
        SetPointWords { inverse: configuration.inverse, exponents: scale.exponents(), slew: configuration.slew[0] };
    let words = RecordedWords {
        gains: configuration.gains[0],
        tick_period: scale.tick_period,
        speed_mode: settings.speed_mode,
        set_points: (settings.set_point_mode == SetPointMode::Twist).then_some(set_points),
    };
    let mut robot = believed.clone();
    // As it was, not as it was asked for: an integrator adds up a difference of a millionth.
    robot.control_rate_hz = 1.0 / scale.tick_s();
    robot.pi.arithmetic = Some("fixed-kin".to_owned());
    robot.pi.registers.clear();
    words.each(|name, word| robot.pi.registers.push((name.to_owned(), word)));
    robot.duty_quantum = Some(Format::DUTY.lsb());
    robot.ref_quantum = Some(scale.speed(Speed::from_bits(1)));
    robot
}
