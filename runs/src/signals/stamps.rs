//! Stamps of too few digits: milliseconds of rows that are no whole number of them apart, seconds since long ago in 32 bits.
//! Rows that came in a beat are read by their number.

use super::super::Run;

/// Rows from which a beat is told from chance.
const FEWEST: usize = 100;
/// Rows over which a beat is laid first.
const FIRST: usize = 16;
/// Step of the stamps, in rows, from which it matters: speeds from row to row err by 1 % by it.
const COARSE: f64 = 0.02;
/// Rows that a log may lack, as a share of those that it has.
const LOST: f64 = 0.25;
/// Part of a step by which stamps written with few digits miss it.
const WHOLE: f64 = 0.02;
/// Steps from the beat by which no stamp errs that was rounded to them, with what the beat itself is not known to.
const ROUNDED: f64 = 0.6;

/// How a log's stamps are read.
pub(super) struct Stamps {
    /// Step of the stamps and time from row to row, s.
    coarse: Option<[f64; 2]>,
    said: bool,
}

impl Stamps {
    /// By the first part of a log, of a loop with ticks of `tick_s`, if that is known.
    pub(super) fn of(run: &Run, tick_s: Option<f64>) -> Self {
        let rows = run.sampled();
        let found = || {
            let step = step(&rows)?;
            let mean = (rows[rows.len() - 1] - rows[0]) / (rows.len() - 1) as f64;
            // A beat much faster than the rows fits any.
            let known = tick_s.filter(|tick| (1.0..1.0 + LOST).contains(&(mean / tick)));
            let (beat, period) = known.into_iter().chain([mean]).find_map(|period| beat(&rows, period, step))?;
            // Rows that are missing leave whole rows.
            let rounded = rows.iter().zip(&beat).any(|(t, beat)| (t - beat).abs() > WHOLE * step);
            (rounded && is_smoother(run, &rows, &beat)).then_some([step, period])
        };
        Self { coarse: found(), said: false }
    }

    /// Sets the rows on their beat, and what comes between them with them.
    pub(super) fn apply(&self, run: &mut Run) {
        let Some([step, period]) = self.coarse else { return };
        let rows = run.sampled().into_owned();
        let Some((beat, _)) = beat(&rows, period, step) else { return };
        let mut next = 0;
        for t in &mut run.t {
            while next + 1 < rows.len() && rows[next + 1] <= *t {
                next += 1;
            }
            let (here, then) = (next, (next + 1).min(rows.len() - 1));
            let lasts = rows[then] - rows[here];
            let inside = *t >= rows[here] && lasts > 0.0;
            let rate = if inside { (beat[then] - beat[here]) / lasts } else { 1.0 };
            *t = beat[here] + rate * (*t - rows[here]);
        }
    }

    /// What was found, said once.
    pub(super) fn note(&mut self) -> Option<String> {
        let [step, period] = self.coarse.filter(|_| !std::mem::replace(&mut self.said, true))?;
        Some(format!(
            "stamps have steps of {:.3} ms, as rounded or float32 ones do: rows are read by their number, at {:.1} Hz",
            1e3 * step,
            1.0 / period
        ))
    }
}

/// The step of which all distances of rows are multiples, though they are not all alike; `None` of one too fine to matter.
fn step(rows: &[f64]) -> Option<f64> {
    if rows.len() < FEWEST {
        return None;
    }
    let mut apart: Vec<f64> = rows.windows(2).map(|w| w[1] - w[0]).collect();
    apart.sort_by(f64::total_cmp);
    let row = apart[apart.len() / 2];
    let step = apart.windows(2).map(|w| w[1] - w[0]).filter(|d| *d >= COARSE * row).fold(f64::INFINITY, f64::min);
    // Longer ones are gaps, in which the step's own error adds up.
    let near = apart.iter().filter(|d| **d < 4.0 * row);
    let whole = |d: &f64| ((d / step) - (d / step).round()).abs() <= WHOLE;
    (step < f64::INFINITY && near.clone().count() > 0 && near.clone().all(whole)).then_some(step)
}

/// Times in a beat from which no row errs by more than rounding, and its period, which is near `period`; rows may be missing.
fn beat(rows: &[f64], period: f64, step: f64) -> Option<(Vec<f64>, f64)> {
    let (mut origin, mut period) = (*rows.first()?, period);
    let mut numbers: Vec<f64> = Vec::new();
    let mut known = FIRST.min(rows.len());
    // The longer the part, the better its beat is known, and the next part is twice as long.
    loop {
        let part = &rows[..known];
        numbers.clear();
        for t in part {
            let least = numbers.last().map_or(0.0, |n| n + 1.0);
            numbers.push(((t - origin) / period).round().max(least));
        }
        let n = known as f64;
        let (mean_n, mean_t) = (numbers.iter().sum::<f64>() / n, part.iter().sum::<f64>() / n);
        let sxx: f64 = numbers.iter().map(|k| (k - mean_n).powi(2)).sum();
        let sxy: f64 = numbers.iter().zip(part).map(|(k, t)| (k - mean_n) * (t - mean_t)).sum();
        (period, origin) = (sxy / sxx, mean_t - sxy / sxx * mean_n);
        let errs = |(k, t): (&f64, &f64)| (origin + period * k - t).abs() > ROUNDED * step;
        if period.is_nan() || period <= 0.0 || numbers.iter().zip(part).any(errs) {
            return None;
        }
        if known == rows.len() {
            return Some((numbers.iter().map(|k| origin + period * k).collect(), period));
        }
        known = (2 * known).min(rows.len());
    }
}

/// Whether speeds change less from row to row by the beat than by the stamps: a loop may have been woken in steps.
fn is_smoother(run: &Run, rows: &[f64], beat: &[f64]) -> bool {
    let rough = |t: &[f64]| -> f64 {
        let of = |(counts, gaps): (&Vec<i64>, &Vec<usize>)| {
            let own = counts.iter().enumerate().filter(|(k, _)| gaps.binary_search(k).is_err());
            let own: Vec<i64> = own.map(|(_, c)| *c).collect();
            let speed = |k: usize| own[k + 1].wrapping_sub(own[k]) as f64 / (t[k + 1] - t[k]);
            (2..own.len().min(t.len())).map(|k| (speed(k - 1) - speed(k - 2)).powi(2)).sum::<f64>()
        };
        run.counts.iter().zip(&run.count_gaps).map(of).sum()
    };
    run.counts.is_empty() || rough(beat) < rough(rows)
}
