//! The regime map: in which situations each signal is off, before and after.

use std::fmt::Write as _;

use crate::analysis::Analysis;
use crate::statistics::rms;

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

/// Ticks over which a change of speed is looked at, on either side.
const AROUND: usize = 30;

pub(super) fn table(a: &Analysis) -> Option<String> {
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
    let mut out = String::from("<div class=\"w\"><table class=\"m\"><tr><th>signal</th>");
    for c in COLUMNS {
        let _ = write!(out, "<th>{c}</th>");
    }
    out.push_str("</tr>");
    for (name, samples) in rows {
        let _ = write!(out, "<tr><td>{name}</td>");
        for column in 0..COLUMNS.len() {
            let own = || samples.iter().filter(|s| s.regimes[column]);
            if own().count() < 5 {
                out.push_str("<td>–</td>");
                continue;
            }
            let (before, after) = (rms(own().map(|s| s.before)), rms(own().map(|s| s.after)));
            let _ = write!(out, "<td style=\"background:{}\">{before:.1} → {after:.1}</td>", colour(before));
        }
        out.push_str("</tr>");
    }
    out.push_str("</table></div>");
    Some(out)
}

/// White at the floor, orange from five floors.
fn colour(excess: f64) -> String {
    let share = ((excess - 1.0) / 4.0).clamp(0.0, 1.0);
    let mix = |full: f64| (255.0 - share * (255.0 - full)).round();
    format!("rgb({},{},{})", mix(240.0), mix(150.0), mix(80.0))
}

fn motion(
    a: &Analysis,
    before: &[crate::motion::WindowResiduals],
    after: &[crate::motion::WindowResiduals],
    signal: usize,
) -> Vec<Sample> {
    // How fast the robot is at a time, and how its speed changes.
    let situation = |run: usize, t: f64| {
        let s = a.segments.iter().find(|s| s.run == run && s.t.first() <= Some(&t) && s.t.last() >= Some(&t))?;
        let k = s.tick_at(t);
        let (from, to) = (k.saturating_sub(AROUND), (k + AROUND).min(s.t.len() - 1));
        Some((s.twist[k].speed(), s.twist[to].speed() - s.twist[from].speed(), s.twist[k].vy < 0.0, k > s.t.len() / 2))
    };
    let mut found = Vec::new();
    for (b, f) in before.iter().zip(after) {
        for k in 0..b.t.len().min(f.t.len()) {
            if b.weights[k] > 0.0
                && let Some(at) = situation(b.run, b.t[k])
            {
                found.push((b.residuals[k][signal], f.residuals[k][signal], at));
            }
        }
    }
    let median = crate::statistics::median(&mut found.iter().map(|f| f.2.0).collect::<Vec<_>>());
    let sample = |(before, after, (speed, gain, backwards, late)): (f64, f64, (f64, f64, bool, bool))| Sample {
        before,
        after,
        regimes: regimes(if backwards { -speed } else { speed }, median, gain, late),
    };
    found.into_iter().map(sample).collect()
}

fn drive(
    a: &Analysis,
    before: &crate::drive::DriveResiduals,
    after: &crate::drive::DriveResiduals,
    wheel: usize,
) -> Vec<Sample> {
    let floor = a
        .links
        .iter()
        .find(|l| l.link == crate::effect::Link::Drive)
        .and_then(|l| l.floor.get(wheel).copied())
        .unwrap_or(1.0);
    let used = (0..before.torque.len()).filter(|b| before.weights[*b][wheel] > 0.0 && *b < after.torque.len());
    let found: Vec<(usize, f64, f64, bool)> = used
        .map(|b| {
            let (segment, k) = before.at[b];
            let s = &a.segments[segment];
            let speed = &s.speed[wheel];
            let (from, to) = (k.saturating_sub(AROUND), (k + AROUND).min(speed.len() - 1));
            (b, speed[k], speed[to].abs() - speed[from].abs(), k > speed.len() / 2)
        })
        .collect();
    let median = crate::statistics::median(&mut found.iter().map(|f| f.1.abs()).collect::<Vec<_>>());
    let sample = |(b, speed, gain, late): (usize, f64, f64, bool)| Sample {
        before: before.torque[b][wheel] / floor,
        after: after.torque[b][wheel] / floor,
        regimes: regimes(speed, median, gain, late),
    };
    found.into_iter().map(sample).collect()
}
