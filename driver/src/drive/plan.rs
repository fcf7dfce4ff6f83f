//! What to drive, and what the controller believes of the robot.

use super::{Control, DriveError};
use crate::imu::Imu;
use crate::{Scale, Settings};
use fixed_kin::speed::SpeedMode;
use model::effects::Applied;
use model::fusion::FusionOptions;
use model::localisation::Localiser;
use model::odometry::{Covariance, Estimate};
use model::trajectory::SetPoint;
use runs::frames::Pose;
use runs::geometry::GeometryError;
use runs::robot::Robot;

/// What to drive.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The robot; its effects are honoured where the card or the controller can: skew, angles and radii go
    /// into the coefficient registers, the camera's latency into the fusion.
    pub robot: Robot,
    /// Where to go.
    pub set_points: Vec<SetPoint>,
    /// Who steers.
    pub control: Control,
    /// Where the robot stands.
    pub start: Pose,
    /// How well that is known; without it, as a pose of the robot's camera.
    pub start_covariance: Option<Covariance>,
    /// Whether poses from outside correct the controller's; else odometry is all it has.
    pub fused: bool,
    /// Standard deviation of the place in its worst direction, m, above which the robot stops and looks round, and gives up
    /// where that tells it no more; without it, it drives on whatever it knows.
    pub sure_m: Option<f64>,
    /// Speeds and time-outs.
    pub settings: Settings,
    /// Longest drive, s.
    pub limit_s: f64,
}

impl Plan {
    /// Set points for a robot that stands at the origin.
    #[must_use]
    pub fn new(robot: &Robot, set_points: &[SetPoint]) -> Self {
        // A slow control loop commits seldom.
        let defaults = Settings::default();
        let watchdog_s = defaults.watchdog_s.max(5.0 * robot.tick_s());
        Self {
            robot: robot.clone(),
            set_points: set_points.to_vec(),
            control: Control::default(),
            start: Pose::default(),
            start_covariance: None,
            fused: false,
            sure_m: None,
            settings: Settings { watchdog_s, speed_mode: SpeedMode::Difference, ..defaults },
            limit_s: 60.0,
        }
    }

    /// The robot as the controller believes it to be: its effects on geometry and the camera's latency are in
    /// its numbers and no longer effects, so that nothing applies them twice.
    #[must_use]
    pub fn believed(&self) -> Robot {
        let mut robot = Applied::geometry_of(&self.robot);
        let latency = robot.effect("camera-latency").and_then(|effect| effect.value("latency_s")).unwrap_or(0.0);
        robot.camera_latency_s = (robot.camera_latency_s + latency).max(0.0);
        robot.effects.retain(|effect| effect.name != "camera-latency");
        robot
    }

    /// What tells the controller where the robot is, with an inertial sensor if the heading follows it.
    ///
    /// # Errors
    /// As [`Self::localiser`].
    pub fn localiser_with(&self, imu: Option<&Imu>) -> Result<Localiser, GeometryError> {
        let Some(imu) = imu.filter(|imu| imu.steers()) else { return self.localiser() };
        let robot = self.believed();
        let geometry = robot.geometry()?;
        let options = FusionOptions::of(&robot).uncalibrated();
        Ok(Localiser::inertial(&robot, &geometry, options, &imu.model(robot.control_rate_hz), self.told(&options)))
    }

    /// What tells the controller where the robot is.
    ///
    /// # Errors
    /// [`GeometryError`] where the wheels do not tell how the robot moves.
    pub fn localiser(&self) -> Result<Localiser, GeometryError> {
        let robot = self.believed();
        let geometry = robot.geometry()?;
        Ok(if self.fused {
            let options = FusionOptions::of(&robot).uncalibrated();
            Localiser::fused(&robot, &geometry, options, self.told(&options))
        } else {
            Localiser::odometry(&robot, &geometry, self.start)
        })
    }

    /// What the filter is told of the start.
    fn told(&self, options: &FusionOptions) -> Estimate {
        let covariance = self.start_covariance.unwrap_or(Estimate::new(self.start, options.camera_noise).covariance);
        Estimate { pose: self.start, covariance }
    }

    /// Conversions for this plan on a card with this clock.
    ///
    /// # Errors
    /// [`DriveError::Scale`] where the robot does not fit the card.
    pub fn scale(&self, clock_hz: f64) -> Result<Scale, DriveError> {
        Ok(Scale::new(&self.believed(), clock_hz)?)
    }
}
