//! What a state leaves by itself, nothing adjusted beside it.

use super::plain::losses;
use crate::problem::Problem;
use crate::state::State;
use crate::thresholds::Thresholds;

/// What a state leaves, by clusters, and how much of it is more than noise.
pub(super) struct Left {
    pub(super) clusters: Vec<f64>,
    n: f64,
}

impl Left {
    /// What it leaves on held-out runs.
    pub(super) fn of(problem: &Problem, state: &State) -> Self {
        let (clusters, n) = losses(problem, state);
        Self { clusters, n }
    }

    /// The same on the runs that the state was fitted to.
    pub(super) fn fitted(problem: &Problem, state: &State) -> Self {
        let equations = problem.linearise_nothing(state);
        let clusters = equations.clusters.iter().map(|c| c.rr / c.weight).collect();
        Self { clusters, n: equations.plain().1 }
    }

    pub(super) fn sum(&self) -> f64 {
        self.clusters.iter().sum()
    }

    pub(super) fn excess(&self) -> f64 {
        self.sum() - self.n
    }

    pub(super) fn rms(&self) -> f64 {
        (self.sum() / self.n.max(1.0)).sqrt()
    }

    /// By how much it is more than another, in standard deviations of that over the clusters.
    pub(super) fn above(&self, other: &Self) -> f64 {
        let differences = || self.clusters.iter().zip(&other.clusters).map(|(a, b)| a - b);
        let spread = differences().map(|d| d * d).sum::<f64>().sqrt();
        differences().sum::<f64>() / spread.max(f64::MIN_POSITIVE)
    }

    /// Whether it is far from the noise.
    pub(super) fn is_far(&self, thresholds: &Thresholds) -> bool {
        self.sum() > thresholds.from_noise.powi(2) * self.n
    }

    /// Whether it is no more than noise: the sum of n squares of noise, of which some count as one, has a standard deviation
    /// of the root of twice n and that many.
    pub(super) fn is_noise(&self, thresholds: &Thresholds) -> bool {
        self.excess() < thresholds.told * (2.0 * self.n * thresholds.drive_correlation).sqrt()
    }

    /// Whether it is far more than what another law leaves, which is hardly more than noise.
    ///
    /// Of two laws that differ by d at every residual, one of which leaves noise alone, the other leaves d² more, give or
    /// take twice |d| noise: half the root of what it leaves more is its distance in standard deviations.
    pub(super) fn far_above(&self, other: &Self, thresholds: &Thresholds) -> bool {
        self.apart(other, thresholds) && other.excess().max(0.0) < thresholds.undecided * self.excess()
    }

    /// The same of two that leave no more than the floor: one that was found without a law holds what that law does, and beside
    /// what leaves a small part of it is no noise.
    pub(super) fn far_above_in_floor(&self, other: &Self, thresholds: &Thresholds) -> bool {
        self.apart(other, thresholds) && self.excess() <= 0.0 && other.sum() < thresholds.undecided * self.sum()
    }

    fn apart(&self, other: &Self, thresholds: &Thresholds) -> bool {
        let more = (self.sum() - other.sum()) / thresholds.drive_correlation;
        0.5 * more.max(0.0).sqrt() > thresholds.told
    }

    /// Whether it is no more than what another law leaves, but for what makes a tie.
    pub(super) fn is_hardly_more(&self, other: &Self, thresholds: &Thresholds) -> bool {
        let noise = thresholds.ties[0] * thresholds.drive_correlation;
        self.excess() < (1.0 + thresholds.undecided) * other.excess().max(0.0) + noise
    }

    /// The same, and no more than noise.
    pub(super) fn is_as_little(&self, other: &Self, thresholds: &Thresholds) -> bool {
        !self.is_far(thresholds) && self.is_hardly_more(other, thresholds)
    }
}
