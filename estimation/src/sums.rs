//! Sums that a processor can add side by side.

/// Σ a·b over the shorter of two; four sums side by side, which one loop would add one after the other.
#[inline]
#[must_use]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let length = a.len().min(b.len());
    let ((a, a_rest), (b, b_rest)) = (a[..length].as_chunks::<4>(), b[..length].as_chunks::<4>());
    let mut sum = [0.0; 4];
    for (a, b) in a.iter().zip(b) {
        for l in 0..4 {
            sum[l] += a[l] * b[l];
        }
    }
    sum[0] + sum[1] + (sum[2] + sum[3]) + a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::dot;

    #[test]
    fn every_length_is_summed_whole() {
        for n in 0..20 {
            let a: Vec<f64> = (0..n).map(f64::from).collect();
            let expected: f64 = a.iter().map(|x| x * x).sum();
            assert_eq!(dot(&a, &a), expected, "{n}");
            assert_eq!(dot(&a, &[2.0]), 0.0);
        }
    }
}
