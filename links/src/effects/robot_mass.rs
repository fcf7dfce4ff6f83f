//! `robot-mass`: a robot heavier or lighter than stated.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};

/// A robot heavier or lighter than stated.
pub(super) struct RobotMass;

impl Effect for RobotMass {
    fn name(&self) -> &str {
        "robot-mass"
    }

    fn equation(&self) -> &str {
        "mass times (1 + scale)"
    }

    fn reference(&self) -> &str {
        "-"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        vec![Form::whole(vec![Parameter::new("scale", 0.02, [-0.6, 2.0], 0.06)])]
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        model.mass *= 1.0 + values.get("scale");
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("put the robot on scales", 1.0))
    }
}
