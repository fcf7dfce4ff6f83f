//! The host's side of the card: registers, units, and the board that drives the robot.
//!
//! [`Registers`] is the seam: whatever answers aligned 32-bit reads and writes can be driven, the
//! bit-true model as well as compiled Verilog. [`Scale`] is the one place that knows seconds and
//! radians; [`Board`] is the protocol: identify, configure, arm, command, read snapshots.

mod board;
mod registers;
mod scale;

pub use board::{Board, BoardError, Identity, Settings, Snapshot, Status};
pub use registers::{BusError, Recorder, Registers, Transfer};
pub use scale::{PWM_FREQUENCY_HZ, Scale, ScaleError};
