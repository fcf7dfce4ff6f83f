//! Estimates of what is named, and taking back what they do not support.

use nalgebra::DMatrix;

use super::{Design, Selection, finish, settle};
use crate::problem::{Owner, Problem};
use crate::state::Active;
use crate::thresholds::Thresholds;
use links::thresholds::{Estimate, gate};

/// Estimates of an active effect's fitted parameters with 95 % intervals.
pub fn estimates(design: &Design, index: usize) -> Vec<Estimate> {
    let roles = design.estimating();
    let fit = design.fit_roles(&roles);
    estimates_of(design, index, &fit.step, &design.covariance(&roles, &fit))
}

fn estimates_of(
    design: &Design,
    index: usize,
    step: &nalgebra::DVector<f64>,
    covariance: &DMatrix<f64>,
) -> Vec<Estimate> {
    let active = &design.state.active[index];
    let free = &active.form.free;
    let df = design.linear.equations.clusters.len().saturating_sub(free.len());
    let estimate = |(j, p): (usize, &links::effect::Parameter)| {
        let column = design.linear.owners.iter().position(|o| *o == Owner::Active(index, j));
        let value = active.values.get(&p.name) + column.map_or(0.0, |c| step[c]).clamp(-p.scale, p.scale);
        let value = active.effect.period(&p.name).map_or(value, |period| value.rem_euclid(period));
        let sd = column.map_or(0.0, |c| covariance[(c, c)].max(0.0).sqrt());
        // The effect's own law is not known to better than that.
        let half =
            (estimation::statistics::t_quantile_975(df) * sd).hypot(2.0 * active.effect.law_uncertainty() * value);
        Estimate {
            name: p.name.clone(),
            value,
            interval: [value - half, value + half],
            bounds: p.bounds,
            sized: p.material.is_finite(),
            absent_at_zero: p.below.is_none(),
            blurred: p.blurred,
            closed: p.closed,
        }
    };
    free.iter().enumerate().map(estimate).collect()
}

/// Takes back, one after the other, what the gate does not let through by its estimates.
pub(super) fn sure(
    problem: &Problem,
    mut found: Selection,
    from: usize,
    all: &[Active],
    thresholds: &Thresholds,
) -> Selection {
    let mut taken_back = Vec::new();
    loop {
        let design = &found.design;
        let roles = design.estimating();
        let fit = design.fit_roles(&roles);
        let covariance = design.covariance(&roles, &fit);
        let refused = |i: usize| {
            let why = gate(&estimates_of(design, i, &fit.step, &covariance), None).err()?;
            found.state.active[i].worth().then_some((i, why))
        };
        let Some((index, why)) = (from..found.state.active.len()).rev().find_map(refused) else {
            return Selection { taken_back, ..found };
        };
        let mut state = found.state.clone();
        taken_back.push((state.active.remove(index).effect.name().to_owned(), why));
        let settled = settle(problem, &mut state, all, thresholds);
        found = finish(state, settled, from, thresholds);
    }
}
