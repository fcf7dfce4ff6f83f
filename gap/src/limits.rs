//! Detection limits: the size from which an effect would be named in these data.

use crate::intervals::Intervals;
use crate::problem::{Owner, Problem};
use crate::select::Design;
use crate::state::Active;
use crate::thresholds::Thresholds;
use estimation::prior::Role;
use links::effect::{Link, Parameter};

/// Standard deviations of the estimate between a size that is named every other time and nine times of ten.
const NINE_OF_TEN: f64 = 1.2816;

/// An effect that is detectable but immaterial, or the limit from which it would be named.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// Name of the effect.
    pub name: String,
    /// As in `robot.toml`.
    pub parameter: String,
    /// Its estimate if everything else unnamed is held near zero.
    pub estimate: f64,
    /// Its standard deviation.
    pub sd: f64,
    /// Size that is named in nine of ten such data sets.
    pub limit: f64,
    /// Materiality threshold.
    pub material: f64,
}

/// What an effect must pass to be named, as sizes.
struct Gates<'a> {
    design: &'a Design,
    thresholds: &'a Thresholds,
    link: Link,
    /// Held-out sum of squares with what is named, and what of it is more than noise.
    total: f64,
    excess: f64,
    left_by_laws: f64,
}

impl Gates<'_> {
    /// Least size of an estimate that passes: in the objective, in materiality, on held-out runs, and by an interval that
    /// does not hold zero.
    fn least(&self, column: usize, roles: &[Role], free: usize, margin: f64, interval: f64) -> f64 {
        let t = self.thresholds;
        let per_square = self.design.gain_per_square(column, roles);
        let by_gain = |gain: f64| ((gain + t.cost(free)) / per_square).sqrt();
        let information = self.design.information_beside_named(column);
        let sum: f64 = information.iter().sum();
        let squares: f64 = information.iter().map(|i| i * i).sum();
        // The effect adds to the total that it must be a share of.
        let of = |share: f64, what: f64| (share * what / (sum * (1.0 - share))).sqrt();
        let by_share = of(t.share(self.link), self.total)
            .max(of(t.share_of_excess, self.excess))
            .max((self.left_by_laws / sum).sqrt());
        // Gains of clusters scatter by what the effect does there, and by noise.
        let by_t = |needed: f64| {
            let room = sum * sum - needed * needed * squares;
            if room > 0.0 { 2.0 * needed * (self.design.variance * sum / room).sqrt() } else { f64::INFINITY }
        };
        let by_run = by_t(t.held_out_t).min(by_t(0.5 * t.held_out_t).max(by_gain(t.strong)));
        by_gain(t.gain).max(margin).max(by_share).max(by_run).max(interval)
    }
}

/// Least size, in a column's unit, whose interval does not hold zero: it widens with the size, because the effect's own
/// law is not exact.
fn beyond_zero(intervals: &Intervals, column: usize, active: &Active, p: &Parameter) -> f64 {
    let own = (2.0 * active.effect.law_uncertainty()).powi(2);
    let half = intervals.half(column, active, p);
    if own < 1.0 { half / (1.0 - own).sqrt() } else { f64::INFINITY }
}

/// The limits of every effect of a link, those found included: nine of ten such data sets in which an effect has this
/// size, beside what is named already, would have it named.
pub(crate) fn limits(problem: &Problem, design: &Design, from: usize, thresholds: &Thresholds) -> Vec<Limit> {
    let mut out: Vec<Limit> = Vec::new();
    let total: f64 = design.held_out(None).iter().sum();
    let excess = (total - design.linear.equations.n()).max(0.0);
    let left_by_laws = design.left_by_laws();
    let gates = Gates { design, thresholds, link: problem.link(), total, excess, left_by_laws };
    let mut add = |name: &str, p: &Parameter, unit: f64, estimate: f64, sd: f64, least: f64| {
        let limit = unit * (least + NINE_OF_TEN * sd);
        let known = out.iter().any(|l| l.name == name && l.parameter == p.name);
        let most = p.bounds[0].abs().max(p.bounds[1].abs());
        if !known && sd > 0.0 && limit < most {
            let (estimate, sd) = (unit * estimate, unit * sd);
            out.push(Limit {
                name: name.to_owned(),
                parameter: p.name.clone(),
                estimate,
                sd,
                limit,
                material: p.material,
            });
        }
    };
    // What is named has a limit, too: that of its own columns.
    let roles = design.estimating();
    let fit = design.fit_roles(&roles);
    let covariance = design.covariance(&roles, &fit);
    let intervals = Intervals::new(problem, design, &design.judged(&[], false), &covariance);
    let named: Vec<usize> = (from..design.state.active.len()).filter(|i| design.state.active[*i].worth()).collect();
    for (column, owner) in design.linear.owners.iter().enumerate() {
        let Owner::Active(index, j) = *owner else { continue };
        let active = &design.state.active[index];
        let p = &active.form.free[j];
        if index < from || active.effect.probe() || !p.material.is_finite() || p.below.is_some() {
            continue;
        }
        let sd = covariance[(column, column)].max(0.0).sqrt();
        let mut without = design.roles();
        without[column] = Role::Held(thresholds.held_share * p.material, 0.0);
        let interval = beyond_zero(&intervals, column, active, p);
        let least = gates.least(column, &without, active.form.free.len(), p.material, interval);
        add(active.effect.name(), p, 1.0, active.values.get(&p.name), sd, least);
    }
    for (c, candidate) in design.candidates.iter().enumerate() {
        let wheels = design.state.robot.wheel_count();
        let known = design.state.active.iter().any(|a| a.effect.name() == candidate.effect.name());
        // Beside its twin it has no size of its own.
        let twin = || named.iter().any(|i| design.is_twin(c, *i));
        if known || candidate.effect.probe() || candidate.form.free.len() > wheels.max(3) || twin() {
            continue;
        }
        let roles = design.freeing(&[c]);
        let fit = design.fit(&[c]);
        let covariance = design.covariance(&roles, &fit);
        let columns = design.linear.of_candidate(c);
        let beside = design.estimating_with(&[c]);
        let beside = design.covariance(&beside, &design.fit_roles(&beside));
        let intervals = Intervals::new(problem, design, &design.judged(&[c], false), &beside);
        for (j, p) in
            candidate.form.free.iter().enumerate().filter(|(_, p)| p.material.is_finite() && p.below.is_none())
        {
            let Some(column) = columns.get(j).copied() else { continue };
            let sd = covariance[(column, column)].max(0.0).sqrt();
            // The column of an effect that is switched on stands for its start value.
            let unit = if candidate.switched() { p.start.unwrap_or(1.0).abs() } else { 1.0 };
            let margin = (p.material / unit).max(design.margin(c, j));
            // What is switched on is not absent at zero.
            let interval = if candidate.switched() { 0.0 } else { beyond_zero(&intervals, column, candidate, p) };
            let least = gates.least(column, &design.roles(), candidate.form.free.len(), margin, interval);
            add(candidate.effect.name(), p, unit, fit.step[column], sd, least);
        }
    }
    out
}
