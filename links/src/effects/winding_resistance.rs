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
        "resistance of the circuit times (1 + scale), of every motor or of one"
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

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        // Material is what weakens a stalled motor as much as a material torque constant.
        Form::all_or_one(robot, "scale", |name| Parameter::new(name, 0.02, [-0.9, 3.0], 0.05))
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        for (i, a) in model.axes.iter_mut().enumerate() {
            a.resistance *= 1.0 + values.wheel("scale", i, "");
        }
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("block a wheel and measure voltage and current at the bridge", 5.0))
    }
}
