//! `wheel-skew`: wheels whose drive direction is turned clockwise by a small angle.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values, turn_wheels, wheel_name};
use crate::motion::MotionModel;

/// Wheels whose drive direction is turned clockwise by a small angle.
pub(super) struct WheelSkew;

impl Effect for WheelSkew {
    fn name(&self) -> &str {
        "wheel-skew"
    }

    fn equation(&self) -> &str {
        "drive direction of wheel i turned clockwise by alpha_i: w = M(alpha) v / r"
    }

    fn reference(&self) -> &str {
        "paper, section 3, equation (6)"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        vec![Form::each(robot, |i| {
            Parameter::new(wheel_name("skew", i, "rad"), 0.01, [-0.6, 0.6], 0.4_f64.to_radians())
        })]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        turn_wheels(&mut model.wheels, |i, w| w.drive_rad -= values.wheel("skew", i, "rad"));
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        turn_wheels(&mut model.wheels, |i, w| w.drive_rad -= values.wheel("skew", i, "rad"));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("measure the wheels' drive directions on the base plate with a square", 10.0))
    }
}
