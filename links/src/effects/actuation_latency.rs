//! `actuation-latency`: duties that act later than logged.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};

/// Rows by which duties may be logged late: the one in which they are, and what a fit needs beside it.
const LOGGED_LATE: f64 = 1.2;

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
        // Duties that are logged with the row after theirs act a row before it.
        let early = -LOGGED_LATE / robot.control_rate_hz;
        let latency = Parameter::new("latency_s", 0.002, [early.min(-0.001), 0.3], row.max(0.004));
        vec![Form::whole(vec![latency.open_by(0.5 * row)])]
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        model.duty_delay_s += values.get("latency_s");
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("an oscilloscope at bridge input and output", 5.0))
    }
}
