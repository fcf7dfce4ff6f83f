//! `camera-clock`: clocks of robot and camera that were set against each other anew for every run.

use runs::CLOCK_OFF_S;
use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

/// Clocks of robot and camera that were set against each other anew for every run: what a recording started by hand
/// has. Frames that are equally old in all runs are [`super::camera_latency`]; where each run has its clock, what they
/// have in common is no latency. How fast clocks part is `camera-timing`.
pub struct CameraClock {
    /// Runs of the data set; the effect has no form with fewer than two.
    pub runs: usize,
}

impl CameraClock {
    /// Name of the effect.
    pub const NAME: &'static str = "camera-clock";

    fn parameter(run: usize) -> String {
        format!("offset_{}_s", run + 1)
    }

    /// Seconds by which each run's frames are old. A file that leaves out the last run has offsets that sum to 0.
    fn offsets(&self, values: &Values) -> Vec<f64> {
        let mut offsets: Vec<f64> = (0..self.runs).map(|run| values.get(&Self::parameter(run))).collect();
        let sum: f64 = offsets.iter().sum();
        if let Some(last) = offsets.last_mut()
            && values.find(&Self::parameter(self.runs - 1)).is_none()
        {
            *last = -sum;
        }
        offsets
    }
}

impl Effect for CameraClock {
    fn name(&self) -> &str {
        Self::NAME
    }

    fn equation(&self) -> &str {
        "frames of run i show the robot at t - offset_i_s, fitted anew for the runs at hand"
    }

    fn reference(&self) -> &str {
        "clock synchronisation, e.g. IEEE 1588"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        if self.runs < 2 {
            return Vec::new();
        }
        let p = |run| {
            Parameter::new(
                Self::parameter(run),
                0.005,
                [-CLOCK_OFF_S, CLOCK_OFF_S],
                super::camera_latency::material(robot),
            )
        };
        vec![Form::whole((0..self.runs).map(p).collect())]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        let offsets = self.offsets(values);
        model.clock_offset_s.resize(offsets.len().max(model.clock_offset_s.len()), 0.0);
        model.clock_offset_s.iter_mut().zip(offsets).for_each(|(sum, offset)| *sum += offset);
    }

    fn nuisance(&self) -> bool {
        true
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("start every run with a jerk that both clocks see, or synchronise the clocks", 5.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_run_has_an_offset_and_one_run_has_none() {
        let robot = Robot::racbot();
        assert!(CameraClock { runs: 1 }.forms(&robot).is_empty());
        let clock = CameraClock { runs: 3 };
        assert_eq!(clock.forms(&robot)[0].free.len(), 3);
        let mut values = Values::default();
        values.set("offset_1_s", 0.02);
        values.set("offset_2_s", -0.05);
        let told = |values: &Values, wanted: [f64; 3]| {
            let mut model = MotionModel::new(&robot);
            clock.motion(values, &mut model);
            let found = &model.clock_offset_s;
            assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
        };
        told(&values, [0.02, -0.05, 0.03]);
        values.set("offset_3_s", 0.01);
        told(&values, [0.02, -0.05, 0.01]);
    }
}
