//! `marker-heading`: a marker plate that is turned on the robot.

use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

/// A marker plate that is turned on the robot.
pub(super) struct MarkerHeading;

impl Effect for MarkerHeading {
    fn name(&self) -> &str {
        "marker-heading"
    }

    fn equation(&self) -> &str {
        "camera sees theta + angle_rad (counter-clockwise)"
    }

    fn reference(&self) -> &str {
        "camera calibration"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        vec![Form::whole(vec![Parameter::new("angle_rad", 0.01, [-3.2, 3.2], 0.4_f64.to_radians())])]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        model.marker.theta += values.get("angle_rad");
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("hold a square against chassis and marker plate", 2.0))
    }
}
