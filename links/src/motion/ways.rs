//! Wheels and poses over several seconds.
//!
//! What wheels slip adds up along the way, what poses err does not. Compared as if every pose erred by itself, a second is as
//! long as a window may be, and what is wrong by a per cent does not show in it. Here both errors are counted: the wheels' as
//! a random walk of the rest of the way, in proportion to what they rolled, the poses' as noise of each group of frames. The
//! residuals of a window are what a Kalman filter that knows both did not expect (its innovations), each in units of its own
//! standard deviation; derivatives go through the same filter. The start pose of a window is known to nothing in it.

use estimation::parallel::each;
use estimation::statistics::median;
use nalgebra::{Matrix3, Vector3};
use runs::frames::{Pose, wrap_angle};

/// Standard deviations of a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// Along each axis, m.
    pub axis_m: f64,
    /// Of the heading, rad.
    pub heading_rad: f64,
}

impl Errors {
    /// So many times as large.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { axis_m: factor * self.axis_m, heading_rad: factor * self.heading_rad }
    }

    fn squares(self) -> Vector3<f64> {
        let axis = self.axis_m * self.axis_m;
        Vector3::new(axis, axis, self.heading_rad * self.heading_rad)
    }
}

/// How far wheels and poses part, and over which time frames are taken together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ways {
    /// Time of a group of frames, s.
    pub together_s: f64,
    /// Of a group's mean pose.
    pub seen: Errors,
    /// What wheels part from their way by over a metre rolled.
    pub wander: Errors,
    /// How far the wheels are from the middle, m: what they roll as the robot turns.
    pub rim_m: f64,
    /// Standard deviations of what is not expected of a group, m, m, rad, in the middle of all.
    pub unexpected: [f64; 3],
    /// By how much more wheels wander than matters, axes and heading, at least 1: a floor is no larger than what matters.
    pub beyond: [f64; 3],
}

/// Standard deviation of a window's start pose before its first frame, m and rad: next to nothing is known.
const ANYWHERE: f64 = 10.0;
/// Weight of a group whose frames are all outliers.
const NOTHING: f64 = 1e-6;
/// Standard deviations of a group's innovation from which it counts less (Huber).
const FAR: f64 = 3.5;
/// Factors by which the likeliest errors are looked for, one after the other, and rounds of each at most.
const FACTORS: [f64; 4] = [4.0, 2.0, 1.3, 1.1];
const ROUNDS: usize = 12;
/// Groups from which errors are known at all.
const FEWEST: usize = 8;

/// A group as the filter sees it: where the model has it, and its weight, 1 where all its frames count.
pub(super) type Group = (Pose, f64);

/// A window's start pose, its groups and their residuals, m, m, rad.
pub(super) type Residuals = (Pose, Vec<Group>, Vec<[f64; 3]>);

/// What the filter does with the residual of one group.
pub(super) struct Step {
    /// What a group's residual shows of an error of the start pose.
    rows: Matrix3<f64>,
    gain: Matrix3<f64>,
    /// What makes an innovation white.
    whitens: Matrix3<f64>,
    ln_det: f64,
    unexpected: [f64; 3],
}

impl Ways {
    /// Groups of that length, nothing known of the errors but by the noise of a group's pose.
    pub(super) fn begin(together_s: f64, rim_m: f64, seen: Errors) -> Self {
        Self { together_s, seen, wander: seen, rim_m, unexpected: [0.0; 3], beyond: [1.0; 3] }
    }

    /// The same with all errors so many times as large.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        let [seen, wander] = [self.seen, self.wander].map(|e| e.times(factor));
        Self { seen, wander, unexpected: self.unexpected.map(|s| factor * s), ..self }
    }

    /// The same with what the wheels wander so many times what matters, along an axis and in heading.
    #[must_use]
    pub fn beyond(self, [axis, heading]: [f64; 2]) -> Self {
        Self { beyond: [axis, axis, heading].map(|b| b.max(1.0)), ..self }
    }

    /// The filter along a window's groups.
    pub(super) fn steps(&self, start: Pose, groups: &[Group]) -> Vec<Step> {
        let mut p = Matrix3::from_diagonal_element(ANYWHERE * ANYWHERE);
        let (seen, wander) = (self.seen.squares(), self.wander.squares());
        let mut before: Option<Pose> = None;
        let mut step = |&(pose, weight): &Group| {
            if let Some(before) = before {
                let turned = wrap_angle(pose.theta - before.theta).abs();
                let rolled = (pose.x - before.x).hypot(pose.y - before.y) + self.rim_m * turned;
                // A turn about where it happens, seen from the start.
                let middle = [0.5 * (pose.x + before.x) - start.x, 0.5 * (pose.y + before.y) - start.y];
                let from_start = shift(middle.map(|m| -m));
                p += from_start * Matrix3::from_diagonal(&(rolled * wander)) * from_start.transpose();
            }
            before = Some(pose);
            let rows = shift([pose.x - start.x, pose.y - start.y]);
            let noise = Matrix3::from_diagonal(&(seen / weight.max(NOTHING)));
            let s = rows * p * rows.transpose() + noise;
            // A sum of a positive semidefinite matrix and a positive diagonal.
            let Some(cholesky) = s.cholesky() else {
                let none = Matrix3::zeros();
                return Step { rows, gain: none, whitens: none, ln_det: 0.0, unexpected: [0.0; 3] };
            };
            let root = cholesky.l();
            let gain = p * rows.transpose() * cholesky.inverse();
            let rest = Matrix3::identity() - gain * rows;
            p = rest * p * rest.transpose() + gain * noise * gain.transpose();
            Step {
                rows,
                gain,
                whitens: root.try_inverse().unwrap_or_default(),
                ln_det: 2.0 * root.diagonal().map(f64::ln).sum(),
                unexpected: [0, 1, 2].map(|i| s[(i, i)].sqrt()),
            }
        };
        groups.iter().map(&mut step).collect()
    }

    /// The errors that make what a model leaves likeliest; `None` where there is next to nothing.
    pub(super) fn likeliest(mut self, windows: &[Residuals]) -> Option<Self> {
        // The first group of a window finds its start pose.
        if windows.iter().map(|w| w.1.len().saturating_sub(1)).sum::<usize>() < FEWEST {
            return None;
        }
        let mut best = self.unlikelihood(windows);
        for factor in FACTORS {
            for _ in 0..ROUNDS {
                let mut moved = false;
                for error in 0..4 {
                    let other = [factor, 1.0 / factor].map(|by| self.with(error, by));
                    let other = other.map(|ways| (ways.unlikelihood(windows), ways));
                    if let Some((less, ways)) = other.into_iter().find(|(unlikely, _)| *unlikely < best) {
                        (best, self, moved) = (less, ways, true);
                    }
                }
                if !moved {
                    break;
                }
            }
        }
        let steps: Vec<Vec<Step>> = each(windows, &|(start, groups, _)| self.steps(*start, groups));
        let after_first = || steps.iter().flat_map(|w| &w[1..]);
        let unexpected = [0, 1, 2].map(|i| median(&mut after_first().map(|s| s.unexpected[i]).collect::<Vec<f64>>()));
        Some(Self { unexpected, ..self })
    }

    /// The same with one of its four errors so many times as large.
    fn with(mut self, error: usize, factor: f64) -> Self {
        let errors = if error < 2 { &mut self.seen } else { &mut self.wander };
        *(if error.is_multiple_of(2) { &mut errors.axis_m } else { &mut errors.heading_rad }) *= factor;
        self
    }

    /// Twice the negative logarithm of the likelihood of residuals, but for a constant.
    fn unlikelihood(&self, windows: &[Residuals]) -> f64 {
        let of = |(start, groups, residuals): &Residuals| -> f64 {
            let steps = self.steps(*start, groups);
            let white = whitened(&steps, residuals);
            let each = steps.iter().zip(&white).skip(1).map(|(step, r)| {
                let far = Vector3::from(*r).norm();
                step.ln_det + if far < FAR { far * far } else { FAR * (2.0 * far - FAR) }
            });
            each.sum()
        };
        each(windows, &of).iter().sum()
    }
}

/// What an error of a pose (x, y, heading) is at a place that far from it.
fn shift([x, y]: [f64; 2]) -> Matrix3<f64> {
    Matrix3::new(1.0, 0.0, -y, 0.0, 1.0, x, 0.0, 0.0, 1.0)
}

/// Residuals of a window (m, m, rad) as the filter sees them, in standard deviations.
pub(super) fn whitened(steps: &[Step], residuals: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut expected = Vector3::zeros();
    let mut white = |(step, r): (&Step, &[f64; 3])| {
        let innovation = Vector3::from(*r) - step.rows * expected;
        expected += step.gain * innovation;
        (step.whitens * innovation).into()
    };
    steps.iter().zip(residuals).map(&mut white).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// Windows of a robot on a circle whose wheels and poses err by known amounts.
    fn drawn(seen: Errors, wander: Errors, rim_m: f64, windows: usize) -> Vec<Residuals> {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        let mut normal = move || -> f64 { StandardNormal.sample(&mut random) };
        let window = |_| {
            let start = Pose::new(0.3, -0.2, 0.4);
            let at = |k: usize| {
                let angle = 0.25 * k as f64;
                start.compose(Pose::new(0.6 * angle.sin(), 0.6 * (1.0 - angle.cos()), angle))
            };
            let groups: Vec<Group> = (0..20).map(|k| (at(k), 1.0)).collect();
            // Errors of the start pose that have the wheels where they are.
            let mut error = Vector3::new(0.01 * normal(), 0.01 * normal(), 0.02 * normal());
            let mut residuals = Vec::new();
            for k in 0..groups.len() {
                if k > 0 {
                    let [a, b] = [groups[k - 1].0, groups[k].0];
                    let rolled = (b.x - a.x).hypot(b.y - a.y) + rim_m * wrap_angle(b.theta - a.theta).abs();
                    let local = Vector3::new(wander.axis_m, wander.axis_m, wander.heading_rad) * rolled.sqrt();
                    let local = local.map(|s| s * normal());
                    error += shift([start.x - 0.5 * (a.x + b.x), start.y - 0.5 * (a.y + b.y)]) * local;
                }
                let place = groups[k].0;
                let r = shift([place.x - start.x, place.y - start.y]) * error;
                residuals.push([
                    r.x + seen.axis_m * normal(),
                    r.y + seen.axis_m * normal(),
                    r.z + seen.heading_rad * normal(),
                ]);
            }
            (start, groups, residuals)
        };
        (0..windows).map(window).collect()
    }

    #[test]
    fn errors_are_found_that_were_drawn() {
        let seen = Errors { axis_m: 4e-4, heading_rad: 2e-3 };
        let wander = Errors { axis_m: 3e-3, heading_rad: 1e-2 };
        let windows = drawn(seen, wander, 0.1, 60);
        let begin = Errors { axis_m: 1e-3, heading_rad: 1e-3 };
        let found = Ways::begin(0.5, 0.1, begin).likeliest(&windows).unwrap();
        for (found, drawn) in [
            (found.seen.heading_rad, seen.heading_rad),
            (found.wander.axis_m, wander.axis_m),
            (found.wander.heading_rad, wander.heading_rad),
        ] {
            assert!((found / drawn - 1.0).abs() < 0.2, "{found} of {drawn}");
        }
        assert!(found.seen.axis_m < 2.0 * seen.axis_m, "{}", found.seen.axis_m);
        // What is not expected is white then, and has nothing of the start pose.
        let white: Vec<[f64; 3]> = windows
            .iter()
            .flat_map(|(start, groups, r)| whitened(&found.steps(*start, groups), r).split_off(1))
            .collect();
        let rms = estimation::statistics::rms(white.iter().flatten().copied());
        assert!((rms - 1.0).abs() < 0.05, "{rms}");
    }

    #[test]
    fn a_wrong_start_pose_is_nothing() {
        let none = Errors { axis_m: 1e-3, heading_rad: 1e-3 };
        let (start, groups, _) = drawn(none, none, 0.1, 1).remove(0);
        let error = Vector3::new(0.02, -0.01, 0.03);
        let residuals: Vec<[f64; 3]> =
            groups.iter().map(|(p, _)| (shift([p.x - start.x, p.y - start.y]) * error).into()).collect();
        let white = whitened(&Ways::begin(0.5, 0.1, none).steps(start, &groups), &residuals);
        assert!(white.iter().flatten().all(|r| r.abs() < 0.01), "{white:?}");
    }
}
