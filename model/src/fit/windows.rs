//! Windows, their start poses, and the equations they give.

use nalgebra::{DMatrix, DVector, Matrix3, Matrix3xX, Vector3};

use estimation::statistics::median;
use runs::Run;
use runs::frames::{Pose, wrap_angle};

/// Fewer frames than this fix a start pose but hardly anything else.
const FEWEST_FRAMES: usize = 4;
/// Frames further out than this many robust standard deviations get less weight (Huber), ...
const HUBER: f64 = 4.0;
/// ... and none at all from here.
const REJECT: f64 = 12.0;
/// Median of the norm of three standard normal numbers.
const MEDIAN_OF_CHI3: f64 = 1.538_2;
/// Gauss-Newton steps for a start pose: quadratic convergence from a start that is already close.
const ALIGNMENT_STEPS: usize = 4;

/// x, y (m) and heading (rad) of something at one frame.
pub(super) type Frame = [f64; 3];

/// Consecutive camera frames of one run.
#[derive(Debug, Clone)]
pub(super) struct Window {
    run: usize,
    /// First entry in the run's camera list.
    first: usize,
    seen: Vec<Pose>,
}

impl Window {
    /// Its run, from 0.
    pub(super) fn run(&self) -> usize {
        self.run
    }
}

/// Cuts runs with camera and encoders into windows of `window_s`.
pub(super) fn cut(runs: &[Run], window_s: f64) -> Vec<Window> {
    let mut windows = Vec::new();
    for (index, run) in runs.iter().enumerate().filter(|(_, run)| !run.counts.is_empty()) {
        let start = run.t.first().copied().unwrap_or(0.0);
        let window_of = |i: usize| ((run.t[run.camera[i].tick] - start) / window_s).floor();
        let mut first = 0;
        for i in 1..=run.camera.len() {
            if i < run.camera.len() && window_of(i) == window_of(first) {
                continue;
            }
            if i - first >= FEWEST_FRAMES {
                let seen = run.camera[first..i].iter().map(|s| s.pose).collect();
                windows.push(Window { run: index, first, seen });
            }
            first = i;
        }
    }
    windows
}

/// Residuals of all windows at one set of parameters.
#[derive(Debug, Clone)]
pub(super) struct Evaluation {
    windows: Vec<Aligned>,
    /// Robust standard deviation of the residuals in units of the noise, at least 1.
    spread: f64,
    noise: [f64; 3],
}

/// A window, aligned with what was seen.
#[derive(Debug, Clone)]
struct Aligned {
    start: Pose,
    /// Predicted poses before `observe`, aligned.
    placed: Vec<Pose>,
    /// Seen minus predicted, in units of the noise.
    residuals: Vec<Frame>,
    weights: Vec<f64>,
}

impl Evaluation {
    pub(super) fn new(
        windows: &[Window],
        tracks: &[Vec<Pose>],
        observe: &dyn Fn(Pose) -> Pose,
        noise: [f64; 3],
    ) -> Self {
        let mut evaluation = Self { windows: Vec::with_capacity(windows.len()), spread: 1.0, noise };
        for window in windows {
            evaluation.windows.push(Aligned::new(window, relative(window, tracks), observe, noise));
        }
        let mut norms: Vec<f64> = evaluation.windows.iter().flat_map(Aligned::norms).collect();
        evaluation.spread = (median(&mut norms) / MEDIAN_OF_CHI3).max(1.0);
        // Once more with weights, now that it is known what an outlier is.
        for (aligned, window) in evaluation.windows.iter_mut().zip(windows) {
            aligned.weigh(evaluation.spread);
            if aligned.weights.iter().any(|w| *w < 1.0) {
                aligned.align(window, &relative(window, tracks), observe, noise);
                aligned.weigh(evaluation.spread);
            }
        }
        evaluation
    }

    /// Predicted frames for other tracks, from the same start poses.
    pub(super) fn predict(
        &self,
        windows: &[Window],
        tracks: &[Vec<Pose>],
        observe: &dyn Fn(Pose) -> Pose,
    ) -> Vec<Vec<Frame>> {
        let predict = |(window, aligned): (&Window, &Aligned)| {
            let seen = relative(window, tracks).map(|pose| observe(aligned.start.compose(pose)));
            seen.map(|p| [p.x, p.y, p.theta]).collect()
        };
        windows.iter().zip(&self.windows).map(predict).collect()
    }

    /// Weighted sum of squares, half of −2 log likelihood.
    pub(super) fn cost(&self) -> f64 {
        self.windows.iter().map(|w| w.cost(&w.weights)).sum()
    }

    /// The share of one window.
    pub(super) fn window_cost(&self, w: usize) -> f64 {
        self.windows[w].cost(&self.windows[w].weights)
    }

    /// The cost under another evaluation's weights, so that the two can be compared.
    pub(super) fn cost_under(&self, other: &Self) -> f64 {
        self.windows.iter().zip(&other.windows).map(|(own, theirs)| own.cost(&theirs.weights)).sum()
    }

    /// Information and score of one window for parameters whose derivatives are `columns`, the
    /// start pose projected out.
    pub(super) fn window_equations(&self, w: usize, columns: &[&[Frame]]) -> (DMatrix<f64>, DVector<f64>) {
        let (n, window) = (columns.len(), &self.windows[w]);
        let mut information = DMatrix::zeros(n, n);
        let mut score = DVector::zeros(n);
        let mut nuisance = Matrix3::<f64>::zeros();
        let mut mixed = Matrix3xX::<f64>::zeros(n);
        let mut nuisance_score = Vector3::<f64>::zeros();
        let mut row = DVector::zeros(n);
        for (frame, placed) in window.placed.iter().enumerate() {
            let start_rows = start_derivative(window.start, *placed);
            let weight = window.weights[frame];
            for i in 0..3 {
                let factor = 1.0 / self.noise[i];
                for (slot, column) in row.iter_mut().zip(columns) {
                    *slot = column[frame][i] * factor;
                }
                let start_row = Vector3::from(start_rows[i]) * factor;
                let residual = window.residuals[frame][i];
                information.ger(weight, &row, &row, 1.0);
                score.axpy(weight * residual, &row, 1.0);
                nuisance += start_row * start_row.transpose() * weight;
                mixed += start_row * row.transpose() * weight;
                nuisance_score += start_row * (weight * residual);
            }
        }
        let Some(inverse) = nuisance.try_inverse() else {
            return (DMatrix::zeros(n, n), DVector::zeros(n));
        };
        let projected = mixed.transpose() * inverse;
        information -= &projected * &mixed;
        score -= &projected * nuisance_score;
        (information, score)
    }

    pub(super) fn frames(&self) -> usize {
        self.windows.iter().map(|w| w.residuals.len()).sum()
    }

    pub(super) fn outliers(&self) -> usize {
        self.windows.iter().flat_map(|w| &w.weights).filter(|w| **w < 1.0).count()
    }

    pub(super) fn reduced_chi2(&self, parameters: usize) -> f64 {
        let used = self.frames() - self.outliers();
        let freedom = (3 * used).saturating_sub(3 * self.windows.len() + parameters).max(1);
        self.cost() / freedom as f64
    }

    pub(super) fn rms(&self, noise: [f64; 3]) -> [f64; 3] {
        let mut sums = [0.0; 3];
        let mut n = 0.0;
        for w in &self.windows {
            for (residual, weight) in w.residuals.iter().zip(&w.weights) {
                n += weight;
                for (sum, r) in sums.iter_mut().zip(residual) {
                    *sum += weight * r * r;
                }
            }
        }
        let mut rms = [0.0; 3];
        for i in 0..3 {
            rms[i] = noise[i] * (sums[i] / f64::max(n, 1.0)).sqrt();
        }
        rms
    }
}

impl Aligned {
    fn new(
        window: &Window,
        relative: impl Iterator<Item = Pose>,
        observe: &dyn Fn(Pose) -> Pose,
        noise: [f64; 3],
    ) -> Self {
        let n = window.seen.len();
        let relative: Vec<Pose> = relative.collect();
        // The middle frame has the shortest lever to either end.
        let (seen, own) = (window.seen[n / 2], relative[n / 2]);
        let start = seen.compose(own.inverse());
        let mut aligned = Self { start, placed: relative.clone(), residuals: vec![[0.0; 3]; n], weights: vec![1.0; n] };
        aligned.align_to(window, &relative, observe, noise);
        aligned
    }

    fn align(
        &mut self,
        window: &Window,
        relative: &(impl Iterator<Item = Pose> + Clone),
        observe: &dyn Fn(Pose) -> Pose,
        noise: [f64; 3],
    ) {
        let relative: Vec<Pose> = relative.clone().collect();
        self.align_to(window, &relative, observe, noise);
    }

    /// Finds the start pose; `observe` is close to the identity, so its derivative is taken as 1.
    fn align_to(&mut self, window: &Window, relative: &[Pose], observe: &dyn Fn(Pose) -> Pose, noise: [f64; 3]) {
        for step in 0..=ALIGNMENT_STEPS {
            let (mut information, mut score) = (Matrix3::<f64>::zeros(), Vector3::<f64>::zeros());
            for (i, (own, seen)) in relative.iter().zip(&window.seen).enumerate() {
                let placed = self.start.compose(*own);
                let predicted = observe(placed);
                let residual = [seen.x - predicted.x, seen.y - predicted.y, wrap_angle(seen.theta - predicted.theta)];
                self.placed[i] = placed;
                for (j, row) in start_derivative(self.start, placed).iter().enumerate() {
                    let row = Vector3::from(*row) / noise[j];
                    self.residuals[i][j] = residual[j] / noise[j];
                    information += row * row.transpose() * self.weights[i];
                    score += row * (self.weights[i] * residual[j] / noise[j]);
                }
            }
            let Some(inverse) = information.try_inverse().filter(|_| step < ALIGNMENT_STEPS) else { break };
            let change = inverse * score;
            self.start = Pose::new(self.start.x + change.x, self.start.y + change.y, self.start.theta + change.z);
        }
    }

    fn norms(&self) -> impl Iterator<Item = f64> + '_ {
        self.residuals.iter().map(|r| (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]).sqrt())
    }

    fn weigh(&mut self, spread: f64) {
        let norms: Vec<f64> = self.norms().collect();
        for (weight, norm) in self.weights.iter_mut().zip(norms) {
            let out = norm / spread;
            *weight = match out {
                out if out > REJECT => 0.0,
                out if out > HUBER => HUBER / out,
                // NaN included, so that it shows in the cost.
                _ => 1.0,
            };
        }
    }

    fn cost(&self, weights: &[f64]) -> f64 {
        self.norms().zip(weights).map(|(norm, weight)| if *weight > 0.0 { weight * norm * norm } else { 0.0 }).sum()
    }
}

/// The window's predicted poses relative to its first.
fn relative<'a>(window: &'a Window, tracks: &'a [Vec<Pose>]) -> impl Iterator<Item = Pose> + Clone + 'a {
    let track = &tracks[window.run][window.first..window.first + window.seen.len()];
    let origin = track[0];
    track.iter().map(move |pose| origin.relative(*pose))
}

/// Derivative of a placed pose by its window's start pose: rows x, y, heading.
fn start_derivative(start: Pose, placed: Pose) -> [[f64; 3]; 3] {
    [[1.0, 0.0, start.y - placed.y], [0.0, 1.0, placed.x - start.x], [0.0, 0.0, 1.0]]
}

/// (a − b)·factor, frame by frame.
pub(super) fn difference(a: &[Vec<Frame>], b: &[Vec<Frame>], factor: f64) -> Vec<Vec<Frame>> {
    let frame = |(a, b): (&Frame, &Frame)| [0, 1, 2].map(|i| (a[i] - b[i]) * factor);
    a.iter().zip(b).map(|(a, b)| a.iter().zip(b).map(frame).collect()).collect()
}
