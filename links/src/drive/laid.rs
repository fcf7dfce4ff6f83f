//! Test functions laid over their segment: their weights, and the accelerations that the encoders measured. Neither depends on
//! a model, and both are kept as long as their segment is.

use nalgebra::DVector;

use crate::segment::Segment;

/// One test function on one segment.
#[derive(Debug, Clone)]
pub(super) struct TestFunction {
    pub(super) segment: usize,
    /// Where it begins and how long it is, s.
    pub(super) start: f64,
    pub(super) length: f64,
    /// Its first tick, on which it is 0, and its number of intervals from tick to tick.
    pub(super) first: usize,
    pub(super) intervals: usize,
    /// 1 where the wheel turned, 0 where it may have been stuck.
    pub(super) weights: Vec<f64>,
    /// Share of the test function in which it may have been stuck, one a wheel.
    pub(super) stuck: Vec<f64>,
    /// Whether a wheel slips in it.
    pub(super) slips: bool,
    /// Cluster, unique over all segments.
    pub(super) cluster: usize,
}

/// A test function's weights.
pub(super) struct Shape {
    /// Of the angles: second differences of the test function, from the test function's first tick.
    pub(super) angle: Vec<f64>,
    /// Of the intervals from tick to tick, summing to 1.
    pub(super) force: Vec<f64>,
}

/// The test functions of a segment.
pub(super) struct Laid {
    /// Their weights.
    pub(super) shapes: Vec<Shape>,
    /// Mean accelerations of the wheels by the encoders in each, rad/s².
    pub(super) measured: Vec<DVector<f64>>,
}

impl Laid {
    pub(super) fn new(own: &[TestFunction], s: &Segment, shapes: Vec<Shape>) -> Self {
        let measured = own.iter().zip(&shapes).map(|(b, shape)| {
            DVector::from_fn(s.angle.len(), |i, _| {
                let own = &s.angle[i][b.first..];
                shape.angle.iter().zip(own).map(|(w, x)| w * (x - own[0])).sum()
            })
        });
        Self { measured: measured.collect(), shapes }
    }
}

impl TestFunction {
    pub(super) fn shape(&self, s: &Segment) -> Shape {
        let t = &s.t[self.first..=self.first + self.intervals];
        let value = |t: f64| {
            let x = (t - self.start) / self.length;
            if (0.0..=1.0).contains(&x) { (std::f64::consts::PI * x).sin().powi(2) } else { 0.0 }
        };
        let m = t.len();
        // With duty held from tick to tick the acceleration a_k is constant there, and exactly
        // Δθ_k/h_k − Δθ_{k−1}/h_{k−1} = (a_k·h_k + a_{k−1}·h_{k−1})/2: summed with the test function's
        // values and by parts this gives the weights of angles and intervals.
        let mut angle = vec![0.0; m];
        let mut force = vec![0.0; m - 1];
        for k in 1..m - 1 {
            let (before, after) = (t[k] - t[k - 1], t[k + 1] - t[k]);
            let shape = value(t[k]);
            angle[k - 1] += shape / before;
            angle[k] -= shape * (1.0 / before + 1.0 / after);
            angle[k + 1] += shape / after;
            force[k - 1] += 0.5 * shape * before;
            force[k] += 0.5 * shape * after;
        }
        let total: f64 = force.iter().sum();
        angle.iter_mut().for_each(|w| *w /= total);
        force.iter_mut().for_each(|w| *w /= total);
        Shape { angle, force }
    }
}
