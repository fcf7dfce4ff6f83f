//! Newton's law for the body alone. Where wheels slip, how the body moves is no longer theirs to tell; an inertial sensor
//! tells it, and what turns the wheels is measured. No law of the contact is needed: what a wheel passes on to the floor is
//! its motor's torque less what its own inertia takes.
//!
//! While wheels roll this is the law of the drive link once more, with the same torques and their errors: it is left out.

use estimation::parallel::each;
use nalgebra::{DMatrix, DVector, Rotation3, Vector3};
use std::ops::Range;

use super::laid::{Shape, TestFunction};
use super::test_functions::{BodyFelt, DriveLink};
use super::{DriveModel, Side};
use crate::inertial::{Integral, Sensor};
use crate::segment::Segment;
use estimation::normal_equations::Cluster;
use estimation::statistics::median;

/// Test functions with slip from which their scatter is known.
const FEWEST: usize = 24;
/// Neighbours of a test function that share ticks with it, on either side.
const APART: usize = 2;

/// What is left of a body's acceleration in a test function, m/s²; NaN where it was not measured.
type Left = [f64; 2];

impl DriveLink<'_> {
    /// Takes what an inertial sensor felt while wheels slipped, its noise measured about a model. Nothing where there is no
    /// sensor, or too little slip.
    pub fn feel(&mut self, model: &DriveModel, sensor: &Sensor) {
        self.felt = None;
        let mut apart: [Vec<f64>; 2] = Default::default();
        for range in self.by_segment() {
            let s = self.pieces.get(self.test_functions[range.start].segment);
            if !self.test_functions[range.clone()].iter().any(|b| b.slips) {
                continue;
            }
            let laid = self.laid(&s, &range);
            let Some(left) = self.felt_left(model, sensor, &s, &range, &laid.shapes) else { continue };
            for (a, b) in left.iter().zip(left.iter().skip(APART)) {
                for (apart, (a, b)) in apart.iter_mut().zip(a.iter().zip(b)).filter(|(_, (a, b))| (*b - *a).is_finite())
                {
                    apart.push((b - a).abs());
                }
            }
        }
        if apart.iter().all(|apart| apart.len() >= FEWEST) {
            // The median of a normal variable's size is 0.6745, and two are in a difference.
            let noise = apart.map(|mut apart| median(&mut apart) / (0.674_5 * 2.0_f64.sqrt()));
            self.felt = Some(BodyFelt { sensor: sensor.clone(), noise });
        }
    }

    /// Felt less predicted acceleration of some test functions of one segment; NaN where no wheel slips.
    fn felt_left(
        &self,
        model: &DriveModel,
        sensor: &Sensor,
        s: &Segment,
        range: &Range<usize>,
        shapes: &[Shape],
    ) -> Option<Vec<Left>> {
        let felt = s.felt.as_ref()?;
        let [Some(right), Some(forward), _] = &felt.force else { return None };
        let turn = felt.gyro[2].as_ref()?;
        let rows = model.mechanics()?.rows;
        let n = model.wheels.len();
        let forces = model.felt_forces(s);
        let out = self.test_functions[range.clone()].iter().zip(shapes).map(|(b, shape)| {
            if !b.slips {
                return [f64::NAN; 2];
            }
            let mean = |of: &dyn Fn(usize) -> f64| {
                shape.force.iter().enumerate().map(|(j, w)| w * of(b.first + j)).sum::<f64>()
            };
            // What a tick felt stands in a later row.
            let gain = |i: &Integral, from: usize, to: usize| i.between_late(&s.t, from, to, sensor.latency_s);
            let rate = |i: &Integral, k: usize| gain(i, k, k + 1) / (s.t[k + 1] - s.t[k]);
            let spun = mean(&|k| rate(turn, k).powi(2));
            let spins = accelerated(b, shape, |k| gain(turn, b.first, k));
            let body = Rotation3::from_scaled_axis(Vector3::from(sensor.turned_rad))
                * Vector3::new(mean(&|k| rate(right, k)), mean(&|k| rate(forward, k)), 0.0);
            // From the sensor's place to the centre of mass.
            let [x, y] = [0, 1].map(|i| sensor.place_m[i] - model.centre_of_mass[i]);
            let measured = [body.x + x * spun + y * spins, body.y + y * spun - x * spins];
            let mut push = [mean(&|k| forces[n][k]), mean(&|k| forces[n + 1][k])];
            for i in 0..n {
                let turns =
                    model.axes[i].encoder_scale * accelerated(b, shape, |k| s.angle[i][k] - s.angle[i][b.first]);
                let passed = mean(&|k| forces[i][k]) - model.spinning_inertia(i) * turns;
                push[0] += rows[(i, 0)] * passed;
                push[1] += rows[(i, 1)] * passed;
            }
            [measured[0] - push[0] / model.mass, measured[1] - push[1] / model.mass]
        });
        Some(out.collect())
    }

    /// Residuals and their derivatives along each side, in the clusters of the test functions. What is the same in all of a
    /// cluster is the sensor's bias, or gravity along its axes, and says nothing.
    pub(super) fn felt_clusters(
        &self,
        model: &DriveModel,
        sides: &[Side],
        s: &Segment,
        range: &Range<usize>,
        shapes: &[Shape],
    ) -> Vec<Cluster> {
        let own = &self.test_functions[range.clone()];
        let Some(BodyFelt { sensor, noise }) = self.felt.as_ref().filter(|_| own.iter().any(|b| b.slips)) else {
            return Vec::new();
        };
        let left = |model: &DriveModel| self.felt_left(model, sensor, s, range, shapes);
        let Some(base) = left(model) else { return Vec::new() };
        let columns: Vec<Vec<Left>> = each(sides, &|side| {
            let low = side.low.as_ref().map_or_else(|| Some(base.clone()), left);
            let Some((low, high)) = low.zip(left(&side.high)) else { return vec![[0.0; 2]; base.len()] };
            // What a model explains more is left less.
            low.iter().zip(&high).map(|(low, high)| [0, 1].map(|i| (low[i] - high[i]) / side.step)).collect()
        });
        let mut clusters = Vec::new();
        let mut first = 0;
        for part in own.chunk_by(|a, b| a.cluster == b.cluster) {
            let at = first..first + part.len();
            first += part.len();
            for axis in 0..2 {
                let used: Vec<usize> = at.clone().filter(|k| base[*k][axis].is_finite()).collect();
                if used.len() < 2 {
                    continue;
                }
                let white = |of: &[Left]| {
                    let values = DVector::from_iterator(used.len(), used.iter().map(|k| of[*k][axis] / noise[axis]));
                    values.add_scalar(-values.mean())
                };
                let columns: Vec<DVector<f64>> = columns.iter().map(|column| white(column)).collect();
                let jacobian = DMatrix::from_fn(used.len(), columns.len(), |row, column| columns[column][row]);
                let n = used.len() as f64 - 1.0;
                clusters.push(Cluster::new(s.run, s.t[part[0].first], n, &white(&base), &jacobian));
            }
        }
        clusters
    }
}

/// Mean acceleration of an angle in a test function.
fn accelerated(b: &TestFunction, shape: &Shape, angle: impl Fn(usize) -> f64) -> f64 {
    shape.angle.iter().enumerate().map(|(j, w)| w * angle(b.first + j)).sum()
}
