//! `rotor-inertia`: rotors with another inertia than stated.

use runs::robot::Robot;

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
        // Material is what changes the inertia a wheel feels by as much as a material mass does.
        let model = DriveModel::new(robot);
        let own = robot.gear_ratio.powi(2) * robot.motor.rotor_inertia;
        let material = 0.06 * model.felt_inertia() / own.max(f64::MIN_POSITIVE);
        vec![Form::whole(vec![Parameter::new("scale", (0.2 * material).max(0.02), [-0.9, 200.0], material)])]
    }

    fn is_inertia(&self) -> bool {
        true
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        model.axes.iter_mut().for_each(|a| a.rotor_inertia *= 1.0 + values.get("scale"));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("a step of duty with the wheels lifted", 2.0))
    }
}
