//! The virtual robot: driver code → registers → FPGA → motors and body → encoders → FPGA.
//!
//! ```text
//!        ┌────────── snapshot ──────────┐
//!        ▼                              │
//!  controller ──► driver ──► registers: FPGA ──duty──► motors, body ──┐
//!        ▲                              ▲                              │
//!        └── camera                     └───────── encoders ───────────┘
//! ```
//!
//! The controller is [`driver::drive::Plan`], the loop that drives a real robot.

mod drive;
mod memory;
pub mod picture;
mod robot;

pub use drive::{Drive, Driven};
pub use driver::drive::{Control, Ending};
pub use robot::{Moment, VirtualRobot};

use crate::error::FpgaError;
use driver::drive::DriveError;
use driver::recording::RecordingError;
use driver::{BoardError, ScaleError};
use fixed_kin::registers::NOMINAL_CLOCK_HZ;
use runs::geometry::GeometryError;

/// A virtual robot that cannot be set up, or whose card failed.
#[derive(Debug, thiserror::Error)]
pub enum LoopError {
    /// Robot, wheels or card are not fit to drive.
    #[error(transparent)]
    Drive(#[from] DriveError),
    /// The FPGA's simulation failed.
    #[error(transparent)]
    Fpga(#[from] FpgaError),
    /// The log could not be kept.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// No thread for the log.
    #[error("the log cannot be kept: {0}")]
    Thread(#[from] std::io::Error),
}

macro_rules! through_drive {
    ($($cause:ty),*) => {$(
        impl From<$cause> for LoopError {
            fn from(cause: $cause) -> Self {
                Self::Drive(cause.into())
            }
        }
    )*};
}
through_drive!(ScaleError, GeometryError, BoardError);

/// The clock near the nominal one at which a control period is a whole number of clocks, so that a
/// simulated tick is exactly 1 / `rate_hz` long.
#[must_use]
pub fn whole_tick_clock_hz(rate_hz: f64) -> f64 {
    (f64::from(NOMINAL_CLOCK_HZ) / rate_hz).round().max(1.0) * rate_hz
}
