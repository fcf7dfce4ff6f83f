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

#[cfg(test)]
mod tests {
    use super::super::{Imu, ImuModel, Motion, Reading};
    use crate::effects::Applied;
    use crate::plant::GRAVITY;
    use runs::robot::{Effect, EffectParameter, Robot};

    /// The last of ten readings of a part with an effect less those of the same part without.
    fn changed(name: &str, parameters: &[(&str, f64)], motion: impl Fn(usize) -> Motion) -> Reading {
        let parameter = |(n, value): &(&str, f64)| {
            ((*n).to_owned(), EffectParameter { value: *value, ..EffectParameter::default() })
        };
        let parameters = parameters.iter().map(parameter).collect();
        let effect = Effect { name: name.to_owned(), parameters, ..Effect::default() };
        let applied = Applied::of(&Robot { effects: vec![effect], ..Robot::racbot() });
        assert!(applied.unsupported.is_empty());
        let mut plain = Imu::new(ImuModel::icm_42688_p(1000.0), 7);
        let mut hidden = plain.clone().with_deviations(&applied.imu);
        let mut last = Reading::default();
        for k in 0..10 {
            let [a, b] = [&mut hidden, &mut plain].map(|imu| imu.read(&motion(k)));
            let less = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| a[i] - b[i]);
            last = Reading {
                gyro: less(a.gyro, b.gyro),
                acceleration: less(a.acceleration, b.acceleration),
                ..Reading::default()
            };
        }
        last
    }

    fn close(found: [f64; 3], expected: [f64; 3], within: f64) {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < within), "{found:?} {expected:?}");
    }

    fn turning(rate: f64) -> Motion {
        Motion { omega: [0.0, 0.0, rate], ..Motion::default() }
    }

    #[test]
    fn every_effect_of_the_sensor_does_what_its_equation_says() {
        close(changed("gyro-scale", &[("scale", 0.05)], |_| turning(4.0)).gyro, [0.0, 0.0, 0.2], 0.01);
        let bias = changed("gyro-bias", &[("x_rad_s", 0.1), ("z_rad_s", -0.2)], |_| turning(4.0));
        close(bias.gyro, [0.1, 0.0, -0.2], 0.003);
        // Three and a half periods late on a ramp of 1 rad/s a period.
        let late = changed("imu-latency", &[("latency_s", 0.003_5)], |k| turning(k as f64));
        close(late.gyro, [0.0, 0.0, -3.5], 0.05);
        // Turned about x, the chip's y axis has a part of the turn and loses gravity's.
        let turned = changed("imu-mount", &[("x_rad", 0.1)], |_| turning(4.0));
        let (sin, cos) = 0.1_f64.sin_cos();
        close(turned.gyro, [0.0, 4.0 * sin, 4.0 * (cos - 1.0)], 0.02);
        close(turned.acceleration, [0.0, GRAVITY * sin, GRAVITY * (cos - 1.0)], 0.05);
        let moved = changed("imu-mount", &[("x_m", 0.05), ("y_m", -0.02)], |_| turning(4.0));
        close(moved.acceleration, [-16.0 * 0.05, 16.0 * 0.02, 0.0], 0.03);
    }
}
