//! `gear-backlash`: play between motor and wheel.

use nalgebra::DMatrix;
use runs::robot::Robot;

use crate::drive::{DriveModel, smooth_sign};
use crate::effect::{Effect, Form, Link, Parameter, Values, wheel_name};
use crate::motion::MotionModel;
use crate::segment::Segment;

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
        let p = |name: String| Parameter::new(name, 0.02, [0.0, 2.0], 0.03);
        let mut forms = vec![Form::whole(vec![p("play_rad".to_owned())])];
        forms.extend(Form::alone(robot, |i| p(wheel_name("play", i, "rad"))));
        forms
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        let (values, ratio) = (values.clone(), model.gear_ratio);
        let inertia = model.inertia.clone();
        model.angles.push(Box::new(move |segment, angles| {
            for (i, angle) in angles.iter_mut().enumerate() {
                let half = 0.5 * values.wheel("play", i, "rad") / ratio;
                if half != 0.0 {
                    let side = side(segment, &inertia, i);
                    angle.iter_mut().zip(side).for_each(|(a, s)| *a -= half * s);
                }
            }
        }));
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let (values, ratio) = (values.clone(), model.gear_ratio);
        model.offsets.push(Box::new(move |model, segment| {
            (0..segment.angle.len())
                .map(|i| {
                    let half = 0.5 * values.wheel("play", i, "rad") / ratio;
                    if half == 0.0 {
                        return vec![0.0; segment.t.len()];
                    }
                    flank(model, segment, i).into_iter().map(|s| half * s).collect()
                })
                .collect()
        }));
    }

    fn law_uncertainty(&self) -> f64 {
        // The rotor bounces between the flanks.
        0.08
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("turn the wheel by hand against the held motor", 3.0))
    }
}

/// Time over which the motor's torque is averaged, s: a rotor crosses its play in about that.
const CROSSING_S: f64 = 0.012;

/// Which flank of the teeth carries, −1 to 1: the sign of the torque that the motor puts on the gear.
fn flank(model: &DriveModel, segment: &Segment, wheel: usize) -> Vec<f64> {
    let (axis, g) = (&model.axes[wheel], model.gear_ratio);
    let n = segment.t.len();
    let torque: Vec<f64> = (0..n)
        .map(|k| {
            let volts = segment.duty[wheel][k] * segment.supply[k] - axis.back_emf * g * segment.speed[wheel][k];
            g * (axis.torque_constant * volts / axis.resistance - axis.friction * segment.sign[wheel][k])
        })
        .collect();
    let usual = crate::statistics::rms(torque.iter().copied()).max(f64::MIN_POSITIVE);
    let tick = (segment.t[n - 1] - segment.t[0]) / (n - 1) as f64;
    let back = (CROSSING_S / tick).round().max(1.0) as usize;
    let mut sum = 0.0;
    (0..n)
        .map(|k| {
            sum += torque[k];
            if k >= back {
                sum -= torque[k - back];
            }
            smooth_sign(sum / back.min(k + 1) as f64, 0.08 * usual)
        })
        .collect()
}

/// The same from the motion alone: the sign of the torque that accelerates the robot at this wheel.
fn side(segment: &Segment, inertia: &DMatrix<f64>, wheel: usize) -> Vec<f64> {
    let n = segment.speed.len();
    let momentum: Vec<f64> =
        (0..segment.t.len()).map(|k| (0..n).map(|j| inertia[(wheel, j)] * segment.speed[j][k]).sum()).collect();
    let last = momentum.len() - 1;
    let peak = 1e-3 * inertia.trace() / n as f64;
    let torque = |k: usize| {
        let (a, b) = (k.saturating_sub(4), (k + 4).min(last));
        (momentum[b] - momentum[a]) / (segment.t[b] - segment.t[a]).max(1e-9)
    };
    (0..=last).map(|k| smooth_sign(torque(k), 500.0 * peak)).collect()
}
