//! A linearised link with all candidates: fits of any subset, their trials and covariances.

use std::ops::Index;

use estimation::parallel::numbered;
use nalgebra::DMatrix;

use crate::candidates::does_all;
use crate::problem::{Linear, Owner, Problem};
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use estimation::prior::{Penalised, PenalisedFit, Role};

/// A linearised link with all candidates, ready for any question about subsets.
pub struct Design {
    /// The state it is linearised about.
    pub state: State,
    /// Candidates with a column each parameter.
    pub candidates: Vec<Active>,
    /// Derivatives of the residuals by what may be estimated.
    pub linear: Linear,
    /// Variance of the residuals in units of the assumed noise.
    pub variance: f64,
    pub(super) held: Vec<Role>,
    /// The same before named effects widened anything, and without their look-alikes.
    narrow: Vec<Role>,
    thresholds: Thresholds,
    /// Squared torque that the motors gave, in noises; 0 where no drive is compared.
    given: f64,
}

/// A candidate's fit on a design.
#[derive(Debug, Clone)]
pub struct Trial {
    /// Index of the candidate.
    pub candidate: usize,
    /// Decrease of the objective, complexity paid for.
    pub gain: f64,
    /// Estimates of its parameters, in their order.
    pub values: Vec<f64>,
    /// Whether any of them is material.
    pub material: bool,
    /// Whether the straight line leads out of the bounds, at which the estimates were stopped.
    pub beyond: bool,
}

impl Design {
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
                    if !p.material.is_finite() || !candidate.effect.may_be_little(&candidate.form) {
                        return Role::Out;
                    }
                    if candidate.switched() {
                        // Of the forms of one effect that have the same parameters only those nearest to its absence.
                        let alike = |o: &Active| {
                            let names = o.form.free.iter().map(|p| &p.name);
                            o.effect.name() == candidate.effect.name()
                                && names.eq(candidate.form.free.iter().map(|p| &p.name))
                        };
                        let own: Vec<usize> = (0..candidates.len()).filter(|o| alike(&candidates[*o])).collect();
                        let near = match candidate.form.free.first().and_then(|p| p.below) {
                            Some(_) => own.last() == Some(c),
                            None => own.first() == Some(c) || own.get(own.len() / 2) == Some(c),
                        };
                        // No more of a large one that is tried than of any.
                        let little = thresholds.held_share * p.material / p.start.map_or(1.0, f64::abs);
                        let share =
                            if p.below.is_none() { little.min(thresholds.held_switch) } else { thresholds.held_switch };
                        return if near { Role::Held(share, 0.0) } else { Role::Out };
                    }
                    Role::Held(thresholds.held_share * p.material, 0.0)
                }
            })
            .collect::<Vec<_>>();
        let mut design = Self {
            state: state.clone(),
            candidates: candidates.to_vec(),
            linear,
            variance: 1.0,
            narrow: held.clone(),
            held,
            thresholds: thresholds.clone(),
            given: match problem {
                Problem::Motion(_) => 0.0,
                Problem::Drive(link) => link.tells(&state.drive(None)),
            },
        };
        design.merge_twins();
        design.share_margins();
        design.narrow.clone_from(&design.held);
        design.freeze_twins();
        design.widen();
        let free: Vec<Role> =
            design.held.iter().map(|r| if *r == Role::Out { Role::Out } else { Role::Free }).collect();
        let n = design.linear.equations.n();
        let columns = free.iter().filter(|r| **r == Role::Free).count() as f64;
        let least = Penalised::new(&design.linear.equations, 1.0).fit(&free).loss;
        design.variance = (least / (n - columns).max(1.0)).max(1.0) * thresholds.correlation(problem.link());
        design
    }

    /// Of columns that are the same but for a factor, one is held; several would add their margins.
    fn merge_twins(&mut self) {
        let m = self.linear.owners.len();
        let jj = self.linear.equations.information();
        for a in 0..m {
            for b in 0..a {
                let (Role::Held(sa, _), Role::Held(sb, _)) = (self.held[a], self.held[b]) else { continue };
                let cos2 = jj[(a, b)].powi(2) / (jj[(a, a)] * jj[(b, b)]).max(1e-300);
                if cos2 > self.thresholds.one {
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
        let jj = self.linear.equations.information();
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

    /// What does the same as the named effects together is frozen while their sizes are estimated: these are the sizes
    /// of "this is the cause".
    fn freeze_twins(&mut self) {
        let jj = self.linear.equations.information();
        let named = self.linear.active();
        if named.is_empty() {
            return;
        }
        let a = DMatrix::from_fn(named.len(), named.len(), |i, j| jj[(named[i], named[j])]);
        for c in 0..self.linear.owners.len() {
            if !matches!(self.narrow[c], Role::Held(..)) {
                continue;
            }
            let b = nalgebra::DVector::from_fn(named.len(), |i, _| jj[(named[i], c)]);
            if b.dot(&estimation::normal_equations::solve(&a, &b)) > self.thresholds.alike * jj[(c, c)] {
                self.narrow[c] = Role::Out;
            }
        }
    }

    /// The law of a large effect is not known to the last tenth: what looks like a named effect is
    /// allowed a share of it without being named, less where the law is geometry.
    fn widen(&mut self) {
        let m = self.linear.owners.len();
        let jj = self.linear.equations.information();
        for index in 0..self.state.active.len() {
            let (columns, p) = self.whole(index);
            let size2 = square(&jj, &columns, &p);
            if size2 <= 0.0 {
                continue;
            }
            let share = self.thresholds.law_share(self.state.active[index].effect.law_uncertainty());
            for c in 0..m {
                let Role::Held(sd, at) = self.held[c] else { continue };
                if jj[(c, c)] <= 0.0 {
                    continue;
                }
                let overlap: f64 = columns.iter().zip(&p).map(|(a, x)| jj[(c, *a)] * x).sum();
                let cos2 = overlap * overlap / (size2 * jj[(c, c)]);
                let Owner::Candidate(candidate, j) = self.linear.owners[c] else { continue };
                // No wider than what is physical: a column that is next to nothing would else be stretched to anything.
                let [low, high] = self.candidates[candidate].form.free[j].bounds;
                let wide = (share * cos2 * (size2 / jj[(c, c)]).sqrt()).min(0.5 * (high - low));
                self.held[c] = Role::Held(sd.max(wide), at);
            }
        }
    }

    /// What the laws of the named effects, none of them exact, may leave at two standard deviations: a sum of squares
    /// in units of the noise.
    pub fn left_by_laws(&self) -> f64 {
        let jj = self.linear.equations.information();
        let left = |index: usize| {
            let (columns, p) = self.whole(index);
            self.state.active[index].effect.law_uncertainty().powi(2) * square(&jj, &columns, &p)
        };
        self.thresholds.law_sigmas.powi(2) * (0..self.state.active.len()).map(left).sum::<f64>()
    }

    /// What some active effects do together, and what of it a candidate cannot do: sums of squares in units of the
    /// variance.
    pub fn left_by(&self, candidate: usize, indices: &[usize]) -> [f64; 2] {
        self.beside(indices, &self.linear.of_candidate(candidate))
    }

    /// The columns of an active effect, and the step along them that takes all of it away.
    pub(super) fn whole(&self, index: usize) -> (Vec<usize>, Vec<f64>) {
        if let Some(column) = self.linear.owners.iter().position(|o| *o == Owner::Whole(index)) {
            return (vec![column], vec![1.0]);
        }
        let active = &self.state.active[index];
        let columns = self.linear.of_active(index);
        let value = |c: &usize| match self.linear.owners[*c] {
            Owner::Active(_, j) => active.values.get(&active.form.free[j].name),
            _ => 0.0,
        };
        let p = columns.iter().map(value).collect();
        (columns, p)
    }

    /// What an active effect does that another one cannot.
    pub(super) fn own_part(&self, index: usize, other: usize) -> f64 {
        self.beside(&[index], &self.whole(other).0)[1]
    }

    fn beside(&self, indices: &[usize], others: &[usize]) -> [f64; 2] {
        let jj = self.linear.equations.information();
        let (mut columns, mut p) = (Vec::new(), Vec::new());
        for index in indices {
            let part = self.whole(*index);
            columns.extend(part.0);
            p.extend(part.1);
        }
        let size2 = square(&jj, &columns, &p);
        let a = DMatrix::from_fn(others.len(), others.len(), |i, j| jj[(others[i], others[j])]);
        let b = nalgebra::DVector::from_fn(others.len(), |i, _| {
            columns.iter().zip(&p).map(|(c, x)| jj[(others[i], *c)] * x).sum::<f64>()
        });
        let done = b.dot(&estimation::normal_equations::solve(&a, &b)).clamp(0.0, size2.max(0.0));
        [size2 / self.variance, (size2 - done) / self.variance]
    }

    /// Whether a candidate does what an active effect does.
    pub fn is_twin(&self, candidate: usize, index: usize) -> bool {
        let [all, left] = self.left_by(candidate, &[index]);
        left < (1.0 - self.thresholds.alike) * all
    }

    /// Decrease of the objective that naming a column brings for each square of its size, if it is what the data
    /// hold: what is not named would have to be stretched for it.
    pub fn gain_per_square(&self, column: usize, roles: &[Role]) -> f64 {
        let roles: Vec<Role> =
            roles.iter().map(|r| if let Role::Held(sd, _) = r { Role::Held(*sd, 0.0) } else { *r }).collect();
        let fit = self.penalised().explain(column, &roles);
        fit.loss + fit.penalty
    }

    /// What each cluster tells of a column that the named effects do not.
    pub fn information_beside_named(&self, column: usize) -> Vec<f64> {
        let jj = self.linear.equations.information();
        let named: Vec<usize> = self.linear.active().into_iter().filter(|c| *c != column).collect();
        let a = DMatrix::from_fn(named.len(), named.len(), |i, j| jj[(named[i], named[j])]);
        let b = nalgebra::DVector::from_fn(named.len(), |i, _| jj[(named[i], column)]);
        let x = estimation::normal_equations::solve(&a, &b);
        let of = |k: &estimation::normal_equations::Cluster| {
            let twice = 2.0 * named.iter().enumerate().map(|(i, c)| x[i] * k.jj[(*c, column)]).sum::<f64>();
            k.jj[(column, column)] - twice + square(&k.jj, &named, x.as_slice())
        };
        self.linear.equations.clusters.iter().map(of).collect()
    }

    /// How far a margin of so many a standard deviation goes: hardly beyond what is physical, and what the log leaves open.
    /// Of what has no little within its bounds, as duties that are logged a row late, only what the log leaves open; what undoes
    /// it, as duties that act late by a part of a row, may be.
    fn limits_of(&self, candidate: &Active, parameter: usize, sd: f64) -> [f64; 2] {
        let p = &candidate.form.free[parameter];
        let [low, high] = p.bounds;
        if candidate.switched() {
            let little = |start: f64| (low..=high).contains(&(sd * start));
            let none = p.start.filter(|start| p.below.is_none() && !little(*start));
            return [f64::NEG_INFINITY, none.map_or(f64::INFINITY, |start| p.open / start.abs())];
        }
        let beyond = p.open + self.thresholds.held_beyond * sd;
        [low - beyond, high + beyond]
    }

    pub(super) fn penalised(&self) -> Penalised<'_> {
        let limits = self.linear.owners.iter().zip(&self.held).map(|(owner, role)| match (*owner, *role) {
            (Owner::Candidate(c, j), Role::Held(sd, _)) => self.limits_of(&self.candidates[c], j, sd),
            _ => [f64::NEG_INFINITY, f64::INFINITY],
        });
        Penalised::new(&self.linear.equations, self.variance).within(limits.collect())
    }

    /// By which it was made.
    pub fn thresholds(&self) -> &Thresholds {
        &self.thresholds
    }

    /// Roles with nothing freed.
    pub fn roles(&self) -> Vec<Role> {
        self.held.clone()
    }

    /// Roles for the estimates of what is named.
    pub fn estimating(&self) -> Vec<Role> {
        self.narrow.clone()
    }

    /// The same without what, once all else that is not named adapts, does what a named effect does: a motor 3 K
    /// warmer and a rotor 1 % lighter are viscous friction, as a torque constant alone is, which is frozen already.
    pub fn without_twins(&self) -> Vec<Role> {
        self.penalised().without_twins(&self.narrow, self.thresholds.alike)
    }

    /// Roles for the estimates of what is named, and of `freed` candidates, if they are the cause: what looks like them,
    /// alone or together with what else is not named, is frozen. With `bare` everything is.
    pub fn judged(&self, freed: &[usize], bare: bool) -> Vec<Role> {
        let role = |role: Role| if bare && matches!(role, Role::Held(..)) { Role::Out } else { role };
        self.without_alike(freed, self.thresholds.twin).into_iter().map(role).collect()
    }

    /// The same where only what does all that they do is frozen.
    pub fn estimating_with(&self, freed: &[usize]) -> Vec<Role> {
        self.without_alike(freed, self.thresholds.alike)
    }

    /// Roles with some candidates freed, and frozen what shares at least so much with them and with what is named.
    fn without_alike(&self, freed: &[usize], share: f64) -> Vec<Role> {
        let mut named = self.linear.active();
        named.extend(freed.iter().flat_map(|c| self.linear.of_candidate(*c)));
        let jj = self.linear.equations.information();
        let a = DMatrix::from_fn(named.len(), named.len(), |i, j| jj[(named[i], named[j])]);
        let alike = |c: usize| {
            let b = nalgebra::DVector::from_fn(named.len(), |i, _| jj[(named[i], c)]);
            b.dot(&estimation::normal_equations::solve(&a, &b)) > share * jj[(c, c)]
        };
        let role = |(c, r): (usize, Role)| if matches!(r, Role::Held(..)) && alike(c) { Role::Out } else { r };
        let from = if freed.is_empty() { self.narrow.clone() } else { self.freeing(freed) };
        from.into_iter().enumerate().map(role).collect()
    }

    /// The estimates of the roles with one run (or block) left out at a time, steps along all columns.
    pub fn left_out(&self, roles: &[Role]) -> Vec<nalgebra::DVector<f64>> {
        self.penalised().left_out(roles)
    }

    /// The fit with given roles.
    pub fn fit_roles(&self, roles: &[Role]) -> PenalisedFit {
        self.penalised().fit(roles)
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
    pub fn objective(&self, fit: &PenalisedFit, freed: &[usize], thresholds: &Thresholds) -> f64 {
        let costs: f64 = freed.iter().map(|c| thresholds.cost(self.candidates[*c].form.free.len())).sum();
        fit.loss + fit.penalty + costs
    }

    /// The fit with nothing freed.
    pub fn base(&self) -> PenalisedFit {
        self.penalised().fit(&self.held)
    }

    /// The fit with nothing freed in which named effects move no further than a straight line holds.
    pub fn near(&self) -> PenalisedFit {
        let limits: Vec<[f64; 2]> = self
            .linear
            .owners
            .iter()
            .map(|owner| match *owner {
                Owner::Active(index, j) => {
                    let active = &self.state.active[index];
                    let p = &active.form.free[j];
                    let now = active.values.get(&p.name);
                    [(p.bounds[0] - now).clamp(-p.scale, 0.0), (p.bounds[1] - now).clamp(0.0, p.scale)]
                }
                _ => [f64::NEG_INFINITY, f64::INFINITY],
            })
            .collect();
        self.penalised().fit_within(&self.held, &limits)
    }

    /// Objective of the state as it stands, unnamed effects adjusted.
    pub fn standing(&self) -> PenalisedFit {
        let still = |r: &Role| if *r == Role::Free { Role::Out } else { *r };
        self.penalised().fit(&self.held.iter().map(still).collect::<Vec<_>>())
    }

    /// The fit with some candidates freed.
    pub fn fit(&self, freed: &[usize]) -> PenalisedFit {
        self.penalised().fit(&self.freeing(freed))
    }

    /// The roles with one candidate freed, those of its parameters that the straight line leads out of their
    /// bounds stopped there; `None` if it does not make sense at all.
    fn inside(&self, penalised: &Penalised, c: usize) -> Option<(Vec<Role>, PenalisedFit, bool)> {
        let mut roles = self.freeing(&[c]);
        let fit = penalised.fit(&roles);
        if self.within_bounds(c, &self.values(&fit, c), &fit) {
            return Some((roles, fit, false));
        }
        let candidate = &self.candidates[c];
        let columns = self.linear.of_candidate(c);
        if candidate.switched() {
            return None;
        }
        for (p, column) in candidate.form.free.iter().zip(&columns) {
            let x = fit.step[*column];
            let stopped = x.clamp(p.bounds[0], p.bounds[1]);
            if stopped == 0.0 && x != 0.0 {
                // The other sign of what has one only.
                return None;
            }
            if stopped != x {
                roles[*column] = Role::At(stopped);
            }
        }
        let fit = penalised.fit(&roles);
        self.within_bounds(c, &self.values(&fit, c), &fit).then_some((roles, fit, true))
    }

    /// Roles with a candidate freed and nothing held beside it.
    fn bare(&self, freed: Option<usize>) -> Vec<Role> {
        let roles = match freed {
            Some(c) => self.inside(&self.penalised(), c).map_or_else(|| self.freeing(&[c]), |i| i.0),
            None => self.held.clone(),
        };
        roles.into_iter().map(|r| if matches!(r, Role::Held(..)) { Role::Out } else { r }).collect()
    }

    /// Held-out losses per cluster with a candidate freed, and nothing held beside it.
    pub fn held_out(&self, freed: Option<usize>) -> Vec<f64> {
        self.penalised().held_out(&self.bare(freed))
    }

    /// The same with parts of runs held out instead of runs.
    pub fn held_out_blocks(&self, freed: Option<usize>) -> Vec<f64> {
        let equations = self.linear.equations.with_folds(|i| i % 5);
        Penalised::new(&equations, self.variance).held_out(&self.bare(freed))
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
        let (base, without) = (self.base(), self.penalised().fit(&roles));
        let freed = active.form.free.len() - keep.len();
        let cost =
            if keep.is_empty() { thresholds.cost(active.form.free.len()) } else { thresholds.costs[1] * freed as f64 };
        without.loss + without.penalty - base.loss - base.penalty - cost
    }

    /// Estimates of a candidate in a fit.
    pub fn values(&self, fit: &PenalisedFit, candidate: usize) -> Vec<f64> {
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
        let penalised = self.penalised();
        let trial = |c: usize| {
            if self.is_active(c) || !self.linear.of_candidate(c).iter().all(|j| self.linear.equations.tells(*j)) {
                return None;
            }
            let (_, fit, beyond) = self.inside(&penalised, c)?;
            let values = self.values(&fit, c);
            let gain = from - self.objective(&fit, &[c], thresholds);
            Some(Trial { candidate: c, gain, material: self.material(c, &values), values, beyond })
        };
        let mut trials: Vec<Trial> = numbered(self.candidates.len(), &trial).into_iter().flatten().collect();
        // Equals keep the order of the catalogue.
        trials.sort_by(|a, b| (b.gain - 1e-6 * b.candidate as f64).total_cmp(&(a.gain - 1e-6 * a.candidate as f64)));
        trials
    }

    fn is_active(&self, c: usize) -> bool {
        let candidate = &self.candidates[c];
        self.state.active.iter().filter(|a| !a.given).any(|a| {
            let as_rich = a.form.free.len() >= candidate.form.free.len() || a.form.fixed != candidate.form.fixed;
            a.effect.name() == candidate.effect.name() && as_rich || does_all(a, candidate)
        })
    }

    /// Whether an estimate makes physical sense: all parameters within bounds, give or take noise.
    pub(super) fn within_bounds(&self, c: usize, values: &[f64], fit: &PenalisedFit) -> bool {
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

    /// Size that a candidate's parameter must exceed beside its materiality threshold: more where a named effect of
    /// the same look widened the margin.
    pub fn margin(&self, c: usize, j: usize) -> f64 {
        match self.linear.of_candidate(c).get(j).map(|j| self.held[*j]) {
            Some(Role::Held(sd, _)) if !self.candidates[c].switched() => sd / self.thresholds.held_share,
            _ => 0.0,
        }
    }

    /// Whether an estimate exceeds the materiality threshold.
    pub fn material(&self, c: usize, values: &[f64]) -> bool {
        let free = self.candidates[c].form.free.iter();
        free.zip(values).enumerate().any(|(j, (p, v))| p.is_material(*v) && v.abs() >= self.margin(c, j))
    }

    /// Whether an effect that is there or is not takes enough of what the motors gave to be there.
    pub(super) fn takes(&self, t: &Trial) -> bool {
        let candidate = &self.candidates[t.candidate];
        candidate.effect.may_be_little(&candidate.form)
            || t.gain * self.variance >= self.thresholds.takes.powi(2) * self.given
    }

    /// What one direction of a missing law may add to the variances of the freed columns, where laws have so many of
    /// them.
    ///
    /// What is left above the noise is no scatter: it is the same in every cluster and every run, and how much of it a
    /// named effect took for its own does not show in the data. It points in any direction as likely as in another. Where
    /// the rest is adjusted beside what is freed, what that takes at its price is no law that is missing; far from the noise it
    /// would take anything.
    pub fn missed(&self, roles: &[Role], directions: f64) -> Vec<f64> {
        let (square, n) = self.linear.equations.plain();
        let adjusted = if square < self.thresholds.far.powi(2) * n {
            let weighted: f64 = self.linear.equations.clusters.iter().map(|c| c.rr).sum();
            let fit = self.fit_roles(roles);
            square * ((fit.loss + fit.penalty) * self.variance / weighted).min(1.0)
        } else {
            square
        };
        let alone: Vec<Role> = roles.iter().map(|r| if matches!(r, Role::Held(..)) { Role::Out } else { *r }).collect();
        let of = |square: f64, roles: &[Role]| {
            let excess = (square - n).max(0.0) / directions;
            let diagonal = self.penalised().inverse_diagonal(roles).into_iter();
            diagonal.map(|x| if x.is_finite() { excess * x } else { x }).collect::<Vec<f64>>()
        };
        of(adjusted, roles).into_iter().zip(of(square, &alone)).map(|(a, b)| a.max(b)).collect()
    }

    /// Covariance of the freed columns: see [`Penalised::covariance`].
    pub fn covariance(&self, roles: &[Role], fit: &PenalisedFit) -> DMatrix<f64> {
        self.penalised().covariance(roles, fit)
    }
}

/// Square of a step along some columns in units of the noise.
fn square(jj: &impl Index<(usize, usize), Output = f64>, columns: &[usize], p: &[f64]) -> f64 {
    let row = |(a, x): (&usize, &f64)| columns.iter().zip(p).map(|(b, y)| jj[(*a, *b)] * x * y).sum::<f64>();
    columns.iter().zip(p).map(row).sum()
}
