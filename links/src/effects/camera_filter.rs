//! `camera-filter`: poses that a camera, or a program after it, has smoothed.

use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

/// A low-pass of first order on the poses of the camera, all the time or once a frame.
pub(super) struct CameraFilter;

impl Effect for CameraFilter {
    fn name(&self) -> &str {
        "camera-filter"
    }

    fn equation(&self) -> &str {
        "a camera pose p_log follows the robot's p by time_s dp_log/dt = p - p_log, or (at_frames 1) keeps exp(-dt/time_s) of the \
         difference from a frame to the next"
    }

    fn reference(&self) -> &str {
        "low-pass of first order"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        // Tried at what a filter usually has: next to nothing of one is a latency. So is one that forgets from a frame to the
        // next.
        let material = super::camera_latency::material(robot).max(1.0 / robot.camera_rate_hz);
        let time = Parameter::new("time_s", TRIED_S, [0.0, FILTER_S], material);
        [0.0, 1.0].map(|at_frames| Form::whole(vec![time.clone()]).fixing("at_frames", at_frames)).into()
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        model.camera_filter.time_s += values.get("time_s").max(0.0);
        model.camera_filter.at_frames |= values.get("at_frames") > 0.5;
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("stop the robot at once, and look how long its pose creeps on", 5.0))
    }
}

/// Step by which a filter is told from a latency, s: as long as a robot takes to change its speed by a tenth.
const TRIED_S: f64 = 0.03;
/// Time constant of a filter at most, s: beyond, a tracker's poses would be of no use to its robot. Reasoned.
const FILTER_S: f64 = 0.3;
