//! Whether scores of independent clusters sum to more than chance would: a randomisation test.
//!
//! If nothing is there, the score of every cluster is as likely with either sign, whatever its distribution (Cameron,
//! Gelbach, Miller, "Bootstrap-based improvements for inference with clustered errors", 2008: wild cluster bootstrap
//! with Rademacher weights).

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};

use crate::normal_equations::inverse;

/// Draws of signs.
const FLIPS: u32 = 4999;
/// The least p-value that these draws resolve, 1/5000.
pub const LEAST: f64 = 1.0 / (FLIPS + 1) as f64;
/// Seed of the draws: the same data give the same p-value.
const SEED: u64 = 20_051_123;

/// Two-sided p-value of the sum of the clusters' scores, one vector a cluster; 1 without scores, if they have no
/// inverse spread, or if one of them is no number.
///
/// # Panics
/// If the scores are not of one length.
pub fn p_value(scores: &[DVector<f64>]) -> f64 {
    let Some(m) = scores.first().map(DVector::len) else { return 1.0 };
    assert!(scores.iter().all(|u| u.len() == m), "the scores of all clusters are of one length");
    let mut spread = DMatrix::<f64>::zeros(m, m);
    for u in scores {
        spread += u * u.transpose();
    }
    let Some(inverse) = inverse(&spread) else { return 1.0 };
    let statistic = |signs: &mut dyn FnMut() -> f64| {
        let mut sum = DVector::<f64>::zeros(m);
        for u in scores {
            sum.axpy(signs(), u, 1.0);
        }
        (sum.transpose() * &inverse * &sum)[0]
    };
    let observed = statistic(&mut || 1.0);
    if !observed.is_finite() {
        return 1.0;
    }
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(SEED);
    let reached = (0..FLIPS)
        .filter(|_| {
            let mut sign = || if rng.random::<bool>() { 1.0 } else { -1.0 };
            statistic(&mut sign) >= observed
        })
        .count();
    (reached + 1) as f64 / f64::from(FLIPS + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn p_is_the_share_of_sign_patterns_that_reach_as_far() {
        let of = |scores: &[f64]| p_value(&scores.iter().map(|s| DVector::from_element(1, *s)).collect::<Vec<_>>());
        // All n scores alike: two of 2ⁿ patterns reach the observed sum.
        for n in [1, 3, 5, 8] {
            let (found, expected) = (of(&vec![0.7; n]), 2.0 / 2f64.powi(n as i32));
            assert!((found - expected).abs() < 0.1 * expected + 3e-3, "{n}: {found} for {expected}");
        }
        // Signs in balance: every pattern reaches 0.
        assert!(of(&[1.0, -1.0, 1.0, -1.0]) > 0.99);
        // The unit does not matter, and the least is one in as many as there are draws.
        assert!((of(&[1e-9; 5]) - of(&[1e9; 5])).abs() < 1e-12);
        assert!((of(&[1.0; 40]) - 1.0 / 5000.0).abs() < 1e-12);
    }

    #[test]
    fn both_of_two_columns_are_tested_at_once() {
        // The first column is nothing, the second the same in all of eight clusters.
        let scores: Vec<_> =
            (0..8).map(|i| DVector::from_column_slice(&[if i % 2 == 0 { 1.0 } else { -1.0 }, 2.0])).collect();
        assert!(p_value(&scores) < 0.03, "{}", p_value(&scores));
        assert!((p_value(&[]) - 1.0).abs() < 1e-12);
        // What is no number is no evidence.
        let spoilt = scores.iter().cloned().chain([DVector::from_column_slice(&[f64::NAN, 2.0])]);
        assert!((p_value(&spoilt.collect::<Vec<_>>()) - 1.0).abs() < 1e-12);
    }
}
