//! Set points and measured speeds to duties.

use fixed_kin::format::{Format, Speed};
use fixed_kin::recording::{Compared as Word, LoopReplay};
use fixed_kin::speed::{SpeedMode, by_difference};
use runs::robot::Robot;
use runs::ticks::Gaps;
use runs::{Columns, Log, Run};

use super::{Card, Compared, NoWord, Signal, duty};
use crate::exact::{ExactLink, Replay};
use crate::parts::rows;
use links::effect::Link;

/// Everything that was compared.
#[derive(Default)]
struct Tally {
    duties: Vec<Signal>,
    speeds: Vec<Signal>,
    gaps: Gaps,
    /// Ticks on which all outputs were off although the loops say otherwise, and the time of the first, s.
    off: (usize, Option<f64>),
}

/// Replays the duties of runs that have set points, counts and duties.
pub(crate) fn controller(robot: &Robot, logs: &[&Log]) -> Compared {
    let card = match Card::of(robot) {
        Ok(card) => card,
        Err(why) => return Compared::InFloatingPoint(why),
    };
    let by_counts = card.words.speed_mode == SpeedMode::Difference;
    if let Some(log) = logs.iter().find(|log| log.layout().measured.is_empty() && !by_counts) {
        return Compared::Impossible(format!(
            "Controller: not compared, {} has no measured speeds (meas_1..), and by count and time they cannot be told from the counts.",
            log.name
        ));
    }
    let wheels = robot.wheel_count();
    let signals = || (0..wheels).map(|_| Signal::default()).collect();
    let mut tally = Tally { duties: signals(), speeds: signals(), ..Tally::default() };
    for log in logs {
        if let Err(no_word) = replay(&card, log, &mut tally) {
            return Compared::InFloatingPoint(Some(no_word.remark("Controller")));
        }
    }
    Compared::Link(Box::new(tally.link()))
}

fn replay(card: &Card, log: &Log, tally: &mut Tally) -> Result<(), NoWord> {
    let wheels = tally.duties.len();
    let mut loops = vec![LoopReplay::new(card.words.gains); wheels];
    let mut inputs = vec![None; wheels];
    let mut logged = vec![None; wheels];
    let columns = Columns { reference: true, counts: true, duty: true, measured: true, ..Columns::NONE };
    for (part, row) in rows(log, columns) {
        let run = &part.run;
        let since = card.since(run, row);
        if since > 1 {
            tally.gaps.pauses += 1;
            tally.gaps.missing += since - 1;
            loops.iter_mut().for_each(LoopReplay::lose);
        }
        for wheel in 0..wheels {
            let speed = speed(card, run, wheel, row, since, &mut tally.speeds[wheel])?;
            inputs[wheel] = card.speed(run, "ref", &run.reference, wheel, row)?.zip(speed);
            logged[wheel] = duty(run, wheel, row)?;
        }
        let zero = |wheel: usize| {
            inputs[wheel].is_some_and(|(r, _)| r == Speed::ZERO) && logged[wheel].is_some_and(|d| d == 0)
        };
        let next: Vec<(LoopReplay, Word)> = (0..wheels)
            .map(|wheel| {
                let mut replay = loops[wheel];
                let compared = match inputs[wheel] {
                    Some((reference, speed)) => replay.step(reference, speed, logged[wheel]),
                    None => {
                        replay.lose();
                        Word::Unknown
                    }
                };
                (replay, compared)
            })
            .collect();
        let differs = |w: &Word| matches!(w, Word::Different(_));
        if (0..wheels).all(zero) && next.iter().any(|(_, word)| differs(word)) {
            // Everything at zero at once: the card has switched off, and cleared its loops.
            tally.off.0 += 1;
            tally.off.1.get_or_insert(run.t[row]);
            loops.iter_mut().for_each(LoopReplay::clear);
            continue;
        }
        for (wheel, (replay, compared)) in next.into_iter().enumerate() {
            loops[wheel] = replay;
            match (compared, logged[wheel]) {
                (Word::Different(computed), Some(logged)) => {
                    tally.duties[wheel].wrong(run, row, logged.to_bits(), computed.to_bits());
                }
                (Word::Same, _) => tally.duties[wheel].same(),
                _ => {}
            }
        }
    }
    Ok(())
}

/// The speed the loop had: as logged, else from the counts, which are compared where both are there.
fn speed(
    card: &Card,
    run: &Run,
    wheel: usize,
    row: usize,
    since: u64,
    signal: &mut Signal,
) -> Result<Option<Speed>, NoWord> {
    let sampled = |row: usize| run.count_gaps.get(wheel).is_none_or(|gaps| gaps.binary_search(&row).is_err());
    let counted = (card.words.speed_mode == SpeedMode::Difference && since == 1 && sampled(row) && sampled(row - 1))
        .then(|| run.counts[wheel][row].wrapping_sub(run.counts[wheel][row - 1]))
        // The counter behind has 16 bits.
        .map(|counts| by_difference(i32::from(counts as i16), card.words.tick_period));
    if run.measured.is_empty() {
        return Ok(counted);
    }
    let measured = card.speed(run, "meas", &run.measured, wheel, row)?;
    if let (Some(counted), Some(measured)) = (counted, measured) {
        if counted == measured {
            signal.same();
        } else {
            signal.wrong(run, row, measured.to_bits(), counted.to_bits());
        }
    }
    Ok(measured)
}

impl Tally {
    fn link(self) -> ExactLink {
        let lsb = Format::DUTY.lsb();
        let count = |signals: &[Signal], of: fn(&Signal) -> usize| signals.iter().map(of).sum::<usize>();
        let (compared, wrong) = (count(&self.duties, |s| s.compared), count(&self.duties, |s| s.different));
        let (speeds, wrong_speeds) = (count(&self.speeds, |s| s.compared), count(&self.speeds, |s| s.different));
        let names = |stem: &'static str| move |(i, s): (usize, &Signal)| s.place(&format!("{stem}_{}", i + 1));
        let duties = self.duties.iter().enumerate().filter_map(names("duty"));
        let places: Vec<String> = duties.chain(self.speeds.iter().enumerate().filter_map(names("meas"))).collect();
        let mut remark = format!("Controller: {compared} duty words replayed in the card's arithmetic, {wrong} differ");
        if speeds > 0 {
            remark += &format!("; {speeds} speed words from the counts, {wrong_speeds} differ");
        }
        if let Some(gaps) = self.gaps.words() {
            remark += &format!("; {gaps}, after each the integrators are told by the duties");
        }
        if let (ticks, Some(first)) = self.off {
            remark += &format!("; outputs off on {ticks} ticks, first at {first:.4} s");
        }
        let different = wrong + wrong_speeds;
        let before: Vec<f64> = self.duties.iter().map(|s| lsb * s.rms()).collect();
        ExactLink {
            link: Link::Controller,
            unit: "duty",
            floor: 0.5 * lsb,
            after: before.clone(),
            before,
            wrong_share: different as f64 / (compared + speeds).max(1) as f64,
            finding: None,
            unexplained: different > 0,
            replay: Some(Replay {
                remark: remark + ".",
                structure: (different > 0).then(|| places.join("; ")),
                compared,
                different,
                gaps: self.gaps.pauses,
                missing: self.gaps.missing,
            }),
        }
    }
}
