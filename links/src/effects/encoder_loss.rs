//! `encoder-loss`: an encoder that loses counts above a speed.

use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values, wheel_name};
use crate::motion::MotionModel;

/// An encoder that loses counts above a speed.
pub(super) struct EncoderLoss;

impl Effect for EncoderLoss {
    fn name(&self) -> &str {
        "encoder-loss"
    }

    fn equation(&self) -> &str {
        "above threshold_rad_s at the wheel a share loss_i of the counts is lost"
    }

    fn reference(&self) -> &str {
        "encoder and counter bandwidth"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        // Speeds robots drive at, about a quarter apart, up to half the no-load speed.
        let most = 0.5 * Sizes::of(robot).no_load;
        let steps = std::iter::successors(Some(2.0), |w| Some(1.27 * w)).take_while(|w| *w < most.min(60.0));
        let mut forms = Vec::new();
        for threshold in std::iter::once(0.0).chain(steps) {
            for form in Form::alone(robot, |i| Parameter::new(wheel_name("loss", i, ""), 0.01, [0.0, 0.9], 0.02)) {
                forms.push(form.fixing("threshold_rad_s", (2.0_f64 * threshold).round() / 2.0));
            }
        }
        forms
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        let values = values.clone();
        model.angles.push(Box::new(move |segment, angles| {
            let threshold = values.get("threshold_rad_s");
            for (i, angle) in angles.iter_mut().enumerate() {
                let loss = values.wheel("loss", i, "");
                if loss == 0.0 {
                    continue;
                }
                let mut regained = 0.0;
                let mut before = angle[0];
                for k in 1..angle.len() {
                    let step = angle[k] - before;
                    before = angle[k];
                    if segment.speed[i][k].abs() * (1.0 / (1.0 - loss)) > threshold {
                        regained += step * loss / (1.0 - loss);
                    }
                    angle[k] += regained;
                }
            }
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("compare the counter with an oscilloscope at speed", 15.0))
    }
}
