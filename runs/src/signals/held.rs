//! Encoders that are read less often than the log has ticks: what repeats the last reading is no sample.

use crate::Run;

/// Changes of a counter from which its rhythm is told: half a second of a control loop of 60 Hz.
const FEWEST_CHANGES: usize = 30;
/// Counts of the usual change of a counter that is read rarely. One that changes rarely because it turns slowly changes
/// by one, or two at an edge that bounces.
const LEAST_CHANGE: u64 = 3;
/// Share of the changes that keep the rhythm: a few readings come late.
const RHYTHM: f64 = 0.9;

/// The rhythm of every wheel's encoder.
pub(super) struct Held {
    wheels: Vec<Option<Rhythm>>,
    said: bool,
}

#[derive(Clone, Copy)]
struct Rhythm {
    /// Mean number of ticks between readings, 2 or more.
    ticks: f64,
    /// Count of the last reading, and ticks since.
    last: Option<(i64, usize)>,
}

impl Held {
    /// By the first part of a log.
    pub(super) fn of(run: &Run) -> Self {
        let rhythm = |(counts, gaps): (&Vec<i64>, &Vec<usize>)| {
            let ticks = if gaps.is_empty() { rhythm(counts) } else { None };
            ticks.map(|ticks| Rhythm { ticks, last: None })
        };
        Self { wheels: run.counts.iter().zip(&run.count_gaps).map(rhythm).collect(), said: false }
    }

    /// Marks what is no reading as a gap.
    pub(super) fn apply(&mut self, run: &mut Run) {
        for ((rhythm, counts), gaps) in self.wheels.iter_mut().zip(&run.counts).zip(&mut run.count_gaps) {
            let Some(rhythm) = rhythm else { continue };
            gaps.clear();
            for (tick, count) in counts.iter().enumerate() {
                let fresh = match &mut rhythm.last {
                    None => true,
                    Some((last, since)) => {
                        *since += 1;
                        // A wheel that stands still is read, too.
                        count != last || *since as f64 >= rhythm.ticks.ceil()
                    }
                };
                if fresh {
                    rhythm.last = Some((*count, 0));
                } else {
                    gaps.push(tick);
                }
            }
        }
    }

    /// What was found, said once.
    pub(super) fn note(&mut self, run: &Run) -> Option<String> {
        if std::mem::replace(&mut self.said, true) {
            return None;
        }
        let slow: Vec<(usize, f64)> =
            self.wheels.iter().enumerate().filter_map(|(i, r)| Some((i + 1, (*r)?.ticks))).collect();
        let (_, ticks) = slow.first()?;
        let names: Vec<String> = slow.iter().map(|(i, _)| format!("enc_{i}")).collect();
        let rate = run.t.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
        let tick = if rate.is_finite() { run.duration_s() / (run.len() - 1) as f64 } else { return None };
        Some(format!(
            "{} repeat their readings: a new one comes every {:.1} ticks ({:.0} Hz), and what is between is no sample",
            names.join(", "),
            ticks,
            1.0 / (ticks * tick)
        ))
    }
}

/// Ticks between the readings of a counter, if it is read less often than at every tick.
fn rhythm(counts: &[i64]) -> Option<f64> {
    let changes: Vec<(usize, u64)> = counts
        .windows(2)
        .enumerate()
        .filter(|(_, w)| w[0] != w[1])
        .map(|(i, w)| (i + 1, w[1].abs_diff(w[0])))
        .collect();
    if changes.len() < FEWEST_CHANGES {
        return None;
    }
    let mut sizes: Vec<u64> = changes.iter().map(|c| c.1).collect();
    let mut apart: Vec<usize> = changes.windows(2).map(|w| w[1].0 - w[0].0).collect();
    apart.sort_unstable();
    sizes.sort_unstable();
    let median = apart[apart.len() / 2];
    if median < 2 || sizes[sizes.len() / 2] < LEAST_CHANGE {
        return None;
    }
    // Beyond that a reading was the same as the one before, or the wheel stood still.
    apart.retain(|a| 2 * a < 3 * median);
    let mean = apart.iter().sum::<usize>() as f64 / apart.len() as f64;
    let kept = apart.iter().filter(|a| (**a as f64 - mean).abs() < 1.0).count();
    (kept as f64 >= RHYTHM * apart.len() as f64).then_some(mean)
}
