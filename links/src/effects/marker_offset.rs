//! `marker-offset`: a marker plate that is off the centre.

use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values};
use crate::motion::MotionModel;

/// A marker plate that is off the centre.
pub(super) struct MarkerOffset;

impl Effect for MarkerOffset {
    fn name(&self) -> &str {
        "marker-offset"
    }

    fn equation(&self) -> &str {
        "camera sees the point (x_m, y_m) of the body instead of the centre"
    }

    fn reference(&self) -> &str {
        "camera calibration"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        let rim = Sizes::of(robot).rim_m;
        let p = |name| Parameter::new(name, 0.025 * rim, [-4.0 * rim, 4.0 * rim], 0.03 * rim);
        vec![Form::whole(vec![p("x_m"), p("y_m")])]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        model.marker.x += values.get("x_m");
        model.marker.y += values.get("y_m");
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("measure the marker plate with a calliper", 2.0))
    }
}
