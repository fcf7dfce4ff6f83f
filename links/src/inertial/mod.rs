//! The links to an inertial sensor: encoder angles to its gyroscope and accelerometer.
//!
//! Weak form: between nodes a twentieth of a second apart, the integral of each axis is compared with what the wheels say
//! of it, their turn for the gyroscope and their change of speed for the accelerometer. A bias that wanders slowly is a
//! nuisance of each window. The clusters join those of the camera, so that one regression weighs all that is seen of the
//! same wheels.

mod link;
mod ride;
mod signal;

use nalgebra::{Rotation3, Vector3};
use runs::Run;
use runs::robot::Robot;

pub use link::{Channel, Fit, InertialLink, NODES_S, overall};
pub use signal::Integral;

/// An inertial sensor on the body; effects change it.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensor {
    /// Relative error of the gyroscope's scale.
    pub gyro_scale: f64,
    /// Bias of the gyroscope's axes, rad/s.
    pub gyro_bias: [f64; 3],
    /// Age of a reading at its tick, s.
    pub latency_s: f64,
    /// Turn of the chip in the body frame, a rotation vector, rad.
    pub turned_rad: [f64; 3],
    /// Place of the chip (right, forward), m.
    pub place_m: [f64; 2],
}

impl Sensor {
    /// As the robot's file has it.
    pub fn of(robot: &Robot) -> Self {
        let place = robot.imu.map_or([0.0; 3], |imu| imu.place_m);
        Self {
            gyro_scale: 0.0,
            gyro_bias: [0.0; 3],
            latency_s: 0.0,
            turned_rad: [0.0; 3],
            place_m: [place[0], place[1]],
        }
    }

    /// A vector of the body in the chip's axes.
    fn seen(&self, body: [f64; 3]) -> [f64; 3] {
        if self.turned_rad == [0.0; 3] {
            return body;
        }
        let turn = Rotation3::from_scaled_axis(Vector3::from(self.turned_rad));
        turn.inverse_transform_vector(&Vector3::from(body)).into()
    }
}

/// A sensor's signals over a segment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Felt {
    /// Turn by each axis of the gyroscope, rad.
    pub gyro: [Option<Integral>; 3],
    /// Gain of speed by each axis of the accelerometer, m/s, gravity included.
    pub force: [Option<Integral>; 3],
}

impl Felt {
    /// The signals of a part of a log; `turn` is what the wheels turn the robot from tick to tick, rad. `None` without
    /// samples.
    pub(crate) fn of(part: &Run, turn: &[f64]) -> Option<Self> {
        let of = |axes: &Option<[Vec<f64>; 3]>| {
            axes.as_ref().map_or_else(Default::default, |axes| signal::integrate(&part.t, axes, turn))
        };
        let felt = Self { gyro: of(&part.gyro), force: of(&part.acceleration) };
        felt.gyro.iter().chain(&felt.force).any(Option::is_some).then_some(felt)
    }
}
