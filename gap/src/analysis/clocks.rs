//! Whether the clocks of robot and camera were set against each other anew for every run, with what the file says.

use estimation::normal_equations::Cluster;
use estimation::statistics::{chi2_upper, t_quantile_975};
use model::fit::clocks;

use super::found::Named;
use crate::evidence::Interval;
use crate::state::State;
use links::effects::camera_latency;
use links::motion::MotionLink;
use links::thresholds::SIGNIFICANT;

/// Step of the age by which poses are derived, s: that of its parameter.
const STEP_S: f64 = 0.005;

/// Whether one clock does not do for all runs.
pub(super) fn differ(link: &MotionLink, start: &State) -> bool {
    let moved = |by: f64| {
        let mut model = start.motion(None);
        model.latency_s += by;
        model
    };
    let side = (Some(moved(-STEP_S)), moved(STEP_S), 2.0 * STEP_S);
    let age = |run: &[Cluster]| {
        let sum = |of: &dyn Fn(&Cluster) -> f64| run.iter().map(of).sum::<f64>();
        clocks::age(sum(&|c| c.jj[(0, 0)]), sum(&|c| c.jr[0]), sum(&|c| c.rr), sum(&|c| c.n))
    };
    let clusters = link.linearise_camera(&start.motion(None), &[side]);
    let ages: Vec<[f64; 2]> = clusters.chunk_by(|a, b| a.run == b.run).filter_map(age).collect();
    clocks::differ(&ages, camera_latency::material(&start.robot))
}

/// Whether clocks that were found run by run part by no more than chance: frames are then equally old in all runs, by one
/// number.
pub(super) fn are_one(clocks: &Named) -> bool {
    let known = |(_, offset, interval): &(String, f64, Interval)| {
        let [low, high] = interval.ends()?;
        let error = 0.5 * (high - low) / t_quantile_975(usize::MAX);
        (error > 0.0).then(|| [*offset, error.powi(-2)])
    };
    let known: Vec<[f64; 2]> = clocks.parameters.iter().filter_map(known).collect();
    let sum = |of: &dyn Fn(&[f64; 2]) -> f64| known.iter().map(of).sum::<f64>();
    let mean = sum(&|[offset, weight]| offset * weight) / sum(&|[_, weight]| *weight);
    let apart = sum(&|[offset, weight]| weight * (offset - mean).powi(2));
    known.len() > 1 && chi2_upper(apart, known.len() as f64 - 1.0) > SIGNIFICANT
}

#[cfg(test)]
mod tests {
    use links::effect::Link;

    use super::*;

    #[test]
    fn clocks_that_part_by_chance_are_one() {
        let clocks = |ms: &[[f64; 2]]| {
            let offset = |[at, half]: &[f64; 2]| {
                (String::new(), 1e-3 * at, Interval::Ci95([1e-3 * (at - half), 1e-3 * (at + half)]))
            };
            Named { parameters: ms.iter().map(offset).collect(), ..Named::bare("camera-clock", Link::Motion, &[]) }
        };
        assert!(are_one(&clocks(&[[34.6, 5.4], [41.1, 9.3], [34.0, 6.6], [36.9, 6.7]])));
        assert!(!are_one(&clocks(&[[34.6, 5.4], [61.1, 9.3], [34.0, 6.6], [36.9, 6.7]])));
        assert!(!are_one(&clocks(&[])));
    }
}
