//! `body-radius`: contact points further from the centre than drawn.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values, turn_wheels};
use crate::motion::MotionModel;

/// Contact points further from the centre than drawn.
pub(super) struct BodyRadius;

impl Effect for BodyRadius {
    fn name(&self) -> &str {
        "body-radius"
    }

    fn equation(&self) -> &str {
        "contact points at (1 + scale) times their distance from the centre"
    }

    fn reference(&self) -> &str {
        "Borenstein and Feng 1996, UMBmark"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        vec![Form::whole(vec![Parameter::new("scale", 0.01, super::SIZES, 0.006)])]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        let s = 1.0 + values.get("scale");
        turn_wheels(&mut model.wheels, |_, w| {
            w.x_m *= s;
            w.y_m *= s;
        });
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let s = 1.0 + values.get("scale");
        turn_wheels(&mut model.wheels, |_, w| {
            w.x_m *= s;
            w.y_m *= s;
        });
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("turn ten times on the spot and count; or measure the contact points with a calliper", 3.0))
    }
}
