//! Linearised residuals, condensed to small matrices per cluster.
//!
//! All that selection needs (fits of any subset of columns on any runs, held-out losses, robust
//! covariances, sign flips, look-alikes) comes from JᵀJ, Jᵀr and rᵀr of each cluster, so that its
//! cost does not depend on the length of the logs.

use std::sync::{Arc, OnceLock};

use nalgebra::{DMatrix, DVector};

use crate::Symmetric;

/// One cluster: residuals that may be correlated with each other, but not with other clusters.
#[derive(Debug, Clone)]
pub struct Cluster {
    /// Index of the run.
    pub run: usize,
    /// Start, s.
    pub t: f64,
    /// Number of residuals less fitted nuisances.
    pub n: f64,
    /// rᵀr.
    pub rr: f64,
    /// Jᵀr.
    pub jr: DVector<f64>,
    /// JᵀJ.
    pub jj: Symmetric,
    /// Huber weight that n, rr, jr and jj carry already.
    pub weight: f64,
    /// Huber loss minus rr: constant under a linear step.
    pub offset: f64,
}

/// Mean square from which a cluster counts less, in units of the noise: a burst of slip in one
/// second must not outweigh a minute of driving.
const BURST: f64 = 4.0;

impl Cluster {
    /// Condenses residuals and their Jacobian.
    ///
    /// # Panics
    /// If the Jacobian has not a row a residual.
    pub fn new(run: usize, t: f64, n: f64, residual: &DVector<f64>, jacobian: &DMatrix<f64>) -> Self {
        assert_eq!(jacobian.nrows(), residual.len(), "a Jacobian has a row a residual");
        Self {
            run,
            t,
            n,
            rr: residual.norm_squared(),
            jr: jacobian.transpose() * residual,
            jj: Symmetric::of(&(jacobian.transpose() * jacobian)),
            weight: 1.0,
            offset: 0.0,
        }
    }

    /// The same with columns that stand several times: column i is `of[i]` of this one's.
    ///
    /// # Panics
    /// If this one has not so many columns.
    #[must_use]
    pub fn spread(self, of: &[usize]) -> Self {
        Self { jr: DVector::from_fn(of.len(), |i, _| self.jr[of[i]]), jj: self.jj.spread(of), ..self }
    }

    /// Huber loss after a step along the columns.
    ///
    /// # Panics
    /// If the step has not as many entries as there are columns.
    pub fn loss_after(&self, step: &DVector<f64>) -> f64 {
        let moved = self.rr - 2.0 * step.dot(&self.jr) + self.jj.square(step);
        let (square, n) = (moved.max(0.0) / self.weight, self.n / self.weight);
        huber(square, BURST * n)
    }

    /// Appends neighbours in order, so many together as one, each alone for 0.
    ///
    /// # Panics
    /// If those that come together have not the same columns.
    pub fn append(clusters: &mut Vec<Self>, neighbours: Vec<Self>, together: usize) {
        for (k, cluster) in neighbours.into_iter().enumerate() {
            match clusters.last_mut() {
                Some(last) if k % together.max(1) != 0 => last.add(&cluster),
                _ => clusters.push(cluster),
            }
        }
    }

    /// The same clusters with the last `nuisances` columns fitted over all of them, whatever the others are, and gone: the
    /// rest is what those columns cannot do (Frisch and Waugh 1933).
    ///
    /// # Panics
    /// If the clusters have not the same columns, or fewer than `nuisances`.
    #[must_use]
    pub fn beside(clusters: Vec<Self>, nuisances: usize) -> Vec<Self> {
        let Some(first) = clusters.first() else { return clusters };
        let all = first.jr.len();
        let m = all - nuisances;
        let mut jj = DMatrix::zeros(all, all);
        let mut jr = DVector::zeros(all);
        for c in &clusters {
            c.jj.add_to(&mut jj);
            jr += &c.jr;
        }
        let own = jj.view((m, m), (nuisances, nuisances)).into_owned();
        let mut of_columns = DMatrix::zeros(nuisances, m);
        for (j, mut slot) in of_columns.column_iter_mut().enumerate() {
            slot.copy_from(&solve(&own, &jj.view((m, j), (nuisances, 1)).column(0).into_owned()));
        }
        let of_residual = solve(&own, &jr.rows(m, nuisances).into_owned());
        let without = |c: Self| {
            let full = c.jj.full();
            let columns = full.view((0, 0), (m, m)).into_owned();
            let cross = full.view((m, 0), (nuisances, m)).into_owned();
            let square = full.view((m, m), (nuisances, nuisances)).into_owned();
            let (score, nuisance_score) = (c.jr.rows(0, m).into_owned(), c.jr.rows(m, nuisances).into_owned());
            let fitted = of_columns.transpose() * &cross;
            Self {
                rr: (c.rr - 2.0 * of_residual.dot(&nuisance_score) + of_residual.dot(&(&square * &of_residual)))
                    .max(0.0),
                jr: score - of_columns.transpose() * nuisance_score - cross.transpose() * &of_residual
                    + of_columns.transpose() * (&square * &of_residual),
                jj: Symmetric::of(
                    &(columns - &fitted - fitted.transpose() + of_columns.transpose() * &square * &of_columns),
                ),
                ..c
            }
        };
        clusters.into_iter().map(without).collect()
    }

    /// Joins the residuals of a neighbour.
    ///
    /// # Panics
    /// If it has not the same columns.
    pub fn add(&mut self, other: &Self) {
        assert_eq!(self.jr.len(), other.jr.len(), "neighbours have the same columns");
        self.n += other.n;
        self.rr += other.rr;
        self.jr += &other.jr;
        self.jj.add(&other.jj);
    }

    /// Weighs a cluster down whose residuals are far beyond the noise (Huber on its norm).
    fn robust(mut self) -> Self {
        let limit = BURST * self.n;
        if self.rr > limit && self.n > 0.0 {
            let huber = huber(self.rr, limit);
            self.weight = (limit / self.rr).sqrt();
            self.n *= self.weight;
            self.rr *= self.weight;
            self.jr *= self.weight;
            self.jj.scale(self.weight);
            self.offset = huber - self.rr;
        }
        self
    }
}

/// Huber's loss of a cluster with this sum of squares, a square up to `limit`.
fn huber(square: f64, limit: f64) -> f64 {
    if square > limit && limit > 0.0 { 2.0 * (limit * square).sqrt() - limit } else { square }
}

/// Linearised residuals, condensed.
#[derive(Debug, Clone)]
pub struct NormalEquations {
    /// Sums that belong together, such as those of a window.
    pub clusters: Vec<Cluster>,
    /// Group of each cluster for leaving out: the run, or a block of a single run.
    pub folds: Vec<usize>,
    totals: OnceLock<Arc<Totals>>,
}

/// Sums over all clusters.
#[derive(Debug, Clone)]
pub struct Totals {
    /// JᵀJ.
    pub jj: DMatrix<f64>,
    /// Jᵀr.
    pub jr: DVector<f64>,
    /// rᵀr.
    pub rr: f64,
    /// JᵀJ and Jᵀr of each fold.
    pub folds: Vec<(usize, DMatrix<f64>, DVector<f64>)>,
}

/// Blocks a single run is cut into.
const BLOCKS: usize = 4;
/// Regularisation in units of a column's own information: keeps exact twins solvable without moving
/// anything measurable.
const REGULARISATION: f64 = 1e-9;

impl NormalEquations {
    /// Sets up folds: leave one run out, or blocks of a single run.
    ///
    /// # Panics
    /// If the clusters have not the same columns.
    pub fn new(clusters: Vec<Cluster>) -> Self {
        let same = clusters.iter().all(|c| c.jr.len() == clusters[0].jr.len());
        assert!(same, "all clusters of normal equations have the same columns");
        let clusters: Vec<Cluster> = clusters.into_iter().map(Cluster::robust).collect();
        let first = clusters.first().map_or(0, |c| c.run);
        let single = clusters.iter().all(|c| c.run == first);
        let n = clusters.len();
        let folds =
            (0..n).map(|i| if single { i * BLOCKS.min(n.max(1)) / n.max(1) } else { clusters[i].run }).collect();
        Self { clusters, folds, totals: OnceLock::new() }
    }

    /// The same clusters with other folds.
    #[must_use]
    pub fn with_folds(&self, of: impl Fn(usize) -> usize) -> Self {
        let folds = (0..self.clusters.len()).map(of).collect();
        Self { clusters: self.clusters.clone(), folds, totals: OnceLock::new() }
    }

    /// The clusters of one run alone, as they are weighted here.
    #[must_use]
    pub fn of_run(&self, run: usize) -> Self {
        let own = self.clusters.iter().zip(&self.folds).filter(|(c, _)| c.run == run);
        let (clusters, folds) = own.map(|(c, fold)| (c.clone(), *fold)).unzip();
        Self { clusters, folds, totals: OnceLock::new() }
    }

    /// Sums over all clusters, worked out once.
    pub fn totals(&self) -> Arc<Totals> {
        let sum = || {
            let m = self.clusters.first().map_or(0, |c| c.jr.len());
            let mut folds: Vec<(usize, DMatrix<f64>, DVector<f64>)> = Vec::new();
            for (c, fold) in self.clusters.iter().zip(&self.folds) {
                let at = folds.iter().position(|f| f.0 == *fold).unwrap_or_else(|| {
                    folds.push((*fold, DMatrix::zeros(m, m), DVector::zeros(m)));
                    folds.len() - 1
                });
                c.jj.add_to(&mut folds[at].1);
                folds[at].2 += &c.jr;
            }
            let (mut jj, mut jr) = (DMatrix::zeros(m, m), DVector::zeros(m));
            for (_, own, score) in &folds {
                jj += own;
                jr += score;
            }
            Arc::new(Totals { jj, jr, rr: self.clusters.iter().map(|c| c.rr).sum(), folds })
        };
        self.totals.get_or_init(sum).clone()
    }

    /// Huber loss of the residuals.
    pub fn loss(&self) -> f64 {
        self.clusters.iter().map(|c| c.rr + c.offset).sum()
    }

    /// Sum of squares of the residuals without weights, and their number.
    pub fn plain(&self) -> (f64, f64) {
        let sum = |f: &dyn Fn(&Cluster) -> f64| self.clusters.iter().map(|c| f(c) / c.weight).sum();
        (sum(&|c| c.rr), sum(&|c| c.n))
    }

    /// Huber loss of the residuals after a step along the columns.
    ///
    /// # Panics
    /// If the step has not as many entries as there are columns.
    pub fn loss_after(&self, step: &DVector<f64>) -> f64 {
        self.clusters.iter().map(|c| c.loss_after(step)).sum()
    }

    /// JᵀJ of all columns.
    pub fn information(&self) -> DMatrix<f64> {
        self.totals().jj.clone()
    }

    /// Whether the data say anything of a column.
    ///
    /// # Panics
    /// If there is no such column.
    pub fn tells(&self, column: usize) -> bool {
        self.clusters.iter().any(|c| c.jj[(column, column)] > 0.0)
    }

    /// Number of residuals, weighted.
    pub fn n(&self) -> f64 {
        self.clusters.iter().map(|c| c.n).sum()
    }

    /// Fits some columns to all clusters: the step along each.
    ///
    /// # Panics
    /// If there is no such column.
    pub fn solve(&self, columns: &[usize]) -> DVector<f64> {
        self.solve_held(columns, &vec![[0.0; 2]; columns.len()])
    }

    /// The same with each column held by so much information near a step: information, and its product with the step.
    ///
    /// # Panics
    /// If there is no such column, or `held` has not an entry a column.
    pub fn solve_held(&self, columns: &[usize], held: &[[f64; 2]]) -> DVector<f64> {
        assert_eq!(columns.len(), held.len(), "each column has what holds it");
        let m = columns.len();
        let mut a = DMatrix::from_diagonal(&DVector::from_iterator(m, held.iter().map(|h| h[0])));
        let mut b = DVector::from_iterator(m, held.iter().map(|h| h[1]));
        for c in &self.clusters {
            for (p, jp) in columns.iter().enumerate() {
                b[p] += c.jr[*jp];
                for (q, jq) in columns.iter().enumerate() {
                    a[(p, q)] += c.jj[(*jp, *jq)];
                }
            }
        }
        solve(&a, &b)
    }
}

/// Solves A·x = b for a positive semidefinite A scaled to a unit diagonal, with a tiny regularisation.
///
/// # Panics
/// If A is not square, of as many rows as b.
pub fn solve(a: &DMatrix<f64>, b: &DVector<f64>) -> DVector<f64> {
    let m = b.len();
    assert_eq!(a.shape(), (m, m), "A has a row and a column for each entry of b");
    let scale: Vec<f64> = (0..m).map(|i| if a[(i, i)] > 1e-300 { a[(i, i)].sqrt() } else { 0.0 }).collect();
    let scaled = DMatrix::from_fn(m, m, |i, j| {
        let unit = if i == j { 1.0 + REGULARISATION } else { 0.0 };
        if scale[i] == 0.0 || scale[j] == 0.0 {
            return unit;
        }
        a[(i, j)] / (scale[i] * scale[j]) + if i == j { REGULARISATION } else { 0.0 }
    });
    let rhs = DVector::from_fn(m, |i, _| if scale[i] == 0.0 { 0.0 } else { b[i] / scale[i] });
    let x = match scaled.clone().cholesky() {
        Some(c) => c.solve(&rhs),
        None => scaled.lu().solve(&rhs).unwrap_or_else(|| DVector::zeros(m)),
    };
    DVector::from_fn(m, |i, _| if scale[i] == 0.0 { 0.0 } else { x[i] / scale[i] })
}

/// Inverse of a positive matrix, scaled to a unit diagonal with a tiny regularisation on the way, infinite on the diagonal
/// where the matrix is 0 there; `None` if it has none, is not square or holds what is no number.
pub fn inverse(a: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    if !a.is_square() || a.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let m = a.nrows();
    let scale: Vec<f64> = (0..m).map(|i| a[(i, i)].sqrt().max(f64::MIN_POSITIVE)).collect();
    let unit =
        DMatrix::from_fn(m, m, |p, q| a[(p, q)] / scale[p] / scale[q] + if p == q { REGULARISATION } else { 0.0 });
    let inverse = unit.try_inverse()?.map_with_location(|p, q, x| x / scale[p] / scale[q]);
    inverse.iter().all(|x| !x.is_nan()).then_some(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_square_matrix_of_numbers_has_an_inverse() {
        let of = |rows, columns, x: &[f64]| inverse(&DMatrix::from_row_slice(rows, columns, x));
        let found = of(2, 2, &[2.0, 0.0, 0.0, 4.0]).unwrap();
        assert!((found[(0, 0)] - 0.5).abs() < 1e-6 && (found[(1, 1)] - 0.25).abs() < 1e-6, "{found}");
        assert_eq!(of(0, 0, &[]), Some(DMatrix::zeros(0, 0)));
        // Of a column that is 0 nothing is known, of the other all.
        let found = of(2, 2, &[0.0, 0.0, 0.0, 4.0]).unwrap();
        assert!(found[(0, 0)] == f64::INFINITY && (found[(1, 1)] - 0.25).abs() < 1e-6, "{found}");
        for (rows, columns, x) in [
            (2, 2, [f64::NAN; 4]),
            (2, 2, [1.0, f64::NAN, f64::NAN, 1.0]),
            (2, 2, [f64::INFINITY, 0.0, 0.0, 1.0]),
            (2, 2, [-1.0, 0.5, 0.5, -1.0]),
            (1, 4, [1.0; 4]),
            (4, 1, [1.0; 4]),
        ] {
            assert_eq!(of(rows, columns, &x), None, "{rows} by {columns}: {x:?}");
        }
    }

    #[test]
    fn what_does_not_fit_together_is_said() {
        let said = |work: &dyn Fn()| {
            let panic = std::panic::catch_unwind(std::panic::AssertUnwindSafe(work)).unwrap_err();
            panic.downcast_ref::<String>().cloned().or_else(|| panic.downcast_ref::<&str>().map(|s| (*s).to_owned()))
        };
        let cluster =
            |columns: usize| Cluster::new(0, 0.0, 3.0, &DVector::zeros(3), &DMatrix::from_element(3, columns, 1.0));
        let short = || drop(Cluster::new(0, 0.0, 2.0, &DVector::zeros(2), &DMatrix::zeros(3, 1)));
        let mixed = || drop(NormalEquations::new(vec![cluster(1), cluster(2)]));
        let joined = || Cluster::add(&mut cluster(2), &cluster(1));
        let held = || drop(NormalEquations::new(vec![cluster(1)]).solve_held(&[0], &[]));
        let wide = || drop(solve(&DMatrix::zeros(2, 3), &DVector::zeros(2)));
        let cases: [(&dyn Fn(), &str); 5] = [
            (&short, "a row a residual"),
            (&mixed, "the same columns"),
            (&joined, "the same columns"),
            (&held, "what holds it"),
            (&wide, "a row and a column"),
        ];
        for (work, part) in cases {
            let said = said(work).unwrap_or_default();
            assert!(said.contains(part), "{said} has no {part}");
        }
    }

    #[test]
    fn columns_fitted_beside_others_leave_what_a_fit_of_both_does() {
        let n = 60;
        let wave = |r: usize, by: usize| ((r * by + 3) % 17) as f64 - 8.0;
        let column = DVector::from_fn(n, |r, _| wave(r, 5));
        let nuisances = DMatrix::from_fn(n, 2, |r, c| wave(r, 7 + 4 * c) + 0.5 * column[r]);
        let residual = DVector::from_fn(n, |r, _| 0.07 * column[r] - 0.1 * nuisances[(r, 0)] + 0.03 * wave(r, 13));
        let all = DMatrix::from_fn(n, 3, |r, c| if c == 0 { column[r] } else { nuisances[(r, c - 1)] });
        let part = |rows: std::ops::Range<usize>| {
            let (from, count) = (rows.start, rows.len());
            let jacobian = all.rows(from, count).into_owned();
            Cluster::new(0, from as f64, count as f64, &residual.rows(from, count).into_owned(), &jacobian)
        };
        let clusters = || vec![part(0..25), part(25..n)];
        let both = NormalEquations::new(clusters()).solve(&[0, 1, 2]);
        let beside = Cluster::beside(clusters(), 2);
        assert_eq!(beside[0].jr.len(), 1);
        let alone = NormalEquations::new(beside.clone()).solve(&[0]);
        assert!((alone[0] - both[0]).abs() < 1e-6, "{alone} {both}");
        let left: f64 = beside.iter().map(|c| c.rr - 2.0 * alone[0] * c.jr[0] + alone[0].powi(2) * c.jj[(0, 0)]).sum();
        let best = (&residual - &all * &both).norm_squared();
        assert!((left - best).abs() < 1e-6 * best, "{left} {best}");
    }

    #[test]
    fn the_loss_after_a_step_is_that_of_what_the_step_leaves() {
        let n = 40;
        let column = DMatrix::from_fn(n, 1, |r, _| 1.0 + (r % 3) as f64);
        let noise = DVector::from_fn(n, |r, _| if r % 2 == 0 { 1.0 } else { -1.0 });
        for (size, step) in [(0.0, 0.0), (0.5, 0.5), (20.0, 20.0), (20.0, 0.0), (20.0, 15.0)] {
            let equations = |residual: &DVector<f64>| {
                NormalEquations::new(vec![Cluster::new(0, 0.0, n as f64, residual, &column)]).loss()
            };
            let before = &noise + column.column(0) * size;
            let after = equations(&(&before - column.column(0) * step));
            let moved = NormalEquations::new(vec![Cluster::new(0, 0.0, n as f64, &before, &column)]);
            let found = moved.loss_after(&DVector::from_element(1, step));
            assert!((found - after).abs() < 1e-9 * after, "{size} {step}: {found} {after}");
        }
    }
}
