//! `quadratic-drag`: what a fan, a pump, a propeller or the air takes of an axis.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values, wheel_name};

/// A load that grows with the square of the speed, against it either way. Where a motor chatters within rows, the smoothed
/// speed has less of a square than the true one, and the law fits badly.
pub(super) struct QuadraticDrag;

impl Effect for QuadraticDrag {
    fn name(&self) -> &str {
        "quadratic-drag"
    }

    fn equation(&self) -> &str {
        "torque -c w |w| at the output shaft of an axis on blocks"
    }

    fn reference(&self) -> &str {
        "White 2011, chapter 7 (drag of immersed bodies) and chapter 11 (torque of pumps and fans)"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        self.forms_in(robot, &Sizes::of(robot))
    }

    fn forms_in(&self, robot: &Robot, s: &Sizes) -> Vec<Form> {
        // As viscous friction: what takes as much at the speed of the log as a dry friction that matters takes at any.
        let unit = s.drive_nm / s.speed.powi(2);
        let bounds = [0.0, 2.0 * unit.max(s.stall_nm / s.speed.powi(2))];
        Form::alone(robot, |i| Parameter::new(wheel_name("coefficient", i, "nms2"), 0.003 * unit, bounds, 0.025 * unit))
    }

    fn is_load(&self) -> bool {
        true
    }

    fn may_be_little(&self, _form: &Form) -> bool {
        // An axis turns a fan or it does not; the air about any other is nothing beside its friction.
        false
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let c: Vec<f64> = (0..model.wheels.len()).map(|i| values.wheel("coefficient", i, "nms2")).collect();
        model.loads.push(Box::new(move |now, loads| {
            for (i, c) in c.iter().enumerate() {
                loads.wheel[i] -= c * now.speed[i] * now.speed[i].abs();
            }
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("log the current at three steady speeds, or take the fan off and log again", 5.0))
    }
}
