//! `gear-backlash`: play between motor and wheel.

use runs::robot::Robot;

use crate::drive::{Ahead, DriveModel, LOAD_FRICTION, RATIO, TEST_FUNCTION_S, smooth_sign};
use crate::effect::{Effect, Form, Link, Parameter, Play, Sizes, Values, wheel_name};
use crate::motion::MotionModel;
use crate::segment::Segment;

/// Play between motor and wheel.
pub(super) struct GearBacklash;

impl Effect for GearBacklash {
    fn name(&self) -> &str {
        "gear-backlash"
    }

    fn equation(&self) -> &str {
        "the wheel follows the motor shaft with play of play_rad, turned at that shaft; of the dry friction load_friction_nm acts on \
         the wheel"
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
        // What would have to be more than any gear has is not looked for, nor what leaves no less.
        if least >= most || sizes.play.is_some_and(|play| play.rad == 0.0) {
            return Vec::new();
        }
        // One that was looked for lies next to where it was found.
        let found = sizes.play.map(|play| play.rad);
        let (tried, most) = found.map_or((0.7 * unit, most), |play| (play, most.min(NEXT * play)));
        let p = |name: String| Parameter::new(name, tried.min(0.5 * most), [0.0, most], least);
        let mut forms = vec![Form::whole(vec![p("play_rad".to_owned())])];
        forms.extend(Form::alone(robot, |i| p(wheel_name("play", i, "rad"))));
        if let Some(Play { load_friction_nm: held, friction_nm, .. }) =
            sizes.play.filter(|play| play.load_friction_nm > 0.0)
        {
            let bounds = [0.0, MOST_HELD * friction_nm];
            let friction = Parameter::new(LOAD_FRICTION, 0.1 * held, bounds, f64::INFINITY).from(held).closed_above();
            for form in &mut forms {
                form.free[0].start = Some(tried);
                form.free.push(friction.clone());
            }
        }
        forms
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        let (values, ratio) = (values.clone(), model.gear_ratio);
        model.angles.push(Box::new(move |segment, angles| {
            for (i, angle) in angles.iter_mut().enumerate() {
                let half = 0.5 * values.wheel("play", i, "rad") / ratio;
                let crossed = Crossed::new(segment, i, half, 0.0);
                angle.iter_mut().zip(crossed.ahead).for_each(|(a, ahead)| *a -= ahead);
            }
        }));
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let (values, ratio) = (values.clone(), model.gear_ratio);
        let friction = values.find(LOAD_FRICTION).unwrap_or(0.0);
        let crossed = move |model: &DriveModel, segment: &Segment| -> Vec<Crossed> {
            let half = |i: usize| 0.5 * values.wheel("play", i, "rad") / ratio;
            let slows = |i: usize| friction / model.beyond_the_gear(i);
            (0..segment.angle.len()).map(|i| Crossed::new(segment, i, half(i), slows(i))).collect()
        };
        let crossed = std::sync::Arc::new(crossed);
        if friction > 0.0 {
            let (index, crossed) = (model.prepare.len(), crossed.clone());
            model.prepare.push(Box::new(move |model, segment| {
                crossed(model, segment).into_iter().map(|wheel| wheel.spared).collect()
            }));
            model.loads.push(Box::new(move |now, loads| {
                for (i, load) in loads.wheel.iter_mut().enumerate() {
                    *load += friction * now.prepared[index][i][now.tick];
                }
            }));
        }
        let ahead = move |model: &DriveModel, segment: &Segment| {
            crossed(model, segment).into_iter().map(|wheel| wheel.ahead).collect()
        };
        model.offsets.push((Ahead::Rotor, Box::new(ahead)));
    }

    fn takes_noise(&self) -> bool {
        // The wheel coasts past it. Two of 200 motors of any size that lack nothing had play without this.
        true
    }

    fn law_uncertainty(&self) -> f64 {
        // The rotor bounces between the flanks.
        0.08
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("turn the wheel by hand against the held motor, times the gear ratio", 3.0))
    }
}

/// Share of the dry friction that the wheel may have of its own: all, and as much as an estimate of that scatters by (0.87 to 1.06
/// of twelve simulated axes). Friction that gives way before it slips looked like play with 1.18 to 2.6 of the friction there was.
const MOST_HELD: f64 = 1.15;
/// Times a play that was found from which another one would have left less.
const NEXT: f64 = RATIO * RATIO;
/// Turns of the output that no gear with teeth has in play: a quarter turn is a shaft that has come loose. Without it, logs of
/// a staircase of settled speeds, whose rows no gear could tell from play, had 3 turns named beside a friction.
const MOST_TURNS: f64 = 0.25;
/// Square of the time within which a test function of [`TEST_FUNCTION_S`] shows a step of the angle (0.0023 s²) times the share of
/// the drive's torque that matters (0.034), s²: what makes it 0.03 rad on the paper's robot, as the blind bench has it.
const SHOWS: f64 = 7.8e-5;

/// How a wheel follows its rotor, on which the encoder sits, so that its motion is known: the wheel coasts, slowed down by its
/// own dry friction, until a flank takes it along, and leaves the flank when the rotor slows down faster. What moves the rotor
/// does not enter: beside rest its small torques say nothing of which flank carries.
struct Crossed {
    /// By how much the rotor is ahead of its wheel at every tick, rad at the wheel, at most half the play.
    ahead: Vec<f64>,
    /// Sense of the rotor's motion minus that of the wheel's, from each tick to the next.
    spared: Vec<f64>,
}

impl Crossed {
    /// With half the play, rad at the wheel; `slows` is what dry friction takes of a wheel that coasts, rad/s².
    fn new(segment: &Segment, wheel: usize, half: f64, slows: f64) -> Self {
        let speed = &segment.speed[wheel];
        let mut out = Self { ahead: vec![0.0; speed.len()], spared: vec![0.0; speed.len()] };
        if half == 0.0 {
            return out;
        }
        let (mut ahead, mut coasts) = (0.0, speed.first().copied().unwrap_or(0.0));
        for (k, w) in speed.windows(2).enumerate() {
            let dt = segment.t[k + 1] - segment.t[k];
            let (began, mean) = (coasts, 0.5 * (w[0] + w[1]));
            coasts -= (slows * dt).min(coasts.abs()).copysign(coasts);
            ahead += dt * (mean - 0.5 * (began + coasts));
            let mut goes = 0.5 * (began + coasts);
            if ahead.abs() > half {
                (ahead, coasts, goes) = (half.copysign(ahead), w[1], mean);
            }
            out.ahead[k + 1] = ahead;
            let sense = |w: f64| smooth_sign(w, segment.turning);
            out.spared[k] = sense(mean) - sense(goes);
        }
        out
    }
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
    fn a_wheel_coasts_across_the_play_when_its_rotor_turns_back() {
        let t: Vec<f64> = (0..2000).map(|k| 1e-3 * f64::from(k)).collect();
        // From 2 rad/s at 8 rad/s² to -2 rad/s within half a second, and on.
        let speed: Vec<f64> = t.iter().map(|t| 2.0 - 8.0 * (t - 0.5).clamp(0.0, 0.5)).collect();
        let segment = Segment { angle: vec![vec![0.0; t.len()]], speed: vec![speed], t, ..Segment::default() };
        let half = 0.05;
        let found = Crossed::new(&segment, 0, half, 0.0).ahead;
        // Nothing tells where it is before the rotor first slows down; then the rotor falls back by 4 t².
        let (before, t) = (found[500], 0.1);
        assert!((found[600] - (before - 4.0 * t * t)).abs() < 1e-3, "{} {before}", found[600]);
        let there = 500 + (1e3 * ((before + half) / 4.0).sqrt()).ceil() as usize + 2;
        assert!(found[there..].iter().all(|x| (x + half).abs() < 1e-12), "{:?}", &found[there..there + 9]);
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
