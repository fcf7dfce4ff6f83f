//! `camera-latency`: a camera frame that is older than its stamp.

use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

/// A camera frame that is older than its stamp.
pub(super) struct CameraLatency;

impl Effect for CameraLatency {
    fn name(&self) -> &str {
        "camera-latency"
    }

    fn equation(&self) -> &str {
        "camera pose at t shows the robot at t - latency_s"
    }

    fn reference(&self) -> &str {
        "vision latency"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        // Frames stand at ticks of the log: their age is not known to better than the rounding, which a camera in step
        // with the ticks never averages out.
        let material = 0.003_f64.max(0.6 / robot.control_rate_hz);
        vec![Form::whole(vec![Parameter::new("latency_s", 0.005, [-robot.camera_latency_s - 0.001, 0.5], material)])]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        model.latency_s += values.get("latency_s");
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("blink a light on a clock the camera sees", 5.0))
    }
}
