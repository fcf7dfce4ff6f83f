//! `yaw-inertia`: a robot with another moment of inertia than stated.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};

/// A robot with another moment of inertia than stated.
pub(super) struct YawInertia;

impl Effect for YawInertia {
    fn name(&self) -> &str {
        "yaw-inertia"
    }

    fn equation(&self) -> &str {
        "yaw inertia times (1 + scale)"
    }

    fn reference(&self) -> &str {
        "-"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        vec![Form::whole(vec![Parameter::new("scale", 0.05, [-0.8, 3.0], 0.15)])]
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        model.yaw_inertia *= 1.0 + values.get("scale");
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("swing the robot on two strings (bifilar pendulum)", 10.0))
    }
}
