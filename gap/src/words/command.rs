//! Body velocities to set points, where the card does the inverse kinematics.

use fixed_kin::format::Speed;
use fixed_kin::kinematics::TWIST;
use fixed_kin::recording::SetPointWords;
use runs::robot::Robot;
use runs::{Columns, Log};

use super::{Card, Compared, NoWord, Signal, twist};
use crate::exact::{ExactLink, Replay};
use crate::parts::rows;
use links::effect::Link;

/// Share of the commands that may have arrived a tick late.
const LATE_SHARE: f64 = 0.01;
/// Control ticks without a command after which a card may have let the set points go.
const SILENT_TICKS: u64 = 5;

#[derive(Default)]
struct Tally {
    signals: Vec<Signal>,
    /// Set points that follow the command of the row before.
    late: usize,
}

/// Replays the set points of runs that have commands and set points.
pub(crate) fn command(robot: &Robot, logs: &[&Log]) -> Compared {
    // What is wrong with the words is said once, by the controller.
    let Ok(card) = Card::of(robot) else { return Compared::InFloatingPoint(None) };
    let Some(words) = card.words.set_points else { return Compared::InFloatingPoint(None) };
    let mut tally = Tally { signals: (0..robot.wheel_count()).map(|_| Signal::default()).collect(), late: 0 };
    for log in logs {
        if let Err(no_word) = replay(&card, &words, log, &mut tally) {
            return Compared::InFloatingPoint(Some(no_word.remark("Command")));
        }
    }
    Compared::Link(Box::new(tally.link(1.0 / card.per_rad_s)))
}

fn replay(card: &Card, words: &SetPointWords, log: &Log, tally: &mut Tally) -> Result<(), NoWord> {
    let mut before: Option<[i32; TWIST]> = None;
    let mut held = vec![None; tally.signals.len()];
    let columns = Columns { command: true, reference: true, ..Columns::NONE };
    for (part, row) in rows(log, columns) {
        let run = &part.run;
        let Some(command) = &run.command else { return Ok(()) };
        let since = card.since(run, row);
        let now = twist(run, command, &words.exponents, row)?;
        for (wheel, signal) in tally.signals.iter_mut().enumerate() {
            let logged = card.speed(run, "ref", &run.reference, wheel, row)?;
            let last = held[wheel].filter(|_| since == 1);
            held[wheel] = logged;
            let from = match last {
                Some(last) => last,
                None if words.is_slewed() => continue,
                None => Speed::ZERO,
            };
            let (Some(now), Some(logged)) = (now, logged) else { continue };
            let computed = words.step(wheel, from, &now);
            let is_late = || before.is_some_and(|twist| words.step(wheel, from, &twist) == logged);
            let is_let_go = || since >= SILENT_TICKS && words.step(wheel, from, &[0; TWIST]) == logged;
            if computed == logged {
                signal.same();
            } else if is_late() || is_let_go() {
                signal.same();
                tally.late += 1;
            } else {
                signal.wrong(run, row, logged.to_bits(), computed.to_bits());
            }
        }
        before = now;
    }
    Ok(())
}

impl Tally {
    fn link(self, lsb: f64) -> ExactLink {
        let compared: usize = self.signals.iter().map(|s| s.compared).sum();
        let different: usize = self.signals.iter().map(|s| s.different).sum();
        let places = self.signals.iter().enumerate().filter_map(|(i, s)| s.place(&format!("ref_{}", i + 1)));
        let mut places: Vec<String> = places.collect();
        let late_share = self.late as f64 / compared.max(1) as f64;
        if late_share > LATE_SHARE {
            places.push(format!("{} of {compared} set points follow the command of the tick before", self.late));
        }
        let late = if self.late > 0 {
            format!(", {} follow the command of the tick before", self.late)
        } else {
            String::new()
        };
        let remark =
            format!("Command: {compared} set points replayed in the card's arithmetic, {different} differ{late}.");
        let before: Vec<f64> = self.signals.iter().map(|s| lsb * s.rms()).collect();
        ExactLink {
            link: Link::Command,
            unit: "rad/s",
            floor: 0.5 * lsb,
            after: before.clone(),
            before,
            wrong_share: (different + self.late) as f64 / compared.max(1) as f64,
            finding: None,
            unexplained: !places.is_empty(),
            replay: Some(Replay {
                remark,
                structure: (!places.is_empty()).then(|| places.join("; ")),
                compared,
                different,
                ..Replay::default()
            }),
        }
    }
}
