//! `drive-curve`: a bridge whose mean voltage is not in proportion to the duty.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};

/// A bridge whose mean voltage is not in proportion to the duty.
pub(super) struct DriveCurve;

impl Effect for DriveCurve {
    fn name(&self) -> &str {
        "drive-curve"
    }

    fn equation(&self) -> &str {
        "duty u becomes u (1 + curvature (|u| - 1)): right at 0 and full duty, less between"
    }

    fn reference(&self) -> &str {
        "H-bridge decay modes"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn before_current(&self) -> bool {
        true
    }

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        vec![Form::whole(vec![Parameter::new("curvature", 0.05, [-1.0, 1.0], 0.12)])]
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let c = values.get("curvature");
        model.duty_maps.push(Box::new(move |_, u| u * (1.0 + c * (u.abs() - 1.0))));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("a duty staircase with the wheels lifted", 2.0))
    }
}
