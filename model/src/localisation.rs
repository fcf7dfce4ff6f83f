//! Where the controller believes the robot to be: by odometry alone, or corrected by the camera.

use crate::fusion::{Fusion, FusionOptions};
use crate::odometry::{DEFAULT_WHEEL_VARIANCE, Estimate, Odometer};
use runs::frames::Pose;
use runs::geometry::Geometry;
use runs::robot::Robot;

/// The paper's two modes.
#[derive(Debug, Clone)]
pub enum Localiser {
    /// Open: odometry only.
    Odometry {
        /// Counts to displacements.
        odometer: Odometer,
        /// Pose and covariance.
        estimate: Estimate,
    },
    /// Closed: odometry carries the fast loop, the camera corrects slowly.
    Fused(Box<Fusion>),
}

impl Localiser {
    /// Odometry from a known start.
    pub fn odometry(robot: &Robot, geometry: &Geometry, start: Pose) -> Self {
        Self::Odometry {
            odometer: Odometer::new(geometry, robot.counts_per_wheel_rad(), DEFAULT_WHEEL_VARIANCE),
            estimate: Estimate::new(start, [0.0; 3]),
        }
    }

    /// Odometry and camera, from a start known to the camera's noise.
    pub fn fused(robot: &Robot, geometry: &Geometry, options: FusionOptions, start: Pose) -> Self {
        let sd = options.camera_noise;
        Self::Fused(Box::new(Fusion::new(geometry, robot.counts_per_wheel_rad(), options, start, sd)))
    }

    /// One control tick at time `t` (s): counts, and what the camera delivered, if anything.
    pub fn tick(&mut self, t: f64, counts: &[i64], seen: Option<Pose>) -> Pose {
        match self {
            Self::Odometry { odometer, estimate } => {
                *estimate = estimate.moved(&odometer.increment(counts));
                estimate.pose
            }
            Self::Fused(fusion) => {
                fusion.predict(t, counts);
                if let Some(pose) = seen {
                    fusion.correct(t, pose);
                }
                fusion.pose()
            }
        }
    }

    /// Pose and covariance now.
    pub fn estimate(&self) -> Estimate {
        match self {
            Self::Odometry { estimate, .. } => *estimate,
            Self::Fused(fusion) => fusion.estimate(),
        }
    }
}
