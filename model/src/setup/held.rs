//! What no sensor reads: set points in the column of a measured speed, as headers that were shifted by one give them, and currents
//! of a drive that is off, of which the last one stays in the log; and what drives, where nothing but 0 was written.

use runs::robot::Robot;
use runs::{Columns, DutySource, Log, is_from_speeds};

use super::samples::{HELD, MOST_TICKS};
use super::{Mistake, short};

/// Rows from which anything is said.
const FEWEST: usize = 200;
/// Share of the rows in which such a speed changes at most, and in which the duty of its wheel changes at least: where a bridge
/// is told something else that often, a speed that is measured moves with it, however coarse.
const CHANGES: [f64; 2] = [0.01, 0.25];
/// Share of the rows in which it is not 0 at least: a wheel that rests is one that stands still.
const TURNS: f64 = 0.5;

/// Rows, and those in which the speed of a wheel changes, its duty does, and it turns.
#[derive(Default)]
struct Rows {
    all: usize,
    speed: usize,
    duty: usize,
    turns: usize,
}

/// Rows in which a current stays the same to the last digit, from which none was read: of a sensor that else changes in so much
/// of its rows that comes by chance in no log.
const STALE: usize = 25;
const READ: f64 = 0.75;
/// Rows after those in which a sensor that is coarse shows that it read a steady current, and the share of them that is as near to
/// it as it resolves.
const BESIDE: usize = 12;
const NEAR: f64 = 0.5;
/// Share of its speed that an axis keeps whose drive is on: of a loop, to what counts resolve.
const KEEPS: f64 = 0.98;
/// Counts by which the axis turns meanwhile: one that rests may hold its load by a current that is asked for.
const TURNED: i64 = 25;

pub(super) fn mistakes(robot: &Robot, logs: &[Log]) -> Vec<Mistake> {
    let mut found = speeds(robot, logs);
    let currents = logs.first().is_some_and(|log| log.layout().source.duties == DutySource::Currents);
    found.extend(undriven(logs, if currents { "current" } else { "duty" }));
    if currents {
        found.extend((0..robot.wheel_count()).filter_map(|axis| stale(logs, axis)));
    }
    found
}

/// What drives, of no wheel ever anything but 0 though one turns: drivers fill in so what they do not measure, as the efforts of
/// joints. A model whose motors give nothing explains any motion by weights and springs.
fn undriven(logs: &[Log], stem: &str) -> Option<Mistake> {
    let (mut rows, mut wheels, mut turned) = (0, 0, 0);
    for log in logs {
        let columns = Columns { duty: true, counts: true, sensors: true, ..Columns::NONE };
        let run = log.part(0..log.len().min(MOST_TICKS), columns);
        let drives = if stem == "duty" { &run.duty } else { &run.current };
        if drives.iter().flatten().any(|x| x.is_finite() && *x != 0.0) {
            return None;
        }
        wheels = drives.len();
        rows += drives.first().map_or(0, |drive| drive.iter().filter(|x| x.is_finite()).count());
        let ends = |counts: &[i64]| counts.iter().max().zip(counts.iter().min()).map(|(most, least)| most - least);
        turned = run.counts.iter().filter_map(|counts| ends(counts)).fold(turned, i64::max);
    }
    if rows < FEWEST || turned < TURNED {
        return None;
    }
    let column = if wheels > 1 { format!("{stem}_1..{wheels}") } else { format!("{stem}_1") };
    let what = format!(
        "nothing but 0 in {rows} rows though {}: it was not logged",
        if wheels > 1 { "wheels turn" } else { "the axis turns" }
    );
    let remedy = "leave it out of the map, or log what drives; where really nothing does, as of what swings freely, \
                  --despite-mistakes goes on";
    Some(Mistake::new("drive-not-logged", &column, what, remedy.to_owned()))
}

fn speeds(robot: &Robot, logs: &[Log]) -> Vec<Mistake> {
    if !is_from_speeds(robot) {
        return Vec::new();
    }
    let mut wheels: Vec<Rows> = (0..robot.wheel_count()).map(|_| Rows::default()).collect();
    for log in logs {
        let columns = Columns { duty: true, sensors: true, ..Columns::NONE };
        let run = log.part(0..log.len().min(MOST_TICKS), columns);
        for ((rows, speed), duty) in wheels.iter_mut().zip(&run.speed).zip(&run.duty) {
            let both = |k: &usize| speed[*k].is_finite() && duty[*k].is_finite();
            let sampled: Vec<usize> = (0..speed.len().min(duty.len())).filter(both).collect();
            let changes = |of: &[f64]| sampled.windows(2).filter(|k| of[k[0]] != of[k[1]]).count();
            rows.all += sampled.len();
            rows.speed += changes(speed);
            rows.duty += changes(duty);
            rows.turns += sampled.iter().filter(|k| speed[**k] != 0.0).count();
        }
    }
    let told = |(i, rows): (usize, &Rows)| {
        let share = |n: usize| n as f64 / rows.all.max(1) as f64;
        let held = rows.speed > 0 && share(rows.speed) <= CHANGES[0] && share(rows.duty) >= CHANGES[1];
        if rows.all < FEWEST || !held || share(rows.turns) < TURNS {
            return None;
        }
        let column = format!("speed_{}", i + 1);
        let what = format!(
            "it changes in {} of {} rows and duty_{} in {}: no motor holds its speed like that, it looks like a set point",
            rows.speed,
            rows.all,
            i + 1,
            rows.duty
        );
        let remedy = format!("write it as ref_{}; what was measured may stand under another header", i + 1);
        Some(Mistake::new("speed-asked-for", &column, what, remedy))
    };
    wheels.iter().enumerate().filter_map(told).collect()
}

/// A current that stays in the log while its axis turns on. None of a loop that reaches its limit, nor 0, nor what is asked for
/// and seldom changes, or drives: an axis that is off gains no speed. Nor what a coarse sensor reads of an even drive.
fn stale(logs: &[Log], axis: usize) -> Option<Mistake> {
    let (mut rows, mut changes, mut longest) = (0, 0, None::<(f64, f64, &str)>);
    for log in logs {
        let columns = Columns { duty: true, counts: true, sensors: true, ..Columns::NONE };
        let run = log.part(0..log.len().min(MOST_TICKS), columns);
        let (Some(current), Some(counts)) = (run.current.get(axis), run.counts.get(axis)) else { continue };
        let most = current.iter().filter(|i| i.is_finite()).fold(0.0_f64, |most, i| most.max(i.abs()));
        let step = finest(current);
        let mut from = 0;
        for same in current.chunk_by(|a, b| a == b) {
            let to = from + same.len() - 1;
            let size = same[0].abs();
            let turned = counts[to].wrapping_sub(counts[from]).abs();
            if same.len() >= STALE && size > 0.0 {
                let lasted = run.t[to] - run.t[from];
                if is_driven(&counts[from..=to], same[0]) {
                    return None;
                }
                let told = size < HELD * most && turned >= TURNED && longest.is_none_or(|(most, ..)| lasted > most);
                if told && !is_even(current, counts, [from, to], step) {
                    longest = Some((lasted, same[0], log.name.as_str()));
                }
            } else if size > 0.0 {
                rows += same.len();
                changes += 1;
            }
            from = to + 1;
        }
    }
    let (lasted, value, name) = longest.filter(|_| changes as f64 >= READ * rows as f64 && rows >= FEWEST)?;
    let column = format!("current_{}", axis + 1);
    let what = format!(
        "it stays at {} A for {} s of {name} while the axis turns, and else changes from row to row: the last reading of a drive \
         that is off",
        short(value),
        short(lasted)
    );
    let remedy = "write 0 where the drive is off, or leave those rows out".to_owned();
    Some(Mistake::new("current-held", &column, what, remedy))
}

/// What a sensor resolves: the least by which its readings differ.
fn finest(current: &[f64]) -> f64 {
    let steps = current.windows(2).map(|i| (i[1] - i[0]).abs());
    steps.filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min)
}

/// Whether a coarse sensor read the same of an even drive: the axis then loses no speed, or is next read so as well, which a
/// drive that begins again is not.
fn is_even(current: &[f64], counts: &[i64], [from, to]: [usize; 2], step: f64) -> bool {
    let [first, last] = thirds(&counts[from..=to]).map(|turned| turned as f64);
    let beside = &current[to + 1..current.len().min(to + 1 + BESIDE)];
    let near = beside.iter().filter(|i| (**i - current[from]).abs() < 1.5 * step).count();
    last.abs() + 1.0 >= KEEPS * first.abs() || near > 0 && near as f64 >= NEAR * beside.len() as f64
}

/// By how much an axis turns in the first third of these rows, and in the last.
fn thirds(counts: &[i64]) -> [i64; 2] {
    let third = counts.len() / 3;
    let turned = |rows: &[i64]| rows[rows.len() - 1].wrapping_sub(rows[0]);
    [turned(&counts[..=third]), turned(&counts[counts.len() - 1 - third..])]
}

/// Whether an axis turns farther in the last third of these rows than in the first, and the way that its current drives it.
fn is_driven(counts: &[i64], current: f64) -> bool {
    let [first, last] = thirds(counts);
    last as f64 * current > 0.0 && last.abs() > first.abs() + TURNED
}
