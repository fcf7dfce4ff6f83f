//! Who makes body velocities out of set points.

use model::trajectory::{Arrival, Follower, FollowerOptions, Limits, MotionController, SetPoint};
use runs::frames::{Pose, Twist};
use runs::geometry::GeometryError;
use runs::robot::Robot;

/// Which controller drives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Control {
    /// Limits of speed and acceleration, corners and stops: for robots with mass.
    #[default]
    Follower,
    /// The paper's: straight at the next set point with its speed at once.
    Paper,
}

/// Distance at which the paper's controller takes a set point as reached, m. A robot with mass that
/// comes at 1 m/s would circle around a smaller one.
const PAPER_TOLERANCE_M: f64 = 0.05;

/// A controller on its way.
#[derive(Debug)]
pub enum Controller {
    /// With limits.
    Follower(Box<Follower>),
    /// Positions by the controller of the 2005 paper, one set point after the other.
    Paper {
        /// Turns set points and poses into velocities of the body.
        motion: MotionController,
        /// Set points in order of time.
        points: Vec<SetPoint>,
        /// What became of them.
        arrivals: Vec<Arrival>,
        /// Time, s.
        t: f64,
    },
}

impl Controller {
    /// A controller at `start`, at rest.
    ///
    /// # Errors
    /// [`GeometryError`] where the wheels cannot drive the robot.
    pub fn new(control: Control, robot: &Robot, points: &[SetPoint], start: Pose) -> Result<Self, GeometryError> {
        Ok(match control {
            Control::Follower => {
                let (geometry, limits) = (robot.geometry()?, Limits::of(robot)?);
                Self::Follower(Box::new(Follower::new(points, start, &geometry, limits, FollowerOptions::of(robot)?)))
            }
            Control::Paper => Self::Paper {
                motion: MotionController::new(points, PAPER_TOLERANCE_M),
                points: points.to_vec(),
                arrivals: vec![Arrival::Pending; points.len()],
                t: 0.0,
            },
        })
    }
}

/// Who steers: makes the body velocity of every tick.
pub trait Steer {
    /// The body velocity for the coming `dt` seconds, or `None` once there is nothing left to do. Must neither wait nor
    /// allocate.
    fn command(&mut self, pose: Pose, dt: f64) -> Option<Twist>;

    /// The body velocity that brings the robot to rest in its place, turning at a rate (rad/s), while it must not go on. Must
    /// neither wait nor allocate.
    fn hold(&mut self, pose: Pose, turn: f64, dt: f64) -> Twist {
        let _ = (pose, dt);
        Twist::new(0.0, 0.0, turn)
    }

    /// What became of each set point so far, where there are any.
    fn arrivals(&self) -> &[Arrival] {
        &[]
    }
}

impl Steer for Controller {
    fn command(&mut self, pose: Pose, dt: f64) -> Option<Twist> {
        match self {
            Self::Follower(follower) => follower.command(pose, dt),
            Self::Paper { motion, points, arrivals, t } => {
                let before = motion.reached();
                let command = motion.command(pose, dt);
                for (arrival, point) in arrivals.iter_mut().zip(points).take(motion.reached()).skip(before) {
                    *arrival = Arrival::Reached { t: *t, miss_m: (pose.x - point.x).hypot(pose.y - point.y) };
                }
                *t += dt;
                command
            }
        }
    }

    fn hold(&mut self, pose: Pose, turn: f64, dt: f64) -> Twist {
        match self {
            Self::Follower(follower) => follower.hold(pose, turn, dt),
            Self::Paper { t, .. } => {
                *t += dt;
                Twist::new(0.0, 0.0, turn)
            }
        }
    }

    fn arrivals(&self) -> &[Arrival] {
        match self {
            Self::Follower(follower) => follower.arrivals(),
            Self::Paper { arrivals, .. } => arrivals,
        }
    }
}
