//! Ranges, round ticks and their labels.

/// The largest number that is told from others, and one over it the smallest: spans, their ratios and their products with pixels
/// stay numbers.
const LARGEST: f64 = 1e150;
/// The least span in units of the numbers that bound it: ticks within it still differ.
const FINEST: f64 = 1e-13;

/// The smallest of 1, 2, 5 × 10ⁿ that divides `span` into at most `most` steps.
pub(super) fn round_step(span: f64, most: usize) -> f64 {
    let raw = span / most.max(1) as f64;
    let magnitude = 10f64.powf(raw.log10().floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|f| f * magnitude >= raw * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * magnitude
}

/// Multiples of `step` within a range.
pub(super) fn ticks([low, high]: [f64; 2], step: f64) -> Vec<f64> {
    let (first, last) = ((low / step - 1e-6).ceil(), (high / step + 1e-6).floor());
    let n = (last - first).clamp(0.0, 100.0) as usize;
    (0..=n).map(|k| (first + k as f64) * step).collect()
}

/// A tick's label, with as many decimals as the step needs.
pub(super) fn label(value: f64, step: f64) -> String {
    // No "-0".
    let value = if value.abs() < step * 1e-6 { 0.0 } else { value };
    if value.abs().max(step) >= 1e6 || step < 1e-4 {
        return if value == 0.0 { "0".to_owned() } else { format!("{value:.1e}") };
    }
    let decimals = (-step.log10() - 1e-9).ceil().max(0.0) as usize;
    format!("{value:.decimals$}").replace('-', "\u{2212}")
}

/// A range in which places are numbers: the given one, as far as it is one.
pub(super) fn drawable(range: [f64; 2]) -> [f64; 2] {
    let [low, high] = range.map(|v| v.clamp(-LARGEST, LARGEST));
    let least = (FINEST * low.abs().max(high.abs())).max(1.0 / LARGEST);
    if high - low >= least {
        return [low, high];
    }
    let middle = 0.5 * (low + high);
    [middle - 0.5 * least, middle + 0.5 * least]
}

/// The range of some numbers, a little widened; a range about the value where there is only one.
pub(super) fn padded(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let range = values
        .filter(|v| v.is_finite())
        .map(|v| v.clamp(-LARGEST, LARGEST))
        .fold(None, |range: Option<[f64; 2]>, v| Some(range.map_or([v, v], |[low, high]| [low.min(v), high.max(v)])));
    let [low, high] = range.unwrap_or([0.0, 1.0]);
    let margin = 0.04 * (high - low);
    // Rounding noise about a constant is no structure worth a whole axis.
    if margin <= 1e-9 * low.abs().max(1e-9) {
        let half = if low == 0.0 { 1.0 } else { 0.1 * low.abs() };
        return [low - half, high + half];
    }
    [low - margin, high + margin]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round_and_labels_short() {
        for (span, most, step) in [(10.0, 5, 2.0), (0.7, 7, 0.1), (13.0, 6, 5.0), (3e-3, 5, 1e-3), (400.0, 5, 100.0)] {
            assert!((round_step(span, most) / step - 1.0).abs() < 1e-9, "{span}: {}", round_step(span, most));
        }
        assert_eq!(ticks([-0.31, 0.42], 0.2).len(), 4);
        let shown: Vec<String> = ticks([-0.31, 0.42], 0.2).iter().map(|v| label(*v, 0.2)).collect();
        assert_eq!(shown, ["\u{2212}0.2", "0.0", "0.2", "0.4"]);
        assert_eq!(label(2e7, 1e7), "2.0e7");
        assert_eq!(label(0.0, 1e-120), "0");
    }

    #[test]
    fn ranges_survive_constants_gaps_and_nothing() {
        assert_eq!(padded([].into_iter()), [-0.04, 1.04]);
        assert_eq!(padded([5.0, f64::NAN].into_iter()), [4.5, 5.5]);
        assert_eq!(padded([0.0].into_iter()), [-1.0, 1.0]);
        assert_eq!(padded([0.0, 100.0].into_iter()), [-4.0, 104.0]);
    }
}
