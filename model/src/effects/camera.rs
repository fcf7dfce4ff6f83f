//! Effects of camera and marker plate.

use crate::camera::CameraModel;
use crate::frames::{Pose, wrap_angle};
use crate::robot::Effect;

/// Applies an effect on when the camera looks, if it is one.
pub(super) fn apply(effect: &Effect, camera: &mut CameraModel) -> bool {
    if effect.name != "camera-latency" {
        return false;
    }
    camera.latency_s += effect.value("latency_s").unwrap_or(0.0);
    true
}

/// Whether an effect is one on what the camera sees.
pub(super) fn is_seen(effect: &Effect) -> bool {
    matches!(effect.name.as_str(), "camera-scale" | "marker-heading" | "marker-offset" | "lens-distortion")
}

/// What the camera sees of a pose.
pub(super) fn seen(effect: &Effect, pose: Pose) -> Pose {
    let value = |name: &str| effect.value(name).unwrap_or(0.0);
    match effect.name.as_str() {
        "camera-scale" => Pose::new((1.0 + value("scale")) * pose.x, (1.0 + value("scale")) * pose.y, pose.theta),
        "marker-heading" => Pose::new(pose.x, pose.y, wrap_angle(pose.theta + value("angle_rad"))),
        "marker-offset" => {
            let moved = pose.compose(Pose::new(value("x_m"), value("y_m"), 0.0));
            Pose::new(moved.x, moved.y, pose.theta)
        }
        "lens-distortion" => {
            let s = 1.0 + value("k1_per_m2") * (pose.x * pose.x + pose.y * pose.y);
            Pose::new(s * pose.x, s * pose.y, pose.theta)
        }
        _ => pose,
    }
}
