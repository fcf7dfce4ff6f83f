//! Small statistics.

/// Median, of an even number the upper of the two in the middle; 0 of nothing.
pub fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

/// Root mean square; 0 of nothing.
pub fn rms(values: impl IntoIterator<Item = f64>) -> f64 {
    let (mut sum, mut n) = (0.0, 0.0_f64);
    for v in values {
        sum += v * v;
        n += 1.0;
    }
    if n > 0.0 { (sum / n).sqrt() } else { 0.0 }
}

/// Natural logarithm of the gamma function (Lanczos), for positive arguments.
pub fn ln_gamma(x: f64) -> f64 {
    const C: [f64; 6] = [
        76.180_091_729_471_46,
        -86.505_320_329_416_77,
        24.014_098_240_830_91,
        -1.231_739_572_450_155,
        0.120_865_097_386_617_9e-2,
        -0.539_523_938_495_3e-5,
    ];
    let t = x + 5.5 - (x + 0.5) * (x + 5.5).ln();
    let series = C.iter().enumerate().fold(1.000_000_000_190_015, |s, (i, c)| s + c / (x + 1.0 + i as f64));
    -t + (2.506_628_274_631_000_5 * series / x).ln()
}

/// Upper tail of the χ² distribution with `k` degrees of freedom, to eight digits up to millions of them.
pub fn chi2_upper(x: f64, k: f64) -> f64 {
    if x <= 0.0 || k <= 0.0 {
        return 1.0;
    }
    if x == f64::INFINITY {
        return 0.0;
    }
    let (a, x) = (0.5 * k, 0.5 * x);
    // Terms that count lie within some widths of the distribution, which is as wide as the root of its middle.
    let terms = 500 + (20.0 * a.sqrt()) as u32;
    let front = (-x + a * x.ln() - ln_gamma(a)).exp();
    if x < a + 1.0 {
        let (mut term, mut sum, mut n) = (1.0 / a, 1.0 / a, a);
        for _ in 0..terms {
            n += 1.0;
            term *= x / n;
            sum += term;
            if term < sum * 1e-15 {
                break;
            }
        }
        return (1.0 - front * sum).clamp(0.0, 1.0);
    }
    // Continued fraction (Lentz).
    let mut b = x + 1.0 - a;
    let mut c = 1e300;
    let mut d = 1.0 / b;
    let mut h = d;
    for i in 1..terms {
        let an = -f64::from(i) * (f64::from(i) - a);
        b += 2.0;
        d = an * d + b;
        d = 1.0 / if d.abs() < 1e-300 { 1e-300 } else { d };
        c = b + an / c;
        if c.abs() < 1e-300 {
            c = 1e-300;
        }
        let delta = d * c;
        h *= delta;
        if (delta - 1.0).abs() < 1e-15 {
            break;
        }
    }
    (front * h).clamp(0.0, 1.0)
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

    #[test]
    fn small_sets_have_a_middle_and_a_size() {
        for (values, middle, size) in [
            (vec![], 0.0, 0.0),
            (vec![3.0], 3.0, 3.0),
            (vec![3.0, -4.0], 3.0, 12.5_f64.sqrt()),
            (vec![1.0, 9.0, 2.0], 2.0, (86.0_f64 / 3.0).sqrt()),
        ] {
            assert!((median(&mut values.clone()) - middle).abs() < 1e-12, "{values:?}");
            assert!((rms(values.iter().copied()) - size).abs() < 1e-12, "{values:?}");
        }
    }

    #[test]
    fn tails_are_those_of_the_tables() {
        for (x, k, p) in [(3.841, 1.0, 0.05), (11.345, 3.0, 0.01), (1.0, 2.0, 0.606_53), (100.0, 100.0, 0.481_19)] {
            assert!((chi2_upper(x, k) / p - 1.0).abs() < 2e-3, "{x} {k}: {}", chi2_upper(x, k));
        }
        assert!(chi2_upper(2000.0, 1.0) >= 0.0);
        assert_eq!(chi2_upper(f64::INFINITY, 3.0), 0.0);
        // By scipy; on both sides of the middle, where the most terms count.
        for (x, k, p) in [
            (1e4, 1e4, 0.498_119_366),
            (1.02e4, 1e4, 0.079_328_881),
            (1e6, 1e6, 0.499_811_937),
            (1.002e6, 1e6, 0.078_718_661),
            (0.998e6, 1e6, 0.921_419_708),
        ] {
            assert!((chi2_upper(x, k) / p - 1.0).abs() < 1e-7, "{x} {k}: {}", chi2_upper(x, k));
        }
    }
}
