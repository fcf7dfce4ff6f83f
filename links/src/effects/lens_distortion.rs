//! `lens-distortion`: a lens whose scale changes with the distance from the field centre.

use runs::frames::Pose;
use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values};
use crate::motion::MotionModel;

/// A lens whose scale changes with the distance from the field centre.
pub(super) struct LensDistortion;

impl Effect for LensDistortion {
    fn name(&self) -> &str {
        "lens-distortion"
    }

    fn equation(&self) -> &str {
        "camera sees (x, y) (1 + k1 (x^2 + y^2)), k1 in 1/m^2"
    }

    fn reference(&self) -> &str {
        "Brown 1966"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        self.forms_in(robot, &Sizes::of(robot))
    }

    fn forms_in(&self, _robot: &Robot, sizes: &Sizes) -> Vec<Form> {
        // It matters where it moves the frames as far as a `camera-scale` that matters does.
        let unit = super::camera_scale::MATERIAL / sizes.seen_m.powi(2);
        vec![Form::whole(vec![Parameter::new("k1_per_m2", 0.5 * unit, [-50.0 * unit, 50.0 * unit], unit)])]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        let k1 = values.get("k1_per_m2");
        model.observe.push(Box::new(move |p| {
            let s = 1.0 + k1 * (p.x * p.x + p.y * p.y);
            Pose::new(s * p.x, s * p.y, p.theta)
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("lay a chessboard at the centre and in a corner of the field", 5.0))
    }
}
