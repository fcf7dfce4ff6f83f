//! `winding-resistance`: motors whose circuit has more or less resistance than the data sheet says.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};

/// Motors whose circuit has more or less resistance than the data sheet says: windings, brushes, cables, transistors.
pub(super) struct WindingResistance;

impl Effect for WindingResistance {
    fn name(&self) -> &str {
        "winding-resistance"
    }

    fn equation(&self) -> &str {
        "resistance of every motor's circuit times (1 + scale)"
    }

    fn reference(&self) -> &str {
        "motor data sheet"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn before_current(&self) -> bool {
        true
    }

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        // Material is what weakens a stalled motor as much as a material torque constant.
        vec![Form::whole(vec![Parameter::new("scale", 0.02, [-0.6, 3.0], 0.05)])]
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let s = 1.0 + values.get("scale");
        model.axes.iter_mut().for_each(|a| a.resistance *= s);
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("block a wheel and measure voltage and current at the bridge", 5.0))
    }
}
