//! Detection limits: the size from which an effect would be named in these data.

use crate::analysis::Limit;
use crate::effect::Link;
use crate::options::Thresholds;
use crate::problem::Owner;
use crate::select::Bench;

/// The limits of every effect of a link, those found included: what is material, exceeds its own
/// scatter, and explains enough of what the noise does not.
pub(crate) fn limits(link: Link, bench: &Bench, from: usize, thresholds: &Thresholds) -> Vec<Limit> {
    let mut out: Vec<Limit> = Vec::new();
    let gram = &bench.linear.gram;
    let total: f64 = gram.clusters.iter().map(|c| c.rr).sum();
    let needed = (thresholds.share(link) * total).max(thresholds.share_of_excess * (total - gram.n()).max(0.0));
    let by_share = |column: usize| {
        let own: f64 = gram.clusters.iter().map(|c| c.jj[(column, column)]).sum();
        if own > 0.0 { (needed / own).sqrt() } else { f64::INFINITY }
    };
    let mut add =
        |name: &str, parameter: &str, material: f64, estimate: f64, sd: f64, column: usize, unit: f64, free: usize| {
            let known = out.iter().any(|l| l.name == name && l.parameter == parameter);
            let limit =
                material.max(unit * (thresholds.gain + thresholds.cost(free)).sqrt() * sd).max(unit * by_share(column));
            if known || !sd.is_finite() || sd == 0.0 || !limit.is_finite() {
                return;
            }
            out.push(Limit {
                name: name.to_owned(),
                parameter: parameter.to_owned(),
                estimate,
                sd: unit * sd,
                limit,
                material,
            });
        };
    // What is named has a limit, too: that of its own columns.
    let roles = bench.estimating();
    let fit = bench.fit_roles(&roles);
    let covariance = bench.covariance(&roles, &fit);
    for (column, owner) in bench.linear.owners.iter().enumerate() {
        let Owner::Active(index, j) = *owner else { continue };
        let active = &bench.state.active[index];
        let p = &active.form.free[j];
        if index < from || active.effect.probe() || !p.material.is_finite() || p.below.is_some() {
            continue;
        }
        let sd = covariance[(column, column)].max(0.0).sqrt();
        let value = active.values.get(&p.name);
        add(active.effect.name(), &p.name, p.material, value, sd, column, 1.0, active.form.free.len());
    }
    for (c, candidate) in bench.candidates.iter().enumerate() {
        let wheels = bench.state.robot.wheel_count();
        let named = bench.state.active.iter().any(|a| a.effect.name() == candidate.effect.name());
        if named || candidate.effect.probe() || candidate.form.free.len() > wheels.max(3) {
            continue;
        }
        let roles = bench.freeing(&[c]);
        let fit = bench.fit(&[c]);
        let covariance = bench.covariance(&roles, &fit);
        let columns = bench.linear.of_candidate(c);
        for (j, p) in
            candidate.form.free.iter().enumerate().filter(|(_, p)| p.material.is_finite() && p.below.is_none())
        {
            let Some(column) = columns.get(j).copied() else { continue };
            let sd = covariance[(column, column)].max(0.0).sqrt();
            // The column of an effect that is switched on stands for its start value.
            let unit = if candidate.switched() { p.start.unwrap_or(1.0).abs() } else { 1.0 };
            let free = candidate.form.free.len();
            add(candidate.effect.name(), &p.name, p.material, unit * fit.step[column], sd, column, unit, free);
        }
    }
    out
}
