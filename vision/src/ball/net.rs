//! What features mean together: small nets beside the additive model, which weighs each on its own.

/// Units of the first and of the second layer.
pub const LAYERS: [usize; 2] = [24, 12];

/// A net of two layers of rectified units over `ROW - 1` features; the last number of a row is what is added.
#[derive(Clone, Debug)]
pub struct Net<const ROW: usize> {
    /// From features to the first layer.
    pub first: [[f32; ROW]; LAYERS[0]],
    /// From the first layer to the second.
    pub second: [[f32; LAYERS[0] + 1]; LAYERS[1]],
    /// From the second layer to the odds.
    pub last: [f32; LAYERS[1] + 1],
}

impl<const ROW: usize> Net<ROW> {
    /// Logarithm of the odds of a ball.
    pub(super) fn odds(&self, features: &[f32]) -> f32 {
        let first = self.first.each_ref().map(|row| sum(row, features).max(0.0));
        let second = self.second.each_ref().map(|row| sum(row, &first).max(0.0));
        sum(&self.last, &second)
    }
}

fn sum(row: &[f32], values: &[f32]) -> f32 {
    row.iter().zip(values).map(|(weight, value)| weight * value).sum::<f32>() + row[values.len()]
}
