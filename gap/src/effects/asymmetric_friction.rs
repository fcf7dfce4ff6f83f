//! `asymmetric-friction`: dry friction in one sense of rotation only.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values, wheel_name};

/// Dry friction in one sense of rotation only.
pub(super) struct AsymmetricFriction;

impl Effect for AsymmetricFriction {
    fn name(&self) -> &str {
        "asymmetric-friction"
    }

    fn equation(&self) -> &str {
        "torque -T sign(w) at the wheel shaft where sign(w) = sense (+1 or -1), nothing the other way"
    }

    fn reference(&self) -> &str {
        "Armstrong-Helouvry 1994"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        let stall = Sizes::of(robot).stall_nm;
        let mut forms = Vec::new();
        for sense in [1.0, -1.0] {
            let bounds = [-0.02 * stall, stall];
            let whole = Form::whole(vec![Parameter::new("torque_nm", 0.01 * stall, bounds, 0.045 * stall)]);
            forms.push(whole.fixing("sense", sense));
            let p = |i| Parameter::new(wheel_name("torque", i, "nm"), 0.01 * stall, bounds, 0.055 * stall);
            forms.extend(Form::alone(robot, p).into_iter().map(|f| f.fixing("sense", sense)));
        }
        forms
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let torque: Vec<f64> = (0..model.wheels.len()).map(|i| values.wheel("torque", i, "nm")).collect();
        let sense = values.find("sense").unwrap_or(1.0);
        model.loads.push(Box::new(move |now, loads| {
            for (i, t) in torque.iter().enumerate() {
                loads.wheel[i] -= t * sense * (sense * now.sign[i]).max(0.0);
            }
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("run the lifted wheels both ways at equal duty", 3.0))
    }
}
