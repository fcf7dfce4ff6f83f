//! The camera's noise, from its own frames.

use estimation::statistics::median;
use runs::Run;
use runs::frames::{Pose, wrap_angle};

/// Noise below which no real camera is; keeps a noiseless simulation from dividing by zero.
const FLOOR: [f64; 3] = [1e-5, 1e-5, 1e-5];

/// Noise of a heading that nobody measured, rad: a thousand frames of it tell less than a turn.
pub const NO_HEADING_RAD: f64 = 100.0;

/// What is assumed where too few frames follow each other: a league camera.
const USUAL: [f64; 3] = [0.0015, 0.0015, 0.0087];
/// Longest step over shortest up to which four frames follow each other without a gap; coarse ticks
/// make neighbouring steps unequal.
const UNEVEN: f64 = 2.2;
/// The same up to which they count as evenly spaced.
const EVEN: f64 = 1.3;

/// Standard deviations of x, y (m) and heading (rad), from third differences of consecutive frames:
/// motion with limited jerk leaves less than 0.3 mm in them at 60 Hz, white noise √20 times its own
/// size. By the median, so that outliers and missing frames do not matter.
pub fn camera_noise(runs: &[Run]) -> [f64; 3] {
    let seen = |run: &Run| run.camera.iter().map(|f| (run.t[f.tick], f.pose)).collect::<Vec<_>>();
    camera_noise_of(runs.iter().map(seen))
}

/// The noise of what a camera reports: a heading that nobody measured tells nothing.
pub fn with_headings(noise: [f64; 3], positions_only: bool) -> [f64; 3] {
    if positions_only { [noise[0], noise[1], NO_HEADING_RAD] } else { noise }
}

/// The same of runs' frames alone, times in s and poses.
pub fn camera_noise_of(runs: impl IntoIterator<Item = Vec<(f64, Pose)>>) -> [f64; 3] {
    let mut differences: [Vec<f64>; 3] = Default::default();
    for frames in runs {
        for four in frames.windows(4) {
            let t = [0, 1, 2, 3].map(|i| four[i].0);
            let steps = [t[1] - t[0], t[2] - t[1], t[3] - t[2]];
            let (least, most) = steps.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), s| (a.min(*s), b.max(*s)));
            if most > UNEVEN * least {
                continue;
            }
            let weights = if most > EVEN * least { divided(t) } else { [-1.0, 3.0, -3.0, 1.0] };
            let norm = weights.iter().map(|w| w * w).sum::<f64>().sqrt();
            let third = |v: [f64; 4]| weights.iter().zip(v).map(|(w, v)| w * v).sum::<f64>().abs() / norm;
            differences[0].push(third([0, 1, 2, 3].map(|i| four[i].1.x)));
            differences[1].push(third([0, 1, 2, 3].map(|i| four[i].1.y)));
            let theta = four[0].1.theta;
            differences[2].push(third([0, 1, 2, 3].map(|i| wrap_angle(four[i].1.theta - theta))));
        }
    }
    let mut noise = FLOOR;
    for (slot, values) in noise.iter_mut().zip(&mut differences) {
        // Median of |normal| is 0.6745 σ.
        *slot = slot.max(median(values) / 0.6745);
    }
    if differences[0].is_empty() { USUAL } else { noise }
}

/// Weights of the third divided difference: no parabola shows in it, whatever the times.
fn divided(t: [f64; 4]) -> [f64; 4] {
    let apart = |i: usize| (0..4).filter(|j| *j != i).map(|j| t[i] - t[j]).product::<f64>();
    [0, 1, 2, 3].map(|i| 1.0 / apart(i))
}
