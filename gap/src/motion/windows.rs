//! Windows of camera frames: alignment, weights, residuals and their derivatives.

use std::ops::Range;

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use rayon::prelude::*;
use runs::frames::{Pose, wrap_angle};

use super::MotionModel;
use crate::gram::Cluster;
use crate::pieces::Pieces;
use crate::segment::Segment;

/// Fewer frames than this fix a start pose but hardly anything else.
const FEWEST_FRAMES: usize = 4;
/// Frames further out than this many robust standard deviations get less weight (Huber), ...
const HUBER: f64 = 4.0;
/// ... and none from here.
const REJECT: f64 = 10.0;
/// Clusters at most; beyond, neighbouring windows count as one.
const MOST_CLUSTERS: usize = 400;
/// Median of the norm of three standard normal numbers.
const MEDIAN_OF_CHI3: f64 = 1.538_2;

/// Length of a window, s: a league robot drives 0.7 m in it. Over four seconds, slip and creep of the wheels stood far
/// above the camera's noise on recordings of slower machines, and nothing passed on held-out runs.
pub const WINDOW_S: f64 = 1.0;

/// The motion link of a data set.
pub struct MotionLink<'a> {
    /// The pieces of the runs.
    pub pieces: &'a Pieces<'a>,
    /// Standard deviations of a camera pose (m, m, rad).
    pub noise: [f64; 3],
    /// Length of a window, s.
    pub window_s: f64,
    windows: Vec<Window>,
}

/// Consecutive frames of one segment.
#[derive(Debug, Clone)]
struct Window {
    segment: usize,
    frames: Range<usize>,
}

/// One window's frames and what the model makes of them.
#[derive(Debug, Clone)]
pub struct WindowResiduals {
    /// Index of the run.
    pub run: usize,
    /// Times of the frames, s.
    pub t: Vec<f64>,
    /// Predicted poses.
    pub predicted: Vec<Pose>,
    /// Seen minus predicted, in units of the noise.
    pub residuals: Vec<[f64; 3]>,
    /// Weight of each frame, 0 to 1.
    pub weights: Vec<f64>,
    start: Pose,
}

impl<'a> MotionLink<'a> {
    /// Cuts the segments into windows of `window_s`; without an end, each into one.
    pub fn new(pieces: &'a Pieces<'a>, noise: [f64; 3], window_s: f64) -> Self {
        let mut windows = Vec::new();
        for (index, s) in pieces.iter().enumerate().filter(|(_, s)| !s.angle.is_empty()) {
            let number = |i: usize| ((s.frames[i].t - s.stretch[0]) / window_s).floor();
            let is_own = |i: usize| {
                let begins = if window_s.is_finite() { s.stretch[0] + number(i) * window_s } else { s.frames[i].t };
                (s.span[0]..s.span[1]).contains(&begins)
            };
            let frames: Vec<usize> = (0..s.frames.len()).filter(|i| is_own(*i)).collect();
            for window in frames.chunk_by(|a, b| number(*a) == number(*b)) {
                if window.len() >= FEWEST_FRAMES {
                    windows.push(Window { segment: index, frames: window[0]..window[0] + window.len() });
                }
            }
        }
        Self { pieces, noise, window_s, windows }
    }

    /// No more than the first windows.
    #[must_use]
    pub fn first(mut self, number: usize) -> Self {
        self.windows.truncate(number);
        self
    }

    /// Windows of each segment.
    fn by_segment(&self) -> Vec<Range<usize>> {
        let mut first = 0;
        let part = |part: &[Window]| {
            first += part.len();
            first - part.len()..first
        };
        self.windows.chunk_by(|a, b| a.segment == b.segment).map(part).collect()
    }

    /// Number of windows.
    pub fn len(&self) -> usize {
        self.windows.len()
    }

    /// Whether there is nothing to compare.
    pub fn is_empty(&self) -> bool {
        self.windows.is_empty()
    }

    /// Residuals of every window, start poses fitted, outliers weighted down.
    pub fn residuals(&self, model: &MotionModel) -> Vec<WindowResiduals> {
        let Some(columns) = model.columns() else { return Vec::new() };
        let parts: Vec<Vec<(Vec<Pose>, WindowResiduals)>> = self
            .by_segment()
            .into_par_iter()
            .map(|range| {
                let s = self.pieces.get(self.windows[range.start].segment);
                let angles = model.angles(&s);
                let windows = self.windows[range].par_iter();
                windows
                    .map(|w| {
                        let track = model.track(&s, &angles, &columns, &s.frames[w.frames.clone()]);
                        let aligned = self.align(model, &s, w, &track, None);
                        (track, aligned)
                    })
                    .collect()
            })
            .collect();
        let (tracks, mut all): (Vec<Vec<Pose>>, Vec<WindowResiduals>) = parts.into_iter().flatten().unzip();
        // An outlier is a frame unlike its neighbours; a misfit they share is what is looked for.
        let mut norms: Vec<f64> =
            all.iter().flat_map(|w| (0..w.residuals.len()).map(|i| apart(&w.residuals, i))).collect();
        let spread = (crate::statistics::median(&mut norms) / MEDIAN_OF_CHI3).max(1.0);
        all.par_iter_mut().zip(self.windows.par_iter().zip(&tracks)).for_each(|(w, (window, track))| {
            let weights: Vec<f64> = (0..w.residuals.len()).map(|i| weight(apart(&w.residuals, i) / spread)).collect();
            if weights.iter().any(|x| *x < 1.0) {
                *w = self.align(model, &self.pieces.get(window.segment), window, track, Some(weights));
            }
        });
        all
    }

    fn align(
        &self,
        model: &MotionModel,
        s: &Segment,
        window: &Window,
        track: &[Pose],
        weights: Option<Vec<f64>>,
    ) -> WindowResiduals {
        let frames = &s.frames[window.frames.clone()];
        let n = frames.len();
        let middle = n / 2;
        // Chassis pose of the first frame so that the middle one fits.
        let marker_inverse = model.marker.inverse();
        let mut start = frames[middle].pose.compose(marker_inverse).compose(track[middle].inverse());
        let weights = weights.unwrap_or_else(|| vec![1.0; n]);
        let mut residuals = vec![[0.0; 3]; n];
        let mut predicted = vec![Pose::default(); n];
        for step in 0..=4 {
            let (mut information, mut score) = (Matrix3::<f64>::zeros(), Vector3::<f64>::zeros());
            for i in 0..n {
                let placed = start.compose(track[i]);
                let p = drifted(model, model.seen(placed), frames[i].t - frames[0].t);
                predicted[i] = p;
                let seen = frames[i].pose;
                let raw = [seen.x - p.x, seen.y - p.y, wrap_angle(seen.theta - p.theta)];
                for (j, row) in start_rows(start, p).iter().enumerate() {
                    let row = Vector3::from(*row) / self.noise[j];
                    residuals[i][j] = raw[j] / self.noise[j];
                    information += row * row.transpose() * weights[i];
                    score += row * (weights[i] * residuals[i][j]);
                }
            }
            if step == 4 {
                break;
            }
            let Some(inverse) = information.try_inverse() else { break };
            let d = inverse * score;
            start = Pose::new(start.x + d.x, start.y + d.y, start.theta + d.z);
        }
        WindowResiduals { run: s.run, t: frames.iter().map(|f| f.t).collect(), predicted, residuals, weights, start }
    }

    /// Linearises: residuals and the derivatives of the prediction along each pair of models (low or
    /// `None` for the model itself, high, step between them), start poses projected out. A cluster is
    /// a window, or several in long logs.
    pub fn linearise(&self, model: &MotionModel, sides: &[(Option<MotionModel>, MotionModel, f64)]) -> Vec<Cluster> {
        let base = self.residuals(model);
        let together = self.windows.len().div_ceil(MOST_CLUSTERS);
        let mut clusters: Vec<Cluster> = Vec::new();
        // Segment by segment, so that the columns of a long log never stand in memory at once.
        for range in self.by_segment() {
            let s = self.pieces.get(self.windows[range.start].segment);
            let start = self.predict(model, &s, &base, range.clone());
            let columns: Vec<Vec<DVector<f64>>> = sides
                .par_iter()
                .map(|(low, high, step)| {
                    let low = low.as_ref().map(|low| self.predict(low, &s, &base, range.clone()));
                    let high = self.predict(high, &s, &base, range.clone());
                    self.column(&base[range.clone()], low.as_ref().unwrap_or(&start), &high, *step)
                })
                .collect();
            let part: Vec<Cluster> =
                (0..range.len()).into_par_iter().map(|w| self.cluster(w, &base[range.start + w], &columns)).collect();
            for (k, cluster) in part.into_iter().enumerate() {
                match clusters.last_mut() {
                    Some(last) if k % together != 0 => last.add(&cluster),
                    _ => clusters.push(cluster),
                }
            }
        }
        clusters
    }

    /// Predictions of some windows of one segment, from start poses already fitted; empty where the
    /// wheels cannot drive the robot.
    fn predict(
        &self,
        model: &MotionModel,
        s: &Segment,
        base: &[WindowResiduals],
        range: Range<usize>,
    ) -> Vec<Vec<Pose>> {
        let Some(columns) = model.columns() else { return vec![Vec::new(); range.len()] };
        let angles = model.angles(s);
        range
            .map(|w| {
                let track = model.track(s, &angles, &columns, &s.frames[self.windows[w].frames.clone()]);
                let b = &base[w];
                let placed = track.iter().zip(&b.t);
                placed.map(|(p, t)| drifted(model, model.seen(b.start.compose(*p)), t - b.t[0])).collect()
            })
            .collect()
    }

    /// Derivative of the predictions of every window, in units of the noise; 0 where one is missing.
    fn column(&self, base: &[WindowResiduals], low: &[Vec<Pose>], high: &[Vec<Pose>], step: f64) -> Vec<DVector<f64>> {
        low.iter()
            .zip(high)
            .zip(base)
            .map(|((a, b), w)| {
                let n = w.t.len();
                if a.len() != n || b.len() != n {
                    return DVector::zeros(3 * n);
                }
                DVector::from_iterator(
                    3 * n,
                    a.iter().zip(b).flat_map(|(a, b)| {
                        let d = [b.x - a.x, b.y - a.y, wrap_angle(b.theta - a.theta)];
                        [0, 1, 2].map(|i| d[i] / (step * self.noise[i]))
                    }),
                )
            })
            .collect()
    }

    fn cluster(&self, w: usize, aligned: &WindowResiduals, columns: &[Vec<DVector<f64>>]) -> Cluster {
        let n = aligned.t.len();
        let rows = 3 * n;
        let root: Vec<f64> = aligned.weights.iter().flat_map(|w| [w.sqrt(); 3]).collect();
        let mut jacobian = DMatrix::from_fn(rows, columns.len(), |r, c| columns[c][w][r] * root[r]);
        let mut residual =
            DVector::from_iterator(rows, aligned.residuals.iter().flatten().zip(&root).map(|(x, w)| x * w));
        let nuisance = DMatrix::from_fn(rows, 3, |r, c| {
            start_rows(aligned.start, aligned.predicted[r / 3])[r % 3][c] * root[r] / self.noise[r % 3]
        });
        let q = nuisance.qr().q();
        let projected = q.transpose() * &jacobian;
        jacobian -= &q * projected;
        let projected = q.transpose() * &residual;
        residual -= &q * projected;
        let used = aligned.weights.iter().filter(|w| **w > 0.0).count();
        Cluster::new(aligned.run, aligned.t[0], (3 * used).saturating_sub(3) as f64, &residual, &jacobian)
    }
}

/// A pose seen by a camera whose origin has drifted for `t` seconds.
fn drifted(model: &MotionModel, p: Pose, t: f64) -> Pose {
    Pose::new(p.x + model.drift[0] * t, p.y + model.drift[1] * t, p.theta)
}

/// Distance of a residual from the median of its neighbours.
fn apart(residuals: &[[f64; 3]], i: usize) -> f64 {
    let near = &residuals[i.saturating_sub(3)..(i + 4).min(residuals.len())];
    let component = |j: usize| {
        let mut values: Vec<f64> = near.iter().map(|r| r[j]).collect();
        residuals[i][j] - crate::statistics::median(&mut values)
    };
    norm(&[component(0), component(1), component(2)])
}

fn norm(r: &[f64; 3]) -> f64 {
    (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]).sqrt()
}

fn weight(out: f64) -> f64 {
    match out {
        out if out > REJECT => 0.0,
        out if out > HUBER => HUBER / out,
        _ => 1.0,
    }
}

/// Derivative of a predicted pose by its window's start pose: rows x, y, heading. What the camera
/// does to a pose is close enough to the identity.
fn start_rows(start: Pose, placed: Pose) -> [[f64; 3]; 3] {
    [[1.0, 0.0, start.y - placed.y], [0.0, 1.0, placed.x - start.x], [0.0, 0.0, 1.0]]
}
