//! Where the controller believes the robot to be: by odometry alone, or corrected by the camera.

use crate::fusion::{Fusion, FusionOptions};
use crate::imu::{ImuModel, Reading};
use crate::inertial::Inertial;
use crate::measurement::Measurement;
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
    /// Wheels, gyroscope and, where it comes, the camera.
    Inertial {
        /// State, covariance and what waits for a late camera frame.
        filter: Box<Inertial>,
        /// What the sensor says at the coming tick.
        felt: Option<Reading>,
    },
}

impl Localiser {
    /// Odometry from a known start.
    pub fn odometry(robot: &Robot, geometry: &Geometry, start: Pose) -> Self {
        Self::Odometry {
            odometer: Odometer::new(geometry, robot.counts_per_wheel_rad(), DEFAULT_WHEEL_VARIANCE),
            estimate: Estimate::new(start, [0.0; 3]),
        }
    }

    /// Odometry and camera.
    pub fn fused(robot: &Robot, geometry: &Geometry, options: FusionOptions, start: Estimate) -> Self {
        Self::Fused(Box::new(Fusion::new(geometry, robot.counts_per_wheel_rad(), options, start)))
    }

    /// Wheels and gyroscope; the camera may come.
    pub fn inertial(
        robot: &Robot,
        geometry: &Geometry,
        options: FusionOptions,
        sensor: &ImuModel,
        start: Estimate,
    ) -> Self {
        let filter = Inertial::new(geometry, robot.counts_per_wheel_rad(), options, sensor, start);
        Self::Inertial { filter: Box::new(filter), felt: None }
    }

    /// What the inertial sensor says at the coming tick; `None` where it is silent, and the wheels tell the heading.
    pub fn feel(&mut self, reading: Option<Reading>) {
        if let Self::Inertial { felt, .. } = self {
            *felt = reading;
        }
    }

    /// Whether the wheels slip, where somebody can tell.
    pub fn slips(&self) -> bool {
        matches!(self, Self::Inertial { filter, .. } if filter.slipping())
    }

    /// One control tick at time `t` (s): counts, and what the camera delivered, if anything.
    pub fn tick(&mut self, t: f64, counts: &[i64], seen: Option<Measurement>) -> Pose {
        match self {
            Self::Odometry { odometer, estimate } => {
                *estimate = estimate.moved(&odometer.increment(counts));
                estimate.pose
            }
            Self::Fused(fusion) => {
                fusion.predict(t, counts);
                if let Some(seen) = seen {
                    fusion.correct(t, seen);
                }
                fusion.pose()
            }
            Self::Inertial { filter, felt } => {
                match felt.take() {
                    Some(reading) => filter.predict(t, counts, &reading),
                    None => filter.predict_by_wheels(t, counts),
                }
                if let Some(seen) = seen {
                    filter.correct(t, seen);
                }
                filter.pose()
            }
        }
    }

    /// Pose and covariance now.
    pub fn estimate(&self) -> Estimate {
        match self {
            Self::Odometry { estimate, .. } => *estimate,
            Self::Fused(fusion) => fusion.estimate(),
            Self::Inertial { filter, .. } => filter.estimate(),
        }
    }
}
