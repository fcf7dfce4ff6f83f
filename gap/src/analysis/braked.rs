//! A bridge that swallows small duties, one that takes volts off, and a dry friction do the same as long as nothing works
//! against what turns.

use std::sync::Arc;

use super::ratios::{DEAD_BAND, FRICTIONS};
use super::study::Outcome;
use super::workflow::Workflow;
use crate::state::State;
use links::drive::DriveLink;
use links::effect::Effect;
use links::pieces::Pieces;
use runs::robot::Robot;

impl<'a> Workflow<'a> {
    /// The dry friction that a bridge may be as well where its motor does not brake, tied with it: of the two it is the
    /// likelier. Nothing where no such bridge is named, where motors brake, or where that is no friction: then what drops
    /// volts, which differs in nothing but braking, is tied with it as it is.
    pub(super) fn unbraked(
        &mut self,
        link: &DriveLink,
        outcome: &mut Outcome,
        here: &[Arc<dyn Effect>],
    ) -> Option<(DriveLink<'a>, Outcome)> {
        let named = |outcome: &Outcome, name: &str| outcome.named.iter().any(|n| n.name == name);
        let bridge = BRIDGES.into_iter().find(|name| named(outcome, name)).filter(|_| !named(outcome, FRICTION))?;
        let [most, surely] = self.thresholds.braked;
        let share = if bridge == BRIDGE_DROP {
            braked_by_motor(link, &self.start, surely)
        } else {
            braked(self.searched().pieces, surely)
        };
        if share > most {
            return None;
        }
        let others: Vec<_> = here.iter().filter(|e| !BRIDGES.contains(&e.name())).cloned().collect();
        let mut again = self.drive_again(&others).filter(|(_, again)| named(again, FRICTION));
        let tied = match &mut again {
            Some((_, friction)) => friction,
            None if bridge == BRIDGE_DROP => outcome,
            None => return None,
        };
        tied.tie(&[FRICTION, bridge], true);
        let [works, does] = if bridge == BRIDGE_DROP {
            ["Motors hardly ever work", "takes volts off"]
        } else {
            ["Duties hardly ever work", "swallows small duties"]
        };
        self.findings.remarks.push(format!(
            "{works} against what turns ({:.1} % of the time): a bridge that {does} does what dry friction does. Brake by the \
             motor, and they differ.",
            100.0 * share
        ));
        again
    }
}

/// The friction that such bridges look like.
const FRICTION: &str = FRICTIONS[0];
const BRIDGE_DROP: &str = "bridge-drop";
const BRIDGES: [&str; 2] = [DEAD_BAND, BRIDGE_DROP];

/// Instants in which a wheel surely turned, and those of them in which something worked against that.
#[derive(Default)]
struct Turned {
    all: u64,
    braked: u64,
}

impl Turned {
    fn count(&mut self, braked: bool) {
        self.all += 1;
        self.braked += u64::from(braked);
    }

    fn share(&self) -> f64 {
        self.braked as f64 / self.all.max(1) as f64
    }
}

/// Share of the rows in which a wheel surely turned, by that speed, whose duties worked against that.
fn braked(pieces: &Pieces, surely: f64) -> f64 {
    let mut turned = Turned::default();
    for s in pieces.iter() {
        for (duty, speed) in s.duty.iter().zip(&s.speed) {
            let rows = s.own.clone().filter(|k| speed[*k].abs() > surely * s.turning);
            rows.for_each(|k| turned.count(duty[k] * speed[k] < 0.0));
        }
    }
    turned.share()
}

/// Share of the test functions in which a wheel surely turned whose motor worked against that: it brakes as soon as the wheel
/// turns faster than the duty would have it, which single rows of a coarse encoder do not tell.
fn braked_by_motor(link: &DriveLink, start: &State, surely: f64) -> f64 {
    let n = link.noise.len();
    let turning = link.at_middles(|s, _| s.turning);
    let means = link.means(2 * n, |s, k, out| {
        for (i, slot) in out.chunks_exact_mut(2).enumerate() {
            slot.copy_from_slice(&[s.speed[i][k], s.duty[i][k] * s.supply[k]]);
        }
    });
    let done = link.done(&start.drive(None));
    let mut turned = Turned::default();
    for (i, wheel) in means.chunks_exact(2).enumerate() {
        let instants = wheel[0].iter().zip(&wheel[1]).zip(&turning).zip(&done);
        let surely = instants.filter(|(((speed, _), turning), _)| speed.abs() > surely * **turning);
        // Along the motion: speed, volts, and what its acceleration takes.
        let along: Vec<[f64; 3]> = surely
            .map(|(((speed, volts), _), done)| [speed.abs(), volts * speed.signum(), done[i] * speed.signum()])
            .collect();
        let per_volt = speed_per_volt(&along, &start.robot);
        along.iter().for_each(|[speed, volts, _]| turned.count(*speed > per_volt * volts));
    }
    turned.share()
}

/// Speed per volt at no load: the file's, or that of a motor which turned faster while it was driven hard and did not slow
/// down, rad/s per V.
fn speed_per_volt(along: &[[f64; 3]], robot: &Robot) -> f64 {
    let of_file = robot.no_load_wheel_speed(robot.supply_v) / robot.supply_v;
    let most = along.iter().map(|[_, volts, _]| *volts).fold(0.0, f64::max);
    let hard = along.iter().filter(|[_, volts, done]| *volts > DRIVEN_HARD * most && *done >= 0.0);
    hard.map(|[speed, volts, _]| speed / volts).fold(of_file, f64::max)
}

/// Share of the largest voltage from which a motor is driven hard: near none any speed is one of no load.
const DRIVEN_HARD: f64 = 0.5;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motor_that_is_faster_than_its_file_brakes_no_more_for_it() {
        let robot = Robot::racbot();
        let of_file = robot.no_load_wheel_speed(1.0);
        // Up to speed at a third more than the file's, hardly driven and coasting at any.
        let of_motor = 1.3 * of_file;
        let mut along: Vec<[f64; 3]> = (1..=6).map(|v| [of_motor * f64::from(v), f64::from(v), 0.0]).collect();
        along.extend([[9.0 * of_file, 0.5, 0.0], [9.0 * of_file, 5.0, -1e-3]]);
        assert!((speed_per_volt(&along, &robot) / of_motor - 1.0).abs() < 1e-12);
        assert_eq!(speed_per_volt(&[[0.5 * of_file, 1.0, 1e-3]], &robot), of_file);
    }
}
