//! Driving: set points to motion, over any card, by any clock.
//!
//! ```text
//!  timer ─► snapshot ─► plausible? ─► localise ─► steer ─► commit ─► record ─► watch ─┐
//!    ▲                                                                               │
//!    └───────────────────────────── every control period ────────────────────────────┘
//! ```
//!
//! Nothing in the loop waits for anything but the timer and the bus, and nothing allocates. Whatever ends
//! it, the outputs are off afterwards: at once by [`Armed`], or by the card's watchdog where the bus or the
//! process is gone.

mod armed;
mod controller;
mod fault;
mod heading;
mod kick;
mod outcome;
mod plan;
mod run;
mod session;
mod source;
mod sure;
mod watch;

pub use armed::Armed;
pub use controller::{Control, Controller, Steer};
pub use fault::Fault;
pub use kick::{Kick, KickError, Kicked};
pub use outcome::{Driven, Ending};
pub use plan::Plan;
pub use session::Session;
pub use source::{NoSource, PoseSource};

use crate::imu::ImuError;
use crate::{BoardError, ScaleError};
use runs::geometry::GeometryError;

/// A drive that could not begin.
#[derive(Debug, thiserror::Error)]
pub enum DriveError {
    /// The robot does not fit the card.
    #[error(transparent)]
    Scale(#[from] ScaleError),
    /// The wheels cannot drive the robot.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// The card is not ready.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// The inertial sensor cannot be used.
    #[error(transparent)]
    Imu(#[from] ImuError),
}
