//! `turning-resistance`: the floor holds back what turns, as wheels that are dragged sideways in a turn do.

use runs::robot::Robot;

use crate::drive::{DriveModel, smooth_sign};
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values};

/// Wheels or tracks behind one another that a turn drags sideways, or casters that it swivels.
pub(super) struct TurningResistance;

impl Effect for TurningResistance {
    fn name(&self) -> &str {
        "turning-resistance"
    }

    fn equation(&self) -> &str {
        "torque -torque_nm sign(w) on the body, w the rate at which it turns"
    }

    fn reference(&self) -> &str {
        "moment of turning resistance of tracked and skid-steered vehicles (Wong, Theory of Ground Vehicles)"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        self.forms_in(robot, &Sizes::of(robot))
    }

    fn forms_in(&self, robot: &Robot, sizes: &Sizes) -> Vec<Form> {
        // As of a drag of the body, at the wheels.
        let w = sizes.body_n(robot) * sizes.rim_m;
        vec![Form::whole(vec![Parameter::new("torque_nm", 0.005 * w, [-0.05 * w, w], 0.012 * w)])]
    }

    fn is_load(&self) -> bool {
        true
    }

    fn may_be_little(&self, _form: &Form) -> bool {
        // Rollers let a robot turn, and so do two wheels on one axle.
        false
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let torque = values.get("torque_nm");
        let rim = model.wheels.iter().map(|w| w.x_m.hypot(w.y_m)).fold(0.0, f64::max);
        model.loads.push(Box::new(move |now, loads| {
            loads.body[2] -= torque * smooth_sign(now.twist.omega * rim, now.sliding());
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("turn the robot on the spot by a spring scale at its rim, its motors disconnected", 5.0))
    }
}
