//! `rotor-inertia`: rotors with another inertia than stated.

use model::robot::Robot;
use model::robot::Support;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};

/// Rotors with another inertia than stated.
pub(super) struct RotorInertia;

impl Effect for RotorInertia {
    fn name(&self) -> &str {
        "rotor-inertia"
    }

    fn equation(&self) -> &str {
        "rotor inertia times (1 + scale)"
    }

    fn reference(&self) -> &str {
        "motor data sheet"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        vec![Form::whole(vec![Parameter::new(
            "scale",
            0.1,
            [-0.9, 50.0],
            if robot.support == Support::Blocks { 0.06 } else { 1.0 },
        )])]
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        model.axes.iter_mut().for_each(|a| a.rotor_inertia *= 1.0 + values.get("scale"));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("a step of duty with the wheels lifted", 2.0))
    }
}
