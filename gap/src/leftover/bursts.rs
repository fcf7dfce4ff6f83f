//! Bursts and stretches of time in which a wheel's torque is unlike the rest of the log.

use std::collections::BTreeMap;

use super::{Series, Structure};
use crate::thresholds::Thresholds;
use crate::units;
use estimation::statistics::median;

/// Fewer bursts than this may be anything.
const FEWEST: usize = 2;
/// Length of a stretch, s.
const STRETCH_S: f64 = 2.0;

/// Moments between two that belong to one event.
const NEAR: i64 = 8;
/// Moments round an event that its impulse is taken over.
const ROUND: i64 = 4;

/// Moments in a row that stand out.
struct Event {
    segment: usize,
    first: i64,
    last: i64,
    torque: f64,
    /// Whether the log lacks rows at its largest moment.
    lacks_rows: bool,
}

/// Share of an event's impulse that stays, and its torque beside what the acceleration took, at the wheel that felt most of
/// it.
fn pushed(series: &Series, e: &Event) -> [f64; 2] {
    series
        .wheels
        .iter()
        .map(|w| {
            let inside = |b: &usize| {
                let k = (w.t[*b] / series.hop).round() as i64;
                w.segment[*b] == e.segment && k >= e.first - ROUND && k <= e.last + ROUND
            };
            let inside: Vec<usize> = (0..w.t.len()).filter(inside).collect();
            let most = |of: &[f64]| inside.iter().map(|b| of[*b].abs()).fold(0.0, f64::max);
            let net: f64 = inside.iter().map(|b| w.torque[*b]).sum();
            let all: f64 = inside.iter().map(|b| w.torque[*b].abs()).sum();
            (all, [net.abs() / all.max(1e-300), most(&w.torque) / most(&w.done).max(1e-300)])
        })
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map_or([0.0; 2], |x| x.1)
}

/// Short pushes: collisions, kicks, a foot on the field.
pub(super) fn bursts(
    series: &Series,
    rolls: &dyn Fn(usize, f64) -> bool,
    drive_nm: f64,
    thresholds: &Thresholds,
) -> Option<Structure> {
    // Norm over the wheels and largest torque of every moment, and whether it lacks rows.
    let mut moments: BTreeMap<(usize, i64), (f64, f64, bool)> = BTreeMap::new();
    for w in &series.wheels {
        for (b, x) in w.torque.iter().enumerate() {
            let slot = moments.entry((w.segment[b], (w.t[b] / series.hop).round() as i64)).or_insert((0.0, 0.0, false));
            slot.0 += (x / w.scatter.max(f64::MIN_POSITIVE)).powi(2);
            slot.1 = slot.1.max(x.abs());
            slot.2 |= w.lacks_rows[b];
        }
    }
    if moments.len() < 40 {
        return None;
    }
    let n = series.wheels.len() as f64;
    let mut norms: Vec<f64> = moments.values().map(|m| (m.0 / n).sqrt()).collect();
    norms.sort_by(f64::total_cmp);
    let usual = norms[norms.len() * 9 / 10];
    let [material, out, rare] = thresholds.burst;
    let limit = out.max(rare * usual);
    let mut events: Vec<Event> = Vec::new();
    let total: f64 = moments.values().map(|m| m.0).sum();
    for (at, (square, torque, lacks_rows)) in &moments {
        if (square / n).sqrt() < limit || *torque < material * drive_nm {
            continue;
        }
        match events.last_mut() {
            Some(e) if e.segment == at.0 && at.1 - e.last < NEAR => {
                e.last = at.1;
                if *torque > e.torque {
                    (e.torque, e.lacks_rows) = (*torque, *lacks_rows);
                }
            }
            _ => {
                events.push(Event { segment: at.0, first: at.1, last: at.1, torque: *torque, lacks_rows: *lacks_rows });
            }
        }
    }
    let run_of = |segment: usize| {
        series.wheels.iter().find_map(|w| w.segment.iter().position(|s| *s == segment).map(|b| w.run[b])).unwrap_or(0)
    };
    let is_push = |e: &Event| pushed(series, e).iter().zip(thresholds.pushed).all(|(share, least)| *share > least);
    // What the motors did in a row that is missing nobody knows.
    events.retain(|e| !e.lacks_rows && is_push(e) && rolls(run_of(e.segment), e.first as f64 * series.hop));
    let power: f64 = events
        .iter()
        .map(|e| moments.range((e.segment, e.first - 1)..=(e.segment, e.last + 1)).map(|m| m.1.0).sum::<f64>())
        .sum();
    if events.len() < FEWEST {
        return None;
    }
    let largest = events.iter().max_by(|a, b| a.torque.total_cmp(&b.torque))?;
    let mut sizes: Vec<f64> = events.iter().map(|e| e.torque).collect();
    let run = run_of(largest.segment);
    Some(Structure {
        text: format!(
            "{} short pushes of about {} at a wheel, the largest in run {} at {:.2} s; nothing like them between",
            events.len(),
            units::torque(median(&mut sizes)),
            run + 1,
            largest.first as f64 * series.hop
        ),
        share: power / total.max(1e-300),
    })
}

/// A wheel that is braked or pushed for seconds in one run and not in the others.
pub(super) fn stretches(series: &Series, drive_nm: f64, thresholds: &Thresholds) -> Option<Structure> {
    let length = (STRETCH_S / series.hop) as usize;
    if length < 2 {
        // Rows so far apart hold no stretch.
        return None;
    }
    let [material, out] = thresholds.stretch;
    let mut worst: Option<(f64, f64, usize, usize, f64)> = None;
    for (i, w) in series.wheels.iter().enumerate() {
        let along: Vec<f64> = w.torque.iter().zip(&w.sign).map(|(x, s)| x * s).collect();
        // Means over stretches; their own scatter is the error of a mean, whatever the correlation.
        let mut means: Vec<(usize, f64)> = Vec::new();
        let mut first = 0;
        while first + length <= along.len() {
            let last = first + length - 1;
            if w.segment[first] == w.segment[last] && w.t[last] - w.t[first] < 1.5 * STRETCH_S {
                means.push((first, along[first..=last].iter().sum::<f64>() / length as f64));
            }
            first += length / 2;
        }
        if means.len() < 10 {
            continue;
        }
        let mut sizes: Vec<f64> = means.iter().map(|m| m.1.abs()).collect();
        let error = (1.4826 * median(&mut sizes)).max(f64::MIN_POSITIVE);
        for (first, mean) in means {
            if mean.abs() > material * drive_nm && mean.abs() > out * error {
                let size = mean.abs() / error;
                if worst.is_none_or(|o| size > o.4) {
                    worst = Some((mean, w.t[first], w.run[first], i, size));
                }
            }
        }
    }
    let (mean, t, run, wheel, _) = worst?;
    Some(Structure {
        text: format!(
            "wheel {} has {} along its rotation in run {} from {t:.1} s on for about {STRETCH_S:.0} s, not elsewhere",
            wheel + 1,
            units::torque(mean),
            run + 1
        ),
        share: 1.0,
    })
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};

    use super::super::Wheel;
    use super::*;

    /// Ten seconds of noise with three pushes, of 20 deviations, and rows missing at so many of them.
    fn pushes(missing: usize) -> Option<Structure> {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(14);
        let at = [100, 200, 300];
        let push = |k: &usize| if at.contains(k) { 20e-3 } else { 0.0 };
        let mut uniform = || (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0;
        let n = 400;
        let w = Wheel {
            run: vec![0; n],
            segment: vec![0; n],
            t: (0..n).map(|k| 0.025 * k as f64).collect(),
            torque: (0..n).map(|k| 1e-3 * uniform() + push(&k)).collect(),
            sign: vec![1.0; n],
            done: (0..n).map(|k| 1e-3 * uniform() + push(&k)).collect(),
            lacks_rows: (0..n).map(|k| at[..missing].contains(&k)).collect(),
            scatter: 1e-3,
        };
        let series = Series { wheels: vec![w], hop: 0.025, inertia: 1e-4, count_rad: 1e-4 };
        bursts(&series, &|_, _| true, 20e-3, &Thresholds::default())
    }

    #[test]
    fn what_happens_where_rows_are_missing_is_no_push() {
        assert!(pushes(0).is_some_and(|s| s.text.starts_with("3 ")));
        assert!(pushes(1).is_some_and(|s| s.text.starts_with("2 ")));
        assert!(pushes(2).is_none());
        let t: Vec<f64> = (0..100).filter(|k| *k != 40).map(|k| 0.01 * f64::from(k)).collect();
        let lacks = |k| super::super::lacks_rows(&t, k, 0.05);
        assert!(lacks(37) && lacks(42) && !lacks(20) && !lacks(60));
    }
}
