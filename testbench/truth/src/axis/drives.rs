//! What is driven: as people characterise a motor, and as a machine works.

use std::f64::consts::TAU;

use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

use super::{Axis, Logger};

/// One run, row by row.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Drive {
    /// As people call it.
    pub(super) name: &'static str,
    /// Duties, or set points of speed in no-load speeds.
    pub(super) wanted: Vec<f64>,
    /// Whether a speed loop makes the duties.
    pub(super) closed: bool,
}

/// Most rows of a run; a run lasts fifteen mechanical time constants and some seconds where it can.
const ROWS: usize = 6000;
/// Fewest rows of a short log.
const FEWEST_ROWS: usize = 60;

/// The runs of one case: a characterisation with ramps and steps, or steps, staircases, sweeps or a speed loop; or what a
/// desk leaves in a minute: one log of a few steps or of one step from rest, ten to forty time constants long.
pub(super) fn draw(axis: &Axis, logger: &Logger, rng: &mut ChaCha8Rng) -> Vec<Drive> {
    let tau = axis.time_constant();
    let rows = ((30.0 * tau + rng.random_range(6.0..15.0)) / logger.row_s) as usize;
    let (rows, row_s) = (rows.min(ROWS), logger.row_s);
    let top = rng.random_range(0.45..1.0);
    let make = |name, closed, f: &dyn Fn(f64) -> f64| Drive {
        name,
        wanted: (0..rows).map(|k| f(k as f64 * row_s)).collect(),
        closed,
    };
    let seconds = rows as f64 * row_s;
    let mut levels = |holds: f64| {
        let count = (seconds / holds).ceil() as usize + 1;
        let list: Vec<f64> = (0..count).map(|_| top * rng.random_range(-1.0..1.0)).collect();
        move |t: f64| list[((t / holds) as usize).min(list.len() - 1)]
    };
    let steps = levels((4.0 * tau).clamp(4.0 * row_s, 0.2 * seconds));
    let others = levels((2.0 * tau).clamp(4.0 * row_s, 0.2 * seconds));
    let triangle = |t: f64| {
        let x = 2.0 * t / seconds;
        top * (1.0 - (4.0 * (x - x.floor()) - 2.0).abs())
    };
    let sweep = |t: f64| top * (TAU * t * (0.05 + 0.5 * t / seconds) / (2.0 * tau)).sin();
    let stairs = |t: f64| {
        let x = 16.0 * t / seconds;
        let (level, half) = (x.floor() % 8.0, x < 8.0);
        top * (4.0 - (level - 4.0).abs()) / 4.0 * if half { 1.0 } else { -1.0 }
    };
    let ramp = |t: f64| top * t / seconds;
    let one_step = |t: f64| if t < 0.05 * seconds { 0.0 } else { 0.6 * top };
    let still = |f: &dyn Fn(f64) -> f64, t: f64| if t > 0.92 * seconds { 0.0 } else { 0.8 * f(t) };
    let brief = levels(3.0 * tau);
    let few = (tau * rng.random_range(10.0..40.0) / row_s) as usize;
    let short = |mut drive: Drive| {
        drive.wanted.truncate(few.max(FEWEST_ROWS));
        drive
    };
    let kinds = ["characterised", "steps", "stairs", "sweeps", "loop", "short", "one-step"];
    match kinds.choose(rng).copied().unwrap_or("steps") {
        "characterised" => vec![
            make("slow-forward", false, &ramp),
            make("slow-backward", false, &|t| -ramp(t)),
            make("fast-forward", false, &one_step),
            make("fast-backward", false, &|t| -one_step(t)),
        ],
        "stairs" => vec![make("stairs", false, &stairs), make("steps", false, &steps), make("more", false, &others)],
        "sweeps" => vec![make("sweep", false, &sweep), make("ramps", false, &triangle), make("steps", false, &steps)],
        "short" => vec![short(make("steps", false, &brief))],
        "one-step" => vec![short(make("step", false, &|t| if t < tau { 0.0 } else { top }))],
        "loop" => vec![
            make("loop-steps", true, &|t| still(&steps, t)),
            make("loop-ramps", true, &|t| still(&triangle, t)),
            make("loop-more", true, &|t| still(&others, t)),
        ],
        _ => vec![make("steps", false, &steps), make("more", false, &others), make("ramps", false, &triangle)],
    }
}
