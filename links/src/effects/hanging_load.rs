//! `hanging-load`: a weight that pulls an axis one way wherever it is, such as a lift, a winch or an upright spindle.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values, wheel_name};

/// A weight on a rope, a rack or a spindle.
pub(super) struct HangingLoad;

impl Effect for HangingLoad {
    fn name(&self) -> &str {
        "hanging-load"
    }

    fn equation(&self) -> &str {
        "torque torque_i_nm at the output shaft of an axis on blocks, the same at every angle and speed"
    }

    fn reference(&self) -> &str {
        "Siciliano et al. 2009, chapter 7 (the term g(q) of a prismatic joint)"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        self.forms_in(robot, &Sizes::of(robot))
    }

    fn forms_in(&self, robot: &Robot, sizes: &Sizes) -> Vec<Form> {
        let (drive, most) = (sizes.drive_nm, sizes.carried_nm());
        let p = |i| Parameter::new(wheel_name("torque", i, "nm"), 0.01 * drive, [-most, most], 0.03 * drive);
        Form::alone(robot, p)
    }

    fn is_load(&self) -> bool {
        true
    }

    fn is_carried(&self) -> bool {
        true
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let torque: Vec<f64> = (0..model.wheels.len()).map(|i| values.wheel("torque", i, "nm")).collect();
        model.loads.push(Box::new(move |_, loads| {
            loads.carried.iter_mut().zip(&torque).for_each(|(load, torque)| *load += torque);
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("hold the unpowered axis by a spring scale at two places", 3.0))
    }
}
