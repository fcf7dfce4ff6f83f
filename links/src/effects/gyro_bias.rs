//! `gyro-bias`: a gyroscope that reads a turn at rest.

use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

/// Bias that matters, rad/s: three standard deviations of what parts of a type have (0.5 °/s, ICM-42688-P).
const MATERIAL_RAD_S: f64 = 0.026;

/// A gyroscope that reads a turn at rest.
pub(super) struct GyroBias;

impl Effect for GyroBias {
    fn name(&self) -> &str {
        "gyro-bias"
    }

    fn equation(&self) -> &str {
        "gyroscope reads (x_rad_s, y_rad_s, z_rad_s) more than the rates of turn"
    }

    fn reference(&self) -> &str {
        "IEEE 952, bias"
    }

    fn link(&self) -> Link {
        Link::Gyroscope
    }

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        let p = |name| Parameter::new(name, 0.01, [-1.0, 1.0], MATERIAL_RAD_S);
        vec![Form::whole(vec![p("z_rad_s")]), Form::whole(vec![p("x_rad_s"), p("y_rad_s"), p("z_rad_s")])]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        let bias = ["x_rad_s", "y_rad_s", "z_rad_s"].map(|name| values.get(name));
        model.sensor.gyro_bias.iter_mut().zip(bias).for_each(|(own, more)| *own += more);
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("let the robot stand for ten seconds and take the mean of gyro_x..z", 1.0))
    }
}
