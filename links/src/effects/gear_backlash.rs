//! `gear-backlash`: play between motor and wheel.

use nalgebra::DMatrix;
use runs::robot::Robot;

use crate::drive::{Ahead, DriveModel, TEST_FUNCTION_S, smooth_sign};
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values, wheel_name};
use crate::motion::MotionModel;
use crate::segment::Segment;

/// Play between motor and wheel.
pub(super) struct GearBacklash;

impl Effect for GearBacklash {
    fn name(&self) -> &str {
        "gear-backlash"
    }

    fn equation(&self) -> &str {
        "the wheel follows the motor shaft with play of play_rad, turned at that shaft"
    }

    fn reference(&self) -> &str {
        "Nordin and Gutman 2002"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        self.forms_in(robot, &Sizes::of(robot))
    }

    fn forms_in(&self, robot: &Robot, sizes: &Sizes) -> Vec<Form> {
        // Material is what jerks the encoder as a torque that matters would, within a test function: 0.03 rad at the
        // motor of a robot of 2.4 kg, tenths of a millimetre on a linear axis of 95 kg.
        let longer = (sizes.test_function_s / TEST_FUNCTION_S).powi(2);
        let unit = SHOWS * longer * sizes.drive_nm * robot.gear_ratio / DriveModel::new(robot).felt_inertia();
        // Less than a count is not told from where the counts happen to change.
        let least = unit.max(sizes.count_rad * robot.gear_ratio);
        let most = (700.0 * least).min(MOST_TURNS * std::f64::consts::TAU * robot.gear_ratio);
        // What would have to be more than any gear has is not looked for.
        if least >= most {
            return Vec::new();
        }
        let p = |name: String| Parameter::new(name, (0.7 * unit).min(0.1 * most), [0.0, most], least);
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
        let ahead = move |model: &DriveModel, segment: &Segment| {
            (0..segment.angle.len())
                .map(|i| {
                    let half = 0.5 * values.wheel("play", i, "rad") / ratio;
                    if half == 0.0 {
                        return vec![0.0; segment.t.len()];
                    }
                    between(model, segment, i, half)
                })
                .collect()
        };
        model.offsets.push((Ahead::Rotor, Box::new(ahead)));
    }

    fn law_uncertainty(&self) -> f64 {
        // The rotor bounces between the flanks.
        0.08
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("turn the wheel by hand against the held motor, times the gear ratio", 3.0))
    }
}

/// Turns of the output that no gear with teeth has in play: a quarter turn is a shaft that has come loose. Without it, logs of
/// a staircase of settled speeds, whose rows no gear could tell from play, had 3 turns named beside a friction.
const MOST_TURNS: f64 = 0.25;
/// Square of the time within which a test function of [`TEST_FUNCTION_S`] shows a step of the angle (0.0023 s²) times the share of
/// the drive's torque that matters (0.034), s²: what makes it 0.03 rad on the paper's robot, as the blind bench has it.
const SHOWS: f64 = 7.8e-5;

/// Torque, as a share of what is usual, within which the flank that carries is not known where a rotor weighs nothing.
const NO_FLANK: f64 = 0.08;

/// Where the rotor is between the flanks, −1 to 1 times `half` (rad at the wheel), at every tick: between them its own
/// torque moves it against a load that coasts, and at a flank it stays without bouncing.
fn between(model: &DriveModel, segment: &Segment, wheel: usize, half: f64) -> Vec<f64> {
    let (axis, g) = (&model.axes[wheel], model.gear_ratio);
    let n = segment.t.len();
    let torque: Vec<f64> = (0..n)
        .map(|k| {
            let volts = segment.duty[wheel][k] * segment.supply[k] - axis.back_emf * g * segment.speed[wheel][k];
            g * (axis.torque_constant * volts / axis.resistance - axis.friction * segment.sign[wheel][k])
        })
        .collect();
    let usual = estimation::statistics::rms(torque.iter().copied()).max(f64::MIN_POSITIVE);
    let rotor = model.moves_in_play(wheel);
    let (mut place, mut speed) = (0.0_f64, 0.0_f64);
    (0..n)
        .map(|k| {
            let now = place;
            let Some(next) = segment.t.get(k + 1) else { return now };
            let tick = next - segment.t[k];
            if torque[k] == 0.0 && rotor == 0.0 {
                // Nothing moves it.
                return now;
            }
            if torque[k].abs() * tick * tick > 8.0 * half * rotor {
                // Across within half a tick.
                (place, speed) = (half * smooth_sign(torque[k], NO_FLANK * usual), 0.0);
                return now;
            }
            let acceleration = torque[k] / rotor;
            place += tick * (speed + 0.5 * acceleration * tick);
            speed += tick * acceleration;
            if place.abs() >= half {
                (place, speed) = (place.clamp(-half, half), 0.0);
            }
            now
        })
        .collect()
}

/// Which flank of the teeth carries, −1 to 1, from the motion alone: the sign of the torque that accelerates the robot
/// at this wheel.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn play_is_named_from_what_counts_and_test_functions_resolve() {
        let least = |robot: &Robot, sizes: &Sizes| GearBacklash.forms_in(robot, sizes)[0].free[0].material;
        let robot = Robot::racbot();
        let sizes = Sizes::of(&robot);
        let fine = least(&robot, &sizes);
        let count = |robot: &Robot| robot.gear_ratio / robot.counts_per_wheel_rad();
        assert!(fine > count(&robot));
        // A test function of twice the length, as at 50 Hz, shows a step of the angle a quarter as well.
        let slow = Sizes { test_function_s: 2.0 * TEST_FUNCTION_S, ..sizes };
        assert!((least(&robot, &slow) / fine - 4.0).abs() < 1e-9);
        let coarse = Sizes { count_rad: 100.0 * sizes.count_rad, ..sizes };
        assert!((least(&robot, &coarse) / (100.0 * count(&robot)) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn no_play_is_a_quarter_turn() {
        let robot = Robot::racbot();
        let sizes = Sizes::of(&robot);
        let quarter = 0.25 * std::f64::consts::TAU * robot.gear_ratio;
        let forms =
            |longer: f64| GearBacklash.forms_in(&robot, &Sizes { test_function_s: longer * TEST_FUNCTION_S, ..sizes });
        assert!(!forms(1.0).is_empty() && forms(1.0).iter().all(|f| f.free[0].bounds[1] <= quarter));
        // Of rows half a second apart only a play of turns would show.
        assert!(forms(30.0).is_empty());
    }
}
