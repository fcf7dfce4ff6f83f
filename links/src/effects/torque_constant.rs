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
        "torque and back-EMF constant times (1 + scale)"
    }

    fn reference(&self) -> &str {
        "motor data sheet"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        vec![Form::whole(vec![Parameter::new("scale", 0.02, [-0.6, 1.0], 0.05)])]
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let s = 1.0 + values.get("scale");
        for a in &mut model.axes {
            a.torque_constant *= s;
            a.back_emf *= s;
        }
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("measure the no-load speed of a lifted wheel at full duty", 2.0))
    }
}
