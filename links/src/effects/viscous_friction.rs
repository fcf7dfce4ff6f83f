//! `viscous-friction`: friction in proportion to speed.

use runs::robot::{Robot, Support};

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values, wheel_name};

/// Twice what a wheel loses as rollers are handed over, of its share of the weight, s/m: 0.005 to 0.011 on robots of
/// 1.6 to 3.8 kg in a rigid-body engine.
const HANDED_OVER: f64 = 0.02;

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
        self.forms_in(robot, &Sizes::of(robot))
    }

    fn forms_in(&self, robot: &Robot, s: &Sizes) -> Vec<Form> {
        // What takes as much at the speed of the log as a Coulomb friction that matters takes at any.
        let unit = s.drive_nm / s.speed;
        let rollers = match robot.support {
            Support::Floor => HANDED_OVER * s.weight_n * robot.wheel_radius_m.powi(2) / robot.wheel_count() as f64,
            Support::Blocks => 0.0,
        };
        let bounds = [-0.02 * unit, 2.0 * unit.max(s.stall_nm / s.speed)];
        let p = |name: String| Parameter::new(name, 0.003 * unit, bounds, rollers.max(0.025 * unit));
        let mut forms = vec![Form::whole(vec![p("coefficient_nms".to_owned())])];
        forms.extend(Form::alone(robot, |i| p(wheel_name("coefficient", i, "nms"))));
        forms
    }

    fn is_load(&self) -> bool {
        true
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
