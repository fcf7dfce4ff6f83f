//! Effects on where the wheels are and how far they roll.

use super::of_wheel;
use runs::robot::{Effect, Layout, Robot};

/// Stem of the parameters that say which wheel an axis is wired to.
pub(super) const CABLE: &str = "cable_";

/// Wires the axes to other wheels, as `wheel-order` says: motor and encoder of axis i are those of wheel
/// |cable_i|, inverted where it is negative. Whether that is all the effect says.
pub(super) fn cables(effect: &Effect, robot: &mut Robot) -> bool {
    if effect.name != "wheel-order" || !effect.parameters.iter().any(|(name, _)| name.starts_with(CABLE)) {
        return false;
    }
    let wheels = robot.layout.wheels();
    let wired = (0..wheels.len()).map(|i| {
        let cable = effect.value(&format!("{CABLE}{}", i + 1)).unwrap_or(i as f64 + 1.0);
        let mut wheel = wheels[(cable.abs().round() as usize).clamp(1, wheels.len()) - 1];
        if cable < 0.0 {
            wheel.drive_rad += std::f64::consts::PI;
        }
        wheel
    });
    robot.layout = Layout::Wheels(wired.collect());
    effect.parameters.iter().all(|(name, _)| name.starts_with(CABLE))
}

/// Applies an effect if it is one of these.
pub(super) fn apply(effect: &Effect, robot: &mut Robot) -> bool {
    let scale = 1.0 + effect.value("scale").unwrap_or(0.0);
    let mut wheels = robot.layout.wheels();
    match effect.name.as_str() {
        "wheel-skew" => {
            for (i, w) in wheels.iter_mut().enumerate() {
                w.drive_rad -= of_wheel(effect, "skew", i, "rad");
            }
        }
        "wheel-angle" => {
            for (i, w) in wheels.iter_mut().enumerate() {
                let angle = of_wheel(effect, "angle", i, "rad");
                let (s, c) = angle.sin_cos();
                (w.x_m, w.y_m) = (c * w.x_m - s * w.y_m, s * w.x_m + c * w.y_m);
                w.drive_rad += angle;
            }
        }
        "body-radius" => {
            for w in &mut wheels {
                w.x_m *= scale;
                w.y_m *= scale;
            }
        }
        "wheel-radius-common" => {
            robot.wheel_radius_m *= scale;
            return true;
        }
        _ => return false,
    }
    robot.layout = Layout::Wheels(wheels);
    true
}
