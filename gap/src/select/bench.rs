//! A linearised link with all candidates: fits of any subset, their trials and covariances.

use std::sync::Arc;

use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::effect::{Effect, Link};
use crate::options::Thresholds;
use crate::problem::{Linear, Owner, Problem};
use crate::ridge::{Ridge, RidgeFit, Role};
use crate::state::{Active, State};

/// A linearised link with all candidates, ready for any question about subsets.
pub struct Bench {
    /// The state it is linearised about.
    pub state: State,
    /// Candidates with a column each parameter.
    pub candidates: Vec<Active>,
    /// Columns.
    pub linear: Linear,
    /// Variance of the residuals in units of the assumed noise.
    pub variance: f64,
    pub(super) held: Vec<Role>,
    /// The same before named effects widened anything, and without their look-alikes.
    narrow: Vec<Role>,
    held_share: f64,
}

/// A candidate's fit on a bench.
#[derive(Debug, Clone)]
pub struct Trial {
    /// Index of the candidate.
    pub candidate: usize,
    /// Decrease of the objective, complexity paid for.
    pub gain: f64,
    /// Estimates.
    pub values: Vec<f64>,
    /// Whether any of them is material.
    pub material: bool,
}

/// The link's candidates: every form of every effect fitted there.
pub fn candidates(state: &State, catalogue: &[Arc<dyn Effect>], link: Link) -> Vec<Active> {
    let wanted = catalogue.iter().filter(|e| {
        (e.link() == link || e.also() == Some(link)) && !state.active.iter().any(|a| a.effect.name() == e.name())
            // Creep is slip below the limit of friction: one law of the contact is named.
            && !(e.name() == "wheel-creep" && state.active.iter().any(|a| a.effect.name() == "wheel-slip"))
    });
    wanted
        .flat_map(|e| e.forms(&state.robot).into_iter().map(|f| Active { link, ..Active::new(e.clone(), f) }))
        .collect()
}

impl Bench {
    /// Linearises a link about a state with all candidates.
    pub fn new(problem: &Problem, state: &State, candidates: &[Active], thresholds: &Thresholds) -> Self {
        let linear = problem.linearise(state, candidates);
        let mut seen: Vec<(String, String, String)> = Vec::new();
        let held = linear
            .owners
            .iter()
            .map(|owner| match owner {
                Owner::Active(..) => Role::Free,
                Owner::Whole(_) => Role::Out,
                Owner::Candidate(c, j) => {
                    let candidate = &candidates[*c];
                    let p = &candidate.form.free[*j];
                    let key =
                        (candidate.effect.name().to_owned(), format!("{:?}", candidate.form.fixed), p.name.clone());
                    let named = state.active.iter().any(|a| {
                        a.effect.name() == candidate.effect.name() && a.form.free.iter().any(|f| f.name == p.name)
                    });
                    if named || (seen.contains(&key) && !candidate.switched()) {
                        return Role::Out;
                    }
                    seen.push(key);
                    if !p.material.is_finite() {
                        return Role::Out;
                    }
                    if candidate.switched() {
                        // Of the forms of one effect only those nearest to its absence.
                        let own: Vec<usize> = (0..candidates.len())
                            .filter(|o| candidates[*o].effect.name() == candidate.effect.name())
                            .collect();
                        let near = match candidate.form.free.first().and_then(|p| p.below) {
                            Some(_) => own.last() == Some(c),
                            None => own.first() == Some(c) || own.get(own.len() / 2) == Some(c),
                        };
                        return if near { Role::Held(thresholds.held_switch, 0.0) } else { Role::Out };
                    }
                    Role::Held(thresholds.held_share * p.material, 0.0)
                }
            })
            .collect::<Vec<_>>();
        let mut bench = Self {
            state: state.clone(),
            candidates: candidates.to_vec(),
            linear,
            variance: 1.0,
            narrow: held.clone(),
            held,
            held_share: thresholds.held_share,
        };
        bench.merge_twins();
        bench.share_margins();
        bench.narrow.clone_from(&bench.held);
        bench.widen(thresholds);
        let free: Vec<Role> = bench.held.iter().map(|r| if *r == Role::Out { Role::Out } else { Role::Free }).collect();
        let n = bench.linear.gram.n();
        let columns = free.iter().filter(|r| **r == Role::Free).count() as f64;
        let least = Ridge::new(&bench.linear.gram, 1.0).fit(&free).loss;
        bench.variance = (least / (n - columns).max(1.0)).max(1.0) * thresholds.correlation(problem.link());
        bench
    }

    /// Of columns that are the same but for a factor, one is held; several would add their margins.
    fn merge_twins(&mut self) {
        let m = self.linear.owners.len();
        let jj = self.linear.gram.information();
        for a in 0..m {
            for b in 0..a {
                let (Role::Held(sa, _), Role::Held(sb, _)) = (self.held[a], self.held[b]) else { continue };
                let cos2 = jj[(a, b)].powi(2) / (jj[(a, a)] * jj[(b, b)]).max(1e-300);
                if cos2 > 0.99 {
                    // The narrower of the two, in units of what it does.
                    let (wa, wb) = (sa * jj[(a, a)].sqrt(), sb * jj[(b, b)].sqrt());
                    self.held[if wa < wb { b } else { a }] = Role::Out;
                }
            }
        }
    }

    /// One effect at several thresholds, places or rates is one effect: where its columns look alike
    /// they share one margin instead of adding up to several.
    fn share_margins(&mut self) {
        let m = self.linear.owners.len();
        let jj = self.linear.gram.information();
        let effect = |column: usize| match self.linear.owners[column] {
            Owner::Candidate(c, j) => {
                let candidate = &self.candidates[c];
                Some((candidate.effect.name(), candidate.form.free[j].name.as_str()))
            }
            _ => None,
        };
        let held: Vec<usize> =
            (0..m).filter(|c| matches!(self.held[*c], Role::Held(..)) && jj[(*c, *c)] > 0.0).collect();
        let alike = |a: usize, b: usize| jj[(a, b)].powi(2) / (jj[(a, a)] * jj[(b, b)]);
        let many: Vec<f64> = held
            .iter()
            .map(|a| held.iter().filter(|b| effect(*a) == effect(**b)).map(|b| alike(*a, *b)).sum::<f64>())
            .collect();
        for (c, many) in held.iter().zip(many) {
            if let Role::Held(sd, _) = &mut self.held[*c] {
                *sd /= many.max(1.0).sqrt();
            }
        }
    }

    /// The law of a large effect is not known to the last tenth: what looks like a named effect is
    /// allowed a share of it without being named.
    fn widen(&mut self, thresholds: &Thresholds) {
        let m = self.linear.owners.len();
        let jj = self.linear.gram.information();
        for index in 0..self.state.active.len() {
            let (columns, p) = whole(&self.linear, &self.state, index);
            let size2 = square(&jj, &columns, &p);
            if size2 <= 0.0 {
                continue;
            }
            for c in 0..m {
                let Role::Held(sd, at) = self.held[c] else { continue };
                if jj[(c, c)] <= 0.0 {
                    continue;
                }
                let overlap: f64 = columns.iter().zip(&p).map(|(a, x)| jj[(c, *a)] * x).sum();
                let cos2 = overlap * overlap / (size2 * jj[(c, c)]);
                let wide = thresholds.law_share * cos2 * (size2 / jj[(c, c)]).sqrt();
                self.held[c] = Role::Held(sd.max(wide), at);
            }
        }
    }

    /// What the laws of the named effects, none of them exact, may leave: a sum of squares in units of the noise.
    pub(super) fn left_by_laws(&self) -> f64 {
        let jj = self.linear.gram.information();
        let left = |index: usize| {
            let (columns, p) = whole(&self.linear, &self.state, index);
            self.state.active[index].effect.law_uncertainty().powi(2) * square(&jj, &columns, &p)
        };
        (0..self.state.active.len()).map(left).sum()
    }

    pub(super) fn ridge(&self) -> Ridge<'_> {
        Ridge::new(&self.linear.gram, self.variance)
    }

    /// Roles with nothing freed.
    pub fn roles(&self) -> Vec<Role> {
        self.held.clone()
    }

    /// Roles for the estimates of what is named.
    pub fn estimating(&self) -> Vec<Role> {
        self.narrow.clone()
    }

    /// The fit with given roles.
    pub fn fit_roles(&self, roles: &[Role]) -> RidgeFit {
        self.ridge().fit(roles)
    }

    /// Roles with some candidates freed.
    pub fn freeing(&self, freed: &[usize]) -> Vec<Role> {
        let mut roles = self.held.clone();
        for &c in freed {
            let candidate = &self.candidates[c];
            for (role, owner) in roles.iter_mut().zip(&self.linear.owners) {
                let Owner::Candidate(other, j) = owner else { continue };
                let o = &self.candidates[*other];
                if *other == c {
                    *role = Role::Free;
                } else if o.effect.name() == candidate.effect.name() {
                    // The same number under another form, or another shape of the same effect.
                    let same = candidate.form.free.iter().any(|p| p.name == o.form.free[*j].name);
                    if (same || o.form.fixed != candidate.form.fixed || o.switched()) && !freed.contains(other) {
                        *role = Role::Out;
                    }
                }
            }
        }
        roles
    }

    /// Objective of a fit: loss, penalty and the cost of what is freed.
    pub fn objective(&self, fit: &RidgeFit, freed: &[usize], thresholds: &Thresholds) -> f64 {
        let costs: f64 = freed.iter().map(|c| thresholds.cost(self.candidates[*c].form.free.len())).sum();
        fit.loss + fit.penalty + costs
    }

    /// The fit with nothing freed.
    pub fn base(&self) -> RidgeFit {
        self.ridge().fit(&self.held)
    }

    /// The fit with some candidates freed.
    pub fn fit(&self, freed: &[usize]) -> RidgeFit {
        self.ridge().fit(&self.freeing(freed))
    }

    /// Held-out losses per cluster with some candidates freed, and nothing held beside them.
    pub fn held_out(&self, freed: &[usize]) -> Vec<f64> {
        let bare: Vec<Role> =
            self.freeing(freed).into_iter().map(|r| if r == Role::Free { r } else { Role::Out }).collect();
        self.ridge().held_out(&bare)
    }

    /// The same with parts of runs held out instead of runs.
    pub fn held_out_blocks(&self, freed: &[usize]) -> Vec<f64> {
        let bare: Vec<Role> =
            self.freeing(freed).into_iter().map(|r| if r == Role::Free { r } else { Role::Out }).collect();
        let mut gram = self.linear.gram.clone();
        gram.folds = (0..gram.clusters.len()).map(|i| i % 5).collect();
        Ridge::new(&gram, self.variance).held_out(&bare)
    }

    /// Estimated increase of the objective if an active effect went, or kept only some parameters.
    pub fn loss_without(&self, index: usize, keep: &[String], thresholds: &Thresholds) -> f64 {
        let mut roles = self.held.clone();
        let active = &self.state.active[index];
        for (role, owner) in roles.iter_mut().zip(&self.linear.owners) {
            if let Owner::Active(i, j) = owner
                && *i == index
                && !keep.contains(&active.form.free[*j].name)
            {
                let p = &active.form.free[*j];
                let sd = if p.material > 0.0 && p.material.is_finite() {
                    thresholds.held_share * p.material
                } else {
                    1e-3 * p.scale
                };
                *role = Role::Held(sd, active.values.get(&p.name));
            }
        }
        let (base, without) = (self.base(), self.ridge().fit(&roles));
        let freed = active.form.free.len() - keep.len();
        let cost =
            if keep.is_empty() { thresholds.cost(active.form.free.len()) } else { thresholds.costs[1] * freed as f64 };
        without.loss + without.penalty - base.loss - base.penalty - cost
    }

    /// Estimates of a candidate in a fit.
    pub fn values(&self, fit: &RidgeFit, candidate: usize) -> Vec<f64> {
        let c = &self.candidates[candidate];
        let columns = self.linear.of_candidate(candidate);
        if c.switched() {
            // The column stands for the whole effect at its start.
            let share = columns.first().map_or(0.0, |j| fit.step[*j]);
            return c
                .form
                .free
                .iter()
                .enumerate()
                .map(
                    |(j, p)| {
                        if j == 0 && p.material > 0.0 { share * c.values.get(&p.name) } else { c.values.get(&p.name) }
                    },
                )
                .collect();
        }
        columns.iter().map(|j| fit.step[*j]).collect()
    }

    /// Every candidate on its own, best first.
    pub fn trials(&self, thresholds: &Thresholds) -> Vec<Trial> {
        let base = self.base();
        let from = base.loss + base.penalty;
        let ridge = self.ridge();
        let mut trials: Vec<Trial> = (0..self.candidates.len())
            .into_par_iter()
            .filter(|c| {
                self.linear
                    .of_candidate(*c)
                    .iter()
                    .all(|j| self.linear.gram.clusters.iter().any(|k| k.jj[(*j, *j)] > 0.0))
            })
            .filter(|c| !self.is_active(*c))
            .map(|c| {
                let fit = ridge.fit(&self.freeing(&[c]));
                let values = self.values(&fit, c);
                let within = self.within_bounds(c, &values, &fit);
                let gain = if within { from - self.objective(&fit, &[c], thresholds) } else { f64::NEG_INFINITY };
                Trial { candidate: c, gain, material: self.material(c, &values), values }
            })
            .collect();
        // Equals keep the order of the catalogue.
        trials.sort_by(|a, b| (b.gain - 1e-6 * b.candidate as f64).total_cmp(&(a.gain - 1e-6 * a.candidate as f64)));
        trials
    }

    fn is_active(&self, c: usize) -> bool {
        let candidate = &self.candidates[c];
        self.state.active.iter().any(|a| {
            a.effect.name() == candidate.effect.name()
                && (a.form.free.len() >= candidate.form.free.len() || a.form.fixed != candidate.form.fixed)
                && !a.given
        })
    }

    /// Whether an estimate makes physical sense: all parameters within bounds, give or take noise.
    pub(super) fn within_bounds(&self, c: usize, values: &[f64], fit: &RidgeFit) -> bool {
        let candidate = &self.candidates[c];
        if candidate.switched() {
            let share = self.linear.of_candidate(c).first().map_or(0.0, |j| fit.step[*j]);
            return share > 0.3 && share < 5.0;
        }
        candidate.form.free.iter().zip(values).all(|(p, v)| {
            let slack = 0.5 * p.material.min(p.scale);
            *v >= p.bounds[0] - slack && *v <= p.bounds[1] + slack
        })
    }

    /// Whether an estimate exceeds the materiality threshold.
    pub fn material(&self, c: usize, values: &[f64]) -> bool {
        let candidate = &self.candidates[c];
        let columns = self.linear.of_candidate(c);
        // Where a named effect of the same look widened the margin, it is wider here, too.
        let margin = |j: usize| match columns.get(j).map(|j| self.held[*j]) {
            Some(Role::Held(sd, _)) if !candidate.switched() => sd / self.held_share,
            _ => 0.0,
        };
        candidate.form.free.iter().zip(values).enumerate().any(|(j, (p, v))| p.is_material(*v) && v.abs() >= margin(j))
    }

    /// Covariance of the freed columns: cluster-robust, the held columns' priors as pseudo
    /// observations, nowhere below what the residual variance explains.
    pub fn covariance(&self, roles: &[Role], fit: &RidgeFit) -> DMatrix<f64> {
        let gram = &self.linear.gram;
        let m = roles.len();
        let columns: Vec<usize> =
            (0..m).filter(|i| roles[*i] != Role::Out && gram.clusters.iter().any(|c| c.jj[(*i, *i)] > 0.0)).collect();
        let k = columns.len();
        let mut jj = DMatrix::zeros(k, k);
        let mut meat = DMatrix::zeros(k, k);
        let g = gram.clusters.len() as f64;
        for c in &gram.clusters {
            let score = nalgebra::DVector::from_fn(k, |p, _| {
                c.jr[columns[p]] - columns.iter().map(|q| c.jj[(columns[p], *q)] * fit.step[*q]).sum::<f64>()
            });
            meat += &score * score.transpose();
            for p in 0..k {
                for q in 0..k {
                    jj[(p, q)] += c.jj[(columns[p], columns[q])];
                }
            }
        }
        let free = roles.iter().filter(|r| **r == Role::Free).count() as f64;
        meat *= g / (g - free).max(1.0);
        let mut plain = jj.clone() * self.variance;
        for (p, c) in columns.iter().enumerate() {
            if let Role::Held(sd, _) = roles[*c] {
                let weight = self.variance / (sd * sd);
                jj[(p, p)] += weight;
                meat[(p, p)] += weight * self.variance;
                plain[(p, p)] += weight * self.variance;
            }
        }
        let scale: Vec<f64> = (0..k).map(|i| jj[(i, i)].sqrt().max(1e-150)).collect();
        let unit = DMatrix::from_fn(k, k, |p, q| jj[(p, q)] / (scale[p] * scale[q]) + if p == q { 1e-9 } else { 0.0 });
        let Some(inverse) = unit.try_inverse() else { return DMatrix::from_element(m, m, f64::INFINITY) };
        let inverse = DMatrix::from_fn(k, k, |p, q| inverse[(p, q)] / (scale[p] * scale[q]));
        let robust = &inverse * meat * &inverse;
        let plain = &inverse * plain * &inverse;
        let mut out = DMatrix::zeros(m, m);
        for p in 0..k {
            for q in 0..k {
                let factor = |i: usize| (plain[(i, i)] / robust[(i, i)].max(1e-300)).max(1.0).sqrt();
                out[(columns[p], columns[q])] = robust[(p, q)] * factor(p) * factor(q);
            }
        }
        out
    }
}

/// The columns of an active effect, and the step along them that takes all of it away.
fn whole(linear: &Linear, state: &State, index: usize) -> (Vec<usize>, Vec<f64>) {
    if let Some(column) = linear.owners.iter().position(|o| *o == Owner::Whole(index)) {
        return (vec![column], vec![1.0]);
    }
    let active = &state.active[index];
    let columns = linear.of_active(index);
    let value = |c: &usize| match linear.owners[*c] {
        Owner::Active(_, j) => active.values.get(&active.form.free[j].name),
        _ => 0.0,
    };
    let p = columns.iter().map(value).collect();
    (columns, p)
}

/// Square of a step along some columns in units of the noise.
fn square(jj: &DMatrix<f64>, columns: &[usize], p: &[f64]) -> f64 {
    let row = |(a, x): (&usize, &f64)| columns.iter().zip(p).map(|(b, y)| jj[(*a, *b)] * x * y).sum::<f64>();
    columns.iter().zip(p).map(row).sum()
}

/// Whether any parameter of an effect exceeds its materiality threshold.
pub fn is_material(active: &Active, values: &[f64]) -> bool {
    active.form.free.iter().zip(values).any(|(p, v)| p.is_material(*v))
}
