//! How wide an interval is: what scatters between clusters and runs, and what is the same in all of them.

use estimation::prior::Role;
use estimation::statistics::{chi2_upper, t_quantile_975};
use nalgebra::{DMatrix, DVector};

use crate::problem::Problem;
use crate::select::Design;
use crate::state::Active;
use links::drive::Generic;
use links::effect::{Link, Parameter};

/// What the intervals of a design's columns are made of.
pub(crate) struct Intervals {
    scatter: Vec<f64>,
    missed: Vec<f64>,
    left_out: Vec<DVector<f64>>,
    clusters: usize,
    held_share: f64,
    runs_differ: f64,
    link: Link,
    felt: bool,
}

impl Intervals {
    /// Of columns estimated by `roles`, whose variances are at least those of `beside`.
    ///
    /// What only partly looks like a named effect is there as well, unnamed and of any size up to its margin: the size is
    /// that of this cause alone, but it is not known to better than what those would make of it.
    pub(crate) fn new(problem: &Problem, design: &Design, roles: &[Role], beside: &DMatrix<f64>) -> Self {
        let covariance = design.covariance(roles, &design.fit_roles(roles));
        // A floor is what smooth functions of speed, duty and the like leave of each wheel: laws that are missing are such.
        let missed = match problem {
            Problem::Drive(link) => design.missed(roles, Generic::columns_of_wheel(link) as f64),
            Problem::Motion(_) => vec![0.0; roles.len()],
        };
        Self {
            scatter: (0..roles.len()).map(|c| covariance[(c, c)].max(beside[(c, c)]).max(0.0)).collect(),
            missed,
            left_out: design.left_out(roles),
            clusters: design.linear.equations.clusters.len(),
            held_share: design.thresholds().held_share,
            runs_differ: design.thresholds().runs_differ,
            link: problem.link(),
            felt: problem.is_felt(),
        }
    }

    /// Half the width of the 95 % interval of an effect's parameter, but for the inexactness of the effect's own law.
    pub(crate) fn half(&self, column: usize, active: &Active, p: &Parameter) -> f64 {
        let df = self.clusters.saturating_sub(active.form.free.len());
        let steps: Vec<f64> = self.left_out.iter().map(|s| s[column]).collect();
        let runs = if active.effect.nuisance() { &[][..] } else { &steps[..] };
        let half =
            half_width(self.scatter[column], self.missed[column] + self.usual(p).powi(2), df, runs, self.runs_differ);
        half.hypot(p.open)
    }

    /// Of friction and motors every robot has a little beyond its file, of which a name does not speak.
    fn usual(&self, p: &Parameter) -> f64 {
        match self.link {
            Link::Drive if p.material.is_finite() => self.held_share * p.material,
            // A wheel that creeps under load leads the body, as if it were read later, by some tenths of a millisecond.
            Link::Motion if self.felt && p.name == "latency_s" => self.held_share * p.material,
            _ => 0.0,
        }
    }
}

/// Half the width of a 95 % interval: by clusters, or by runs where they differ by more than clusters explain, and by
/// what is the same in all of them. `left_out` are the estimates without one run each.
fn half_width(variance: f64, common: f64, df: usize, left_out: &[f64], runs_differ: f64) -> f64 {
    let of_common = t_quantile_975(usize::MAX) * common.sqrt();
    of_common.hypot(half_scatter(variance, df, left_out, runs_differ))
}

/// The same of what scatters alone.
fn half_scatter(variance: f64, df: usize, left_out: &[f64], runs_differ: f64) -> f64 {
    let by_clusters = t_quantile_975(df) * variance.sqrt();
    let runs = left_out.len();
    if runs < 3 {
        return by_clusters;
    }
    let mean = left_out.iter().sum::<f64>() / runs as f64;
    let free = (runs - 1) as f64;
    // The jackknife's variance.
    let by_runs = free / runs as f64 * left_out.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
    let chi2 = by_runs / variance.max(1e-300) * free;
    if chi2_upper(chi2, free) < runs_differ {
        by_clusters.max(t_quantile_975(runs - 1) * by_runs.sqrt())
    } else {
        by_clusters
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_as_wide_as_runs_differ() {
        // Runs that agree as clusters have it.
        let t = t_quantile_975(100);
        assert!((half_scatter(1.0, 100, &[0.0, 0.1, -0.1, 0.2], 0.05) - t).abs() < 1e-12);
        // Leave-one-out estimates three cluster deviations apart.
        let wide = half_scatter(1.0, 100, &[3.0, -3.0, 3.0, -3.0], 0.05);
        assert!(wide > 3.0 * t, "{wide}");
        assert!((half_scatter(1.0, 100, &[9.0, -9.0], 0.05) - t).abs() < 1e-12, "two runs have no spread");
        // What all runs share adds to that.
        let both = half_width(1.0, 1.0, 100, &[9.0, -9.0], 0.05);
        assert!((both / t / 2.0_f64.sqrt() - 1.0).abs() < 0.01, "{both}");
    }
}
