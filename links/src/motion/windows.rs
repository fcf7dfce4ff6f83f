//! Windows of camera frames: alignment, weights, residuals and their derivatives.

use std::borrow::Cow;
use std::ops::Range;

use estimation::parallel::{each, numbered};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use runs::frames::{Pose, Walk, wrap_angle};

use super::MotionModel;
use super::track::{Differs, LANES, Path};
use super::ways::{self, Errors, Group, Ways};
use crate::inertial::InertialLink;
use crate::pieces::{MOST_CLUSTERS, Pieces, by_segment};
use crate::segment::{Frame, Segment};
use estimation::normal_equations::Cluster;

/// Fewer frames than this fix a start pose but hardly anything else.
const FEWEST_FRAMES: usize = 4;
/// Frames further out than this many robust standard deviations get less weight (Huber), ...
const HUBER: f64 = 4.0;
/// ... and none from here.
const REJECT: f64 = 10.0;
/// Ticks from which derivatives are taken, as a part of the time between two frames; residuals are taken from all ticks.
/// At 1 kHz and 60 frames/s every fourth tick is left, and what a wheel turns between them is known all the same.
const PART_OF_FRAME: f64 = 0.25;
/// Time within which frames share one derivative, s: a linearisation of 100 frames/s takes a third of the time, and the
/// sizes it gives stay the same to their fourth digit. Frames of a league's camera (60/s) have one each.
const TOGETHER_S: f64 = 0.03;
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
    /// What an inertial sensor felt meanwhile, if the logs have it.
    pub inertial: Option<InertialLink<'a>>,
    /// How far wheels and poses part, where ways are compared in place of single frames.
    pub ways: Option<Ways>,
    /// Whether poses err by their noise for seconds, not from frame to frame: no number of them tells less.
    pub errs_for_seconds: bool,
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

/// A window's track and its residuals.
type Aligned = (Walked, WindowResiduals);
/// How the chassis gets to the frames of a window, and these frames.
type Walked = (Vec<Walk>, Vec<Frame>);

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
        Self { pieces, noise, window_s, inertial: None, ways: None, errs_for_seconds: false, windows }
    }

    /// With ways in place of single frames, if wheels and poses part by that much.
    #[must_use]
    pub fn along(mut self, ways: Option<Ways>) -> Self {
        self.ways = ways;
        self
    }

    /// What wheels and poses part by beside a model, in groups of frames of that time; `None` where there is next to nothing.
    pub fn part(&self, model: &MotionModel, together_s: f64, rim_m: f64) -> Option<Ways> {
        let all = self.aligned(model);
        let together = frames_within(together_s, &all);
        let window = |w: &WindowResiduals| {
            let grouped = Grouped::of(w, together);
            (w.start, grouped.groups(together), grouped.in_units(self.noise))
        };
        let [x, y, heading_rad] = self.noise;
        let seen = Errors { axis_m: x.max(y), heading_rad }.times(1.0 / (together as f64).sqrt());
        Ways::begin(together_s, rim_m, seen).likeliest(&each(&all, &window))
    }

    /// Standard deviations that residuals are in units of, m, m, rad: a frame's, or those of a group in the middle of all, no
    /// larger than what matters.
    pub fn unit(&self) -> [f64; 3] {
        self.ways.map_or(self.noise, |ways| [0, 1, 2].map(|i| ways.unexpected[i] / ways.beyond[i]))
    }

    /// Floors that residuals make of what ways leave in units of its standard deviation.
    pub fn floors(&self) -> f64 {
        self.ways.map_or(1.0, |ways| estimation::statistics::rms(ways.beyond))
    }

    /// Time over which residuals belong to what was rolled, s.
    pub fn rolled_s(&self) -> f64 {
        self.ways.map_or(self.window_s, |ways| ways.together_s)
    }

    /// Residuals of single frames, however ways are compared.
    pub fn of_frames(&self, model: &MotionModel, window_s: f64) -> Vec<WindowResiduals> {
        match self.ways {
            None => self.residuals(model),
            Some(_) => Self::new(self.pieces, self.noise, window_s).residuals(model),
        }
    }

    /// With what an inertial sensor felt, its floors taken about a model.
    #[must_use]
    pub fn felt(mut self, model: &MotionModel) -> Self {
        self.inertial = InertialLink::new(self.pieces, model);
        self
    }

    /// With poses that err by their noise for seconds, or not.
    #[must_use]
    pub fn erring(mut self, for_seconds: bool) -> Self {
        self.errs_for_seconds = for_seconds;
        self
    }

    /// By how much two models part in the frames, in units of the noise: RMS over all windows.
    pub fn apart(&self, models: [&MotionModel; 2]) -> f64 {
        let [one, other] = models.map(|model| self.residuals(model));
        let axes = self.axes();
        let used = one.iter().zip(&other).flat_map(|(a, b)| a.residuals.iter().zip(&b.residuals).zip(&a.weights));
        let used = used.filter(|(_, weight)| **weight > 0.0);
        estimation::statistics::rms(used.flat_map(|((a, b), _)| (0..axes).map(move |i| a[i] - b[i])))
    }

    /// No more than the first windows.
    #[must_use]
    pub fn first(mut self, number: usize) -> Self {
        self.windows.truncate(number);
        self
    }

    /// Numbers that a frame tells: 2 where the camera gives positions without headings.
    pub fn axes(&self) -> usize {
        if self.noise[2] < model::fit::NO_HEADING_RAD { 3 } else { 2 }
    }

    /// Number of windows.
    pub fn len(&self) -> usize {
        self.windows.len()
    }

    /// Whether there is nothing of a camera to compare.
    pub fn is_empty(&self) -> bool {
        self.windows.is_empty()
    }

    /// Residuals of every window, start poses fitted, outliers weighted down; of groups of frames where ways are compared.
    pub fn residuals(&self, model: &MotionModel) -> Vec<WindowResiduals> {
        let all = self.aligned(model);
        let Some(ways) = self.ways else { return all };
        let together = frames_within(ways.together_s, &all);
        each(&all, &|w| {
            let grouped = Grouped::of(w, together);
            let steps = ways.steps(w.start, &grouped.groups(together));
            // The first group finds the start pose alone.
            let mut residuals = ways::whitened(&steps, &grouped.in_units(self.noise)).split_off(1);
            residuals.iter_mut().for_each(|r| r.iter_mut().zip(ways.beyond).for_each(|(r, beyond)| *r *= beyond));
            let weights = grouped.weights[1..].iter().map(|w| (w / together as f64).min(1.0)).collect();
            let t = grouped.frames[1..].iter().map(|f| f.t).collect();
            WindowResiduals {
                run: w.run,
                t,
                predicted: grouped.predicted[1..].to_vec(),
                residuals,
                weights,
                start: w.start,
            }
        })
    }

    fn aligned(&self, model: &MotionModel) -> Vec<WindowResiduals> {
        let part = |range: &Range<usize>| {
            let s = self.pieces.get(self.windows[range.start].segment);
            let path = Path::new(model, &s)?;
            let aligned = |w: &Window| {
                let frames = &s.frames[w.frames.clone()];
                let mut track = Vec::with_capacity(frames.len());
                path.track(frames, &mut track);
                let aligned = self.align(model, s.run, frames, &track, None);
                ((track, frames.to_vec()), aligned)
            };
            Some(each(&self.windows[range.clone()], &aligned))
        };
        let parts: Option<Vec<Vec<Aligned>>> =
            each(&by_segment(&self.windows, |w| w.segment), &part).into_iter().collect();
        let (tracks, mut all): (Vec<Walked>, Vec<WindowResiduals>) =
            parts.unwrap_or_default().into_iter().flatten().unzip();
        // An outlier is a frame unlike its neighbours; a misfit they share is what is looked for.
        let out: Vec<Vec<f64>> = each(&all, &|w| (0..w.residuals.len()).map(|i| apart(&w.residuals, i)).collect());
        let spread = (estimation::statistics::median(&mut out.concat()) / MEDIAN_OF_CHI3).max(1.0);
        let again = |i: usize| {
            let ((track, frames), weights) =
                (&tracks[i], out[i].iter().map(|out| weight(out / spread)).collect::<Vec<_>>());
            let outliers = weights.iter().any(|x| *x < 1.0);
            outliers.then(|| self.align(model, all[i].run, frames, track, Some(weights)))
        };
        let again = numbered(all.len(), &again);
        all.iter_mut().zip(again).for_each(|(w, again)| {
            if let Some(again) = again {
                *w = again;
            }
        });
        all
    }

    fn align(
        &self,
        model: &MotionModel,
        run: usize,
        frames: &[Frame],
        track: &[Walk],
        weights: Option<Vec<f64>>,
    ) -> WindowResiduals {
        let n = frames.len();
        let middle = n / 2;
        // Chassis pose of the first frame so that the middle one fits.
        let marker_inverse = model.marker.inverse();
        let mut start = frames[middle].pose.compose(marker_inverse).compose(track[middle].pose().inverse());
        let weights = weights.unwrap_or_else(|| vec![1.0; n]);
        let mut residuals = vec![[0.0; 3]; n];
        let mut predicted = vec![Pose::default(); n];
        let noise = self.noise;
        let [x_information, y_information, theta_information] = noise.map(|s| 1.0 / (s * s));
        for step in 0..=4 {
            let from = Walk::from(start);
            // Sums of the rows of `start_rows`: weights, their moments and what pulls.
            let (mut all, mut across, mut along, mut turning) = (0.0, 0.0, 0.0, 0.0);
            let mut score = Vector3::<f64>::zeros();
            for i in 0..n {
                let p = drifted(model, model.seen(&from.then(&track[i])), frames[i].t - frames[0].t);
                predicted[i] = p;
                let seen = frames[i].pose;
                let raw = [seen.x - p.x, seen.y - p.y, wrap_angle(seen.theta - p.theta)];
                residuals[i] = [raw[0] / noise[0], raw[1] / noise[1], raw[2] / noise[2]];
                let (w, dx, dy) = (weights[i], p.x - start.x, p.y - start.y);
                let (fx, fy) = (w * x_information * raw[0], w * y_information * raw[1]);
                all += w;
                across += w * dy;
                along += w * dx;
                turning += w * (x_information * dy * dy + y_information * dx * dx + theta_information);
                score += Vector3::new(fx, fy, dx * fy - dy * fx + w * theta_information * raw[2]);
            }
            if step == 4 {
                break;
            }
            let (a, b) = (-x_information * across, y_information * along);
            let information = Matrix3::new(x_information * all, 0.0, a, 0.0, y_information * all, b, a, b, turning);
            let Some(inverse) = information.try_inverse() else { break };
            let d = inverse * score;
            start = Pose::new(start.x + d.x, start.y + d.y, start.theta + d.z);
        }
        WindowResiduals { run, t: frames.iter().map(|f| f.t).collect(), predicted, residuals, weights, start }
    }

    /// Linearises camera and inertial sensor together: see [`MotionLink::linearise_camera`].
    pub fn linearise(&self, model: &MotionModel, sides: &[(Option<MotionModel>, MotionModel, f64)]) -> Vec<Cluster> {
        let mut clusters = self.linearise_camera(model, sides);
        clusters.extend(self.inertial.iter().flat_map(|link| link.linearise(model, sides)));
        clusters
    }

    /// Linearises: residuals and the derivatives of the prediction along each pair of models (low or
    /// `None` for the model itself, high, step between them), start poses projected out. A cluster is
    /// a window, or several in long logs.
    pub fn linearise_camera(
        &self,
        model: &MotionModel,
        sides: &[(Option<MotionModel>, MotionModel, f64)],
    ) -> Vec<Cluster> {
        let base = self.aligned(model);
        if base.is_empty() {
            return Vec::new();
        }
        let together_s = self.ways.map_or(TOGETHER_S, |ways| ways.together_s);
        let neighbours = self.windows.len().div_ceil(MOST_CLUSTERS);
        let mut clusters: Vec<Cluster> = Vec::new();
        // Segment by segment, so that the columns of a long log never stand in memory at once.
        for range in by_segment(&self.windows, |w| w.segment) {
            let own = &base[range.clone()];
            let together = frames_within(together_s, own);
            let grouped: Vec<Grouped> = own.iter().map(|w| Grouped::of(w, together)).collect();
            let columns = if sides.is_empty() {
                Vec::new()
            } else {
                let s = self.pieces.get(self.windows[range.start].segment);
                match s.coarser(PART_OF_FRAME * together as f64) {
                    Some(coarse) => self.columns(model, sides, &coarse, &grouped),
                    None => self.columns(model, sides, &s, &grouped),
                }
            };
            let mut first = 0;
            let places: Vec<usize> = grouped
                .iter()
                .map(|w| {
                    first += 3 * w.frames.len();
                    first - 3 * w.frames.len()
                })
                .collect();
            let part: Vec<Cluster> = numbered(grouped.len(), &|i| match self.ways {
                Some(ways) => self.along_way(ways, together, &grouped[i], &columns, places[i]),
                None => self.cluster(&grouped[i], &columns, places[i]),
            });
            Cluster::append(&mut clusters, part, neighbours);
        }
        clusters
    }

    /// Derivatives along all sides over some windows of one segment, `[side][3 groups of frames]`, in units of the noise;
    /// 0 where the wheels cannot drive the robot.
    fn columns(
        &self,
        model: &MotionModel,
        sides: &[(Option<MotionModel>, MotionModel, f64)],
        s: &Segment,
        base: &[Grouped],
    ) -> Vec<Vec<f64>> {
        let rows = 3 * base.iter().map(|w| w.frames.len()).sum::<usize>();
        let Some(path) = Path::new(model, s) else { return vec![vec![0.0; rows]; sides.len()] };
        let windows: Vec<&[Frame]> = base.iter().map(|w| &w.frames[..]).collect();
        let tracks = path.alone(&windows);
        let start = predicted(model, &tracks, base);
        let column = |low: &[Pose], high: &[Pose], step: f64| {
            let unit = self.noise.map(|s| 1.0 / (step * s));
            let mut column = Vec::with_capacity(rows);
            for (a, b) in low.iter().zip(high) {
                let d = [b.x - a.x, b.y - a.y, wrap_angle(b.theta - a.theta)];
                column.extend([d[0] * unit[0], d[1] * unit[1], d[2] * unit[2]]);
            }
            column
        };
        let differs = |(low, high, _): &(Option<MotionModel>, MotionModel, f64)| {
            low.iter().map(|low| path.differs(low)).fold(path.differs(high), Differs::max)
        };
        let differs: Vec<Differs> = sides.iter().map(differs).collect();
        let of_kind =
            |wanted: &[Differs]| -> Vec<usize> { (0..sides.len()).filter(|i| wanted.contains(&differs[*i])).collect() };
        // Models that differ in their wheels alone, or in what those turn, are walked side by side.
        let [beside, turned] = [[Differs::InColumns], [Differs::InTurns]].map(|kind| of_kind(&kind));
        let others = of_kind(&[Differs::Nowhere, Differs::Alone]);
        let together = |part: &[usize]| -> Vec<(usize, Vec<f64>)> {
            let models: Vec<&MotionModel> =
                part.iter().flat_map(|i| sides[*i].0.iter().chain([&sides[*i].1])).collect();
            let paths: Vec<Path> = models.iter().filter_map(|m| path.of(m)).collect();
            let mut seen = models.iter().zip(Path::beside(&paths, &windows)).map(|(m, t)| predicted(m, &t, base));
            let mut next = || seen.next().unwrap_or_default();
            let of_side = |i: &usize| {
                let (low, _, step) = &sides[*i];
                let low = if low.is_some() { Cow::Owned(next()) } else { Cow::Borrowed(&start) };
                (*i, column(&low, &next(), *step))
            };
            part.iter().map(of_side).collect()
        };
        let predict = |other: &MotionModel| {
            let tracks = match path.differs(other) {
                Differs::Nowhere => Cow::Borrowed(&tracks),
                _ => Cow::Owned(path.of(other)?.alone(&windows)),
            };
            Some(predicted(other, &tracks, base))
        };
        let alone = |i: &usize| {
            let (low, high, step) = &sides[*i];
            let low = match low {
                Some(low) => predict(low).map(Cow::Owned),
                None => Some(Cow::Borrowed(&start)),
            };
            let both = low.zip(predict(high));
            (*i, both.map_or_else(|| vec![0.0; rows], |(low, high)| column(&low, &high, *step)))
        };
        let mut all: Vec<(usize, Vec<f64>)> = each(&others, &alone);
        let parts: Vec<&[usize]> = beside.chunks(LANES / 2).chain(turned.chunks(LANES / 2)).collect();
        all.extend(each(&parts, &|part| together(part)).into_iter().flatten());
        all.sort_by_key(|(i, _)| *i);
        all.into_iter().map(|(_, column)| column).collect()
    }

    /// A window's cluster where ways are compared: residual and columns as the filter sees them.
    fn along_way(&self, ways: Ways, together: usize, grouped: &Grouped, columns: &[Vec<f64>], first: usize) -> Cluster {
        let aligned = grouped.of;
        let rows = 3 * grouped.frames.len();
        let steps = ways.steps(aligned.start, &grouped.groups(together));
        let white = |values: &[f64]| -> Vec<f64> {
            let (values, _) = values.as_chunks::<3>();
            let values: Vec<[f64; 3]> = values.iter().map(|v| [0, 1, 2].map(|i| v[i] * self.noise[i])).collect();
            ways::whitened(&steps, &values).split_off(1).concat()
        };
        let residual = DVector::from_vec(white(grouped.residuals.as_flattened()));
        let white: Vec<f64> = columns.iter().flat_map(|column| white(&column[first..first + rows])).collect();
        let jacobian = DMatrix::from_vec(rows - 3, columns.len(), white);
        let used = grouped.weights[1..].iter().filter(|w| **w > 0.0).count();
        Cluster::new(aligned.run, aligned.t[0], (self.axes() * used) as f64, &residual, &jacobian)
    }

    fn cluster(&self, grouped: &Grouped, columns: &[Vec<f64>], first: usize) -> Cluster {
        let aligned = grouped.of;
        let rows = 3 * grouped.frames.len();
        let root: Vec<f64> = grouped.weights.iter().flat_map(|w| [w.sqrt(); 3]).collect();

        let mut jacobian = DMatrix::<f64>::zeros(rows, columns.len());
        for (slots, column) in jacobian.as_mut_slice().chunks_exact_mut(rows).zip(columns) {
            let own = column[first..].iter().zip(&root);
            slots.iter_mut().zip(own).for_each(|(slot, (x, w))| *slot = x * w);
        }
        let mut residual =
            DVector::from_iterator(rows, grouped.residuals.iter().flatten().zip(&root).map(|(x, w)| x * w));
        let nuisance = DMatrix::from_fn(rows, 3, |r, c| {
            start_rows(aligned.start, grouped.predicted[r / 3])[r % 3][c] * root[r] / self.noise[r % 3]
        });
        let q = nuisance.qr().q();
        jacobian.as_mut_slice().chunks_exact_mut(rows).for_each(|column| project_out(column, q.as_slice()));
        project_out(residual.as_mut_slice(), q.as_slice());
        let used = aligned.weights.iter().filter(|w| **w > 0.0).count();
        let n = (self.axes() * used).saturating_sub(3) as f64;
        let mut cluster = Cluster::new(aligned.run, aligned.t[0], n, &residual, &jacobian);
        cluster.rr += grouped.scatter;
        cluster
    }
}

/// A window whose frames share derivatives in groups, the first frame alone: the window's start pose is there.
struct Grouped<'a> {
    of: &'a WindowResiduals,
    /// Mean times of the groups; without poses.
    frames: Vec<Frame>,
    /// Sum of the weights of each group's frames.
    weights: Vec<f64>,
    /// Weighted mean residual of each group.
    residuals: Vec<[f64; 3]>,
    /// Mean prediction of each group.
    predicted: Vec<Pose>,
    /// Weighted sum of squares about those means.
    scatter: f64,
}

impl<'a> Grouped<'a> {
    /// As a filter sees them: where they are, and the weight of each beside `together` frames.
    fn groups(&self, together: usize) -> Vec<Group> {
        self.predicted.iter().zip(&self.weights).map(|(p, w)| (*p, w / together as f64)).collect()
    }

    /// Residuals in m, m and rad.
    fn in_units(&self, noise: [f64; 3]) -> Vec<[f64; 3]> {
        self.residuals.iter().map(|r| [0, 1, 2].map(|i| r[i] * noise[i])).collect()
    }

    fn of(window: &'a WindowResiduals, together: usize) -> Self {
        let n = window.t.len();
        let groups = 1 + (n - 1).div_ceil(together);
        let (mut frames, mut weights) = (Vec::with_capacity(groups), Vec::with_capacity(groups));
        let (mut residuals, mut predicted) = (Vec::with_capacity(groups), Vec::with_capacity(groups));
        let mut scatter = 0.0;
        for group in std::iter::once(0..1).chain((1..n).step_by(together).map(|i| i..(i + together).min(n))) {
            let size = group.len() as f64;
            let mean = |of: &dyn Fn(usize) -> f64| group.clone().map(of).sum::<f64>() / size;
            frames.push(Frame { t: mean(&|i| window.t[i]), pose: Pose::default() });
            let pose = &window.predicted;
            predicted.push(Pose::new(mean(&|i| pose[i].x), mean(&|i| pose[i].y), mean(&|i| pose[i].theta)));
            let weight: f64 = window.weights[group.clone()].iter().sum();
            weights.push(weight);
            residuals.push([0, 1, 2].map(|j| {
                if size == 1.0 || weight == 0.0 {
                    return window.residuals[group.start][j];
                }
                let of = |i: usize| (window.weights[i], window.residuals[i][j]);
                let mean = group.clone().map(of).map(|(w, r)| w * r).sum::<f64>() / weight;
                scatter += group.clone().map(of).map(|(w, r)| w * (r - mean) * (r - mean)).sum::<f64>();
                mean
            }));
        }
        Self { of: window, frames, weights, residuals, predicted, scatter }
    }
}

/// Frames of some windows that fit into a time, at least 1.
fn frames_within(seconds: f64, windows: &[WindowResiduals]) -> usize {
    let lasted: f64 = windows.iter().map(|w| w.t[w.t.len() - 1] - w.t[0]).sum();
    let intervals = windows.iter().map(|w| w.t.len() - 1).sum::<usize>() as f64;
    (seconds * intervals / lasted.max(1e-9) + 1e-6).floor().clamp(1.0, 1e6) as usize
}

/// Takes out of a column what three orthonormal columns, one after the other, span.
fn project_out(column: &mut [f64], q: &[f64]) {
    let rows = column.len();
    let (a, rest) = q.split_at(rows);
    let (b, c) = rest.split_at(rows);
    // Four sums side by side, which a loop over rows alone would add one after the other.
    let mut sums = [[0.0; 4]; 3];
    let (x, tail) = column.as_chunks::<4>();
    for (q, sum) in [a, b, c].into_iter().zip(&mut sums) {
        let (q, rest) = q.as_chunks::<4>();
        for (x, q) in x.iter().zip(q) {
            for l in 0..4 {
                sum[l] += x[l] * q[l];
            }
        }
        sum[0] += tail.iter().zip(rest).map(|(x, q)| x * q).sum::<f64>();
    }
    let [u, v, w] = sums.map(|s| s[0] + s[1] + (s[2] + s[3]));
    for (((x, a), b), c) in column.iter_mut().zip(a).zip(b).zip(c) {
        *x -= u * a + v * b + w * c;
    }
}

/// What the camera sees along the tracks of some windows, from start poses already fitted.
fn predicted(model: &MotionModel, tracks: &[Walk], base: &[Grouped]) -> Vec<Pose> {
    let mut out = Vec::with_capacity(tracks.len());
    let mut rest = tracks;
    for b in base {
        let (track, after) = rest.split_at(b.frames.len());
        rest = after;
        let from = Walk::from(b.of.start);
        let seen = track.iter().zip(&b.frames);
        out.extend(seen.map(|(p, f)| drifted(model, model.seen(&from.then(p)), f.t - b.frames[0].t)));
    }
    out
}

/// A pose seen by a camera whose origin has drifted for `t` seconds.
fn drifted(model: &MotionModel, p: Pose, t: f64) -> Pose {
    Pose::new(p.x + model.drift[0] * t, p.y + model.drift[1] * t, p.theta)
}

/// Distance of a residual from the median of its neighbours.
fn apart(residuals: &[[f64; 3]], i: usize) -> f64 {
    let near = &residuals[i.saturating_sub(3)..(i + 4).min(residuals.len())];
    let median = |j: usize| match near {
        [a, b, c, d, e, f, g] => median_of_seven([a[j], b[j], c[j], d[j], e[j], f[j], g[j]]),
        _ => estimation::statistics::median(&mut near.iter().map(|r| r[j]).collect::<Vec<f64>>()),
    };
    norm(&[0, 1, 2].map(|j| residuals[i][j] - median(j)))
}

/// The median of seven numbers, by a network that sorts as much as it takes (Devillard 1998).
fn median_of_seven(mut p: [f64; 7]) -> f64 {
    const PAIRS: [(usize, usize); 13] =
        [(0, 5), (0, 3), (1, 6), (2, 4), (0, 1), (3, 5), (2, 6), (2, 3), (3, 6), (4, 5), (1, 4), (1, 3), (3, 4)];
    for (a, b) in PAIRS {
        let (low, high) = if p[b] < p[a] { (p[b], p[a]) } else { (p[a], p[b]) };
        (p[a], p[b]) = (low, high);
    }
    p[3]
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_network_finds_the_middle_of_every_order() {
        // All permutations of seven, by Heap's algorithm.
        let mut p = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let mut counts = [0; 7];
        let (mut i, mut seen) = (0, 1);
        assert_eq!(median_of_seven(p), 3.0);
        while i < 7 {
            if counts[i] < i {
                p.swap(if i % 2 == 0 { 0 } else { counts[i] }, i);
                assert_eq!(median_of_seven(p), 3.0, "{p:?}");
                counts[i] += 1;
                (seen, i) = (seen + 1, 0);
            } else {
                counts[i] = 0;
                i += 1;
            }
        }
        assert_eq!(seen, 5040);
        assert_eq!(median_of_seven([2.0, 1.0, 2.0, 1.0, 1.0, 2.0, 2.0]), 2.0);
    }

    #[test]
    fn what_is_projected_out_is_gone() {
        let rows = 11;
        let nuisance = DMatrix::from_fn(rows, 3, |r, c| ((r * (c + 2) + c) % 5) as f64 - 1.5);
        let q = nuisance.qr().q();
        let column = DVector::from_fn(rows, |r, _| (r * r % 7) as f64);
        let mut left = column.clone();
        project_out(left.as_mut_slice(), q.as_slice());
        let expected = &column - &q * (q.transpose() * &column);
        assert!((left - expected).amax() < 1e-12);
    }
}
