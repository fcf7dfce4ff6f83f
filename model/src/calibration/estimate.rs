//! All skews at once, from logs of encoders and camera.

use nalgebra::DMatrix;
use serde_json::json;

use super::excitation::{Excitation, best_direction};
use super::size::{Estimated, Sizes};
use super::structure::{self, Part};
use super::{KinematicModel, KinematicParameter};
use crate::fit::{Fit, FitError, FitOptions, covariance_at, fit, residuals, window_s};
use estimation::statistics::median;
use runs::Run;
use runs::frames::wrap_angle;
use runs::robot::{Layout, Robot};

/// Longer than the engine's default: a skew shows as curvature, which grows with the window, and
/// wheels that creep by a part in a thousand still do not matter in two seconds.
const WINDOW_S: f64 = 2.0;
/// A difference of two skews counts as found if its 95 % interval is at most this wide either way.
const FOUND: f64 = 1.0;
/// The common skew counts as found if it is known this well (95 %, degrees) without trusting the
/// marker's heading.
const COMMON_FOUND: f64 = 0.5;
/// χ² per degree of freedom from which skew alone does not explain the data. Camera noise that is
/// not quite white reaches 1.2.
const UNEXPLAINED: f64 = 1.5;
/// A wheel turned by more drives another way: the estimate is refused.
const MOST_SKEW: f64 = std::f64::consts::FRAC_PI_4;
/// χ² per degree of freedom from which the estimate is refused: residuals of thirty times the camera's noise.
const ABSURD: f64 = 1000.0;
/// Share of the way driven in a window up to which what is left is the wheels' and not a wrong robot's: motion capture
/// scatters by hundredths of a millimetre, on which wheels are never exact. A robot with two wheels under it left 3 %, wheels
/// of another order leave 30 % and more.
const ROLLS: f64 = 0.1;

/// The skews of a robot's wheels, and what the data cannot tell about them.
#[derive(Debug, Clone, PartialEq)]
pub struct SkewEstimate {
    /// Skew of each wheel, clockwise, rad; on top of `drive_rad` for robots with `[[wheel]]`.
    /// The nominal value where nothing could be found out.
    pub skew_rad: Vec<f64>,
    /// Their 95 % confidence intervals, given that the marker plate is mounted true.
    pub ci95: Vec<[f64; 2]>,
    /// Half widths of the 95 % intervals of skew i − skew j, rad, for wheels i < j from 0. These
    /// need no marker.
    pub differences: Vec<(usize, usize, f64)>,
    /// Camera latency beyond what robot.toml states, s; fitted alongside.
    pub latency_s: Estimated,
    /// Half width of the 95 % interval of the mean skew if the marker plate may be turned, rad.
    pub common_half_width: f64,
    /// Whether every difference is known to 1°.
    pub identifiable: bool,
    /// Whether the mean skew is known to 0.5° without trusting the marker plate.
    pub common_identifiable: bool,
    /// What the camera asks for, as [`Sizes`] and skews.
    pub parts: Vec<Part>,
    /// Radii, marker and clocks, where it asks for any.
    pub sizes: Sizes,
    /// Everything that was fitted, by name; empty where there is no estimate.
    pub fitted: Vec<(KinematicParameter, f64)>,
    /// How well the camera is predicted.
    pub residual: Residual,
    /// What the data cannot tell, and which drive would help; empty if all is well.
    pub remarks: Vec<String>,
}

/// Root mean squares of seen minus predicted (m, m, rad), start poses of one-second windows fitted.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Residual {
    /// With the nominal skews.
    pub before: [f64; 3],
    /// With the estimate.
    pub after: [f64; 3],
    /// The camera's noise.
    pub noise: [f64; 3],
    /// χ² per degree of freedom with the estimate.
    pub reduced_chi2: f64,
    /// Camera frames used.
    pub frames: usize,
    /// Frames recognised as outliers.
    pub outliers: usize,
}

impl SkewEstimate {
    /// Whether nothing at all could be found out; the remarks say why.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.fitted.is_empty()
    }

    /// `{"skew_rad", "ci95", "common_identifiable", "residual": {...}, ...}`.
    pub fn to_json(&self) -> serde_json::Value {
        let r = &self.residual;
        json!({
            "skew_rad": self.skew_rad,
            "ci95": self.ci95,
            "common_identifiable": self.common_identifiable,
            "identifiable": self.identifiable,
            "difference_half_width_rad": self.differences.iter()
                .map(|(i, j, half)| json!({"wheels": [i + 1, j + 1], "ci95_half_width": half}))
                .collect::<Vec<_>>(),
            "common_half_width_rad": self.common_half_width,
            "residual": {
                "before": r.before, "after": r.after, "noise": r.noise,
                "reduced_chi2": r.reduced_chi2, "frames": r.frames, "outliers": r.outliers,
            },
            "latency_s": { "value": self.latency_s.value, "ci95": self.latency_s.ci95 },
            "sizes": (self.sizes != Sizes::default()).then(|| self.sizes.to_json(&self.parts)),
            "remarks": self.remarks,
        })
    }

    /// The robot with these skews, and sizes if any were found, as its nominal geometry.
    #[must_use]
    pub fn apply(&self, robot: &Robot) -> Robot {
        let mut robot = robot.clone();
        self.sizes.apply(&mut robot);
        // A camera that is earlier than the robot is a clock that was set by hand; it says nothing of the next run.
        let latency = robot.camera_latency_s + self.latency_s.value;
        if self.latency_s.is_certain() && latency >= 0.0 {
            robot.camera_latency_s = latency;
        }
        match &mut robot.layout {
            Layout::Rac { skew_rad, .. } => {
                for (slot, skew) in skew_rad.iter_mut().zip(&self.skew_rad) {
                    *slot = *skew;
                }
            }
            Layout::Wheels(wheels) => {
                for (wheel, skew) in wheels.iter_mut().zip(&self.skew_rad) {
                    wheel.drive_rad -= skew;
                }
            }
        }
        robot
    }
}

/// Estimates all skews from logs of encoders and camera.
///
/// Logs that cannot tell (no camera, a robot that stands still, one direction only) are no error:
/// the estimate says so in its remarks and intervals.
///
/// # Errors
/// [`FitError::NotFinite`] if the robot or the logs hold numbers that lead nowhere.
pub fn estimate_skew(robot: &Robot, runs: &[Run]) -> Result<SkewEstimate, FitError> {
    let found = estimated(robot, runs, robot.camera_noise)?;
    let Residual { after, noise, reduced_chi2, frames, .. } = found.residual;
    let seconds: f64 = runs.iter().filter_map(|run| Some(run.t.last()? - run.t.first()?)).sum();
    let way = Excitation::of(robot, runs).path_m * window_s(WINDOW_S, frames_per_s(runs)) / seconds.max(WINDOW_S);
    let rolls = after[0].hypot(after[1]) <= ROLLS * way;
    if robot.camera_noise.is_some() || frames == 0 || reduced_chi2 <= ABSURD || !rolls {
        return Ok(found);
    }
    let mut found = estimated(robot, runs, Some(after))?;
    found.remarks.push(format!(
        "The camera is finer than wheels roll: its frames scatter by {:.2} mm, and whatever is fitted, {:.1} mm and {:.2} degrees \
         are left. That is taken for its noise, and nothing smaller is told.",
        1e3 * noise[0].max(noise[1]),
        1e3 * after[0].max(after[1]),
        after[2].to_degrees()
    ));
    Ok(found)
}

/// The same with poses of a given noise, else with that of their frames.
fn estimated(robot: &Robot, runs: &[Run], noise: Option<[f64; 3]>) -> Result<SkewEstimate, FitError> {
    let n = robot.wheel_count();
    let window_s = window_s(WINDOW_S, frames_per_s(runs));
    let options = FitOptions { window_s, noise, ..FitOptions::default() };
    let (parts, blocks) = match structure::choose(robot, runs, &options) {
        Ok(chosen) => chosen,
        Err(FitError::NoWindows) => return Ok(nothing(robot, runs)),
        Err(e) => return Err(e),
    };
    let fit_of = |parameters: &[KinematicParameter]| {
        fit(&KinematicModel::new(robot, parameters.to_vec()), runs, &vec![0.0; parameters.len()], &options)
    };
    let nominal = nominal_skew(robot);
    let parameters = structure::parameters(&parts, n, runs.len());
    let fitted = fit_of(&parameters)?;
    let before = residuals(&KinematicModel::new(robot, Vec::new()), runs, &[], &options)?;
    let sizes = Sizes::of(&fitted, &parameters);
    let latency_s = sizes.common_clock().unwrap_or_else(|| Sizes::latency(&fitted, &parameters));
    let mut estimate = SkewEstimate {
        skew_rad: nominal.clone(),
        ci95: nominal.iter().map(|s| [*s; 2]).collect(),
        differences: Vec::new(),
        latency_s,
        common_half_width: 0.0,
        identifiable: true,
        common_identifiable: true,
        parts: parts.clone(),
        fitted: parameters.iter().copied().zip(fitted.parameters.iter().copied()).collect(),
        residual: Residual {
            before: before.rms,
            after: fitted.residuals.rms,
            noise: fitted.residuals.noise,
            reduced_chi2: fitted.residuals.reduced_chi2,
            frames: fitted.residuals.frames,
            outliers: fitted.residuals.outliers,
        },
        sizes,
        remarks: Vec::new(),
    };
    let skewed = parts.contains(&Part::Skews);
    let differential = robot.geometry().is_ok_and(|g| g.is_differential());
    let mut worst = 0.0_f64;
    if !differential {
        // Where the camera asks for no skew it still tells how well they are known.
        let (order, freed) = if skewed {
            (parameters, fitted.clone())
        } else {
            let order = structure::parameters(&structure::with(&parts, Part::Skews), n, runs.len());
            let freed = fit_of(&order)?;
            (order, freed)
        };
        let first = order.iter().position(|p| *p == KinematicParameter::Skew(0)).unwrap_or(0);
        worst = (0..n).map(|i| freed.parameters[first + i].abs()).fold(0.0, f64::max);
        estimate.set_skews(&freed, first, skewed, &nominal);
        estimate.common_half_width = common_with_free_marker(robot, runs, &order, &freed, first, &options)?;
        estimate.common_identifiable = estimate.identifiable && estimate.common_half_width.to_degrees() <= COMMON_FOUND;
        estimate.remarks = remarks(robot, runs, &freed, first, &estimate);
    } else {
        estimate.remarks = camera_remarks(&estimate);
    }
    let far = skewed && worst > MOST_SKEW;
    if far || fitted.residuals.reduced_chi2 > ABSURD || !estimate.sizes.are_sound() {
        return Ok(refused(robot, &estimate, far));
    }
    let said = estimate.sizes.remarks(skewed);
    estimate.remarks.extend(said);
    if blocks < structure::FEWEST_BLOCKS {
        estimate.remarks.push(format!(
            "Camera and encoders overlap for {blocks} stretches of {window_s:.0} s, too few to test what part of the robot is at \
             fault on stretches that had no part in the fit: whether it is a skew, a radius or the marker is not proven. Log \
             at least {}.",
            structure::FEWEST_BLOCKS
        ));
    }
    Ok(estimate)
}

impl SkewEstimate {
    /// Skews, intervals and differences of a fit in which the skews begin at `first`; where they are not `asked` for
    /// they stay nominal, with intervals that hold both that and what the fit would make of them.
    fn set_skews(&mut self, freed: &Fit, first: usize, asked: bool, nominal: &[f64]) {
        let n = nominal.len();
        for (i, nominal) in nominal.iter().enumerate() {
            let [low, high] = freed.ci95(first + i);
            if asked {
                self.skew_rad[i] = wrap_angle(nominal + freed.parameters[first + i]);
                self.ci95[i] = [low + nominal, high + nominal];
            } else {
                self.ci95[i] = [low.min(0.0) + nominal, high.max(0.0) + nominal];
            }
        }
        for (i, j) in (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j))) {
            let mut weights = vec![0.0; freed.parameters.len()];
            (weights[first + i], weights[first + j]) = (1.0, -1.0);
            let off = freed.parameters[first + i] - freed.parameters[first + j];
            let half = freed.half_width(&weights) + if asked { 0.0 } else { off.abs() };
            self.differences.push((i, j, half));
        }
        self.identifiable = self.differences.iter().all(|(_, _, half)| half.to_degrees() <= FOUND);
    }
}

fn nominal_skew(robot: &Robot) -> Vec<f64> {
    match &robot.layout {
        Layout::Rac { skew_rad, .. } => skew_rad.to_vec(),
        Layout::Wheels(wheels) => vec![0.0; wheels.len()],
    }
}

/// How well the mean skew is known if the marker plate may be turned as well.
fn common_with_free_marker(
    robot: &Robot,
    runs: &[Run],
    order: &[KinematicParameter],
    fitted: &Fit,
    first: usize,
    options: &FitOptions,
) -> Result<f64, FitError> {
    let n = robot.wheel_count();
    let mut free = order.to_vec();
    free.push(KinematicParameter::MarkerHeading);
    let mut at = fitted.parameters.clone();
    at.push(0.0);
    let (covariance, _) = covariance_at(&KinematicModel::new(robot, free), runs, &at, options)?;
    let variance = covariance.view((first, first), (n, n)).sum() / (n * n) as f64;
    Ok(fitted.quantile * variance.max(0.0).sqrt())
}

/// An estimate that is none: the nominal skews, known to nothing.
fn refused(robot: &Robot, estimate: &SkewEstimate, far: bool) -> SkewEstimate {
    let why = if far {
        format!("a wheel would have to be turned by more than {:.0} degrees", MOST_SKEW.to_degrees())
    } else {
        format!("the camera is predicted {:.0} times worse than its noise", estimate.residual.reduced_chi2.sqrt())
    };
    let remark = format!(
        "No estimate: {why}. Wheels, encoders and camera do not belong together as robot.toml says; look at the order and \
         signs of the encoders, counts per turn, wheel radius, and the camera's axes and units."
    );
    let none = nothing(robot, &[]);
    SkewEstimate { residual: estimate.residual, remarks: vec![remark], ..none }
}

/// Usual frames a second of the camera in some logs; 0 where there are none.
fn frames_per_s(runs: &[Run]) -> f64 {
    let steps = runs.iter().flat_map(|run| run.camera.windows(2).map(|f| run.t[f[1].tick] - run.t[f[0].tick]));
    let usual = median(&mut steps.collect::<Vec<f64>>());
    if usual > 0.0 { usual.recip() } else { 0.0 }
}

/// Logs without a single window of camera and encoders.
fn nothing(robot: &Robot, runs: &[Run]) -> SkewEstimate {
    let n = robot.wheel_count();
    let anything = std::f64::consts::FRAC_PI_2;
    let remark = if runs.iter().all(|r| r.counts.is_empty()) {
        "The logs have no encoder counts (enc_1, enc_2, ...), so nothing can be said about the skews. Log them."
    } else if runs.iter().all(|r| r.camera.is_empty()) {
        "The logs have no camera poses (cam_x, cam_y, cam_theta), so nothing can be said about the skews. Log an \
         overhead camera while the robot drives straight in several directions."
    } else {
        "Nowhere in the logs are there four camera frames close to each other beside encoder counts, so nothing can be \
         said about the skews. Log more frames."
    };
    let skew_rad = nominal_skew(robot);
    SkewEstimate {
        ci95: skew_rad.iter().map(|s| [s - anything, s + anything]).collect(),
        skew_rad,
        differences: (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j, anything))).collect(),
        latency_s: Estimated { value: 0.0, ci95: [-1.0, 1.0] },
        common_half_width: anything,
        identifiable: false,
        common_identifiable: false,
        parts: Vec::new(),
        sizes: Sizes::default(),
        fitted: Vec::new(),
        residual: Residual::default(),
        remarks: vec![remark.to_owned()],
    }
}

fn remarks(robot: &Robot, runs: &[Run], fitted: &Fit, first: usize, estimate: &SkewEstimate) -> Vec<String> {
    let mut remarks = Vec::new();
    let excitation = Excitation::of(robot, runs);
    if excitation.path_m < 0.05 && excitation.turned_rad < 0.2 {
        remarks.push(format!(
            "The robot stands still in these logs: it moves by {:.0} mm and turns by {:.0} degrees in all. Skew only \
             shows while driving; drive straight for a metre in at least two directions.",
            excitation.path_m * 1e3,
            excitation.turned_rad.to_degrees()
        ));
        return remarks;
    }
    if !estimate.identifiable {
        let worst = estimate.differences.iter().max_by(|a, b| a.2.total_cmp(&b.2));
        if let Some((i, j, half)) = worst {
            let why = if excitation.path_m < 0.3 {
                format!("the robot only drives {:.2} m in these logs, beside turning", excitation.path_m)
            } else if let Some(axis) = excitation.single_axis {
                format!("the robot only drives along {}", direction_words(axis))
            } else {
                "these logs do not excite it enough".to_owned()
            };
            remarks.push(format!(
                "The skew of wheel {} against wheel {} is only known to ±{:.1} degrees: {why}. Driving straight for \
                 some metres along {} would help most.",
                i + 1,
                j + 1,
                half.to_degrees(),
                direction_words(best_direction(robot, &weakest_difference(fitted, first, estimate.skew_rad.len()))),
            ));
        }
    }
    remarks.extend(camera_remarks(estimate));
    // A turned plate that was found is said to be one or the other by itself.
    if !estimate.common_identifiable && estimate.parts.contains(&Part::Skews) {
        let mean = estimate.skew_rad.iter().sum::<f64>() / estimate.skew_rad.len() as f64;
        let half = estimate.common_half_width.to_degrees();
        let known = if half < 10.0 {
            format!("is only known to ±{half:.1} degrees")
        } else {
            "is not known at all".to_owned()
        };
        remarks.push(format!(
            "The part that all skews have in common ({:+.2} degrees) looks, but for second order, like a marker plate \
             that is turned on the robot. It holds if the plate is mounted true, and {known} if it is not. No drive tells \
             the two apart; measure the plate. The differences between the wheels do not depend on it.",
            mean.to_degrees(),
        ));
    }
    remarks
}

/// What is to be said of the camera itself.
fn camera_remarks(estimate: &SkewEstimate) -> Vec<String> {
    let mut remarks = Vec::new();
    let Estimated { value: latency, ci95: [low, high] } = estimate.latency_s;
    if latency.abs() > 0.002 && estimate.latency_s.is_certain() {
        let (way, sense, how) =
            if latency > 0.0 { ("later", 1e3, "add it to") } else { ("earlier", -1e3, "take it off") };
        let mut ends = [low, high].map(|end| sense * end);
        ends.sort_by(f64::total_cmp);
        remarks.push(format!(
            "The camera is {:.1} ms {way} (95 %: {:.1} to {:.1}) than robot.toml states; {how} camera_latency_s.",
            sense * latency,
            ends[0],
            ends[1]
        ));
    }
    if estimate.residual.reduced_chi2 > UNEXPLAINED {
        remarks.push(format!(
            "With the best values the camera is still not predicted to its noise: χ² is {:.1} per degree of freedom. \
             Something else is wrong with the robot or its description; the intervals allow for it, the estimates may be off.",
            estimate.residual.reduced_chi2
        ));
    }
    remarks
}

/// The combination of skews, common part aside, about which least is known.
fn weakest_difference(fitted: &Fit, first: usize, wheels: usize) -> Vec<f64> {
    let centre = DMatrix::identity(wheels, wheels) - DMatrix::from_element(wheels, wheels, 1.0 / wheels as f64);
    let block = fitted.covariance.view((first, first), (wheels, wheels));
    let eigen = (&centre * block * &centre).symmetric_eigen();
    eigen.eigenvectors.column(eigen.eigenvalues.imax()).iter().copied().collect()
}

/// A body direction (rad from body x) as a driver would say it; forwards and backwards are alike.
fn direction_words(angle: f64) -> String {
    let from_forward = wrap_angle(2.0 * (angle - std::f64::consts::FRAC_PI_2)) / 2.0;
    match from_forward.to_degrees().round() as i64 {
        0 => "its forward direction".to_owned(),
        90 | -90 => "its sideways direction".to_owned(),
        degrees if degrees > 0 => format!("{degrees} degrees to the left of forward"),
        degrees => format!("{} degrees to the right of forward", -degrees),
    }
}

#[cfg(test)]
mod tests;
