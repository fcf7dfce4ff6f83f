//! What of a loop that no effect of the catalogue replays can be told in words: a limit of its output, and loops of single
//! wheels.

use runs::Log;
use runs::robot::Robot;

use super::replay::{Replayed, replay};
use super::{DUTIES, Law, fit_gains};
use crate::thresholds::Thresholds;

/// Duty by which the largest values of an output may differ: more than its rounding, where that is coarse.
const SAME: f64 = 1e-3;

/// What is asked again and again: the robot, its logs, the law of its file, and what rounding leaves.
struct Question<'a> {
    robot: &'a Robot,
    logs: &'a [&'a Log<'a>],
    nominal: &'a Law,
    floor: f64,
    thresholds: &'a Thresholds,
}

/// In words; `None` where neither replays what differs by the `nominal` law.
pub(super) fn structure(
    robot: &Robot,
    logs: &[&Log],
    nominal: &Law,
    floor: f64,
    nominally: &[Replayed],
    thresholds: &Thresholds,
) -> Option<String> {
    let question = Question { robot, logs, nominal, floor, thresholds };
    question.limit().or_else(|| question.wheels(nominally))
}

impl Question<'_> {
    fn replay(&self, law: &Law) -> Vec<Replayed> {
        replay(self.robot, self.logs, law, self.floor)
    }

    fn is_replayed(&self, wheel: &Replayed) -> bool {
        wheel.wrong_share() <= self.thresholds.differs[1]
    }

    /// A limit of the output below full duty, with which everything replays.
    fn limit(&self) -> Option<String> {
        let most = largest(self.logs, self.thresholds)?;
        let held = |held_from: f64| Law { most, held_from, ..*self.nominal };
        let replays = |law: Law| self.replay(&law).iter().all(|wheel| self.is_replayed(wheel));
        let goes_on = replays(held(1.0));
        (goes_on || replays(held(most))).then(|| {
            let integrator = if goes_on { ", while the integrator goes on to that of full duty" } else { "" };
            format!("duties are limited to {most:.3}{integrator}: with that limit they replay, and the file has none")
        })
    }

    /// Loops of some wheels that differ while those of the others replay, and the gains that come nearest.
    fn wheels(&self, nominally: &[Replayed]) -> Option<String> {
        let differ: Vec<usize> = (0..nominally.len()).filter(|i| !self.is_replayed(&nominally[*i])).collect();
        if differ.len() == nominally.len() || self.nominal.ki == 0.0 {
            return None;
        }
        let own = |i: usize| {
            let square = |law: &Law| self.replay(law)[i].rms.powi(2);
            // From the file's gains, and from those in each other's place: a search by steps does not find its way there.
            let swapped = Law { kp: self.nominal.ki, ki: self.nominal.kp, ..*self.nominal };
            let found = [*self.nominal, swapped].map(|from| fit_gains(&from, square));
            let law = found.into_iter().min_by(|a, b| square(a).total_cmp(&square(b)))?;
            // As much as a finding of gains that all loops have must mend.
            let (before, left) = (&nominally[i], self.replay(&law)[i]);
            let mends = left.rms.powi(2) < (1.0 - self.thresholds.removes[1]) * before.rms.powi(2)
                && left.wrong as f64 <= self.thresholds.left_wrong * before.wrong as f64;
            mends.then(|| format!("nearest to that of wheel {} come kp = {:.4} and ki = {:.4}", i + 1, law.kp, law.ki))
        };
        let names: Vec<String> = differ.iter().map(|i| format!("wheel {}", i + 1)).collect();
        let gains: Vec<String> = differ.iter().filter_map(|i| own(*i)).collect();
        let gains = if gains.is_empty() { String::new() } else { format!("; {}", gains.join(", ")) };
        Some(format!(
            "the loop of {} differs at {:.1} % of the ticks, while those of the other wheels replay by the file's gains{gains}",
            names.join(" and of "),
            100.0 * differ.iter().map(|i| nominally[*i].wrong_share()).fold(0.0, f64::max)
        ))
    }
}

/// The largest duty, where it is below full duty and the duties often lie there.
fn largest(logs: &[&Log], thresholds: &Thresholds) -> Option<f64> {
    let each = |f: &mut dyn FnMut(f64)| {
        for log in logs {
            for part in crate::parts::parts(log, DUTIES) {
                part.run
                    .duty
                    .iter()
                    .flat_map(|d| &d[part.own.clone()])
                    .filter(|d| d.is_finite())
                    .for_each(|d| f(d.abs()));
            }
        }
    };
    let (mut most, mut all, mut there) = (0.0_f64, 0_u64, 0_u64);
    each(&mut |d| (most, all) = (most.max(d), all + 1));
    each(&mut |d| there += u64::from(d >= most - SAME));
    let [full, often] = thresholds.limited;
    (most < full && there as f64 >= often * all as f64 && there > 0).then_some(most)
}

#[cfg(test)]
mod tests {
    use std::borrow::Cow;

    use model::effects::Applied;
    use model::manoeuvre::{Manoeuvre, simulate};
    use model::pi::PiLaw;
    use runs::Run;
    use runs::frames::Pose;
    use runs::ticks::Ticks;

    use super::*;

    const FLOOR: f64 = 0.000_5 + super::super::SLACK;

    /// The duties that loops of these gains and limits would give for what a drive did.
    fn given_by(robot: &Robot, gains: &[[f64; 2]], most: f64) -> Run {
        let mut run = simulate(Manoeuvre::Chirp, &Applied::of(robot), robot, Pose::default(), 3).unwrap();
        let ticks = Ticks::new(robot, &run);
        let per_count = robot.control_rate_hz / robot.counts_per_wheel_rad();
        let duty = |wheel: usize| -> Vec<f64> {
            let [kp, ki] = gains[wheel];
            let law = PiLaw { kp, ki, rate_hz: robot.control_rate_hz, duty_quantum: 0.001, integral_limit: None };
            let mut integral = 0.0;
            let speed = |k: usize| if k == 0 { 0.0 } else { ticks.moved(wheel, k).unwrap_or(0) as f64 * per_count };
            let output = |k: usize| law.step(&mut integral, run.reference[wheel][k], speed(k)).clamp(-most, most);
            (0..run.len()).map(output).collect()
        };
        run.duty = (0..gains.len()).map(duty).collect();
        run
    }

    #[test]
    fn a_limit_and_gains_of_one_wheel_are_told() {
        let robot = Robot { duty_quantum: Some(0.001), ..Robot::racbot() };
        let own = [robot.pi.kp, robot.pi.ki];
        let nominal = Law { kp: own[0], ki: own[1], duty_quantum: 0.001, ..Law::PLAIN };
        let told = |run: Run| {
            let log = Log::from(Cow::Owned(run));
            let nominally = replay(&robot, &[&log], &nominal, FLOOR);
            (structure(&robot, &[&log], &nominal, FLOOR, &nominally, &Thresholds::default()), nominally)
        };
        let (_, as_filed) = told(given_by(&robot, &[own; 3], 1.0));
        let is_replayed = |w: &Replayed| w.wrong_share() <= Thresholds::default().differs[1];
        assert!(as_filed.iter().all(is_replayed), "{as_filed:?}");
        let (limited, differs) = told(given_by(&robot, &[own; 3], 0.2));
        assert!(!differs.iter().all(is_replayed), "{differs:?}");
        assert!(
            limited.as_ref().is_some_and(|said| said.starts_with("duties are limited to 0.200, while")),
            "{limited:?}"
        );
        // More of one gain, and both in each other's place.
        for [kp, ki] in [[1.3 * own[0], own[1]], [own[1], own[0]]] {
            let (one, _) = told(given_by(&robot, &[own, [kp, ki], own], 1.0));
            let one = one.unwrap();
            assert!(one.starts_with("the loop of wheel 2 differs"), "{one}");
            let found = |name: &str| -> f64 {
                let value = one.split(name).nth(1).and_then(|rest| rest.split([' ', ',']).next());
                value.and_then(|v| v.parse().ok()).unwrap_or_else(|| panic!("{one}"))
            };
            assert!((found("kp = ") / kp - 1.0).abs() < 0.01 && (found("ki = ") / ki - 1.0).abs() < 0.05, "{one}");
        }
    }
}
