//! `floor-tilt`: a floor that is not level.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

/// A floor that is not level.
pub(super) struct FloorTilt;

impl Effect for FloorTilt {
    fn name(&self) -> &str {
        "floor-tilt"
    }

    fn equation(&self) -> &str {
        "force m g (x_rad, y_rad) in the world, downhill"
    }

    fn reference(&self) -> &str {
        "-"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn also(&self) -> Option<Link> {
        Some(Link::Accelerometer)
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        let _ = robot;
        vec![Form::whole(vec![
            Parameter::new("x_rad", 0.005, [-0.3, 0.3], 0.008),
            Parameter::new("y_rad", 0.005, [-0.3, 0.3], 0.008),
        ])]
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        model.slope_rad[0] += values.get("x_rad");
        model.slope_rad[1] += values.get("y_rad");
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        model.slope_rad[0] += values.get("x_rad");
        model.slope_rad[1] += values.get("y_rad");
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("lay a spirit level on the floor", 1.0))
    }
}
