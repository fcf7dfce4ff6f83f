//! The counts of a wheel turn that the controller reckons with, where they are not those of the file.
//!
//! Set points and gains are in rad/s, encoders give counts: the duties replay with one number of counts a turn alone.
//! It is told only by duties that replay with it and neither with the file's number nor with other gains.

use runs::robot::Robot;
use runs::ticks::Ticks;
use runs::{CountSource, Log};

use super::replay::{Replayed, replay};
use super::{COLUMNS, ENCODER_SCALE, LOOP_SCALE, Law, WRONG_SHARE, at_rate, stated, with_loops};
use crate::effect::Link;
use crate::evidence::{Evidence, Interval};
use crate::exact::Finding;
use crate::parts::parts;

/// Duty from which an output counts as saturated, where it says nothing of the speed: 1, but for rounding.
const SATURATED: f64 = 0.995;
/// First and last step of the search about what the changes of the duties say, relative.
const STEPS: [f64; 2] = [0.01, 1e-6];

/// Duties that replay with another number of counts than the file's.
pub(super) struct Counted {
    /// That number less one, in those of the file.
    scale: f64,
    /// Between which it lies.
    within: [f64; 2],
    /// RMS beyond rounding of every wheel, duty.
    pub(super) rms: Vec<f64>,
    ticks: u64,
    wrong: u64,
}

impl Counted {
    pub(super) fn finding(&self, wrong_before: u64) -> Finding {
        Finding {
            link: Link::Controller,
            name: ENCODER_SCALE,
            wheels: Vec::new(),
            parameters: vec![(LOOP_SCALE.to_owned(), self.scale, Interval::Resolution(self.within))],
            evidence: Evidence::Replay { ticks: self.ticks, wrong: [wrong_before, self.wrong] },
        }
    }
}

/// Whether the loop's speeds are those of the counts: not where a log has them as measured, or has no counts.
fn by_counts(logs: &[&Log]) -> bool {
    let of_encoders =
        |log: &&Log| log.layout().measured.is_empty() && log.layout().source.counts == CountSource::Encoders;
    logs.iter().all(of_encoders)
}

fn is_exact(wheels: &[Replayed]) -> bool {
    wheels.iter().all(|w| w.ticks > 0 && w.wrong_share() <= WRONG_SHARE)
}

/// The number of counts with which all duties replay, if the file's gains do it with no other.
pub(super) fn counted(robot: &Robot, logs: &[&Log], nominal: &Law, floor: f64) -> Option<Counted> {
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
    if !is_exact(&replayed) || is_exact(&replay(robot, logs, &gains, floor)) {
        return None;
    }
    let exact = |counts: f64| is_exact(&replay(robot, logs, &with(counts), floor));
    let end = |sign: f64| {
        let mut off = STEPS[1];
        while off < 0.5 && exact(best * (1.0 + sign * off)) {
            off *= 2.0;
        }
        best * (1.0 + sign * off) - 1.0
    };
    Some(Counted {
        scale: best - 1.0,
        within: [end(-1.0), end(1.0)],
        rms: replayed.iter().map(|w| w.rms).collect(),
        ticks: replayed.iter().map(|w| w.ticks).sum(),
        wrong: replayed.iter().map(|w| w.wrong).sum(),
    })
}

/// What the changes of the duties from tick to tick say by least squares, without an integrator to know.
fn by_changes(robot: &Robot, logs: &[&Log], law: &Law) -> Option<f64> {
    let rate = robot.control_rate_hz;
    let per_count = rate / robot.counts_per_wheel_rad();
    let older = law.shift.into_iter().max().unwrap_or(0) + 1;
    let (mut square, mut mixed) = (0.0, 0.0);
    for log in logs {
        let mut steady = 0;
        for part in parts(log, COLUMNS) {
            let run = &part.run;
            let ticks = Ticks::with_period(robot, run, log.tick_s());
            for k in part.own.clone() {
                steady = if ticks.since(k) == 1 { steady + 1 } else { 0 };
                if steady <= older || k <= older {
                    continue;
                }
                for wheel in 0..run.duty.len() {
                    let duty = &run.duty[wheel];
                    let speed =
                        |k: usize| ticks.moved(wheel, k - law.shift[0]).map_or(f64::NAN, |n| n as f64 * per_count);
                    let set = |k: usize| run.reference[wheel][k - law.shift[1]];
                    let change = |of: &dyn Fn(usize) -> f64| law.kp * (of(k) - of(k - 1)) + law.ki / rate * of(k);
                    let (of_speed, left) = (change(&speed), change(&set) - (duty[k] - duty[k - 1]));
                    if duty[k].abs().max(duty[k - 1].abs()) < SATURATED && of_speed.is_finite() && left.is_finite() {
                        square += of_speed * of_speed;
                        mixed += of_speed * left;
                    }
                }
            }
        }
    }
    // Speeds are that many times those of the file.
    let share = mixed / square;
    (share.is_finite() && share > 0.0).then(|| 1.0 / share)
}

/// What of the duties is wrong with the file's counts and with as many more: ticks in all, wrong with the file's and with
/// the others. `None` where no counts tell, or where the duties do not replay with the file's.
pub(crate) fn with_other_counts(robot: &Robot, logs: &[Log], scale: f64) -> Option<(u64, [u64; 2])> {
    let logs = at_rate(robot, with_loops(robot, logs));
    if logs.is_empty() || !by_counts(&logs) {
        return None;
    }
    let ([.., floor], nominal) = stated(robot, &logs);
    let other = Law { counts: nominal.counts * (1.0 + scale), ..nominal };
    let [ours, theirs] = [nominal, other].map(|law| replay(robot, &logs, &law, floor));
    let wrong = |wheels: &[Replayed]| wheels.iter().map(|w| w.wrong).sum::<u64>();
    (is_exact(&ours) && !is_exact(&theirs))
        .then(|| (ours.iter().map(|w| w.ticks).sum(), [wrong(&ours), wrong(&theirs)]))
}
