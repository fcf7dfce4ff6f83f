//! Effects on where the wheels are and how far they roll.

use super::of_wheel;
use crate::robot::{Effect, Layout, Robot};

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
