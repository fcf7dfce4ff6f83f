//! `gear-backlash`: play between motor and wheel.

use model::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values, wheel_name};
use crate::motion::MotionModel;

/// Play between motor and wheel.
pub(super) struct GearBacklash;

impl Effect for GearBacklash {
    fn name(&self) -> &str {
        "gear-backlash"
    }

    fn equation(&self) -> &str {
        "the wheel follows the motor shaft with play of play_rad"
    }

    fn reference(&self) -> &str {
        "Nordin and Gutman 2002"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        let _ = robot;
        let p = |name: String| Parameter::new(name, 0.02, [0.0, 2.0], 0.08);
        let mut forms = vec![Form::whole(vec![p("play_rad".to_owned())])];
        forms.extend(Form::alone(robot, |i| p(wheel_name("play", i, "rad"))));
        forms
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        let (values, ratio) = (values.clone(), model.gear_ratio);
        model.angles.push(Box::new(move |segment, angles| {
            for (i, angle) in angles.iter_mut().enumerate() {
                let off = play(&segment.angle[i], values.wheel("play", i, "rad") / ratio);
                angle.iter_mut().zip(off).for_each(|(a, o)| *a -= o);
            }
        }));
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let (values, ratio) = (values.clone(), model.gear_ratio);
        model.offsets.push(Box::new(move |_, segment| {
            (0..segment.angle.len()).map(|i| play(&segment.angle[i], values.wheel("play", i, "rad") / ratio)).collect()
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("turn the wheel by hand against the held motor", 3.0))
    }
}

/// Motor angle minus wheel angle (both at the wheel, rad) for a wheel that follows with `play`.
fn play(angle: &[f64], play: f64) -> Vec<f64> {
    let half = 0.5 * play.max(0.0);
    let mut wheel = angle.first().copied().unwrap_or(0.0);
    angle
        .iter()
        .map(|a| {
            wheel = wheel.clamp(a - half, a + half);
            a - wheel
        })
        .collect()
}
