//! What of a recording is written.

use std::fmt::Write;

use rand::RngExt;

use super::Logger;
use super::motion::Recording;
use crate::noise::{Stream, normal, stream};

/// Standard deviation of a measured supply, share of it.
const SUPPLY_NOISE: f64 = 0.002;

/// A CSV of one or two equal axes, whose encoders differ.
pub(super) fn csv(recording: &Recording, logger: &Logger, axes: usize, seed: u64, number: u32) -> String {
    let mut rng = stream(seed, Stream::Camera(number));
    let per_rad = logger.counts / std::f64::consts::TAU;
    let counted: Vec<Vec<f64>> = (0..axes)
        .map(|_| {
            let zero = rng.random_range(0.0..1.0);
            let edge = |a: &f64, e: f64| {
                ((a + logger.eccentric[0] * a.sin() + logger.eccentric[1] * a.cos()) * per_rad
                    + zero
                    + logger.edges * e)
                    .floor()
            };
            recording.angles.iter().map(|a| edge(a, rng.random_range(-1.0..1.0))).collect()
        })
        .collect();
    let mut text = String::from("t");
    let measured = if logger.mean_rows.is_some() { "speed" } else { "enc" };
    for name in [measured, "duty"] {
        for i in 1..=axes {
            let _ = write!(text, ",{name}_{i}");
        }
    }
    text += if logger.supply { ",supply_v\n" } else { "\n" };
    let mut filtered = vec![0.0; axes];
    for k in 0..recording.t.len() {
        // A firmware filters at every row, whether it arrives or not.
        if let Some(rows) = logger.mean_rows {
            let before = k.saturating_sub(rows);
            let passed = (recording.t[k] - recording.t[before]).max(0.2 * logger.row_s);
            let kept = if logger.filter_s > 0.0 { (-logger.row_s / logger.filter_s).exp() } else { 0.0 };
            for (out, counts) in filtered.iter_mut().zip(&counted) {
                let speed = (counts[k] - counts[before]) / per_rad / passed;
                *out = speed + kept * (*out - speed);
            }
        }
        if rng.random_bool(logger.lost) {
            continue;
        }
        let stamp = logger.stamp_s.map_or(recording.t[k], |step| (recording.t[k] / step).round() * step);
        let _ = write!(text, "{stamp:.6}");
        for (counts, speed) in counted.iter().zip(&filtered) {
            let _ = match logger.mean_rows {
                None => write!(text, ",{}", counts[k]),
                Some(_) => write!(text, ",{speed:.5}"),
            };
        }
        for _ in 0..axes {
            let _ = write!(text, ",{:.6}", recording.duties[k]);
        }
        if logger.supply {
            let _ = write!(text, ",{:.4}", recording.supplies[k] * (1.0 + SUPPLY_NOISE * normal(&mut rng)));
        }
        text.push('\n');
    }
    text
}
