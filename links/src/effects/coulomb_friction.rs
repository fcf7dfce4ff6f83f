//! `coulomb-friction`: dry friction at the wheel shaft beyond nominal.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values, wheel_name};

/// Dry friction at the wheel shaft beyond nominal.
pub(super) struct CoulombFriction;

impl Effect for CoulombFriction {
    fn name(&self) -> &str {
        "coulomb-friction"
    }

    fn equation(&self) -> &str {
        "torque -T sign(w) at the wheel shaft"
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
        // Less than the file's at most by all of it, and by less than matters for what noise does; and no motor turns a wheel
        // against more than its stall torque. A twentieth of the supply that a bridge gave more was a friction below none.
        let nominal = robot.gear_ratio * robot.motor.friction_torque;
        let bounds = [-nominal - 0.02 * drive, drive.max(sizes.stall_nm)];
        let p = |i| Parameter::new(wheel_name("torque", i, "nm"), 0.01 * drive, bounds, 0.04 * drive);
        let mut forms = vec![Form::whole(vec![Parameter::new("torque_nm", 0.01 * drive, bounds, 0.03 * drive)])];
        forms.extend(Form::alone(robot, p));
        forms.push(Form::each(robot, p));
        forms
    }

    fn is_load(&self) -> bool {
        true
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let torque: Vec<f64> = (0..model.wheels.len()).map(|i| values.wheel("torque", i, "nm")).collect();
        model.loads.push(Box::new(move |now, loads| {
            for (i, t) in torque.iter().enumerate() {
                loads.wheel[i] -= t * now.sign[i];
            }
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("turn the wheel by hand with a torque gauge, robot off", 5.0))
    }
}
