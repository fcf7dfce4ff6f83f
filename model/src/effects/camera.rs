//! Effects of camera and marker plate.

use crate::camera::CameraModel;
use runs::robot::Effect;

/// Applies an effect if it is one of these.
pub(super) fn apply(effect: &Effect, camera: &mut CameraModel) -> bool {
    let value = |name: &str| effect.value(name).unwrap_or(0.0);
    match effect.name.as_str() {
        "camera-latency" => camera.latency_s += value("latency_s"),
        "camera-filter" => {
            camera.filter_s += value("time_s");
            camera.filters_frames |= value("at_frames") > 0.5;
        }
        "camera-scale" => camera.scale += value("scale"),
        "marker-heading" => camera.marker.theta += value("angle_rad"),
        "marker-offset" => {
            camera.marker.x += value("x_m");
            camera.marker.y += value("y_m");
        }
        "lens-distortion" => camera.k1_per_m2 += value("k1_per_m2"),
        "camera-timing" => camera.drop_share += value("dropped"),
        _ => return false,
    }
    true
}
