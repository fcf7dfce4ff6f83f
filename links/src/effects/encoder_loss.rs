//! `encoder-loss`: an encoder that loses counts above a speed.

use runs::robot::Robot;

use crate::drive::{Ahead, DriveModel};
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values, wheel_name};
use crate::motion::MotionModel;
use crate::segment::Segment;

/// Speed of a wheel above which its encoder loses counts.
const THRESHOLD: &str = "threshold_rad_s";

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
            for (i, angle) in angles.iter_mut().enumerate() {
                if let Some(lost) = lost(&values, segment, i, angle) {
                    angle.iter_mut().zip(lost).for_each(|(a, lost)| *a += lost);
                }
            }
        }));
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let ahead = |values: Values| {
            move |s: &Segment, i: usize| {
                let lost = lost(&values, s, i, &s.angle[i]);
                lost.map_or_else(|| vec![0.0; s.t.len()], |lost| lost.iter().map(|l| -l).collect())
            }
        };
        let (read, braked) = (ahead(values.clone()), values.clone());
        model
            .offsets
            .push((Ahead::Reading, Box::new(move |model, s| (0..model.wheels.len()).map(|i| read(s, i)).collect())));
        // The motors brake by how fast the shafts turn, and not by what is counted.
        model.loads.push(Box::new(move |now, loads| {
            let threshold = braked.get(THRESHOLD);
            for (i, braking) in now.braking.iter().enumerate() {
                let loss = braked.wheel("loss", i, "");
                if is_lossy(now.segment.speed[i][now.tick + 1], loss, threshold) {
                    loads.wheel[i] -= braking * now.speed[i] * loss / (1.0 - loss);
                }
            }
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("compare the counter with an oscilloscope at speed", 15.0))
    }
}

/// Whether an encoder that loses this share of its counts does so at a speed by those that are left.
fn is_lossy(counted: f64, loss: f64, threshold: f64) -> bool {
    loss != 0.0 && counted.abs() * (1.0 / (1.0 - loss)) > threshold
}

/// What an encoder has not counted of a wheel's way up to each tick, rad; `None` where it loses nothing.
fn lost(values: &Values, segment: &Segment, wheel: usize, angle: &[f64]) -> Option<Vec<f64>> {
    let (loss, threshold) = (values.wheel("loss", wheel, ""), values.get(THRESHOLD));
    let mut sum = 0.0;
    let steps = angle.windows(2).zip(&segment.speed[wheel][1..]).map(|(a, speed)| {
        if is_lossy(*speed, loss, threshold) {
            sum += (a[1] - a[0]) * loss / (1.0 - loss);
        }
        sum
    });
    (loss != 0.0).then(|| std::iter::once(0.0).chain(steps).collect())
}
