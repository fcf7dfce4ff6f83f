//! `imu-latency`: readings of an inertial sensor that are older than the tick they stand at.

use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

/// Age that matters, s: at 6 rad/s a heading is then 1° off; and no less than the rounding to ticks.
const MATERIAL_S: f64 = 0.003;

/// Readings of an inertial sensor that are older than the tick they stand at.
pub(super) struct ImuLatency;

impl Effect for ImuLatency {
    fn name(&self) -> &str {
        "imu-latency"
    }

    fn equation(&self) -> &str {
        "gyroscope and accelerometer at t show the robot at t - latency_s"
    }

    fn reference(&self) -> &str {
        "sampling and filter delay"
    }

    fn link(&self) -> Link {
        Link::Gyroscope
    }

    fn also(&self) -> Option<Link> {
        Some(Link::Accelerometer)
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        let material = MATERIAL_S.max(0.6 / robot.control_rate_hz);
        vec![Form::whole(vec![Parameter::new("latency_s", 0.002, [-0.1, 0.3], material)])]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        model.sensor.latency_s += values.get("latency_s");
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("add up the delay of the sensor's filter and of its bus from their data sheets", 5.0))
    }
}
