//! `gravity-load`: a mass beside the shaft of an axis, such as a pendulum or an arm that is not balanced.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values, wheel_name};

/// A mass beside the shaft of an axis. Within a radian or so a spring does the same.
pub(super) struct GravityLoad;

impl Effect for GravityLoad {
    fn name(&self) -> &str {
        "gravity-load"
    }

    fn equation(&self) -> &str {
        "torque sin_i_nm sin(theta_i) + cos_i_nm cos(theta_i) at the output shaft of an axis on blocks, theta_i its angle by \
         the log's counts, whose zero the two parameters hold"
    }

    fn reference(&self) -> &str {
        "Siciliano et al. 2009, chapter 7 (the term g(q))"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        self.forms_in(robot, &Sizes::of(robot))
    }

    fn forms_in(&self, robot: &Robot, sizes: &Sizes) -> Vec<Form> {
        let drive = sizes.drive_nm;
        let most = sizes.carried_nm();
        let p = |stem, i| Parameter::new(wheel_name(stem, i, "nm"), 0.01 * drive, [-most, most], 0.03 * drive);
        Form::axes(robot, |i| [p("sin", i), p("cos", i)])
    }

    fn is_load(&self) -> bool {
        true
    }

    fn is_carried(&self) -> bool {
        true
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let torque = values.with_angle(model.wheels.len(), "nm");
        model.loads.push(Box::new(move |now, loads| {
            for (i, [a, b]) in torque.iter().enumerate() {
                if *a != 0.0 || *b != 0.0 {
                    let [s, c] = now.segment.shaft_sin_cos(i, now.tick);
                    loads.carried[i] += a * s + b * c;
                }
            }
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("hold the unpowered axis level with a spring scale", 3.0))
    }
}
