//! `dead-band`: a bridge that does nothing at small duties.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};

/// A bridge that does nothing at small duties.
pub(super) struct DeadBand;

impl Effect for DeadBand {
    fn name(&self) -> &str {
        "dead-band"
    }

    fn equation(&self) -> &str {
        "duty u becomes u - duty sign(u), 0 for |u| below duty"
    }

    fn reference(&self) -> &str {
        "dead time of H-bridges"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        vec![Form::whole(vec![Parameter::new("duty", 0.01, [-0.02, 0.5], 0.03)])]
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let band = values.get("duty");
        model.duty_maps.push(Box::new(move |_, u| {
            if band >= 0.0 { u.signum() * (u.abs() - band).max(0.0) } else { u - band * (u / 0.02).tanh() }
        }));
    }

    fn law_uncertainty(&self) -> f64 {
        // Windings smooth what the bridge swallows while the duty dithers.
        0.03
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("a duty staircase with the wheels lifted", 2.0))
    }
}
