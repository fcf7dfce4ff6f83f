//! Fitting parameters of a motion model to camera poses: windowed output error.
//!
//! Every run is cut into windows of about a second. Within a window the model predicts the camera
//! poses from the encoders up to a rigid motion, its start pose, which is fitted beside the
//! parameters and projected out. That is multiple shooting with free nodes: errors of odometry do
//! not add up over a run, and no start pose has to be known. Parameters act on the prediction,
//! never on the measurement.

pub mod clocks;
mod noise;
mod windows;

use estimation::statistics::t_quantile_975;
use estimation::truncated::{Truncated, UnknownDirection};
use nalgebra::{DMatrix, DVector};

use runs::Run;
use runs::frames::Pose;

pub use noise::{NO_HEADING_RAD, camera_noise, camera_noise_of, with_headings};
use windows::{Evaluation, Frame, Window};

/// A model that predicts camera poses from the encoders, for any values of its parameters.
pub trait PoseModel {
    /// Names of the parameters, ending in their unit.
    fn names(&self) -> Vec<String>;

    /// A step of each parameter that is small but matters: 1° for an angle, say. Sets the finite
    /// differences and the unit in which directions of the parameter space are compared.
    fn scales(&self) -> Vec<f64>;

    /// One pose for every entry of [`Run::camera`] of the run with this number, from 0, all up to one rigid motion of
    /// the plane. Heading must be continuous, not wrapped.
    fn track(&self, parameters: &[f64], number: usize, run: &Run) -> Vec<Pose>;

    /// What the camera makes of a pose in the field: the identity, but for distortion and scale.
    fn observe(&self, _parameters: &[f64], pose: Pose) -> Pose {
        pose
    }
}

/// Windows, noise and steps of a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitOptions {
    /// Length of a window, s.
    pub window_s: f64,
    /// Standard deviations of a camera pose (m, m, rad); `None` to take them from the data.
    pub noise: Option<[f64; 3]>,
    /// Gauss-Newton steps at most.
    pub most_steps: usize,
    /// A direction of the parameter space counts as unknown if its standard deviation exceeds this
    /// many [`PoseModel::scales`]; it then keeps its start value.
    pub unknown_beyond: f64,
}

impl Default for FitOptions {
    fn default() -> Self {
        Self { window_s: 1.0, noise: None, most_steps: 12, unknown_beyond: 20.0 }
    }
}

/// Frames that a window holds at least: half of them pay for the start pose and for what is lost at its ends.
const WINDOW_FRAMES: f64 = 8.0;

/// Length of a window, s, that usually is so long: longer where a camera has few frames a second (0: of unknown rate).
pub fn window_s(usual_s: f64, camera_rate_hz: f64) -> f64 {
    if camera_rate_hz > 0.0 { usual_s.max(WINDOW_FRAMES / camera_rate_hz) } else { usual_s }
}

/// Why there is nothing to fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum FitError {
    /// No run has a window with at least four camera frames and encoder counts.
    #[error("no second of the logs has both camera frames and encoder counts")]
    NoWindows,
    /// The residuals are not finite at the start.
    #[error("the prediction is not finite; look at the parameters the fit starts from")]
    NotFinite,
}

/// Outcome of [`fit`].
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Names of the parameters.
    pub names: Vec<String>,
    /// One for each name, in its unit.
    pub parameters: Vec<f64>,
    /// Covariance of the estimates: robust against anything that is correlated within a window
    /// (cluster-robust by window), and nowhere below what the camera noise alone explains.
    pub covariance: DMatrix<f64>,
    /// Quantile for 95 % intervals: Student's t with (windows − parameters) degrees of freedom.
    pub quantile: f64,
    /// What the data cannot tell.
    pub unknown: Vec<UnknownDirection>,
    /// Residuals at the estimates.
    pub residuals: Residuals,
}

/// What a model with given parameters leaves unexplained.
#[derive(Debug, Clone, PartialEq)]
pub struct Residuals {
    /// Root mean squares of x, y (m) and heading (rad), start poses fitted.
    pub rms: [f64; 3],
    /// The noise they are compared with.
    pub noise: [f64; 3],
    /// χ² per degree of freedom: 1 if the model is right and the noise is what it is said to be.
    pub reduced_chi2: f64,
    /// Camera frames used.
    pub frames: usize,
    /// Windows used.
    pub windows: usize,
    /// Frames that got less than full weight: outliers.
    pub outliers: usize,
}

impl Fit {
    /// 95 % confidence interval of one parameter.
    pub fn ci95(&self, parameter: usize) -> [f64; 2] {
        let mut weights = vec![0.0; self.parameters.len()];
        weights[parameter] = 1.0;
        let half = self.half_width(&weights);
        [self.parameters[parameter] - half, self.parameters[parameter] + half]
    }

    /// Half the width of the 95 % confidence interval of a weighted sum of the parameters.
    pub fn half_width(&self, weights: &[f64]) -> f64 {
        let w = DVector::from_column_slice(weights);
        self.quantile * (w.transpose() * &self.covariance * &w)[0].max(0.0).sqrt()
    }
}

/// Fits the parameters of `model` to what the camera saw in `runs`, from `start`.
///
/// Gauss-Newton with Huber weights for outliers; directions the data do not fix are left alone and
/// reported.
///
/// # Errors
/// [`FitError`] if there is nothing to fit.
pub fn fit(model: &dyn PoseModel, runs: &[Run], start: &[f64], options: &FitOptions) -> Result<Fit, FitError> {
    let problem = Problem::new(model, runs, options)?;
    let mut parameters = start.to_vec();
    let mut now = problem.evaluate(&parameters)?;
    for _ in 0..options.most_steps {
        let normal = problem.linearise(&parameters, &now);
        let step = normal.step();
        // Halve a step that makes things worse: far from the solution the problem is not linear.
        let mut accepted = None;
        for halving in 0..6 {
            let factor = 0.5_f64.powi(halving);
            let trial: Vec<f64> =
                parameters.iter().zip(step.iter()).zip(&problem.scales).map(|((p, d), s)| p + factor * d * s).collect();
            if let Ok(evaluated) = problem.evaluate(&trial)
                && evaluated.cost_under(&now) <= now.cost() * (1.0 + 1e-9)
            {
                accepted = Some((trial, evaluated));
                break;
            }
        }
        let Some((trial, evaluated)) = accepted else { break };
        (parameters, now) = (trial, evaluated);
        if step.amax() < 1e-6 {
            break;
        }
    }
    let normal = problem.linearise(&parameters, &now);
    let (covariance, unknown) = normal.covariance(now.reduced_chi2(start.len()));
    let scale = DMatrix::from_diagonal(&DVector::from_column_slice(&problem.scales));
    Ok(Fit {
        names: model.names(),
        parameters,
        covariance: &scale * covariance * &scale,
        quantile: t_quantile_975(problem.windows.len().saturating_sub(start.len())),
        unknown,
        residuals: problem.residuals(&now, start.len()),
    })
}

/// The residuals of `model` with given parameters: for held-out runs, and before a fit.
///
/// # Errors
/// [`FitError`] if there is nothing to compare.
pub fn residuals(
    model: &dyn PoseModel,
    runs: &[Run],
    parameters: &[f64],
    options: &FitOptions,
) -> Result<Residuals, FitError> {
    let problem = Problem::new(model, runs, options)?;
    let evaluation = problem.evaluate(parameters)?;
    Ok(problem.residuals(&evaluation, 0))
}

/// Covariance at given parameters without fitting: what could be known from these runs, and what
/// could not. For questions such as "and if the marker were free, too?".
///
/// # Errors
/// [`FitError`] if there is nothing to compare.
pub fn covariance_at(
    model: &dyn PoseModel,
    runs: &[Run],
    parameters: &[f64],
    options: &FitOptions,
) -> Result<(DMatrix<f64>, Vec<UnknownDirection>), FitError> {
    let problem = Problem::new(model, runs, options)?;
    let evaluation = problem.evaluate(parameters)?;
    let normal = problem.linearise(parameters, &evaluation);
    let (covariance, unknown) = normal.covariance(evaluation.reduced_chi2(parameters.len()));
    let scale = DMatrix::from_diagonal(&DVector::from_column_slice(&problem.scales));
    Ok((&scale * covariance * &scale, unknown))
}

/// What a stretch of one run says about the parameters, linearised: δ more of them, in units of [`PoseModel::scales`],
/// changes its sum of squares by δᵀ·`information`·δ − 2·`score`ᵀ·δ.
#[derive(Debug, Clone, PartialEq)]
pub struct WindowEquations {
    /// The run, from 0.
    pub run: usize,
    /// Parameters × parameters.
    pub information: DMatrix<f64>,
    /// One entry a parameter.
    pub score: DVector<f64>,
    /// The sum of squares as it is, in units of the camera's noise.
    pub squares: f64,
}

impl WindowEquations {
    /// Those of nothing.
    pub(crate) fn none(parameters: usize, run: usize) -> Self {
        let (information, score) = (DMatrix::zeros(parameters, parameters), DVector::zeros(parameters));
        Self { run, information, score, squares: 0.0 }
    }

    /// Adds others' `factor` times, 1 to join two stretches and −1 to part them.
    pub(crate) fn add(&mut self, other: &Self, factor: f64) {
        self.information += &other.information * factor;
        self.score += &other.score * factor;
        self.squares += other.squares * factor;
    }

    /// Change of the sum of squares for a change of the parameters.
    pub(crate) fn loss(&self, change: &DVector<f64>) -> f64 {
        change.dot(&(&self.information * change)) - 2.0 * self.score.dot(change)
    }
}

/// The equations of every window at given parameters, the start poses projected out: for choosing among models by
/// windows that had no part in the fit.
///
/// # Errors
/// [`FitError`] if there is nothing to compare.
pub fn window_equations(
    model: &dyn PoseModel,
    runs: &[Run],
    parameters: &[f64],
    options: &FitOptions,
) -> Result<Vec<WindowEquations>, FitError> {
    let problem = Problem::new(model, runs, options)?;
    let evaluation = problem.evaluate(parameters)?;
    Ok(problem.equations(parameters, &evaluation))
}

struct Problem<'a> {
    model: &'a dyn PoseModel,
    runs: &'a [Run],
    windows: Vec<Window>,
    noise: [f64; 3],
    scales: Vec<f64>,
    unknown_beyond: f64,
}

impl<'a> Problem<'a> {
    fn new(model: &'a dyn PoseModel, runs: &'a [Run], options: &FitOptions) -> Result<Self, FitError> {
        let windows = windows::cut(runs, options.window_s);
        if windows.is_empty() {
            return Err(FitError::NoWindows);
        }
        let noise = options.noise.unwrap_or_else(|| camera_noise(runs));
        let noise = with_headings(noise, runs.iter().any(|run| run.source.positions_only));
        Ok(Self { model, runs, windows, noise, scales: model.scales(), unknown_beyond: options.unknown_beyond })
    }

    /// Predicted frames of every run.
    fn tracks(&self, parameters: &[f64]) -> Vec<Vec<Pose>> {
        self.runs.iter().enumerate().map(|(number, run)| self.model.track(parameters, number, run)).collect()
    }

    fn evaluate(&self, parameters: &[f64]) -> Result<Evaluation, FitError> {
        let tracks = self.tracks(parameters);
        let observe = |pose| self.model.observe(parameters, pose);
        let evaluation = Evaluation::new(&self.windows, &tracks, &observe, self.noise);
        if evaluation.cost().is_finite() { Ok(evaluation) } else { Err(FitError::NotFinite) }
    }

    /// Every window's equations with the start poses projected out, in units of the scales.
    fn equations(&self, parameters: &[f64], at: &Evaluation) -> Vec<WindowEquations> {
        let derivatives: Vec<Vec<Vec<Frame>>> = (0..parameters.len())
            .map(|j| {
                let h = 0.02 * self.scales[j];
                let side = |sign: f64| {
                    let mut moved = parameters.to_vec();
                    moved[j] += sign * h;
                    at.predict(&self.windows, &self.tracks(&moved), &|pose| self.model.observe(&moved, pose))
                };
                windows::difference(&side(1.0), &side(-1.0), self.scales[j] / (2.0 * h))
            })
            .collect();
        let equations = |(w, window): (usize, &Window)| {
            let columns: Vec<&[Frame]> = derivatives.iter().map(|d| d[w].as_slice()).collect();
            let (information, score) = at.window_equations(w, &columns);
            WindowEquations { run: window.run(), information, score, squares: at.window_cost(w) }
        };
        self.windows.iter().enumerate().map(equations).collect()
    }

    /// The normal equations: those of all windows.
    fn linearise(&self, parameters: &[f64], at: &Evaluation) -> Truncated {
        let mut normal = Truncated::new(parameters.len(), self.unknown_beyond);
        for window in self.equations(parameters, at) {
            normal.add(&window.information, &window.score);
        }
        normal
    }

    fn residuals(&self, at: &Evaluation, parameters: usize) -> Residuals {
        Residuals {
            rms: at.rms(self.noise),
            noise: self.noise,
            reduced_chi2: at.reduced_chi2(parameters),
            frames: at.frames(),
            windows: self.windows.len(),
            outliers: at.outliers(),
        }
    }
}

#[cfg(test)]
mod tests;
