//! `encoder-lag`: encoder counts that are older than the tick they stand at.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

/// Encoder counts that are older than the tick they stand at.
pub(super) struct EncoderLag;

impl Effect for EncoderLag {
    fn name(&self) -> &str {
        "encoder-lag"
    }

    fn equation(&self) -> &str {
        "wheel angle at t is logged at t + latency_s"
    }

    fn reference(&self) -> &str {
        "sampling delay"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        // As that of a camera frame.
        let material = 0.003_f64.max(0.6 / robot.control_rate_hz);
        vec![Form::whole(vec![Parameter::new("latency_s", 0.005, [0.0, 0.3], material)])]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        model.latency_s -= values.get("latency_s");
        model.encoder_lag_s += values.get("latency_s");
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        model.duty_delay_s += values.get("latency_s");
    }
}
