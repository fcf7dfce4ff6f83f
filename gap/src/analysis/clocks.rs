//! Whether the clocks of robot and camera were set against each other anew for every run, with what the file says.

use estimation::normal_equations::Cluster;
use model::fit::clocks;

use crate::state::State;
use links::effects::camera_latency;
use links::motion::MotionLink;

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
