//! Sizes, marker and clocks found beside or instead of skews.

use runs::robot::{Effect, EffectParameter, Layout, Robot};
use serde_json::{Value, json};

use super::KinematicParameter;
use super::structure::Part;
use crate::fit::Fit;
use estimation::statistics::t_quantile_975;

/// Relative sizes beyond which a fit is no robot.
const MOST: f64 = 0.5;

/// An estimate with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimated {
    /// Best value.
    pub value: f64,
    /// Low and high end.
    pub ci95: [f64; 2],
}

impl Estimated {
    fn of(fitted: &Fit, index: usize) -> Self {
        Self { value: fitted.parameters[index], ci95: fitted.ci95(index) }
    }

    /// Whether 0 is outside the interval.
    pub fn is_certain(&self) -> bool {
        self.ci95[0] > 0.0 || self.ci95[1] < 0.0
    }

    fn to_json(self) -> Value {
        json!({"value": self.value, "ci95": self.ci95})
    }

    fn effect_parameter(self, name: &str) -> (String, EffectParameter) {
        let ci95 = self.ci95.iter().all(|v| v.is_finite()).then_some(self.ci95);
        (name.to_owned(), EffectParameter { value: self.value, ci95, ..EffectParameter::default() })
    }

    fn percent(self) -> String {
        let [low, high] = self.ci95.map(|v| 1e2 * v);
        format!("{:+.2} % (95 %: {low:+.2} to {high:+.2})", 1e2 * self.value)
    }
}

/// What differs from the robot's file beside skews; what the camera does not ask for is `None` or empty.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sizes {
    /// Radius of all wheels, relative to nominal.
    pub wheel_radius: Option<Estimated>,
    /// Radius of each wheel, relative to nominal, where they differ.
    pub wheel_radii: Vec<Estimated>,
    /// Distance of the contact points from the centre, relative to nominal.
    pub body_radius: Option<Estimated>,
    /// How much further the robot moves along body x than its wheels say, relative.
    pub sideways: Option<Estimated>,
    /// Place of the marker in the body frame, m.
    pub marker_m: Option<[Estimated; 2]>,
    /// Heading of the marker, counter-clockwise, rad. What all skews have in common looks the same.
    pub marker_heading: Option<Estimated>,
    /// Latency of each run beyond what the file states, s, where their clocks were set one by one.
    pub clocks_s: Vec<Estimated>,
}

impl Sizes {
    /// What a fit of these parameters found.
    pub(super) fn of(fitted: &Fit, parameters: &[KinematicParameter]) -> Self {
        use KinematicParameter as P;
        let mut sizes = Self::default();
        let mut place = [None; 2];
        for (index, parameter) in parameters.iter().enumerate() {
            let found = Estimated::of(fitted, index);
            match parameter {
                P::WheelRadiusCommon => sizes.wheel_radius = Some(found),
                P::WheelRadius(_) => sizes.wheel_radii.push(found),
                P::BodyRadius => sizes.body_radius = Some(found),
                P::Sideways => sizes.sideways = Some(found),
                P::MarkerX => place[0] = Some(found),
                P::MarkerY => place[1] = Some(found),
                P::MarkerHeading => sizes.marker_heading = Some(found),
                P::CameraClock(_) => sizes.clocks_s.push(found),
                P::Skew(_) | P::CameraLatency | P::CameraScale => {}
            }
        }
        if let [Some(x), Some(y)] = place {
            sizes.marker_m = Some([x, y]);
        }
        sizes
    }

    /// The latency that one fit found for all runs.
    pub(super) fn latency(fitted: &Fit, parameters: &[KinematicParameter]) -> Estimated {
        let index = parameters.iter().position(|p| *p == KinematicParameter::CameraLatency);
        index.map_or(Estimated { value: 0.0, ci95: [0.0; 2] }, |i| Estimated::of(fitted, i))
    }

    /// Whether a robot can have these sizes.
    pub(super) fn are_sound(&self) -> bool {
        let one = [self.wheel_radius, self.body_radius, self.sideways];
        one.iter().flatten().chain(&self.wheel_radii).all(|s| s.value.abs() < MOST)
    }

    /// The latency that the runs share, given how much their clocks differ: its interval from their scatter.
    pub(super) fn common_clock(&self) -> Option<Estimated> {
        let n = self.clocks_s.len();
        if n == 0 {
            return None;
        }
        let mean = self.clocks_s.iter().map(|c| c.value).sum::<f64>() / n as f64;
        let squares = self.clocks_s.iter().map(|c| (c.value - mean).powi(2)).sum::<f64>();
        // Two clocks or three say next to nothing about the next one.
        let half = if n > 3 { t_quantile_975(n - 1) * (squares / ((n - 1) * n) as f64).sqrt() } else { f64::INFINITY };
        Some(Estimated { value: mean, ci95: [mean - half, mean + half] })
    }

    pub(super) fn to_json(&self, parts: &[Part]) -> Value {
        let each = |list: &[Estimated]| list.iter().map(|e| e.to_json()).collect::<Vec<_>>();
        json!({
            "wheel_radius_scale": self.wheel_radius.map(Estimated::to_json),
            "wheel_radius_scale_each": each(&self.wheel_radii),
            "body_radius_scale": self.body_radius.map(Estimated::to_json),
            "sideways_scale": self.sideways.map(Estimated::to_json),
            "marker_m": self.marker_m.map(|m| m.map(Estimated::to_json)),
            "marker_heading_rad": self.marker_heading.map(Estimated::to_json),
            "clock_offset_s": each(&self.clocks_s),
            "instead_of_skew": !parts.contains(&Part::Skews),
        })
    }

    /// The robot with these sizes: what its file has a key for there, the rest as effects.
    pub(super) fn apply(&self, robot: &mut Robot) {
        if let Some(radius) = self.wheel_radius {
            robot.wheel_radius_m *= 1.0 + radius.value;
        }
        if let Some(body) = self.body_radius {
            let scale = 1.0 + body.value;
            match &mut robot.layout {
                Layout::Rac { body_radius_m, .. } => *body_radius_m *= scale,
                Layout::Wheels(wheels) => wheels.iter_mut().for_each(|w| {
                    w.x_m *= scale;
                    w.y_m *= scale;
                }),
            }
        }
        let mut add = |name: &str, wheels: Vec<usize>, parameters| {
            robot.effects.push(Effect { name: name.to_owned(), wheels, parameters, ..Effect::default() });
        };
        if !self.wheel_radii.is_empty() {
            let radii = self.wheel_radii.iter().enumerate();
            let radii = radii.map(|(i, r)| r.effect_parameter(&format!("scale_{}", i + 1))).collect();
            add("wheel-radius", (1..=self.wheel_radii.len()).collect(), radii);
        }
        if let Some(sideways) = self.sideways {
            add("sideways-creep", Vec::new(), vec![sideways.effect_parameter("scale")]);
        }
        if let Some([x, y]) = self.marker_m {
            add("marker-offset", Vec::new(), vec![x.effect_parameter("x_m"), y.effect_parameter("y_m")]);
        }
        if let Some(heading) = self.marker_heading {
            add("marker-heading", Vec::new(), vec![heading.effect_parameter("angle_rad")]);
        }
    }

    /// In sentences.
    pub(super) fn remarks(&self, skewed: bool) -> Vec<String> {
        let mut parts = Vec::new();
        if let Some(radius) = self.wheel_radius {
            parts.push(format!("wheel radius {}", radius.percent()));
        }
        for (i, radius) in self.wheel_radii.iter().enumerate() {
            parts.push(format!("radius of wheel {} {}", i + 1, radius.percent()));
        }
        if let Some(body) = self.body_radius {
            parts.push(format!("body radius {}", body.percent()));
        }
        let sizes = !parts.is_empty();
        if let Some(sideways) = self.sideways {
            parts.push(format!("sideways motion {} (rollers that give way)", sideways.percent()));
        }
        if let Some([x, y]) = self.marker_m {
            let half = |e: Estimated| 5e2 * (e.ci95[1] - e.ci95[0]);
            let (x, y, dx, dy) = (1e3 * x.value, 1e3 * y.value, half(x), half(y));
            parts.push(format!(
                "marker {x:+.1} mm (± {dx:.1}) to the right and {y:+.1} mm (± {dy:.1}) to the front of the centre"
            ));
        }
        let mut remarks = Vec::new();
        if !parts.is_empty() {
            let skew = match (skewed, sizes) {
                (true, _) => "Skews alone do not explain what the camera shows.",
                (false, true) => {
                    "What the camera shows is a radius, not a skew: no wheel needs to be turned beside it."
                }
                (false, false) => "No wheel needs to be turned.",
            };
            remarks.push(format!("{skew} It asks for: {}.", parts.join(", ")));
        }
        if let Some(heading) = self.marker_heading {
            let [low, high] = heading.ci95.map(f64::to_degrees);
            remarks.push(format!(
                "The marker plate is turned by {:+.2} degrees (95 %: {low:+.2} to {high:+.2}) counter-clockwise, or every wheel \
                 is turned by it clockwise: no drive tells the two apart. Measure the plate.",
                heading.value.to_degrees()
            ));
        }
        if !self.clocks_s.is_empty() {
            let each: Vec<String> = self.clocks_s.iter().map(|c| format!("{:+.0}", 1e3 * c.value)).collect();
            remarks.push(format!(
                "The clocks of robot and camera differ from run to run: the camera is later than robot.toml states by {} ms. \
                 Start every run with a jerk that both see, or synchronise the clocks.",
                each.join(", ")
            ));
        }
        remarks
    }
}
