//! `gyro-scale`: a gyroscope that reads too much or too little.

use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

/// Scale that matters: three standard deviations of what parts of a type differ by (0.5 %, ICM-42688-P).
const MATERIAL: f64 = 0.015;

/// A gyroscope that reads too much or too little.
pub(super) struct GyroScale;

impl Effect for GyroScale {
    fn name(&self) -> &str {
        "gyro-scale"
    }

    fn equation(&self) -> &str {
        "gyroscope reads (1 + scale) times the rate of turn"
    }

    fn reference(&self) -> &str {
        "IEEE 952, scale factor error"
    }

    fn link(&self) -> Link {
        Link::Gyroscope
    }

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        vec![Form::whole(vec![Parameter::new("scale", 0.01, [-0.3, 0.3], MATERIAL)])]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        model.sensor.gyro_scale += values.get("scale");
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("turn the robot by hand ten times against a line on the floor and add up gyro_z", 2.0))
    }
}
