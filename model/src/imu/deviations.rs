//! What a robot's file says of its inertial sensor beyond type and mounting.

use runs::robot::Effect;

/// By what a sensor differs from an exact one that is mounted as the robot's file says, its tolerances apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImuDeviations {
    /// Relative error of the gyroscope's scale.
    pub gyro_scale: f64,
    /// Constant bias of the gyroscope's axes, rad/s.
    pub gyro_bias: [f64; 3],
    /// Age of what is read, s.
    pub latency_s: f64,
    /// Turn of the chip in the body frame, a rotation vector, rad.
    pub turned_rad: [f64; 3],
    /// Place of the chip beyond that in the robot's file (right, forward, up), m.
    pub moved_m: [f64; 3],
    /// Which of all parts of the type it is: seed of its tolerances.
    pub part: u64,
}

impl Default for ImuDeviations {
    fn default() -> Self {
        Self { gyro_scale: 0.0, gyro_bias: [0.0; 3], latency_s: 0.0, turned_rad: [0.0; 3], moved_m: [0.0; 3], part: 1 }
    }
}

impl ImuDeviations {
    /// Applies an effect if it is one of the sensor's.
    pub(crate) fn apply(&mut self, effect: &Effect) -> bool {
        let value = |name: &str| effect.value(name).unwrap_or(0.0);
        match effect.name.as_str() {
            "gyro-scale" => self.gyro_scale += value("scale"),
            "gyro-bias" => {
                let bias = ["x_rad_s", "y_rad_s", "z_rad_s"].map(value);
                self.gyro_bias.iter_mut().zip(bias).for_each(|(own, more)| *own += more);
            }
            "imu-latency" => self.latency_s += value("latency_s"),
            "imu-mount" => {
                let angles = ["x_rad", "y_rad", "z_rad"].map(value);
                self.turned_rad.iter_mut().zip(angles).for_each(|(own, more)| *own += more);
                let place = ["x_m", "y_m"].map(value);
                self.moved_m.iter_mut().zip(place).for_each(|(own, more)| *own += more);
            }
            _ => return false,
        }
        true
    }
}
