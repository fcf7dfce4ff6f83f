//! `camera-timing`: stamps of the camera frames by a clock that runs fast or slow.

use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

/// Stamps of the camera frames by a clock that runs fast or slow; their scatter is found on the
/// timing link.
pub(super) struct CameraTiming;

impl Effect for CameraTiming {
    fn name(&self) -> &str {
        "camera-timing"
    }

    fn equation(&self) -> &str {
        "a frame stamped t s after the start of a run was taken drift t earlier; stamps scatter by jitter_s"
    }

    fn reference(&self) -> &str {
        "clock synchronisation, e.g. IEEE 1588"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        vec![Form::whole(vec![Parameter::new("drift", 5e-4, [-0.02, 0.02], 6e-4)])]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        model.clock_drift += values.get("drift");
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("blink a light on a clock the camera sees, for a minute", 5.0))
    }
}
