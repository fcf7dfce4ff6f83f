//! `viscous-friction`: friction in proportion to speed.

use model::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values, wheel_name};

/// Friction in proportion to speed.
pub(super) struct ViscousFriction;

impl Effect for ViscousFriction {
    fn name(&self) -> &str {
        "viscous-friction"
    }

    fn equation(&self) -> &str {
        "torque -b w at the wheel shaft"
    }

    fn reference(&self) -> &str {
        "Armstrong-Helouvry 1994"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        let s = Sizes::of(robot);
        let unit = s.stall_nm / s.no_load;
        let p = |i| {
            Parameter::new(wheel_name("coefficient", i, "nms"), 0.05 * unit, [-0.2 * unit, 20.0 * unit], 0.4 * unit)
        };
        let mut forms = vec![Form::whole(vec![Parameter::new(
            "coefficient_nms",
            0.05 * unit,
            [-0.2 * unit, 20.0 * unit],
            0.4 * unit,
        )])];
        forms.extend(Form::alone(robot, p));
        forms
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let b: Vec<f64> = (0..model.wheels.len()).map(|i| values.wheel("coefficient", i, "nms")).collect();
        model.loads.push(Box::new(move |now, loads| {
            for (i, b) in b.iter().enumerate() {
                loads.wheel[i] -= b * now.speed[i];
            }
        }));
    }

    fn law_uncertainty(&self) -> f64 {
        // What rollers lose at the hand-over grows with speed, too.
        0.03
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("let the lifted wheels coast down", 3.0))
    }
}
