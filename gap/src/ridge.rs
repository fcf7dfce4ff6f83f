//! Fits in which some columns are free and all others are held near zero.
//!
//! What every robot has a little of (drag of the rollers, micro-slip, a torque constant 2 % off) is
//! in every log and significant in every log. Free parameters for all of it would swallow real
//! effects; leaving it out would let it pass for one. So all effects that are not named keep a
//! Gaussian prior about zero whose width is a fixed share of their materiality threshold.

use nalgebra::{DMatrix, DVector};

use crate::gram::{Gram, solve};

/// A penalised least-squares problem over all columns of a linearisation.
pub struct Ridge<'a> {
    gram: &'a Gram,
    /// Variance the residuals really have, in units of the assumed noise.
    variance: f64,
    jj: DMatrix<f64>,
    jr: DVector<f64>,
    rr: f64,
    folds: Vec<(usize, DMatrix<f64>, DVector<f64>)>,
}

/// A fit.
#[derive(Debug, Clone)]
pub struct RidgeFit {
    /// Step along each column of the linearisation, 0 for those left out.
    pub step: DVector<f64>,
    /// Sum of squares left, in units of the variance.
    pub loss: f64,
    /// Penalty of what is held near zero.
    pub penalty: f64,
}

/// How a column takes part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Role {
    /// Not at all.
    Out,
    /// Held near an offset: (standard deviation, present value).
    Held(f64, f64),
    /// Free.
    Free,
}

impl<'a> Ridge<'a> {
    /// Sums over the clusters once.
    pub fn new(gram: &'a Gram, variance: f64) -> Self {
        let m = gram.clusters.first().map_or(0, |c| c.jr.len());
        let (mut jj, mut jr, mut rr) = (DMatrix::zeros(m, m), DVector::zeros(m), 0.0);
        let mut folds: Vec<(usize, DMatrix<f64>, DVector<f64>)> = Vec::new();
        for (c, fold) in gram.clusters.iter().zip(&gram.folds) {
            c.jj.add_to(&mut jj);
            jr += &c.jr;
            rr += c.rr;
            match folds.iter_mut().find(|f| f.0 == *fold) {
                Some(f) => {
                    c.jj.add_to(&mut f.1);
                    f.2 += &c.jr;
                }
                None => folds.push((*fold, c.jj.full(), c.jr.clone())),
            }
        }
        Self { gram, variance, jj, jr, rr, folds }
    }

    /// The best step with these roles.
    pub fn fit(&self, roles: &[Role]) -> RidgeFit {
        let (step, columns) = self.solve(&self.jj, &self.jr, roles);
        let mut linear = 0.0;
        let mut square = 0.0;
        for &p in &columns {
            linear += step[p] * self.jr[p];
            for &q in &columns {
                square += step[p] * step[q] * self.jj[(p, q)];
            }
        }
        let penalty = penalty(&step, roles);
        RidgeFit { loss: (self.rr - 2.0 * linear + square) / self.variance, step, penalty }
    }

    /// Held-out sum of squares of each cluster, in units of the assumed noise (not the variance).
    pub fn held_out(&self, roles: &[Role]) -> Vec<f64> {
        let mut out: Vec<f64> = self.gram.clusters.iter().map(|c| c.rr).collect();
        if self.folds.len() < 2 {
            return out;
        }
        for (fold, jj, jr) in &self.folds {
            let (step, columns) = self.solve(&(&self.jj - jj), &(&self.jr - jr), roles);
            for (i, c) in self.gram.clusters.iter().enumerate().filter(|(i, _)| self.gram.folds[*i] == *fold) {
                let (mut linear, mut square) = (0.0, 0.0);
                for &p in &columns {
                    linear += step[p] * c.jr[p];
                    for &q in &columns {
                        square += step[p] * step[q] * c.jj[(p, q)];
                    }
                }
                out[i] = c.rr - 2.0 * linear + square;
            }
        }
        out
    }

    fn solve(&self, jj: &DMatrix<f64>, jr: &DVector<f64>, roles: &[Role]) -> (DVector<f64>, Vec<usize>) {
        let columns: Vec<usize> =
            (0..roles.len()).filter(|i| roles[*i] != Role::Out && self.jj[(*i, *i)] > 0.0).collect();
        let m = columns.len();
        let mut a = DMatrix::from_fn(m, m, |p, q| jj[(columns[p], columns[q])]);
        let mut b = DVector::from_fn(m, |p, _| jr[columns[p]]);
        for (p, c) in columns.iter().enumerate() {
            if let Role::Held(sd, at) = roles[*c] {
                let weight = self.variance / (sd * sd);
                a[(p, p)] += weight;
                b[p] -= weight * at;
            }
        }
        let x = solve(&a, &b);
        let mut step = DVector::zeros(roles.len());
        for (p, c) in columns.iter().enumerate() {
            step[*c] = x[p];
        }
        (step, columns)
    }
}

fn penalty(step: &DVector<f64>, roles: &[Role]) -> f64 {
    roles
        .iter()
        .zip(step.iter())
        .map(|(r, x)| if let Role::Held(sd, at) = r { ((x + at) / sd).powi(2) } else { 0.0 })
        .sum()
}
