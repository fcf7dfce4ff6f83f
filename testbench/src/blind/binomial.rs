//! Exact bounds of a rate (Clopper and Pearson, Biometrika 26, 1934).

/// Probability of at most `k` hits in `n` trials at rate `p`.
fn at_most(k: usize, n: usize, p: f64) -> f64 {
    if p <= 0.0 || k >= n {
        return 1.0;
    }
    if p >= 1.0 {
        return 0.0;
    }
    let mut log_term = n as f64 * (1.0 - p).ln();
    let mut sum = log_term.exp();
    for i in 1..=k {
        log_term += ((n - i + 1) as f64 / i as f64).ln() + p.ln() - (1.0 - p).ln();
        sum += log_term.exp();
    }
    sum.min(1.0)
}

/// The rate above which `k` or fewer hits in `n` trials happen with probability 1 − `confidence` at most.
///
/// ```
/// // No hit in n trials: 1 − 0.05^(1/n).
/// assert!((testbench::blind::upper_bound(0, 20, 0.95) - 0.139_108).abs() < 1e-6);
/// ```
pub fn upper_bound(k: usize, n: usize, confidence: f64) -> f64 {
    if k >= n {
        return 1.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let p = 0.5 * (low + high);
        if at_most(k, n, p) > 1.0 - confidence { low = p } else { high = p }
    }
    0.5 * (low + high)
}

/// The rate below which `k` or more hits in `n` trials happen with probability 1 − `confidence` at most.
pub fn lower_bound(k: usize, n: usize, confidence: f64) -> f64 {
    if n == 0 { 0.0 } else { 1.0 - upper_bound(n - k.min(n), n, confidence) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_those_of_the_tables() {
        // One-sided 97.5 %, so two-sided 95 %: 3 of 20 gives 3.21 % to 37.89 %.
        assert!((upper_bound(3, 20, 0.975) - 0.378_927).abs() < 1e-5);
        assert!((lower_bound(3, 20, 0.975) - 0.032_071).abs() < 1e-5);
        assert!((upper_bound(0, 200, 0.95) - (1.0 - 0.05_f64.powf(1.0 / 200.0))).abs() < 1e-9);
        assert_eq!(upper_bound(5, 5, 0.95), 1.0);
        assert_eq!(lower_bound(0, 5, 0.95), 0.0);
        assert_eq!(upper_bound(0, 0, 0.95), 1.0);
    }
}
