//! Radii and lever beside the skews: a wheel that is larger than drawn bends the same camera tracks as turned wheels.

use runs::Run;
use runs::robot::{Layout, Robot};
use serde_json::json;

use super::{KinematicModel, KinematicParameter};
use crate::fit::{Fit, FitError, FitOptions, fit};

/// χ² per degree of freedom that radii must leave, as a share of what skews alone leave, to be believed: with nothing
/// but noise beside the skews four more parameters change it by less than a hundredth.
const BETTER: f64 = 0.8;
/// The same that may be lost by leaving the skews out.
const WITHOUT: f64 = 1.1;
/// Relative sizes beyond which a fit is no robot.
const MOST: f64 = 0.5;

/// Sizes of a robot that differ from its file, relative and with 95 % intervals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sizes {
    /// Radius of all wheels.
    pub wheel_radius: (f64, [f64; 2]),
    /// Distance of the contact points from the centre.
    pub body_radius: (f64, [f64; 2]),
    /// Place of the marker in the body frame, m.
    pub marker_m: [f64; 2],
    /// Whether skews explain nothing beside them.
    pub instead_of_skew: bool,
}

impl Sizes {
    pub(super) fn to_json(self) -> serde_json::Value {
        json!({
            "wheel_radius_scale": {"value": self.wheel_radius.0, "ci95": self.wheel_radius.1},
            "body_radius_scale": {"value": self.body_radius.0, "ci95": self.body_radius.1},
            "marker_m": self.marker_m,
            "instead_of_skew": self.instead_of_skew,
        })
    }

    /// The robot with these sizes.
    pub(super) fn apply(self, robot: &mut Robot) {
        robot.wheel_radius_m *= 1.0 + self.wheel_radius.0;
        let scale = 1.0 + self.body_radius.0;
        match &mut robot.layout {
            Layout::Rac { body_radius_m, .. } => *body_radius_m *= scale,
            Layout::Wheels(wheels) => wheels.iter_mut().for_each(|w| {
                w.x_m *= scale;
                w.y_m *= scale;
            }),
        }
    }

    /// In a sentence.
    pub(super) fn remark(self) -> String {
        let percent = |(v, [low, high]): (f64, [f64; 2])| format!("{:+.2} % (95 %: {:+.2} to {:+.2})", 1e2 * v, 1e2 * low, 1e2 * high);
        let skew = if self.instead_of_skew {
            "What the camera shows is a radius, not a skew: no wheel needs to be turned beside it."
        } else {
            "Skews alone do not explain what the camera shows."
        };
        format!(
            "{skew} Wheel radius {}, body radius {}, marker {:+.1} mm to the right and {:+.1} mm to the front of the centre.",
            percent(self.wheel_radius),
            percent(self.body_radius),
            1e3 * self.marker_m[0],
            1e3 * self.marker_m[1],
        )
    }
}

/// Radii beside the skews where these alone, `fitted`, leave far more than noise: the fit with both, parameters of
/// `free` first, and the sizes. `None` where radii explain no more.
pub(super) fn beside(
    robot: &Robot,
    runs: &[Run],
    free: &[KinematicParameter],
    fitted: &Fit,
    options: &FitOptions,
) -> Result<Option<(Fit, Sizes)>, FitError> {
    use KinematicParameter as P;
    let sizes = [P::WheelRadiusCommon, P::BodyRadius, P::MarkerX, P::MarkerY];
    let fit_of = |free: &[KinematicParameter]| {
        fit(&KinematicModel::new(robot, free.to_vec()), runs, &vec![0.0; free.len()], options)
    };
    let both: Vec<P> = free.iter().chain(&sizes).copied().collect();
    let with = fit_of(&both)?;
    if with.residuals.reduced_chi2 > BETTER * fitted.residuals.reduced_chi2 {
        return Ok(None);
    }
    // Turned wheels are dropped if they are not needed; a turned marker plate stands for what they have in common.
    let plain: Vec<P> =
        free.iter().filter(|p| !matches!(p, P::Skew(_))).chain(&sizes).copied().chain([P::MarkerHeading]).collect();
    let without = fit_of(&plain)?;
    let instead_of_skew = without.residuals.reduced_chi2 < WITHOUT * with.residuals.reduced_chi2;
    let (source, order) = if instead_of_skew { (&without, &plain) } else { (&with, &both) };
    let at = |wanted: P| order.iter().position(|p| *p == wanted).unwrap_or(0);
    let relative = |p: P| (source.parameters[at(p)], source.ci95(at(p)));
    let found = Sizes {
        wheel_radius: relative(P::WheelRadiusCommon),
        body_radius: relative(P::BodyRadius),
        marker_m: [source.parameters[at(P::MarkerX)], source.parameters[at(P::MarkerY)]],
        instead_of_skew,
    };
    let sound = [found.wheel_radius.0, found.body_radius.0].iter().all(|s| s.abs() < MOST);
    Ok(sound.then_some((with, found)))
}
