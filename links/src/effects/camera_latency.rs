//! `camera-latency`: a camera frame that is older than its stamp.

use model::fit::clocks::MATTERS_S;
use runs::CLOCK_OFF_S;
use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

/// Share of a tick that rounding of stamps to the next tick gives a latency of its own.
const ROUNDING_TICKS: f64 = 0.6;
/// Difference of camera's and ticks' rates up to which they are in step, so that no stamp is rounded.
const IN_STEP: f64 = 0.02;
/// How far a stamp may lie before what it shows, s.
const EARLY_S: f64 = 0.3;

/// Age of a camera frame that matters on a robot: frames stand at ticks of the log, and where these are not the
/// camera's own, their age is not known to better than the rounding.
pub fn material(robot: &Robot) -> f64 {
    let in_step = (robot.camera_rate_hz / robot.control_rate_hz - 1.0).abs() < IN_STEP;
    if in_step { MATTERS_S } else { MATTERS_S.max(ROUNDING_TICKS / robot.control_rate_hz) }
}

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
        // Clocks that were set by hand may also run ahead.
        vec![Form::whole(vec![Parameter::new(
            "latency_s",
            0.005,
            [-robot.camera_latency_s - EARLY_S, CLOCK_OFF_S],
            material(robot),
        )])]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        model.latency_s += values.get("latency_s");
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("blink a light on a clock the camera sees", 5.0))
    }
}
