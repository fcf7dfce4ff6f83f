//! What came of a drive.

use super::Fault;
use crate::Standing;
use crate::imu::Imu;
use crate::realtime::Latency;
use model::odometry::Estimate;
use model::trajectory::Arrival;
use std::time::Duration;

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

/// What came of a drive, from arming to switching off.
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
    /// Where the robot is believed to be, and how well that is known.
    pub belief: Estimate,
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
    /// The inertial sensor as it was found, where the robot has one.
    pub imu: Option<Imu>,
    /// When the inertial sensor fell silent for good, s, where the robot has one.
    pub imu_gone: Option<f64>,
    /// Times that wheels and inertial sensor began to disagree: slip.
    pub slips: u64,
    /// Times that the robot stopped to look round, for it no longer knew where it was.
    pub lost: u64,
    /// Poses that came.
    pub poses: u64,
}
