//! `torque-constant`: motors stronger or weaker than the data sheet says.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};

/// Motors stronger or weaker than the data sheet says.
pub(super) struct TorqueConstant;

impl Effect for TorqueConstant {
    fn name(&self) -> &str {
        "torque-constant"
    }

    fn equation(&self) -> &str {
        "torque and back-EMF constant times (1 + scale), of every motor or of one"
    }

    fn reference(&self) -> &str {
        "motor data sheet"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        // A constant in other units, or of a motor like it, is some times too large: for 1 / 2 pi of it, and its interval.
        Form::all_or_one(robot, "scale", |name| Parameter::new(name, 0.02, [-0.9, 1.0], 0.05))
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        for (i, a) in model.axes.iter_mut().enumerate() {
            let s = 1.0 + values.wheel("scale", i, "");
            a.torque_constant *= s;
            a.back_emf *= s;
        }
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("measure the no-load speed of a lifted wheel at full duty", 2.0))
    }
}
