//! `centre-of-mass`: a centre of mass that is not the chassis centre.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values};
use crate::motion::MotionModel;

/// A centre of mass that is not the chassis centre.
pub(super) struct CentreOfMass;

impl Effect for CentreOfMass {
    fn name(&self) -> &str {
        "centre-of-mass"
    }

    fn equation(&self) -> &str {
        "centre of mass at (x_m, y_m) in the body frame"
    }

    fn reference(&self) -> &str {
        "-"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        let rim = Sizes::of(robot).rim_m;
        let p = |name| Parameter::new(name, 0.025 * rim, [-4.0 * rim, 4.0 * rim], 0.05 * rim);
        vec![Form::whole(vec![p("x_m"), p("y_m")])]
    }

    /// What each wheel carries.
    fn motion(&self, values: &Values, model: &mut MotionModel) {
        for (centre, name) in model.centre_of_mass_m.iter_mut().zip(["x_m", "y_m"]) {
            *centre += values.get(name);
        }
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        model.centre_of_mass[0] += values.get("x_m");
        model.centre_of_mass[1] += values.get("y_m");
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("balance the robot on an edge, twice", 3.0))
    }
}
