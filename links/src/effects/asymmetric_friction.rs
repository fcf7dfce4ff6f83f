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
        self.forms_in(robot, &Sizes::of(robot))
    }

    fn forms_in(&self, robot: &Robot, sizes: &Sizes) -> Vec<Form> {
        let drive = sizes.drive_nm;
        let mut forms = Vec::new();
        for sense in [1.0, -1.0] {
            let bounds = [-0.02 * drive, drive.max(sizes.stall_nm)];
            let whole = Form::whole(vec![Parameter::new("torque_nm", 0.01 * drive, bounds, 0.045 * drive)]);
            forms.push(whole.fixing("sense", sense));
            let p = |i| Parameter::new(wheel_name("torque", i, "nm"), 0.01 * drive, bounds, 0.055 * drive);
            forms.extend(Form::alone(robot, p).into_iter().map(|f| f.fixing("sense", sense)));
        }
        forms
    }

    fn is_load(&self) -> bool {
        true
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
