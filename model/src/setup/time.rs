//! The unit of time, and the control rate.

use super::{Mistake, short};
use estimation::statistics::median;
use runs::robot::Robot;
use runs::{Columns, Log};

/// Longest and shortest tick that a log has, s: 2 Hz and 100 kHz.
const TICKS: [f64; 2] = [1e-5, 0.5];
/// Units that are mistaken for seconds.
const UNITS: [(f64, &str, &str); 3] =
    [(1e3, "milliseconds", "1000"), (1e6, "microseconds", "1e6"), (1e9, "nanoseconds", "1e9")];
/// Logarithm by which ticks may differ from a unit: one of another rate may be a thousandth, too, but hardly just that.
const OTHER_UNIT: f64 = 0.7;
/// A log slower than the control loop by less is one that lost a few rows.
const SLOWER: f64 = 1.6;
/// Ticks of a log whose distances are looked at.
const LOOKED_AT: usize = 1 << 16;
/// Ticks from a whole number of them within which rows keep the beat of the loop: what comes at any time is a quarter off.
const BEAT: f64 = 0.1;
/// Times by which distances of rows that come when something happens spread, from the shortest twentieth to the longest: a loop
/// that is late and early at times stays within two.
const SPREAD: f64 = 3.0;
/// Share of the distances that are no multiple of a number of ticks, from which it is not that of a slower loop.
const BETWEEN: f64 = 0.02;

pub(super) fn mistakes(file: &Robot, robot: &Robot, logs: &[Log]) -> Vec<Mistake> {
    let Some(tick) = logs.iter().find_map(Log::tick_s) else { return Vec::new() };
    if let Some(mistake) = odd_one_out(logs) {
        return vec![mistake];
    }
    let known = file.lacks(&["control_rate_hz"]).is_empty();
    let ratio = if known { tick * robot.control_rate_hz } else { 1.0 };
    let unit = UNITS
        .iter()
        .find(|(unit, ..)| (ratio / unit).ln().abs() < 0.3 || !known && tick > TICKS[1] && is_tick(tick / unit));
    if let Some((unit, name, divide)) = unit {
        let (what, slow) = if known {
            let has = 1.0 / robot.control_rate_hz;
            (format!("ticks are {} apart where robot.toml has {} s: it is in {name}", short(tick), short(has)), "")
        } else {
            let rates = [short(1.0 / tick), short(unit / tick)];
            let what = format!(
                "ticks are {} apart: in seconds that were {} rows a second, in {name} {}",
                short(tick),
                rates[0],
                rates[1]
            );
            (what, "; if they are seconds, log 20 rows a second or more, or say so with control_rate_hz in robot.toml")
        };
        let remedy = format!("divide t by {divide}, or name its unit to `racbot convert`{slow}");
        return vec![Mistake::new("time-unit", "t", what, remedy)];
    }
    // A log of a part of the ticks is honest; one of more ticks than there were is not.
    if known && (ratio > 1.0 / SLOWER) && (ratio < SLOWER || logs.iter().all(|log| comes_by_events(robot, log))) {
        return Vec::new();
    }
    if known && (ratio < 1.0 / SLOWER || (ratio - ratio.round()).abs() > 0.02 * ratio || logs.iter().any(drives)) {
        let what = format!(
            "ticks are {} s apart, which is {} a second, not {}",
            short(tick),
            short(1.0 / tick),
            short(robot.control_rate_hz)
        );
        let remedy = format!("write control_rate_hz = {}", short(1.0 / tick));
        return vec![Mistake::new("control-rate", "control_rate_hz", what, remedy)];
    }
    Vec::new()
}

/// A log whose time has another unit than that of most.
fn odd_one_out(logs: &[Log]) -> Option<Mistake> {
    let mut ticks: Vec<f64> = logs.iter().filter_map(Log::tick_s).collect();
    let usual = median(&mut ticks);
    let odd = |ratio: f64| UNITS.iter().any(|(unit, ..)| (ratio.max(1.0 / ratio) / unit).ln().abs() < OTHER_UNIT);
    let (log, tick) = logs.iter().find_map(|log| Some((log, log.tick_s().filter(|tick| odd(tick / usual))?)))?;
    let what = format!("{}: ticks are {} apart, and {} in most logs", log.name, short(tick), short(usual));
    let remedy = "its time is in another unit: convert it by a map of its own".to_owned();
    Some(Mistake::new("time-unit", "t", what, remedy))
}

/// Whether rows come in the beat of the loop, after as many ticks as nothing happened.
fn comes_by_events(robot: &Robot, log: &Log) -> bool {
    let part = log.part(0..log.len().min(LOOKED_AT), Columns { counts: true, ..Columns::NONE });
    let rows = part.sampled();
    let mut ticks: Vec<f64> = rows.windows(2).map(|w| (w[1] - w[0]) * robot.control_rate_hz).collect();
    ticks.sort_by(f64::total_cmp);
    let at = |share: f64| ticks.get((share * ticks.len() as f64) as usize).map_or(0.0, |n| n.round());
    let in_beat = ticks.iter().all(|n| n.round() >= 1.0 && (n - n.round()).abs() <= BEAT);
    let between = |every: &f64| {
        let off = ticks.iter().filter(|n| n.round() % every != 0.0).count();
        off as f64 >= BETWEEN * ticks.len() as f64
    };
    in_beat && at(0.95) >= SPREAD * at(0.05).max(1.0) && [2.0, 3.0, 5.0, 7.0].iter().all(between)
}

/// Whether a log replays a controller, tick by tick.
fn drives(log: &Log) -> bool {
    let layout = log.layout();
    !layout.duty.is_empty() && !layout.reference.is_empty()
}

/// Whether rows so many seconds apart may be ticks of a controller; else they are in another unit, or of something slower.
pub fn is_tick(tick_s: f64) -> bool {
    (TICKS[0]..=TICKS[1]).contains(&tick_s)
}
