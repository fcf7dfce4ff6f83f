//! Fits in which some columns are free and all others are held near zero.
//!
//! What every robot has a little of (drag of the rollers, micro-slip, a torque constant 2 % off) is
//! in every log and significant in every log. Free parameters for all of it would swallow real
//! effects; leaving it out would let it pass for one. So all effects that are not named keep a
//! Gaussian prior about zero whose width is a fixed share of their materiality threshold.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use crate::normal_equations::{NormalEquations, Totals, inverse, solve};

/// A penalised least-squares problem over all columns of a linearisation. What takes roles takes one a column; columns of which
/// there are no data take no part.
pub struct Penalised<'a> {
    equations: &'a NormalEquations,
    /// Variance the residuals really have, in units of the assumed noise.
    variance: f64,
    totals: Arc<Totals>,
    /// Of the step along each held column; none are limited where there are no limits.
    limits: Vec<[f64; 2]>,
}

/// Step along all columns and what it costs.
#[derive(Debug, Clone)]
pub struct PenalisedFit {
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
    /// Left out of the fit: stays at its present value.
    Out,
    /// Held near an offset: (standard deviation, present value).
    Held(f64, f64),
    /// Estimated without a penalty.
    Free,
    /// Taken along by this step, whatever the data say.
    At(f64),
}

impl<'a> Penalised<'a> {
    /// Sums over the clusters once.
    pub fn new(equations: &'a NormalEquations, variance: f64) -> Self {
        Self { equations, variance, totals: equations.totals(), limits: Vec::new() }
    }

    /// The same where what is held stays within limits, one a column, whatever else a fit is asked: no robot has a little of
    /// what cannot be. They hold the step 0.
    #[must_use]
    pub fn within(mut self, limits: Vec<[f64; 2]>) -> Self {
        self.limits = limits;
        self
    }

    /// What the data say of one column: its sum of squares.
    ///
    /// # Panics
    /// If there is no such column.
    pub fn information(&self, column: usize) -> f64 {
        self.totals.jj[(column, column)]
    }

    /// The best step with these roles.
    pub fn fit(&self, roles: &[Role]) -> PenalisedFit {
        let (step, columns) = self.limited(&self.totals.jj, &self.totals.jr, roles);
        self.rated(step, &columns, roles)
    }

    /// The best step with these roles in which no free column leaves its limits.
    ///
    /// # Panics
    /// If there is not a limit a role, or the lower of a limit is above the upper.
    pub fn fit_within(&self, roles: &[Role], limits: &[[f64; 2]]) -> PenalisedFit {
        let mut roles = roles.to_vec();
        loop {
            let fit = self.fit(&roles);
            let out = |c: &usize| {
                let over = (limits[*c][0] - fit.step[*c]).max(fit.step[*c] - limits[*c][1]);
                if roles[*c] == Role::Free { over / (limits[*c][1] - limits[*c][0]).max(1e-300) } else { 0.0 }
            };
            let worst = (0..roles.len()).max_by(|a, b| out(a).total_cmp(&out(b))).filter(|c| out(c) > 0.0);
            let Some(worst) = worst else { return fit };
            roles[worst] = Role::At(fit.step[worst].clamp(limits[worst][0], limits[worst][1]));
        }
    }

    /// The best steps with each fold left out in turn.
    pub fn left_out(&self, roles: &[Role]) -> Vec<DVector<f64>> {
        let without = |(_, jj, jr): &(usize, DMatrix<f64>, DVector<f64>)| {
            self.limited(&(&self.totals.jj - jj), &(&self.totals.jr - jr), roles).0
        };
        self.totals.folds.iter().map(without).collect()
    }

    /// How well the other columns do in place of one, whatever the data say.
    ///
    /// # Panics
    /// If there is no such column, or no role of it.
    pub fn explain(&self, column: usize, roles: &[Role]) -> PenalisedFit {
        let mut roles = roles.to_vec();
        roles[column] = if let Role::Held(..) = roles[column] { roles[column] } else { Role::Out };
        let jj = &self.totals.jj;
        let totals =
            Totals { jr: jj.column(column).into_owned(), rr: jj[(column, column)], jj: jj.clone(), folds: Vec::new() };
        let wanted =
            Self { equations: self.equations, variance: self.variance, totals: Arc::new(totals), limits: Vec::new() };
        wanted.fit(&roles)
    }

    fn rated(&self, step: DVector<f64>, columns: &[usize], roles: &[Role]) -> PenalisedFit {
        let mut linear = 0.0;
        let mut square = 0.0;
        for &p in columns {
            linear += step[p] * self.totals.jr[p];
            for &q in columns {
                square += step[p] * step[q] * self.totals.jj[(p, q)];
            }
        }
        let penalty = penalty(&step, roles);
        PenalisedFit { loss: (self.totals.rr - 2.0 * linear + square) / self.variance, step, penalty }
    }

    /// Held-out sum of squares of each cluster, in units of the assumed noise (not the variance).
    pub fn held_out(&self, roles: &[Role]) -> Vec<f64> {
        let mut out: Vec<f64> = self.equations.clusters.iter().map(|c| c.rr).collect();
        if self.totals.folds.len() < 2 {
            return out;
        }
        for (fold, jj, jr) in &self.totals.folds {
            let (step, columns) = self.limited(&(&self.totals.jj - jj), &(&self.totals.jr - jr), roles);
            for (i, c) in self.equations.clusters.iter().enumerate().filter(|(i, _)| self.equations.folds[*i] == *fold)
            {
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

    /// Columns that take part and that the data say something of.
    fn used(&self, roles: &[Role]) -> Vec<usize> {
        let known = roles.len().min(self.totals.jj.ncols());
        (0..known).filter(|i| roles[*i] != Role::Out && self.equations.tells(*i)).collect()
    }

    /// JᵀJ of some columns with the priors of those that are held.
    fn information_of(&self, used: &[usize], roles: &[Role]) -> DMatrix<f64> {
        let jj = &self.totals.jj;
        let held = |c: usize| if let Role::Held(sd, _) = roles[c] { self.variance / (sd * sd) } else { 0.0 };
        DMatrix::from_fn(used.len(), used.len(), |p, q| {
            jj[(used[p], used[q])] + if p == q { held(used[p]) } else { 0.0 }
        })
    }

    /// Diagonal of (JᵀJ + priors)⁻¹, 0 for columns that take no part, infinite where there is no inverse.
    pub fn inverse_diagonal(&self, roles: &[Role]) -> Vec<f64> {
        let used = self.used(roles);
        let inverse = inverse(&self.information_of(&used, roles));
        let mut out = vec![0.0; roles.len()];
        for (p, c) in used.iter().enumerate() {
            out[*c] = inverse.as_ref().map_or(f64::INFINITY, |inverse| inverse[(p, p)]);
        }
        out
    }

    /// The same roles without the held columns that can do what a free one does (squared partial cosine above `alike`)
    /// once everything else adapts to it, within its own prior: twins that show only beside the others.
    #[must_use]
    pub fn without_twins(&self, roles: &[Role], alike: f64) -> Vec<Role> {
        let mut roles = roles.to_vec();
        loop {
            let used = self.used(&roles);
            let Some(v) = inverse(&self.information_of(&used, &roles)) else { return roles };
            let mut worst = (alike, None);
            for (h, column) in used.iter().enumerate() {
                let Role::Held(sd, _) = roles[*column] else { continue };
                // Its own prior taken out again (Sherman and Morrison).
                let prior = self.variance / (sd * sd);
                let scale = prior / (1.0 - prior * v[(h, h)]).max(1e-12);
                let free = |p: usize, q: usize| v[(p, q)] + scale * v[(p, h)] * v[(q, h)];
                for (c, _) in used.iter().enumerate().filter(|(_, c)| roles[**c] == Role::Free) {
                    let cos2 = free(c, h).powi(2) / (free(c, c) * free(h, h));
                    if cos2 > worst.0 {
                        worst = (cos2, Some(*column));
                    }
                }
            }
            let Some(twin) = worst.1 else { return roles };
            roles[twin] = Role::Out;
        }
    }

    /// Covariance of all columns, 0 for those that take no part: cluster-robust (the sandwich, small-sample corrected),
    /// priors as pseudo observations, no variance below what the residual variance explains.
    ///
    /// # Panics
    /// If there is not a role a column, or the fit is of other roles.
    pub fn covariance(&self, roles: &[Role], fit: &PenalisedFit) -> DMatrix<f64> {
        let equations = self.equations;
        let m = roles.len();
        let columns = self.used(roles);
        let k = columns.len();
        let whole = &self.totals.jj;
        let mut jj = DMatrix::from_fn(k, k, |p, q| whole[(columns[p], columns[q])]);
        let g = equations.clusters.len();
        let free = roles.iter().filter(|r| **r == Role::Free).count() as f64;
        let correction = (g as f64 / (g as f64 - free).max(1.0)).sqrt();
        // Scores of the clusters and, as observations of their own, of the priors, one a column.
        let held = columns.iter().enumerate().filter_map(|(p, c)| match roles[*c] {
            Role::Held(sd, _) => Some((p, self.variance / (sd * sd))),
            _ => None,
        });
        let held: Vec<(usize, f64)> = held.collect();
        let mut scores = DMatrix::zeros(k, g + held.len());
        for (c, mut score) in equations.clusters.iter().zip(scores.column_iter_mut()) {
            let left = &c.jr - c.jj.times(&fit.step);
            score.iter_mut().zip(&columns).for_each(|(slot, column)| *slot = correction * left[*column]);
        }
        for (at, (p, weight)) in held.into_iter().enumerate() {
            jj[(p, p)] += weight;
            scores[(p, g + at)] = (weight * self.variance).sqrt();
        }
        let Some(inverse) = inverse(&jj) else { return DMatrix::from_element(m, m, f64::INFINITY) };
        let moved = &inverse * scores;
        let robust = &moved * moved.transpose();
        // The inverse is regularised: it is not that of jj to the last.
        let told = &inverse * jj;
        let plain = |i: usize| {
            self.variance * told.row(i).iter().zip(inverse.column(i).iter()).map(|(a, b)| a * b).sum::<f64>()
        };
        let factors: Vec<f64> = (0..k).map(|i| (plain(i) / robust[(i, i)].max(1e-300)).max(1.0).sqrt()).collect();
        let mut out = DMatrix::zeros(m, m);
        for p in 0..k {
            for q in 0..k {
                out[(columns[p], columns[q])] = robust[(p, q)] * factors[p] * factors[q];
            }
        }
        out
    }

    /// The step with what is held inside its limits: what leaves them is stopped there, and let go where it would come back
    /// by itself (active sets). Ends after as many rounds as there are columns at most: from then on nothing is let go.
    fn limited(&self, jj: &DMatrix<f64>, jr: &DVector<f64>, roles: &[Role]) -> (DVector<f64>, Vec<usize>) {
        let mut stopped = roles.to_vec();
        let held: Vec<(usize, f64, f64)> = (0..self.limits.len().min(roles.len()))
            .filter_map(|c| if let Role::Held(sd, at) = roles[c] { Some((c, sd, at)) } else { None })
            .collect();
        for round in 0.. {
            let (step, columns) = self.solve(jj, jr, &stopped);
            let mut changed = false;
            for (c, sd, at) in &held {
                let [low, high] = self.limits[*c];
                if matches!(stopped[*c], Role::Held(..)) {
                    if step[*c] < low || step[*c] > high {
                        stopped[*c] = Role::At(step[*c].clamp(low, high));
                        changed = true;
                    }
                } else if round < roles.len() {
                    let pulled = columns.iter().map(|q| jj[(*c, *q)] * step[*q]).sum::<f64>();
                    let inward = jr[*c] - pulled - self.variance / (sd * sd) * (step[*c] + at);
                    if step[*c] == low && inward > 0.0 || step[*c] == high && inward < 0.0 {
                        stopped[*c] = roles[*c];
                        changed = true;
                    }
                }
            }
            if !changed {
                return (step, columns);
            }
        }
        unreachable!("what is only stopped ends")
    }

    fn solve(&self, jj: &DMatrix<f64>, jr: &DVector<f64>, roles: &[Role]) -> (DVector<f64>, Vec<usize>) {
        let told = |i: usize| self.totals.jj.get((i, i)).is_some_and(|x| *x > 0.0);
        let used = |i: &usize| roles[*i] != Role::Out && told(*i);
        let (taken, columns): (Vec<usize>, Vec<usize>) =
            (0..roles.len()).filter(used).partition(|i| matches!(roles[*i], Role::At(_)));
        let m = columns.len();
        let mut step = DVector::zeros(roles.len());
        for &c in &taken {
            if let Role::At(by) = roles[c] {
                step[c] = by;
            }
        }
        let mut a = DMatrix::from_fn(m, m, |p, q| jj[(columns[p], columns[q])]);
        let mut b = DVector::from_fn(m, |p, _| jr[columns[p]]);
        for (p, c) in columns.iter().enumerate() {
            if let Role::Held(sd, at) = roles[*c] {
                let weight = self.variance / (sd * sd);
                a[(p, p)] += weight;
                b[p] -= weight * at;
            }
            b[p] -= taken.iter().map(|t| jj[(*c, *t)] * step[*t]).sum::<f64>();
        }
        let x = solve(&a, &b);
        for (p, c) in columns.iter().enumerate() {
            step[*c] = x[p];
        }
        (step, [columns, taken].concat())
    }
}

fn penalty(step: &DVector<f64>, roles: &[Role]) -> f64 {
    roles
        .iter()
        .zip(step.iter())
        .map(|(r, x)| if let Role::Held(sd, at) = r { ((x + at) / sd).powi(2) } else { 0.0 })
        .sum()
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;
    use crate::normal_equations::Cluster;

    /// Two columns that overlap, and residuals that are 3 of the first and 1 of the second.
    fn equations() -> NormalEquations {
        let columns = DMatrix::from_fn(30, 2, |r, c| if c == 0 { 1.0 } else { f64::from(u8::from(r < 15)) });
        let residual = &columns * DVector::from_column_slice(&[3.0, 1.0]);
        NormalEquations::new(vec![Cluster::new(0, 0.0, 1e3, &residual, &columns)])
    }

    #[test]
    fn what_is_taken_along_is_not_fitted_but_counted() {
        let equations = equations();
        let penalised = Penalised::new(&equations, 1.0);
        let fit = penalised.fit(&[Role::At(2.0), Role::Free]);
        assert!((fit.step[0] - 2.0).abs() < 1e-12 && (fit.step[1] - 2.0).abs() < 1e-6, "{}", fit.step);
        // What is left is 1 where the second column is 0.
        assert!((fit.loss - 15.0).abs() < 1e-6, "{}", fit.loss);
    }

    #[test]
    fn roles_without_data_take_no_part() {
        let (some, none) = (equations(), NormalEquations::new(Vec::new()));
        let roles = [Role::Free, Role::Free, Role::Held(1.0, 0.0)];
        for (equations, expected) in [(&some, [3.0, 1.0, 0.0]), (&none, [0.0; 3])] {
            let penalised = Penalised::new(equations, 1.0);
            let fit = penalised.fit(&roles);
            assert!((&fit.step - DVector::from_column_slice(&expected)).amax() < 1e-6 && fit.loss.abs() < 1e-6);
            assert_eq!(penalised.inverse_diagonal(&roles)[2], 0.0);
        }
        assert_eq!(Penalised::new(&none, 1.0).covariance(&roles, &Penalised::new(&none, 1.0).fit(&roles)).amax(), 0.0);
    }

    #[test]
    fn what_is_held_stays_within_its_limits() {
        let equations = equations();
        let held = [Role::Held(10.0, 0.0), Role::Free];
        let step = |roles: &[Role], limits: [f64; 2]| {
            let penalised = Penalised::new(&equations, 1.0).within(vec![limits, [-1.0, 1.0]]);
            penalised.fit(roles)
        };
        // Stopped at its limit, with the price of that; the free one, which limits do not touch, takes the rest.
        let stopped = step(&held, [-1.0, 0.5]);
        assert!((stopped.step[0] - 0.5).abs() < 1e-12 && (stopped.step[1] - 3.5).abs() < 1e-6, "{}", stopped.step);
        assert!((stopped.penalty - 0.0025).abs() < 1e-9, "{}", stopped.penalty);
        let inside = step(&held, [-9.0, 9.0]);
        assert!((inside.step[0] - Penalised::new(&equations, 1.0).fit(&held).step[0]).abs() < 1e-12);
        // Both leave their limits at first; where the second is stopped, the first comes back by itself.
        let columns = DMatrix::from_fn(40, 2, |r, c| if c == 0 { 1.0 } else { 1.0 + 0.5 * (r % 2) as f64 });
        let residual = &columns * DVector::from_column_slice(&[-1.0, 4.0]);
        let equations = NormalEquations::new(vec![Cluster::new(0, 0.0, 1e3, &residual, &columns)]);
        let both = [Role::Held(100.0, 0.0); 2];
        let fit = Penalised::new(&equations, 1.0).within(vec![[0.0, 9.0], [0.0, 1.0]]).fit(&both);
        // With the second at 1 the first takes the mean of what that leaves: -1 + 3·(1 + 1.5)/2.
        let expected = -1.0 + 3.0 * 1.25;
        assert!((fit.step[0] - expected).abs() < 1e-3 && (fit.step[1] - 1.0).abs() < 1e-12, "{}", fit.step);
    }

    #[test]
    fn no_free_step_leaves_its_limits() {
        let equations = equations();
        let penalised = Penalised::new(&equations, 1.0);
        let roles = [Role::Free, Role::Free];
        let fit = penalised.fit_within(&roles, &[[-2.0, 2.0], [-9.0, 9.0]]);
        assert!((fit.step[0] - 2.0).abs() < 1e-12 && (fit.step[1] - 2.0).abs() < 1e-6, "{}", fit.step);
        let free = penalised.fit_within(&roles, &[[-9.0, 9.0], [-9.0, 9.0]]);
        assert!((free.step[0] - 3.0).abs() < 1e-6 && (free.step[1] - 1.0).abs() < 1e-6, "{}", free.step);
    }

    /// Clusters of residuals that are wrong together: the sandwich sees it, the plain covariance does not.
    #[test]
    fn a_covariance_knows_that_a_cluster_is_one_observation() {
        let ones = DMatrix::from_element(10, 1, 1.0);
        // Ten clusters of ten equal residuals, +1 and -1 in turn: the mean of ten draws, not of a hundred.
        let clusters = (0..10)
            .map(|i| if i % 2 == 0 { 1.0 } else { -1.0 })
            .map(|r| Cluster::new(0, 0.0, 10.0, &DVector::from_element(10, r), &ones));
        let equations = NormalEquations::new(clusters.collect());
        let penalised = Penalised::new(&equations, 1.0);
        for (role, expected) in [
            // 10 scores of 10² over 100², times 10/9.
            (Role::Free, 1.0 / 9.0),
            // A prior as informative as the data halves the inverse: (1000·10/10 + 100)/200².
            (Role::Held(0.1, 0.0), 1100.0 / 40_000.0),
            // No part, no variance.
            (Role::Out, 0.0),
        ] {
            let roles = [role];
            let found = penalised.covariance(&roles, &penalised.fit(&roles))[(0, 0)];
            assert!((found - expected).abs() < 1e-6, "{role:?}: {found} for {expected}");
        }
        let halved = penalised.inverse_diagonal(&[Role::Held(0.1, 0.0)])[0];
        assert!((halved - 1.0 / 200.0).abs() < 1e-9, "{halved}");
    }

    #[test]
    fn each_fold_is_predicted_by_the_others() {
        let ones = DMatrix::from_element(4, 1, 1.0);
        let run = |run: usize, r: f64| Cluster::new(run, 0.0, 1e3, &DVector::from_element(4, r), &ones);
        let equations = NormalEquations::new(vec![run(0, 1.0), run(1, 2.0), run(2, 6.0)]);
        let penalised = Penalised::new(&equations, 1.0);
        // Means of the others: 4, 3.5, 1.5; four residuals each.
        let expected = [4.0 * 9.0, 4.0 * 2.25, 4.0 * 20.25];
        for (found, expected) in penalised.held_out(&[Role::Free]).iter().zip(expected) {
            assert!((found - expected).abs() < 1e-5, "{found} for {expected}");
        }
    }

    /// A free column, and two held ones of which only both together can do what it does.
    #[test]
    fn twins_show_beside_what_else_adapts() {
        let column = |r: usize, c: usize| match c {
            0 => (r % 2) as f64,
            1 => (r % 2) as f64 + (r % 3) as f64,
            2 => (r % 3) as f64,
            _ => (r % 5) as f64,
        };
        let columns = DMatrix::from_fn(60, 4, column);
        let equations =
            NormalEquations::new(vec![Cluster::new(0, 0.0, 60.0, &columns.column(0).into_owned(), &columns)]);
        let penalised = Penalised::new(&equations, 1.0);
        let held = |sd: f64| Role::Held(sd, 0.0);
        // The first of them does what the free one does as far as the second undoes the rest.
        for (second, gone) in [(held(1e3), true), (held(1e-3), false), (Role::Out, false)] {
            let roles = [Role::Free, held(0.1), second, held(0.1)];
            let left = penalised.without_twins(&roles, 0.98);
            let frozen = left[1] == Role::Out || second != Role::Out && left[2] == Role::Out;
            assert_eq!(frozen, gone, "{second:?}: {left:?}");
            assert_eq!((left[0], left[3]), (roles[0], roles[3]));
        }
    }
}
