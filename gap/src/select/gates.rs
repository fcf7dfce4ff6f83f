//! What an effect must do on held-out data to be named.

use super::{Design, Trial};
use crate::thresholds::Thresholds;
use links::effect::Link;

/// What a candidate must do on data that its fit has not seen.
pub(super) struct Gates<'a> {
    link: Link,
    design: &'a Design,
    thresholds: &'a Thresholds,
    without: Vec<f64>,
    left_by_laws: f64,
}

impl<'a> Gates<'a> {
    pub(super) fn new(link: Link, design: &'a Design, thresholds: &'a Thresholds) -> Self {
        Self { link, design, thresholds, without: design.held_out(None), left_by_laws: design.left_by_laws() }
    }

    pub(super) fn pass(&self, t: &Trial) -> bool {
        let (design, thresholds) = (self.design, self.thresholds);
        if !design.takes(t) {
            return false;
        }
        let with = design.held_out(Some(t.candidate));
        let strong = t.gain > thresholds.strong;
        if self.closes(&self.without, &with, thresholds.held_out_t * if strong { 0.5 } else { 1.0 }) {
            return true;
        }
        // What happens in one run only cannot be predicted from the others, but from its own parts.
        let harmless: f64 = self.without.iter().zip(&with).map(|(a, b)| a - b).sum();
        strong
            && harmless > -thresholds.harms * self.without.iter().sum::<f64>()
            && self.closes(&design.held_out_blocks(None), &design.held_out_blocks(Some(t.candidate)), 1.0)
    }

    /// Whether enough of the held-out loss goes: a share of it, a share of what is more than noise, more than the
    /// laws of what is named leave, and over all clusters.
    fn closes(&self, without: &[f64], with: &[f64], t_needed: f64) -> bool {
        let total: f64 = without.iter().sum();
        let differences: Vec<f64> = without.iter().zip(with).map(|(a, b)| a - b).collect();
        let sum: f64 = differences.iter().sum();
        let spread = differences.iter().map(|d| d * d).sum::<f64>().sqrt();
        let excess = (total - self.design.linear.equations.n()).max(0.0);
        sum >= self.thresholds.share(self.link) * total
            && sum >= self.thresholds.share_of_excess * excess
            && sum >= t_needed * spread
            && sum >= self.left_by_laws
    }
}
