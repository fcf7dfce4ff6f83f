//! What a calibration asks of a robot: to drive straight and be watched.

use std::f64::consts::PI;

use crate::simulation::VirtualRobot;
use runs::frames::{Pose, Twist, wrap_angle};
use runs::geometry::Geometry;

/// Why a drive did not happen.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct DriveError(pub String);

/// A robot, virtual or real, that can be sent along a straight line under a camera.
pub trait Drives {
    /// Drives `distance_m` along a body direction (rad from body x, counter-clockwise) with ω = 0,
    /// wheel speeds computed with the `believed` geometry. Returns what the camera saw, from rest
    /// before the drive to rest after it.
    ///
    /// # Errors
    /// [`DriveError`] if the robot does not drive.
    fn drive_straight(
        &mut self,
        believed: &Geometry,
        direction_rad: f64,
        distance_m: f64,
    ) -> Result<Vec<Pose>, DriveError>;
}

/// Speed of calibration drives, m/s.
const SPEED: f64 = 0.6;

impl Drives for VirtualRobot {
    fn drive_straight(
        &mut self,
        believed: &Geometry,
        direction_rad: f64,
        distance_m: f64,
    ) -> Result<Vec<Pose>, DriveError> {
        let first = self.log().camera.len();
        self.drive(Twist::default(), 0.3, believed);
        let (s, c) = direction_rad.sin_cos();
        self.drive(Twist::new(SPEED * c, SPEED * s, 0.0), distance_m / SPEED, believed);
        self.drive(Twist::default(), 0.3, believed);
        Ok(self.log().camera[first..].iter().map(|sample| sample.pose).collect())
    }
}

/// What a straight drive shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Straightness {
    /// Change of heading per metre, rad/m; 0 for a straight line.
    pub heading_per_m: f64,
    /// Direction of travel beside the commanded one, in the body frame, counter-clockwise, rad.
    pub direction_error: f64,
    /// Distance from start to end, m.
    pub distance_m: f64,
}

/// Frames averaged at either end, at rest.
const REST_FRAMES: usize = 8;

impl Straightness {
    /// From camera poses between rest and rest.
    ///
    /// # Errors
    /// [`DriveError`] if there are too few frames or the robot has not moved.
    pub fn of(seen: &[Pose], direction_rad: f64) -> Result<Self, DriveError> {
        if seen.len() < 2 * REST_FRAMES {
            return Err(DriveError(format!("the camera saw the robot only {} times during a drive", seen.len())));
        }
        let (start, end) = (mean(&seen[..REST_FRAMES]), mean(&seen[seen.len() - REST_FRAMES..]));
        let moved = start.relative(end);
        let distance_m = moved.x.hypot(moved.y);
        if distance_m < 0.05 {
            return Err(DriveError(format!("the robot only moved by {:.0} mm", distance_m * 1e3)));
        }
        let turned = wrap_angle(moved.theta);
        // The chord of an arc points half the turn beside its start direction.
        let direction = moved.y.atan2(moved.x) - 0.5 * turned;
        Ok(Self {
            heading_per_m: turned / distance_m,
            direction_error: wrap_angle(direction - direction_rad),
            distance_m,
        })
    }
}

/// Mean of poses that are close together.
fn mean(poses: &[Pose]) -> Pose {
    let n = poses.len() as f64;
    let first = poses[0].theta;
    let sum = poses
        .iter()
        .fold(Pose::default(), |s, p| Pose::new(s.x + p.x, s.y + p.y, s.theta + wrap_angle(p.theta - first)));
    Pose::new(sum.x / n, sum.y / n, first + sum.theta / n)
}

/// The direction in which a robot comes back.
pub(super) fn opposite(direction_rad: f64) -> f64 {
    wrap_angle(direction_rad + PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arc_gives_its_curvature_and_its_direction() {
        let start = Pose::new(1.0, -2.0, 3.0);
        let (direction, turned) = (0.4_f64, 0.3);
        let twist = Twist::new((direction + 0.02).cos(), (direction + 0.02).sin(), turned);
        let mut seen = vec![start; REST_FRAMES];
        seen.extend((0..=20).map(|k| start.advance(twist, f64::from(k) / 20.0)));
        seen.extend([start.advance(twist, 1.0); REST_FRAMES]);
        let s = Straightness::of(&seen, direction).unwrap();
        assert!((s.heading_per_m - 0.3).abs() < 2e-3, "{s:?}");
        assert!((s.direction_error - 0.02).abs() < 1e-9, "{s:?}");
    }

    #[test]
    fn drives_that_show_nothing_are_errors() {
        assert!(Straightness::of(&[Pose::default(); 40], 0.0).unwrap_err().0.contains("only moved by 0 mm"));
        assert!(Straightness::of(&[Pose::default(); 3], 0.0).unwrap_err().0.contains("only 3 times"));
    }
}
