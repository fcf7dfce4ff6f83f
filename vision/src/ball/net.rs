//! What features mean together: small nets beside the additive model, which weighs each on its own.

use super::weights::{COUNT, KNOTS, NETS};

/// Units of the first and of the second layer.
pub const LAYERS: [usize; 2] = [24, 12];

/// A net of two layers of rectified units; the last number of a row is what is added.
#[derive(Clone, Debug)]
pub struct Net {
    /// From features to the first layer.
    pub first: [[f32; COUNT + 1]; LAYERS[0]],
    /// From the first layer to the second.
    pub second: [[f32; LAYERS[0] + 1]; LAYERS[1]],
    /// From the second layer to the odds.
    pub last: [f32; LAYERS[1] + 1],
}

impl Net {
    fn odds(&self, features: &[f32; COUNT]) -> f32 {
        let first = self.first.each_ref().map(|row| sum(row, features).max(0.0));
        let second = self.second.each_ref().map(|row| sum(row, &first).max(0.0));
        sum(&self.last, &second)
    }
}

fn sum(row: &[f32], values: &[f32]) -> f32 {
    row.iter().zip(values).map(|(weight, value)| weight * value).sum::<f32>() + row[values.len()]
}

/// Logarithm of the odds of a ball, the mean of all nets. What lies beyond the knots counts as the nearest one: there was
/// nothing to learn from.
pub(super) fn odds(features: &[f32; COUNT]) -> f32 {
    let within = std::array::from_fn(|i| features[i].clamp(KNOTS[i][0], KNOTS[i][KNOTS[i].len() - 1]));
    NETS.iter().map(|net| net.odds(&within)).sum::<f32>() / NETS.len() as f32
}
