//! When the camera saw something else than the wheels said.

use links::motion::WindowResiduals;

/// Seconds in which the camera saw something else than the wheels said.
pub(super) struct Misses(Vec<(usize, f64, f64)>);

impl Misses {
    pub(super) fn new(windows: Option<&Vec<WindowResiduals>>, far: f64) -> Self {
        let is_far = |w: &&WindowResiduals| {
            let used = w.residuals.iter().zip(&w.weights).filter(|(_, weight)| **weight > 0.0);
            estimation::statistics::rms(used.flat_map(|(r, _)| *r)) > far
        };
        let place = |w: &WindowResiduals| Some((w.run, w.t.first()? - 0.3, w.t.last()? + 0.3));
        Self(windows.into_iter().flatten().filter(is_far).filter_map(place).collect())
    }

    /// Whether there are any.
    pub(super) fn are_some(&self) -> bool {
        !self.0.is_empty()
    }

    /// Whether one of them is near a time; they follow each other in the order of runs and times.
    pub(super) fn are_near(&self, run: usize, t: f64) -> bool {
        let from = self.0.partition_point(|w| w.0 < run || w.0 == run && w.2 <= t);
        self.0[from..].first().is_some_and(|w| w.0 == run && w.1 < t)
    }
}
