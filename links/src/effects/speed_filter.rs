//! `speed-filter`: a firmware smooths the speeds that it logs.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;
use crate::thresholds;

/// A low-pass of first order between an encoder and the logged speed.
pub(super) struct SpeedFilter {
    /// Whether a camera may show it, too: there it is a delay of the encoders by another name.
    pub(super) seen: bool,
}

impl Effect for SpeedFilter {
    fn name(&self) -> &str {
        "speed-filter"
    }

    fn equation(&self) -> &str {
        "logged speed w_log follows a speed w by time_s dw_log/dt = w - w_log"
    }

    fn reference(&self) -> &str {
        "low-pass of first order"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn also(&self) -> Option<Link> {
        self.seen.then_some(Link::Motion)
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        let row = 1.0 / robot.control_rate_hz;
        let time = Parameter::new("time_s", 0.002, [0.0, thresholds::filter_s(row)], row.max(0.004));
        // A logged speed is of the moment or of the row before, as with a delay.
        vec![Form::whole(vec![time.open_by(0.5 * row)])]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        // What went in is what comes out, and the time constant times its rate.
        let time_s = values.get("time_s");
        model.reading_filter_s += time_s;
        model.angles.push(Box::new(move |segment, angles| {
            for (angle, speed) in angles.iter_mut().zip(&segment.speed) {
                angle.iter_mut().zip(speed).for_each(|(a, w)| *a += time_s * w);
            }
        }));
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        model.reading_filter_s += values.get("time_s");
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("log counts beside the speeds, or look for the filter in the firmware", 5.0))
    }
}
