//! `camera-scale`: a camera whose metre is not a metre.

use runs::frames::Pose;
use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

/// Scale that is worth a name.
pub(super) const MATERIAL: f64 = 0.004;

/// A camera whose metre is not a metre.
pub(super) struct CameraScale;

impl Effect for CameraScale {
    fn name(&self) -> &str {
        "camera-scale"
    }

    fn equation(&self) -> &str {
        "camera sees (1 + scale) (x, y)"
    }

    fn reference(&self) -> &str {
        "camera calibration"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        vec![Form::whole(vec![Parameter::new("scale", 0.01, [-0.3, 0.3], MATERIAL)])]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        let s = 1.0 + values.get("scale");
        model.observe.push(Box::new(move |p| Pose::new(s * p.x, s * p.y, p.theta)));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("drive 2 m along a tape measure, or lay a chessboard under the camera", 3.0))
    }
}
