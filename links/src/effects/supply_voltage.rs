//! `supply-voltage`: a supply that nobody logged and that is not what the file says, or falls while the robot drives.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values};

/// A supply that nobody logged and that is not what the file says, or falls while the robot drives.
pub(super) struct SupplyVoltage;

/// Share of the supply that matters: what weakens a stalled motor as much as a material torque constant.
const MATERIAL: f64 = 0.05;
/// Share by which a battery falls from full to empty: lithium cells from 4.2 to 2.7 V.
const OTHER: f64 = 0.36;
/// Time in which a supply falls by that share where a log says of none, s: a battery of 2 Ah at 20 A.
const FALLS_S: f64 = 60.0;

impl Effect for SupplyVoltage {
    fn name(&self) -> &str {
        "supply-voltage"
    }

    fn equation(&self) -> &str {
        "supply V (1 + scale) - fall_v_per_s t, t the time since the start of a run, where no supply is logged"
    }

    fn reference(&self) -> &str {
        "battery data sheet: open-circuit voltage by state of charge"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn before_current(&self) -> bool {
        true
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        self.forms_in(robot, &Sizes::of(robot))
    }

    fn forms_in(&self, robot: &Robot, sizes: &Sizes) -> Vec<Form> {
        let v = robot.supply_v;
        let seconds = if sizes.run_s.is_finite() { sizes.run_s } else { FALLS_S };
        let scale = Parameter::new("scale", 0.02, [-OTHER, OTHER / (1.0 - OTHER)], MATERIAL);
        let per_s = v / seconds;
        let fall = Parameter::new("fall_v_per_s", 0.02 * per_s, [-MATERIAL * per_s, OTHER * per_s], MATERIAL * per_s);
        vec![Form::whole(vec![scale.clone()]), Form::whole(vec![scale, fall])]
    }

    fn may_be_little(&self, _form: &Form) -> bool {
        // What is unknown of it is named; a little of it beside a weak motor would share what is the motor's.
        false
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        model.supply_scale *= 1.0 + values.get("scale");
        model.supply_fall_v_per_s += values.get("fall_v_per_s");
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("log supply_v, or measure the battery before and after a run", 2.0))
    }
}
