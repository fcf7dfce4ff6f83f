//! Least squares that leaves alone what the data do not fix, and says what that is.

use nalgebra::{DMatrix, DVector};

/// A direction of the parameter space about which the data say nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct UnknownDirection {
    /// Components along the parameters, each in its own scale, normalised.
    pub direction: Vec<f64>,
    /// Standard deviation along it, in the same scales; infinite where nothing is measured at all.
    pub sd: f64,
}

/// Normal equations summed over clusters, parameters in scales in which they compare with each other and residuals in
/// units of their noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Truncated {
    /// JᵀJ.
    pub information: DMatrix<f64>,
    /// Jᵀr.
    pub gradient: DVector<f64>,
    /// Sum over clusters of score · scoreᵀ.
    pub spread: DMatrix<f64>,
    /// Number of clusters.
    pub clusters: usize,
    /// Standard deviation, in the scales, beyond which a direction counts as unknown; finite.
    pub unknown_beyond: f64,
}

impl Truncated {
    /// Those of no cluster.
    pub fn new(parameters: usize, unknown_beyond: f64) -> Self {
        let square = || DMatrix::zeros(parameters, parameters);
        Self {
            information: square(),
            gradient: DVector::zeros(parameters),
            spread: square(),
            clusters: 0,
            unknown_beyond,
        }
    }

    /// Adds a cluster's JᵀJ and Jᵀr.
    ///
    /// # Panics
    /// If they are not of as many parameters.
    pub fn add(&mut self, information: &DMatrix<f64>, score: &DVector<f64>) {
        self.spread += score * score.transpose();
        self.information += information;
        self.gradient += score;
        self.clusters += 1;
    }

    /// A basis of the directions that are known, scaled so that the information is 1 along each,
    /// and the directions that are not: all of them where a cluster is no number.
    fn whitened(&self) -> (DMatrix<f64>, Vec<UnknownDirection>) {
        let n = self.gradient.len();
        let mut numbers = self.information.iter().chain(&self.spread).chain(&self.gradient);
        if n == 0 || !numbers.all(|x| x.is_finite()) {
            let axis = |i: usize| (0..n).map(|k| f64::from(u8::from(k == i))).collect();
            let unknown = (0..n).map(|i| UnknownDirection { direction: axis(i), sd: f64::INFINITY });
            return (DMatrix::zeros(n, 0), unknown.collect());
        }
        let eigen = self.information.clone().symmetric_eigen();
        let (mut known, mut unknown) = (Vec::new(), Vec::new());
        for (value, v) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
            let sd = if *value > 0.0 { value.powf(-0.5) } else { f64::INFINITY };
            if sd.is_finite() && sd <= self.unknown_beyond {
                known.push(v * sd);
            } else {
                unknown.push(UnknownDirection { direction: v.iter().copied().collect(), sd });
            }
        }
        let basis = if known.is_empty() { DMatrix::zeros(n, 0) } else { DMatrix::from_columns(&known) };
        (basis, unknown)
    }

    /// The step to the least squares, none along what is unknown.
    pub fn step(&self) -> DVector<f64> {
        let (basis, _) = self.whitened();
        &basis * (basis.transpose() * &self.gradient)
    }

    /// Covariance of the estimates, and what is unknown: robust against anything correlated within a cluster, nowhere
    /// below what the noise alone, or `reduced_chi2` of it, explains. What is unknown is as uncertain as the limit
    /// beyond which it counts as unknown.
    pub fn covariance(&self, reduced_chi2: f64) -> (DMatrix<f64>, Vec<UnknownDirection>) {
        let (basis, unknown) = self.whitened();
        let (clusters, n) = (self.clusters as f64, self.gradient.len() as f64);
        let small_sample = clusters / (clusters - n).max(1.0);
        // In the whitened basis the noise alone explains the identity. A few clusters can agree by
        // chance, so that no direction is granted less.
        let mut covariance = DMatrix::zeros(self.gradient.len(), self.gradient.len());
        if basis.ncols() > 0 {
            let mut spread = (basis.transpose() * &self.spread * &basis * small_sample).symmetric_eigen();
            for value in spread.eigenvalues.iter_mut() {
                *value = value.max(reduced_chi2).max(1.0);
            }
            covariance = &basis * spread.recompose() * basis.transpose();
        }
        for u in &unknown {
            let v = DVector::from_column_slice(&u.direction);
            covariance += &v * v.transpose() * self.unknown_beyond.powi(2);
        }
        (covariance, unknown)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Clusters of one residual each: a row of J and what it leaves.
    fn of(rows: &[([f64; 2], f64)]) -> Truncated {
        let mut out = Truncated::new(2, 20.0);
        for (row, residual) in rows {
            let j = DVector::from_column_slice(row);
            out.add(&(&j * j.transpose()), &(&j * *residual));
        }
        out
    }

    #[test]
    fn what_is_measured_is_solved_and_what_is_not_stays() {
        let table = [
            // Both measured.
            (vec![([1.0, 0.0], 3.0), ([0.0, 1.0], -2.0)], [3.0, -2.0], 0),
            // Only their sum: shared evenly, the difference left alone.
            (vec![([1.0, 1.0], 4.0), ([1.0, 1.0], 4.0)], [2.0, 2.0], 1),
            // The second so weakly that its standard deviation is 100.
            (vec![([1.0, 0.0], 3.0), ([0.0, 0.01], 5.0)], [3.0, 0.0], 1),
            (vec![], [0.0, 0.0], 2),
            // What is no number tells nothing.
            (vec![([1.0, 0.0], 3.0), ([0.0, 1.0], f64::NAN)], [0.0, 0.0], 2),
            (vec![([1.0, 0.0], 3.0), ([0.0, f64::INFINITY], 1.0)], [0.0, 0.0], 2),
        ];
        for (rows, step, unknown) in table {
            let truncated = of(&rows);
            assert!((truncated.step() - DVector::from_column_slice(&step)).amax() < 1e-9, "{rows:?}");
            assert_eq!(truncated.covariance(1.0).1.len(), unknown, "{rows:?}");
        }
    }

    #[test]
    fn without_parameters_nothing_is_known_and_nothing_unknown() {
        let none = Truncated::new(0, 20.0);
        assert_eq!(none.step().len(), 0);
        assert_eq!(none.covariance(1.0), (DMatrix::zeros(0, 0), vec![]));
    }

    #[test]
    fn a_variance_is_the_clusters_own_but_never_below_the_noise() {
        let scatter = |r: f64| of(&[([1.0, 0.0], r), ([1.0, 0.0], -r), ([1.0, 0.0], r), ([1.0, 0.0], -r)]);
        // Four scores of r² over 4², times 4/2; the noise alone explains 1/4.
        for (r, chi2, expected) in [(0.1, 1.0, 0.25), (3.0, 1.0, 9.0 / 4.0 * 2.0), (0.1, 5.0, 1.25)] {
            let (covariance, unknown) = scatter(r).covariance(chi2);
            assert!((covariance[(0, 0)] - expected).abs() < 1e-9, "{r}: {covariance}");
            // Of the other parameter nothing is known.
            assert!((covariance[(1, 1)] - 400.0).abs() < 1e-9 && unknown[0].sd.is_infinite());
        }
    }
}
