//! `asymmetric-friction`: dry friction that differs with the direction of rotation.

use model::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values, wheel_name};

/// Dry friction that differs with the direction of rotation.
pub(super) struct AsymmetricFriction;

impl Effect for AsymmetricFriction {
    fn name(&self) -> &str {
        "asymmetric-friction"
    }

    fn equation(&self) -> &str {
        "torque -T_i (constant sign) while the wheel turns: friction T_i larger forwards than backwards by 2 T_i"
    }

    fn reference(&self) -> &str {
        "Armstrong-Helouvry 1994"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        let stall = Sizes::of(robot).stall_nm;
        Form::alone(robot, |i| {
            Parameter::new(wheel_name("torque", i, "nm"), 0.01 * stall, [-stall, stall], 0.03 * stall)
        })
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let torque: Vec<f64> = (0..model.wheels.len()).map(|i| values.wheel("torque", i, "nm")).collect();
        model.loads.push(Box::new(move |now, loads| {
            for (i, t) in torque.iter().enumerate() {
                loads.wheel[i] -= t * now.sign[i].abs();
            }
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("run the lifted wheels both ways at equal duty", 3.0))
    }
}
