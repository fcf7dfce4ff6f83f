//! Encoders and currents that are read less often than the log has ticks: what repeats the last reading is no sample.

use crate::Run;

/// Changes of a counter from which its rhythm is told: half a second of a control loop of 60 Hz.
const FEWEST_CHANGES: usize = 30;
/// Counts of the usual change of a counter that is read rarely. One that changes rarely because it turns slowly changes
/// by one, or two at an edge that bounces.
const LEAST_CHANGE: u64 = 3;
/// Share of the changes that keep the rhythm: a few readings come late.
const RHYTHM: f64 = 0.9;

/// The rhythm of every wheel's encoder, and of the current of every motor where that is what drives.
pub(super) struct Held {
    wheels: Vec<Option<Rhythm<i64>>>,
    currents: Vec<Option<Rhythm<f64>>>,
    said: bool,
}

#[derive(Clone, Copy)]
struct Rhythm<T> {
    /// Mean number of ticks between readings, 2 or more.
    ticks: f64,
    /// The last reading, and ticks since.
    last: Option<(T, usize)>,
}

impl<T: PartialEq + Copy> Rhythm<T> {
    fn of(ticks: Option<f64>) -> Option<Self> {
        ticks.map(|ticks| Self { ticks, last: None })
    }

    /// Whether what the next row has was read for it.
    fn is_fresh(&mut self, value: T) -> bool {
        let fresh = match &mut self.last {
            None => true,
            Some((last, since)) => {
                *since += 1;
                // What does not change is read, too.
                value != *last || *since as f64 >= self.ticks.ceil()
            }
        };
        if fresh {
            self.last = Some((value, 0));
        }
        fresh
    }
}

impl Held {
    /// By the first part of a log.
    pub(super) fn of(run: &Run) -> Self {
        let of_counts = |(counts, gaps): (&Vec<i64>, &Vec<usize>)| {
            Rhythm::of(if gaps.is_empty() { of_counter(counts) } else { None })
        };
        let of_current = |current: &Vec<f64>| {
            let changes: Vec<usize> = (1..current.len()).filter(|k| current[*k] != current[k - 1]).collect();
            Rhythm::of(if current.iter().all(|i| i.is_finite()) { rhythm(&changes) } else { None })
        };
        Self {
            wheels: run.counts.iter().zip(&run.count_gaps).map(of_counts).collect(),
            currents: if run.duty.is_empty() { run.current.iter().map(of_current).collect() } else { Vec::new() },
            said: false,
        }
    }

    /// Marks what is no reading as a gap.
    pub(super) fn apply(&mut self, run: &mut Run) {
        for ((rhythm, counts), gaps) in self.wheels.iter_mut().zip(&run.counts).zip(&mut run.count_gaps) {
            let Some(rhythm) = rhythm else { continue };
            gaps.clear();
            gaps.extend((0..counts.len()).filter(|tick| !rhythm.is_fresh(counts[*tick])));
        }
        for (rhythm, current) in self.currents.iter_mut().zip(&mut run.current) {
            let Some(rhythm) = rhythm else { continue };
            current.iter_mut().filter(|i| !rhythm.is_fresh(**i)).for_each(|i| *i = f64::NAN);
        }
    }

    /// What was found, said once.
    pub(super) fn note(&mut self, run: &Run) -> Option<String> {
        if std::mem::replace(&mut self.said, true) {
            return None;
        }
        let counts = self.wheels.iter().enumerate().filter_map(|(i, r)| Some((format!("enc_{}", i + 1), (*r)?.ticks)));
        let amps = self.currents.iter().enumerate();
        let amps = amps.filter_map(|(i, r)| Some((format!("current_{}", i + 1), (*r)?.ticks)));
        let (names, slow): (Vec<String>, Vec<f64>) = counts.chain(amps).unzip();
        let ticks = slow.first()?;
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
fn of_counter(counts: &[i64]) -> Option<f64> {
    let changes: Vec<usize> = (1..counts.len()).filter(|k| counts[*k] != counts[k - 1]).collect();
    let mut sizes: Vec<u64> = changes.iter().map(|k| counts[*k].abs_diff(counts[k - 1])).collect();
    sizes.sort_unstable();
    rhythm(&changes).filter(|_| sizes[sizes.len() / 2] >= LEAST_CHANGE)
}

/// Ticks between readings by the rows in which they change, if they come less often than at every tick.
fn rhythm(changes: &[usize]) -> Option<f64> {
    if changes.len() < FEWEST_CHANGES {
        return None;
    }
    let mut apart: Vec<usize> = changes.windows(2).map(|w| w[1] - w[0]).collect();
    apart.sort_unstable();
    let median = apart[apart.len() / 2];
    if median < 2 {
        return None;
    }
    // Beyond that a reading was the same as the one before, or the wheel stood still.
    apart.retain(|a| 2 * a < 3 * median);
    let mean = apart.iter().sum::<usize>() as f64 / apart.len() as f64;
    // Of the two numbers of ticks about a rhythm the nearer one is the more frequent. Readings that repeat for their rounding
    // are most often new at the next tick.
    if (mean - median as f64).abs() > 0.5 + 1.0 / apart.len() as f64 {
        return None;
    }
    let kept = apart.iter().filter(|a| (**a as f64 - mean).abs() < 1.0).count();
    (kept as f64 >= RHYTHM * apart.len() as f64).then_some(mean)
}
