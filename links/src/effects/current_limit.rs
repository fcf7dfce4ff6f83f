//! `current-limit`: a driver that lets no more than so much current through a motor.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values};

/// Limits that are tried, in stall currents.
const TRIED: [f64; 6] = [0.1, 0.18, 0.3, 0.45, 0.65, 0.9];
/// Largest limit that can show, in stall currents: a motor that is turned round at full speed draws two.
const MOST: f64 = 2.0;

/// A driver that lets no more than so much current through a motor.
pub(super) struct CurrentLimit;

impl Effect for CurrentLimit {
    fn name(&self) -> &str {
        "current-limit"
    }

    fn equation(&self) -> &str {
        "the current of each motor is limited to limit_a either way, whatever duty and speed ask for"
    }

    fn reference(&self) -> &str {
        "current limits of motor drivers (chopper drives, firmware of speed controllers)"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn before_current(&self) -> bool {
        true
    }

    fn may_be_little(&self, _form: &Form) -> bool {
        false
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        self.forms_in(robot, &Sizes::of(robot))
    }

    fn forms_in(&self, _robot: &Robot, sizes: &Sizes) -> Vec<Form> {
        let stall = sizes.stall_a;
        let limit = |share: f64| {
            Parameter::new("limit_a", 0.03 * stall, [0.01 * stall, MOST * stall], 0.0)
                .from(share * stall)
                // One that is never reached does nothing.
                .material_below(MOST * stall)
        };
        TRIED.into_iter().map(|share| Form::whole(vec![limit(share)])).collect()
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        model.current_limit_a = values.find("limit_a").unwrap_or(f64::INFINITY);
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("hold a wheel still at full duty and read the current", 2.0))
    }
}
