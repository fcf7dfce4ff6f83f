//! `gear-efficiency`: a gear that loses another share of the torque than stated.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};

/// A gear that loses another share of the torque than stated.
pub(super) struct GearEfficiency;

impl Effect for GearEfficiency {
    fn name(&self) -> &str {
        "gear-efficiency"
    }

    fn equation(&self) -> &str {
        "share of the torque lost becomes (1 - efficiency) - scale"
    }

    fn reference(&self) -> &str {
        "gear data sheet"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        let _ = robot;
        vec![Form::whole(vec![Parameter::new("scale", 0.02, [-0.6, 0.3], 0.06)])]
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        model.axes.iter_mut().for_each(|a| a.gear_loss -= values.get("scale"));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("measure input and output torque of a gear", 20.0))
    }
}
