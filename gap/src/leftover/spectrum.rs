//! Lines in the spectrum of a wheel's torque.

use std::f64::consts::{PI, TAU};

use super::{Series, Structure, Wheel};
use crate::thresholds::Thresholds;
use crate::units;
use estimation::statistics::{chi2_upper, median};

/// Lowest frequency looked at, Hz: below, the drive itself is the spectrum.
const LOWEST_HZ: f64 = 0.4;
/// Half width of the band that the noise floor is taken from, Hz.
const BAND_HZ: f64 = 2.0;
/// Frequencies, four to an independent one, that each side of a line has at least.
const SIDE: usize = 16;
/// Longest piece that one phase is asked of, s, and number of pieces at most.
const PIECE_S: f64 = 20.0;
const MOST_PIECES: usize = 16;
/// The floor round a line is known to about 15 %; two deviations more are asked for.
const UNSURE: f64 = 1.3;

/// The strongest line of each wheel that stands out of the coloured noise round it.
pub(super) fn lines(series: &Series, drive_nm: f64, thresholds: &Thresholds) -> Vec<Structure> {
    series.wheels.iter().enumerate().filter_map(|(i, w)| line(w, i, series, drive_nm, thresholds)).collect()
}

fn line(w: &Wheel, index: usize, series: &Series, drive_nm: f64, thresholds: &Thresholds) -> Option<Structure> {
    let pieces = pieces(w);
    let longest = pieces.iter().map(|p| w.t[p[p.len() - 1]] - w.t[p[0]]).fold(0.0, f64::max);
    let highest = 0.4 / series.hop;
    if longest < 2.0 || highest < 3.0 * LOWEST_HZ {
        return None;
    }
    let step = 0.25 / longest;
    let grid: Vec<f64> = (0..).map(|k| LOWEST_HZ + f64::from(k) * step).take_while(|f| *f < highest).collect();
    let mut power = vec![0.0; grid.len()];
    let mut parts = 0.0;
    for at in &pieces {
        parts += 1.0;
        let mean = at.iter().map(|b| w.torque[*b]).sum::<f64>() / at.len() as f64;
        for (p, f) in power.iter_mut().zip(&grid) {
            let (s, c) = sums(w, at, *f, |b| w.torque[b] - mean);
            *p += (s * s + c * c) / at.len() as f64;
        }
    }
    if parts == 0.0 {
        return None;
    }
    let near = (BAND_HZ / step) as usize;
    let far = (2.0 / longest / step) as usize;
    // Median of a gamma variable of that shape and scale 1.
    let middle = parts - 1.0 / 3.0;
    let (best, ratio) = (0..grid.len())
        .filter_map(|k| {
            // A slope would lend a line to its lower side: the higher of both sides counts.
            let side = |band: std::ops::Range<usize>| {
                let mut others = power[band].to_vec();
                (others.len() >= SIDE).then(|| median(&mut others))
            };
            let low = side(k.saturating_sub(near)..k.saturating_sub(far))?;
            let high = side((k + far + 1).min(grid.len())..(k + near + 1).min(grid.len()))?;
            Some((k, power[k] * middle / low.max(high).max(1e-300)))
        })
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    // Four grid points are one independent frequency.
    let tests = (grid.len() as f64 / 4.0).max(1.0) * series.wheels.len() as f64 * 2.0;
    if chi2_upper(2.0 * ratio / UNSURE, 2.0 * parts) * tests > thresholds.false_alarm {
        return None;
    }
    let f = grid[best];
    // Amplitudes over all pieces, of what is left and of what the drive did.
    let (mut square, mut done, mut n, mut total) = (0.0, 0.0, 0.0, 0.0);
    for at in &pieces {
        let (s, c) = sums(w, at, f, |b| w.torque[b]);
        square += 2.0 * (s * s + c * c) / at.len().max(1) as f64;
        let (s, c) = sums(w, at, f, |b| w.done[b]);
        done += 2.0 * (s * s + c * c) / at.len().max(1) as f64;
        n += at.len() as f64;
        total += at.iter().map(|b| w.torque[*b].powi(2)).sum::<f64>();
    }
    let share = square / total.max(1e-300);
    let amplitude = (2.0 * square / n.max(1.0)).sqrt() / passed(f, 2.0 * series.hop);
    let [material, of_rest, of_drive] = thresholds.line;
    // Counts at a steady speed are rounded alike again and again: a saw tooth of one count, the first line of which is
    // a third of it.
    let rounding = series.inertia * (TAU * f).powi(2) * series.count_rad / PI;
    if amplitude < rounding.max(material * drive_nm) || share < of_rest || square < of_drive.powi(2) * done {
        return None;
    }
    Some(Structure {
        text: format!(
            "the torque of wheel {} oscillates in time at {f:.2} Hz, amplitude {}, {:.0} % of what is left there",
            index + 1,
            units::torque(amplitude),
            100.0 * share
        ),
        share,
    })
}

/// Test functions of every piece of the log of at most [`PIECE_S`]; of a long log pieces here and there.
fn pieces(w: &Wheel) -> Vec<Vec<usize>> {
    let mut all: Vec<(usize, f64, Vec<usize>)> = Vec::new();
    for b in 0..w.t.len() {
        match all.last_mut() {
            Some((segment, start, piece)) if *segment == w.segment[b] && w.t[b] - *start < PIECE_S => piece.push(b),
            _ => all.push((w.segment[b], w.t[b], vec![b])),
        }
    }
    all.retain(|p| p.2.len() >= 24);
    let stride = all.len().div_ceil(MOST_PIECES).max(1);
    all.into_iter().step_by(stride).map(|p| p.2).collect()
}

fn sums(w: &Wheel, at: &[usize], f: f64, x: impl Fn(usize) -> f64) -> (f64, f64) {
    at.iter().fold((0.0, 0.0), |(s, c), b| {
        let (sin, cos) = (TAU * f * w.t[*b]).sin_cos();
        (s + x(*b) * sin, c + x(*b) * cos)
    })
}

/// What averaging over a sin² test function of this length leaves of an oscillation.
fn passed(f: f64, length: f64) -> f64 {
    let x = f * length;
    if (x - 1.0).abs() < 1e-6 {
        return 0.5;
    }
    let sinc = if x < 1e-9 { 1.0 } else { (0.5 * TAU * x).sin() / (0.5 * TAU * x) };
    (sinc / (1.0 - x * x)).abs().max(0.2)
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};

    use super::*;

    /// Three runs of coloured noise with a line of an amplitude in units of its deviation.
    fn series(amplitude: f64, count_rad: f64, seed: u64) -> Series {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let mut w = Wheel {
            run: Vec::new(),
            segment: Vec::new(),
            t: Vec::new(),
            torque: Vec::new(),
            sign: Vec::new(),
            done: Vec::new(),
            lacks_rows: vec![false; 3 * 280],
            scatter: 1e-3,
        };
        for run in 0..3 {
            let mut noise = 0.0;
            for k in 0..280 {
                let uniform: f64 = (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0;
                noise = 0.6 * noise + 0.8e-3 * uniform;
                let t = 0.025 * f64::from(k);
                w.run.push(run);
                w.segment.push(run);
                w.t.push(t);
                w.torque.push(noise + 1e-3 * amplitude * (TAU * 3.3 * t + run as f64).sin());
                w.sign.push(1.0);
                w.done.push(1e-3 * uniform);
            }
        }
        Series { wheels: vec![w], hop: 0.025, inertia: 1e-4, count_rad }
    }

    #[test]
    fn a_line_is_found_in_coloured_noise_and_noise_is_none() {
        let found = lines(&series(4.0, 0.0, 1), 0.05, &Thresholds::default());
        assert!(found.len() == 1 && found[0].text.contains("3.3"), "{found:?}");
        // With counts half a radian apart their rounding is larger than that.
        assert_eq!(lines(&series(4.0, 0.5, 1), 0.05, &Thresholds::default()), []);
        for seed in 2..100 {
            assert_eq!(lines(&series(0.0, 0.0, seed), 0.01, &Thresholds::default()), [], "seed {seed}");
        }
    }
}
