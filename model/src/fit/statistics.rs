//! Small statistics.

/// Median; `None` of nothing.
pub(super) fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// 97.5 % quantile of Student's t, to 0.5 % from 3 degrees of freedom (Cornish-Fisher expansion in
/// Abramowitz and Stegun 26.7.5); the value for 3 below that.
pub fn t_quantile_975(degrees_of_freedom: usize) -> f64 {
    const Z: f64 = 1.959_963_984_540_054;
    let nu = degrees_of_freedom.max(3) as f64;
    let g1 = (Z.powi(3) + Z) / 4.0;
    let g2 = (5.0 * Z.powi(5) + 16.0 * Z.powi(3) + 3.0 * Z) / 96.0;
    let g3 = (3.0 * Z.powi(7) + 19.0 * Z.powi(5) + 17.0 * Z.powi(3) - 15.0 * Z) / 384.0;
    let g4 = (79.0 * Z.powi(9) + 776.0 * Z.powi(7) + 1482.0 * Z.powi(5) - 1920.0 * Z.powi(3) - 945.0 * Z) / 92_160.0;
    Z + g1 / nu + g2 / nu.powi(2) + g3 / nu.powi(3) + g4 / nu.powi(4)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (nu, t) in [(3, 3.182), (5, 2.571), (10, 2.228), (30, 2.042), (1000, 1.962)] {
            assert!((t_quantile_975(nu) / t - 1.0).abs() < 0.005, "{nu}: {}", t_quantile_975(nu));
        }
        assert_eq!(t_quantile_975(0), t_quantile_975(3));
    }
}
