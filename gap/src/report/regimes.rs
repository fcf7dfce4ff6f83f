//! The regime map: in which situations each signal is off, before and after.

use plot::page::Table;

use crate::analysis::{Analysis, Moment};
use estimation::statistics::rms;

/// A residual in units of its floor, and the situation it belongs to.
struct Sample {
    before: f64,
    after: f64,
    /// Which columns of the map it counts in.
    regimes: [bool; COLUMNS.len()],
}

const COLUMNS: [&str; 8] = ["all", "slow", "fast", "forwards", "backwards", "speeding up", "braking", "late"];

/// Speed, and its change over some ticks, as columns; the median speed parts slow from fast.
fn regimes(speed: f64, median: f64, gain: f64, late: bool) -> [bool; COLUMNS.len()] {
    let fast = speed.abs() >= median;
    [true, !fast, fast, speed > 0.0, speed < 0.0, gain > 0.0, gain < 0.0, late]
}

pub(super) fn table(a: &Analysis) -> Option<Table> {
    let mut rows: Vec<(String, Vec<Sample>)> = Vec::new();
    if let Some([before, after]) = &a.motion {
        for (i, name) in ["camera x", "camera y", "camera heading"].iter().enumerate() {
            rows.push(((*name).to_owned(), motion(a, before, after, i)));
        }
    }
    if let Some([before, after]) = &a.drive {
        for i in 0..before.torque.first().map_or(0, Vec::len) {
            rows.push((format!("drive of wheel {}", i + 1), drive(a, before, after, i)));
        }
    }
    if rows.is_empty() {
        return None;
    }
    let headers: Vec<&str> = std::iter::once("signal").chain(COLUMNS).collect();
    let mut table = Table::new(&headers).heat();
    for (name, samples) in rows {
        let cells = (0..COLUMNS.len()).map(|column| {
            let own = || samples.iter().filter(|s| s.regimes[column]);
            if own().count() < 5 {
                return ("–".to_owned(), None);
            }
            let (before, after) = (rms(own().map(|s| s.before)), rms(own().map(|s| s.after)));
            (format!("{before:.1} → {after:.1}"), Some(colour(before)))
        });
        table.coloured(std::iter::once((name, None)).chain(cells));
    }
    Some(table)
}

/// White at the floor, orange from five floors.
fn colour(excess: f64) -> String {
    let share = ((excess - 1.0) / 4.0).clamp(0.0, 1.0);
    let mix = |full: f64| (255.0 - share * (255.0 - full)).round();
    format!("rgb({},{},{})", mix(240.0), mix(150.0), mix(80.0))
}

fn motion(
    a: &Analysis,
    before: &[links::motion::WindowResiduals],
    after: &[links::motion::WindowResiduals],
    signal: usize,
) -> Vec<Sample> {
    let mut found = Vec::new();
    for ((b, f), moments) in before.iter().zip(after).zip(&a.driven.frames) {
        for k in 0..b.t.len().min(f.t.len()) {
            if b.weights[k] > 0.0
                && let Some(at) = moments[k]
            {
                found.push((b.residuals[k][signal], f.residuals[k][signal], at));
            }
        }
    }
    let median = estimation::statistics::median(&mut found.iter().map(|f| f.2.speed.abs()).collect::<Vec<_>>());
    let sample = |(before, after, at): (f64, f64, Moment)| Sample {
        before,
        after,
        regimes: regimes(at.speed, median, at.gain, at.late),
    };
    found.into_iter().map(sample).collect()
}

fn drive(
    a: &Analysis,
    before: &links::drive::DriveResiduals,
    after: &links::drive::DriveResiduals,
    wheel: usize,
) -> Vec<Sample> {
    let floor = a
        .links
        .iter()
        .find(|l| l.link == links::effect::Link::Drive)
        .and_then(|l| l.floor.get(wheel).copied())
        .unwrap_or(1.0);
    let used = (0..before.torque.len()).filter(|b| before.weights[*b][wheel] > 0.0 && *b < after.torque.len());
    let found: Vec<(usize, Moment)> = used.map(|b| (b, a.driven.test_functions[b][wheel])).collect();
    let median = estimation::statistics::median(&mut found.iter().map(|f| f.1.speed.abs()).collect::<Vec<_>>());
    let sample = |(b, at): (usize, Moment)| Sample {
        before: before.torque[b][wheel] / floor,
        after: after.torque[b][wheel] / floor,
        regimes: regimes(at.speed, median, at.gain, at.late),
    };
    found.into_iter().map(sample).collect()
}
