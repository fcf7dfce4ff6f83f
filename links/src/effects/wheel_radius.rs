//! `wheel-radius`: wheels of unequal radius.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values, wheel_name};
use crate::motion::MotionModel;

/// Wheels of unequal radius.
pub(super) struct WheelRadius;

impl Effect for WheelRadius {
    fn name(&self) -> &str {
        "wheel-radius"
    }

    fn equation(&self) -> &str {
        "radius of wheel i is r (1 + scale_i)"
    }

    fn reference(&self) -> &str {
        "Borenstein and Feng 1996, UMBmark"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        let p = |i| Parameter::new(wheel_name("scale", i, ""), 0.01, super::SIZES, 0.004);
        let mut forms = Form::alone(robot, p);
        forms.push(Form::each(robot, p));
        forms
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        for i in 0..model.wheels.len() {
            model.distance_scale[i] *= 1.0 + values.wheel("scale", i, "");
        }
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        for i in 0..model.wheels.len() {
            model.radius_scale[i] *= 1.0 + values.wheel("scale", i, "");
        }
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("measure the wheels with a calliper", 3.0))
    }
}
