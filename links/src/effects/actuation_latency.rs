//! `actuation-latency`: duties that act later than logged.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};

/// Rows by which duties may be logged late, at least and at most: the one in which they are, and what a fit needs beside it.
const LOGGED_LATE: [f64; 2] = [0.5, 1.5];

/// Duties that act later than logged.
pub(super) struct ActuationLatency;

impl Effect for ActuationLatency {
    fn name(&self) -> &str {
        "actuation-latency"
    }

    fn equation(&self) -> &str {
        "duty at t acts at t + latency_s"
    }

    fn reference(&self) -> &str {
        "-"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        // A logged speed is of the moment or of the row before, and a noisy log does not tell which.
        let row = if runs::is_from_speeds(robot) { 1.0 / robot.control_rate_hz } else { 0.0 };
        let material = row.max(0.004);
        let latency = Parameter::new("latency_s", 0.002, [-0.001, 0.3], material);
        let mut forms = vec![Form::whole(vec![latency.open_by(0.5 * row)])];
        // Duties that are logged with the row after theirs act a row before it; no machine is early by a part of a row.
        let tick = 1.0 / robot.control_rate_hz;
        if LOGGED_LATE[0] * tick > 0.001 {
            let [least, most] = LOGGED_LATE.map(|rows| -rows * tick);
            let early = Parameter::new("latency_s", 0.002, [most, least], material.min(-least));
            forms.push(Form::whole(vec![early.from(-tick).open_by(0.5 * row)]));
        }
        forms
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        model.duty_delay_s += values.get("latency_s");
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("an oscilloscope at bridge input and output", 5.0))
    }
}
