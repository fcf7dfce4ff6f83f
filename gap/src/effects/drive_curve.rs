//! `drive-curve`: a bridge whose mean voltage is not in proportion to the duty.

use model::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};

/// A bridge whose mean voltage is not in proportion to the duty.
pub(super) struct DriveCurve;

impl Effect for DriveCurve {
    fn name(&self) -> &str {
        "drive-curve"
    }

    fn equation(&self) -> &str {
        "duty u becomes u + cubic (u^3 - u): right at 0 and full duty, off between"
    }

    fn reference(&self) -> &str {
        "H-bridge decay modes"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        vec![Form::whole(vec![Parameter::new("cubic", 0.05, [-1.0, 1.0], 0.15)])]
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let c = values.get("cubic");
        model.duty_maps.push(Box::new(move |_, u| u + c * (u * u * u - u)));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("a duty staircase with the wheels lifted", 2.0))
    }
}
