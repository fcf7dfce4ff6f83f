//! `bridge-drop`: a bridge that takes some volts off against its current.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};

/// A bridge that takes some volts off against its current.
pub(super) struct BridgeDrop;

impl Effect for BridgeDrop {
    fn name(&self) -> &str {
        "bridge-drop"
    }

    fn equation(&self) -> &str {
        "the voltage u V - e that drives a winding loses drop_v of its size; below that no current flows"
    }

    fn reference(&self) -> &str {
        "saturation voltages of bipolar bridges (data sheet of the L298), dead time of fast ones"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn before_current(&self) -> bool {
        true
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        let supply = robot.supply_v;
        // As of a dead band, whose duties are shares of the supply.
        vec![Form::whole(vec![Parameter::new("drop_v", 0.01 * supply, [0.0, 0.5 * supply], 0.03 * supply)])]
    }

    fn may_be_little(&self, _form: &Form) -> bool {
        // Bridges of transistors that saturate drop volts, others next to nothing.
        false
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        model.bridge_drop_v = values.get("drop_v").max(0.0);
    }

    fn law_uncertainty(&self) -> f64 {
        // As of a dead band: windings smooth what is dropped while the duty dithers.
        0.03
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("measure the voltage at a motor that is held still, at half duty", 2.0))
    }
}
