//! The counts of a wheel turn that the controller reckons with, where they are not those of the file.
//!
//! Set points and gains are in rad/s, encoders give counts: the duties replay with one number of counts a turn alone.
//! It is told only by duties that replay with it and neither with the file's number nor with other gains.

use runs::robot::Robot;
use runs::{CountSource, Log};

use super::replay::{Replayed, replay, totals, walk};
use super::{ENCODER_SCALE, LOOP_SCALE, Law, at_rate, stated, with_loops};
use crate::evidence::{Evidence, Interval, Ticks};
use crate::exact::Finding;
use crate::thresholds::Thresholds;
use links::effect::Link;

/// Duty from which an output counts as saturated, where it says nothing of the speed: 1, but for rounding.
const SATURATED: f64 = 0.995;
/// First and last step of the search about what the changes of the duties say, relative.
const STEPS: [f64; 2] = [0.01, 1e-6];

/// Whether the loop's speeds are those of the counts: not where a log has them as measured, or has no counts.
fn by_counts(logs: &[&Log]) -> bool {
    let of_encoders =
        |log: &&Log| log.layout().measured.is_empty() && log.layout().source.counts == CountSource::Encoders;
    logs.iter().all(of_encoders)
}

fn is_exact(wheels: &[Replayed], differs: f64) -> bool {
    wheels.iter().all(|w| w.ticks > 0 && w.wrong_share() <= differs)
}

/// The number of counts with which all duties replay, if the file's gains do it with no other, and the RMS beyond rounding
/// of every wheel that is left (duty); `nominally` are the ticks with the file's number.
pub(super) fn counted(
    robot: &Robot,
    logs: &[&Log],
    nominal: &Law,
    floor: f64,
    nominally: Ticks,
    differs: f64,
) -> Option<(Finding, Vec<f64>)> {
    if !by_counts(logs) {
        return None;
    }
    let with = |counts: f64| Law { counts, ..*nominal };
    let square = |counts: f64| replay(robot, logs, &with(counts), floor).iter().map(|w| w.rms * w.rms).sum::<f64>();
    let mut best = by_changes(robot, logs, nominal)?;
    let mut left = square(best);
    let mut step = STEPS[0];
    while step > STEPS[1] && left > 0.0 {
        let tried = [best * (1.0 - step), best * (1.0 + step)].map(|counts| (square(counts), counts));
        let [low, high] = tried;
        let nearest = if low.0 < high.0 { low } else { high };
        if nearest.0 < left {
            (left, best) = nearest;
        } else {
            step *= 0.3;
        }
    }
    let replayed = replay(robot, logs, &with(best), floor);
    // Set points at rest: then other gains do the same, and which of the two it is does not show.
    let share = nominal.counts / best;
    let gains = Law { kp: nominal.kp * share, ki: nominal.ki * share, ..*nominal };
    if !is_exact(&replayed, differs) || is_exact(&replay(robot, logs, &gains, floor), differs) {
        return None;
    }
    let exact = |counts: f64| is_exact(&replay(robot, logs, &with(counts), floor), differs);
    let end = |sign: f64| {
        let mut off = STEPS[1];
        while off < 0.5 && exact(best * (1.0 + sign * off)) {
            off *= 2.0;
        }
        best * (1.0 + sign * off) - 1.0
    };
    let finding = Finding {
        link: Link::Controller,
        name: ENCODER_SCALE,
        wheels: Vec::new(),
        parameters: vec![(LOOP_SCALE.to_owned(), best - 1.0, Interval::Resolution([end(-1.0), end(1.0)]))],
        evidence: Evidence::Replay { nominal: nominally, with: totals(&replayed) },
    };
    Some((finding, replayed.iter().map(|w| w.rms).collect()))
}

/// What the changes of the duties from tick to tick say by least squares, without an integrator to know.
fn by_changes(robot: &Robot, logs: &[&Log], law: &Law) -> Option<f64> {
    let rate = robot.control_rate_hz;
    let per_count = rate / robot.counts_per_wheel_rad();
    let older = law.shift.into_iter().max().unwrap_or(0) + 1;
    let (mut square, mut mixed) = (0.0, 0.0);
    for log in logs {
        walk(robot, log, |run, ticks, k, steady| {
            if steady <= older || k <= older {
                return;
            }
            for (wheel, duty) in run.duty.iter().enumerate() {
                let speed = |k: usize| ticks.moved(wheel, k - law.shift[0]).map_or(f64::NAN, |n| n as f64 * per_count);
                let set = |k: usize| run.reference[wheel][k - law.shift[1]];
                let change = |of: &dyn Fn(usize) -> f64| law.kp * (of(k) - of(k - 1)) + law.ki / rate * of(k);
                let (of_speed, left) = (change(&speed), change(&set) - (duty[k] - duty[k - 1]));
                if duty[k].abs().max(duty[k - 1].abs()) < SATURATED && of_speed.is_finite() && left.is_finite() {
                    square += of_speed * of_speed;
                    mixed += of_speed * left;
                }
            }
        });
    }
    // Speeds are that many times those of the file.
    let share = mixed / square;
    (share.is_finite() && share > 0.0).then(|| 1.0 / share)
}

/// What of the duties is wrong with the file's counts, and with as many more. `None` where no counts tell, or where the
/// duties do not replay with the file's.
pub(crate) fn with_other_counts(
    robot: &Robot,
    logs: &[Log],
    scale: f64,
    thresholds: &Thresholds,
) -> Option<[Ticks; 2]> {
    let differs = thresholds.differs[1];
    let logs = at_rate(robot, with_loops(robot, logs), thresholds);
    if logs.is_empty() || !by_counts(&logs) {
        return None;
    }
    let ([.., floor], nominal) = stated(robot, &logs);
    let other = Law { counts: nominal.counts * (1.0 + scale), ..nominal };
    let [ours, theirs] = [nominal, other].map(|law| replay(robot, &logs, &law, floor));
    let [with_ours, with_theirs] = [&ours, &theirs].map(|wheels| totals(wheels));
    (is_exact(&ours, differs) && !is_exact(&theirs, differs)).then_some([with_ours, with_theirs])
}
