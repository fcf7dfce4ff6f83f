//! Weak form: bumps, and the unexplained torque of each.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::{DriveModel, Mechanics};
use crate::gram::Cluster;
use crate::segment::Segment;

/// Length of a bump, s, and in ticks at least.
const BUMP_S: f64 = 0.12;
const FEWEST_TICKS: f64 = 12.0;
/// Length of a cluster, s, and in bumps at least.
const CLUSTER_S: f64 = 1.0;
const FEWEST_BUMPS: f64 = 8.0;
/// Clusters at most; beyond, they are longer.
const MOST_CLUSTERS: f64 = 400.0;
/// Below this speed a wheel may stick, and its friction is anything up to its limit, rad/s.
const STUCK: f64 = 0.35;
/// Share of a bump a wheel may be that slow.
const STUCK_SHARE: f64 = 0.35;

/// The drive link of a data set.
pub struct DriveLink<'a> {
    /// The pieces of the runs.
    pub segments: &'a [Segment],
    /// Torque per wheel acceleration of the nominal robot: the unit residuals are given in.
    inertia: DMatrix<f64>,
    /// Standard deviation of the unexplained torque of one bump, Nm, one a wheel.
    pub noise: Vec<f64>,
    bumps: Vec<Bump>,
}

/// One test function on one segment.
#[derive(Debug, Clone)]
struct Bump {
    segment: usize,
    first: usize,
    /// Weights of the angles, second differences of the test function, from `first`.
    angle: Vec<f64>,
    /// Weights of the intervals from tick to tick, summing to 1.
    force: Vec<f64>,
    /// 1 where the wheel turned, 0 where it may have been stuck.
    weights: Vec<f64>,
    /// Cluster, unique over all segments.
    cluster: usize,
}

/// Unexplained torques.
#[derive(Debug, Clone)]
pub struct DriveResiduals {
    /// Index of the run, one a bump.
    pub run: Vec<usize>,
    /// Segment and middle tick of each bump.
    pub at: Vec<(usize, usize)>,
    /// Torque, Nm, `[bump][wheel]`; what would have to be added to the model.
    pub torque: Vec<Vec<f64>>,
    /// Weight, `[bump][wheel]`.
    pub weights: Vec<Vec<f64>>,
}

impl<'a> DriveLink<'a> {
    /// Lays bumps of the usual length over the segments.
    pub fn new(segments: &'a [Segment], nominal: &DriveModel) -> Option<Self> {
        Self::with_bumps(segments, nominal, BUMP_S)
    }

    /// Lays bumps of a length in s over the segments.
    pub fn with_bumps(segments: &'a [Segment], nominal: &DriveModel, bump_s: f64) -> Option<Self> {
        let inertia = nominal.mechanics()?.inertia;
        let n = nominal.wheels.len();
        let mut bumps = Vec::new();
        let mut cluster = 0;
        let total: f64 = segments.iter().filter_map(|s| Some(s.t.last()? - s.t.first()?)).sum();
        for (index, s) in segments.iter().enumerate() {
            if s.duty.len() != n || s.angle.len() != n || s.t.len() < 2 * FEWEST_TICKS as usize {
                continue;
            }
            let tick = (s.t[s.t.len() - 1] - s.t[0]) / (s.t.len() - 1) as f64;
            let length = bump_s.max(FEWEST_TICKS * tick);
            let cluster_s = CLUSTER_S.max(0.5 * FEWEST_BUMPS * length).max(total / MOST_CLUSTERS);
            let mut start = s.t[0];
            let mut opened = start;
            cluster += 1;
            while start + length <= s.t[s.t.len() - 1] {
                if start - opened >= cluster_s {
                    opened = start;
                    cluster += 1;
                }
                if let Some(bump) = Bump::new(s, index, start, length, cluster, n) {
                    bumps.push(bump);
                }
                start += 0.5 * length;
            }
        }
        (!bumps.is_empty()).then(|| Self { segments, inertia, noise: vec![1.0; n], bumps })
    }

    /// Leaves out bumps in which a wheel slips by what the motion link found: Newton's law in wheel
    /// coordinates needs wheels that roll.
    pub fn mask_slip(&mut self, motion: &crate::motion::MotionModel) {
        /// Slip of a rolling wheel, rad/s: creep and noise stay below.
        const ROLLING: f64 = 1.5;
        if motion.angles.is_empty() {
            return;
        }
        let changed: Vec<_> = self.segments.iter().map(|s| motion.angles(s)).collect();
        for bump in &mut self.bumps {
            let s = &self.segments[bump.segment];
            let end = bump.first + bump.force.len();
            let slips = (0..s.angle.len()).any(|i| {
                let off = |k: usize| changed[bump.segment][i][k] - s.angle[i][k];
                (off(end) - off(bump.first)).abs() > ROLLING * 0.5 * (s.t[end] - s.t[bump.first])
            });
            if slips {
                bump.weights.fill(0.0);
            }
        }
    }

    /// Leaves out bumps at these times (index of the run, s).
    pub fn mask_times(&mut self, out: impl Fn(usize, f64) -> bool) {
        for bump in &mut self.bumps {
            let s = &self.segments[bump.segment];
            if out(s.run, s.t[bump.first + bump.force.len() / 2]) {
                bump.weights.fill(0.0);
            }
        }
    }

    /// Segment and middle tick of the bumps that count for no wheel.
    pub fn masked(&self) -> Vec<(usize, usize)> {
        let out = self.bumps.iter().filter(|b| b.weights.iter().all(|w| *w == 0.0));
        out.map(|b| (b.segment, b.first + b.force.len() / 2)).collect()
    }

    /// Length of a bump, s.
    pub fn length(&self) -> f64 {
        self.bumps.first().map_or(0.0, |b| {
            let t = &self.segments[b.segment].t;
            t[b.first + b.force.len()] - t[b.first]
        })
    }

    /// Ticks in a time, by the first bump.
    pub fn tick_count(&self, seconds: f64) -> usize {
        let ticks = self.bumps.first().map_or(1, |b| b.force.len());
        (seconds / self.length().max(1e-9) * ticks as f64).ceil() as usize
    }

    /// Number of bumps.
    pub fn len(&self) -> usize {
        self.bumps.len()
    }

    /// Whether there is nothing to compare.
    pub fn is_empty(&self) -> bool {
        self.bumps.is_empty()
    }

    /// Wheel accelerations a model predicts, `[bump]`, in units of nominal torque.
    fn predict(&self, model: &DriveModel) -> Option<Vec<DVector<f64>>> {
        let parts: Option<Vec<_>> =
            self.by_segment().into_iter().map(|range| self.predict_part(model, range)).collect();
        Some(parts?.concat())
    }

    /// Bumps of each segment.
    fn by_segment(&self) -> Vec<std::ops::Range<usize>> {
        let mut first = 0;
        self.bumps
            .chunk_by(|a, b| a.segment == b.segment)
            .map(|part| {
                first += part.len();
                first - part.len()..first
            })
            .collect()
    }

    /// The same for some bumps of one segment.
    fn predict_part(&self, model: &DriveModel, range: std::ops::Range<usize>) -> Option<Vec<DVector<f64>>> {
        let mechanics = model.mechanics()?;
        let n = model.wheels.len();
        let bumps = &self.bumps[range];
        let s = &self.segments[bumps.first()?.segment];
        let forces = model.forces(s);
        let offsets: Vec<Vec<Vec<f64>>> = model.offsets.iter().map(|o| o(model, s)).collect();
        let out = bumps.iter().map(|b| {
            let mut a = b.acceleration(&forces, n, &mechanics, model);
            for offset in &offsets {
                for i in 0..n {
                    let own = &offset[i][b.first..];
                    a[i] += b.angle.iter().zip(own).map(|(w, x)| w * (x - own[0])).sum::<f64>();
                }
            }
            &self.inertia * a
        });
        Some(out.collect())
    }

    /// What the encoders measured, in the same units.
    pub fn measured(&self) -> Vec<DVector<f64>> {
        let n = self.noise.len();
        self.bumps
            .iter()
            .map(|b| {
                let s = &self.segments[b.segment];
                let a = DVector::from_fn(n, |i, _| {
                    b.angle.iter().zip(&s.angle[i][b.first..]).map(|(w, x)| w * (x - s.angle[i][b.first])).sum()
                });
                &self.inertia * a
            })
            .collect()
    }

    /// Unexplained wheel acceleration at every inner tick of a segment, rad/s², and the torque it
    /// stands for, Nm, `[wheel][tick]`; as noisy as counts are, for what is averaged over many ticks.
    pub fn raw(&self, model: &DriveModel, segment: usize) -> Option<[Vec<Vec<f64>>; 2]> {
        let mechanics = model.mechanics()?;
        let (n, s) = (self.noise.len(), &self.segments[segment]);
        let (width, ticks) = (n + 3, s.t.len());
        let forces = model.forces(s);
        let acceleration = |k: usize| {
            let row = &forces[k * width..(k + 1) * width];
            let mut a = &mechanics.response * DVector::from_column_slice(&row[..n]);
            if let Some(body) = &mechanics.body {
                a += body * DVector::from_column_slice(&row[n..]);
            }
            a
        };
        let mut out = [vec![vec![0.0; ticks]; n], vec![vec![0.0; ticks]; n]];
        let mut before = acceleration(0);
        for k in 1..ticks - 1 {
            let now = acceleration(k);
            let (h, g) = (s.t[k] - s.t[k - 1], s.t[k + 1] - s.t[k]);
            let a = DVector::from_fn(n, |i, _| {
                let angle = &s.angle[i];
                let measured = ((angle[k + 1] - angle[k]) / g - (angle[k] - angle[k - 1]) / h) * 2.0 / (g + h);
                measured - (before[i] * h + now[i] * g) / (h + g) / model.axes[i].encoder_scale
            });
            let torque = &self.inertia * &a;
            for i in 0..n {
                out[0][i][k] = a[i];
                out[1][i][k] = torque[i];
            }
            before = now;
        }
        Some(out)
    }

    /// Unexplained torques under a model.
    pub fn residuals(&self, model: &DriveModel) -> Option<DriveResiduals> {
        let predicted = self.predict(model)?;
        let measured = self.measured();
        Some(DriveResiduals {
            run: self.bumps.iter().map(|b| self.segments[b.segment].run).collect(),
            at: self.bumps.iter().map(|b| (b.segment, b.first + b.force.len() / 2)).collect(),
            torque: measured.iter().zip(&predicted).map(|(m, p)| (m - p).iter().copied().collect()).collect(),
            weights: self.bumps.iter().map(|b| b.weights.clone()).collect(),
        })
    }

    /// Mean of something over every bump.
    pub fn mean(&self, of: impl Fn(&Segment, usize) -> f64) -> Vec<f64> {
        let mean = |b: &Bump| {
            let s = &self.segments[b.segment];
            b.force.iter().enumerate().map(|(j, w)| w * of(s, b.first + j)).sum()
        };
        self.bumps.iter().map(mean).collect()
    }

    /// Weights, `[bump][wheel]`.
    pub fn weights(&self, bump: usize) -> &[f64] {
        &self.bumps[bump].weights
    }

    /// Cluster of a bump.
    pub fn cluster(&self, bump: usize) -> usize {
        self.bumps[bump].cluster
    }

    /// Segment and first tick of a bump.
    pub fn place(&self, bump: usize) -> (usize, usize) {
        (self.bumps[bump].segment, self.bumps[bump].first)
    }

    /// Linearises: residuals and derivatives along each pair of models (low or `None` for the model
    /// itself, high, step), per cluster.
    pub fn linearise(&self, model: &DriveModel, sides: &[(Option<DriveModel>, DriveModel, f64)]) -> Vec<Cluster> {
        let n = self.noise.len();
        let measured = self.measured();
        let mut clusters = Vec::new();
        // Segment by segment, so that the columns of a long log never stand in memory at once.
        for range in self.by_segment() {
            let Some(base) = self.predict_part(model, range.clone()) else { return Vec::new() };
            let columns: Vec<Option<Vec<DVector<f64>>>> = sides
                .par_iter()
                .map(|(low, high, step)| {
                    let low = match low {
                        Some(low) => Some(self.predict_part(low, range.clone())?),
                        None => None,
                    };
                    let high = self.predict_part(high, range.clone())?;
                    let low = low.as_ref().unwrap_or(&base);
                    Some(low.iter().zip(&high).map(|(a, b)| (b - a) / *step).collect())
                })
                .collect();
            let mut first = 0;
            for part in self.bumps[range.clone()].chunk_by(|a, b| a.cluster == b.cluster) {
                let rows = part.len() * n;
                let weight = |r: usize| part[r / n].weights[r % n] / self.noise[r % n];
                let at = |r: usize| (first + r / n, r % n);
                let residual = DVector::from_fn(rows, |r, _| {
                    let (b, i) = at(r);
                    (measured[range.start + b][i] - base[b][i]) * weight(r)
                });
                let jacobian = DMatrix::from_fn(rows, columns.len(), |r, c| {
                    let (b, i) = at(r);
                    columns[c].as_ref().map_or(0.0, |column| column[b][i] * weight(r))
                });
                let used: f64 = part.iter().flat_map(|b| &b.weights).sum();
                let s = &self.segments[part[0].segment];
                clusters.push(Cluster::new(s.run, s.t[part[0].first], used, &residual, &jacobian));
                first += part.len();
            }
        }
        clusters
    }
}

impl Bump {
    fn new(s: &Segment, segment: usize, start: f64, length: f64, cluster: usize, wheels: usize) -> Option<Self> {
        // Ticks strictly inside, and one on either side, where the bump is 0.
        let first = s.t.partition_point(|t| *t <= start).saturating_sub(1);
        let end = s.t.partition_point(|t| *t < start + length);
        if end >= s.t.len() || end - first < 4 {
            return None;
        }
        let t = &s.t[first..=end];
        let shape: Vec<f64> = t
            .iter()
            .map(|t| {
                let x = (t - start) / length;
                if (0.0..=1.0).contains(&x) { (std::f64::consts::PI * x).sin().powi(2) } else { 0.0 }
            })
            .collect();
        let m = t.len();
        // With duty held from tick to tick the acceleration a_k is constant there, and exactly
        // Δθ_k/h_k − Δθ_{k−1}/h_{k−1} = (a_k·h_k + a_{k−1}·h_{k−1})/2: summed with the bump's
        // values and by parts this gives the weights of angles and intervals.
        let mut angle = vec![0.0; m];
        let mut force = vec![0.0; m - 1];
        for k in 1..m - 1 {
            let (before, after) = (t[k] - t[k - 1], t[k + 1] - t[k]);
            angle[k - 1] += shape[k] / before;
            angle[k] -= shape[k] * (1.0 / before + 1.0 / after);
            angle[k + 1] += shape[k] / after;
            force[k - 1] += 0.5 * shape[k] * before;
            force[k] += 0.5 * shape[k] * after;
        }
        let total: f64 = force.iter().sum();
        if total <= 0.0 {
            return None;
        }
        angle.iter_mut().for_each(|w| *w /= total);
        force.iter_mut().for_each(|w| *w /= total);
        let weights = (0..wheels)
            .map(|i| {
                let stuck: f64 =
                    force.iter().zip(&s.speed[i][first..]).filter(|(_, w)| w.abs() < STUCK).map(|(f, _)| f).sum();
                if stuck > STUCK_SHARE { 0.0 } else { 1.0 }
            })
            .collect();
        Some(Self { segment, first, angle, force, weights, cluster })
    }

    fn acceleration(&self, forces: &[f64], n: usize, mechanics: &Mechanics, model: &DriveModel) -> DVector<f64> {
        let width = n + 3;
        let mut mean = vec![0.0; width];
        for (j, w) in self.force.iter().enumerate() {
            let row = &forces[(self.first + j) * width..(self.first + j + 1) * width];
            for (slot, x) in mean.iter_mut().zip(row) {
                *slot += w * x;
            }
        }
        let wheel = DVector::from_column_slice(&mean[..n]);
        let mut a = &mechanics.response * wheel;
        if let Some(body) = &mechanics.body {
            a += body * DVector::from_column_slice(&mean[n..]);
        }
        // The wheels' acceleration as the encoders see it.
        DVector::from_fn(n, |i, _| a[i] / model.axes[i].encoder_scale)
    }
}
