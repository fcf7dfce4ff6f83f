//! The loop.

use super::{Control, Controller, DriveError, Fault, PoseSource, Session};
use crate::realtime::{Clock, Latency};
use crate::recording::Recording;
use crate::{Board, Registers, Scale, Settings, Standing};
use fixed_kin::speed::SpeedMode;
use model::effects::Applied;
use model::fusion::FusionOptions;
use model::localisation::Localiser;
use model::trajectory::{Arrival, SetPoint};
use runs::frames::Pose;
use runs::geometry::GeometryError;
use runs::robot::Robot;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

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
    /// Whether poses from outside correct the controller's; else odometry is all it has.
    pub fused: bool,
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
            fused: false,
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

    /// What tells the controller where the robot is.
    ///
    /// # Errors
    /// [`GeometryError`] where the wheels do not tell how the robot moves.
    pub fn localiser(&self) -> Result<Localiser, GeometryError> {
        let robot = self.believed();
        let geometry = robot.geometry()?;
        Ok(if self.fused {
            Localiser::fused(&robot, &geometry, FusionOptions::of(&robot).uncalibrated(), self.start)
        } else {
            Localiser::odometry(&robot, &geometry, self.start)
        })
    }

    /// Conversions for this plan on a card with this clock.
    ///
    /// # Errors
    /// [`DriveError::Scale`] where the robot does not fit the card.
    pub fn scale(&self, clock_hz: f64) -> Result<Scale, DriveError> {
        Ok(Scale::new(&self.believed(), clock_hz)?)
    }

    /// Drives until the robot rests at the end, has given up, is stopped, or something is wrong.
    ///
    /// # Errors
    /// [`DriveError`] where nothing has moved yet: the card is not ours, cannot be configured or armed.
    pub fn drive<R: Registers>(
        &self,
        board: Board<R>,
        clock: &mut impl Clock,
        clock_hz: f64,
        source: &mut impl PoseSource,
        mut recording: Option<&mut Recording>,
        stop: &AtomicBool,
    ) -> Result<Driven, DriveError> {
        let scale = self.scale(clock_hz)?;
        let steer = Controller::new(self.control, &self.believed(), &self.set_points, self.start)?;
        let mut session = Session::begin(self, scale, steer, board, clock)?;
        let ending = loop {
            session.wait(clock);
            if stop.load(Ordering::Relaxed) {
                break Ending::Stopped;
            }
            if let Some(ending) = session.tick(clock, source, recording.as_deref_mut()) {
                break ending;
            }
        };
        Ok(session.end(ending))
    }
}

/// Why a drive ended.
#[derive(Debug)]
pub enum Ending {
    /// At rest after the last set point.
    Finished,
    /// The longest time was over.
    TimeLimit,
    /// Somebody asked.
    Stopped,
    /// Something is wrong.
    Fault(Fault),
}

/// A drive that was driven.
#[derive(Debug)]
pub struct Driven {
    /// Why it ended.
    pub ending: Ending,
    /// Whether the card said that it is off; if not, its watchdog switches it off.
    pub switched_off: Result<(), Fault>,
    /// What stood in the card's sticky registers before it was armed, and was cleared.
    pub stood: Standing,
    /// What became of each set point.
    pub arrivals: Vec<Arrival>,
    /// Time of the last tick, s.
    pub t: f64,
    /// Where the robot is believed to be.
    pub pose: Pose,
    /// Control ticks of the card that the host saw.
    pub ticks: u64,
    /// Control ticks that went by unseen: the host was late.
    pub unseen: u64,
    /// Snapshots that could not be true and were read again.
    pub reread: u64,
    /// Commits that the card refused by their checksum; each was followed by a new one.
    pub refused: u64,
    /// How late the host woke up.
    pub latency: Latency,
    /// Longest time between two commits.
    pub silence: Duration,
    /// When the pose source fell silent for good, s; it may have begun so.
    pub source_gone: Option<f64>,
    /// Poses that came.
    pub poses: u64,
}
