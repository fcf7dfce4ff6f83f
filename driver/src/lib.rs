//! The host's side of the card: registers, units, and the board that drives the robot.
//!
//! Two seams. [`PciCard`] is what loading needs: bytes and words in the card's windows.
//! [`Registers`] is what control needs: whatever answers aligned 32-bit reads and writes can be driven,
//! the bit-true model as well as compiled Verilog; a [`RegisterWindow`] makes it of a card.
//! [`Scale`] is the one place that knows seconds and radians; [`Board`] is the protocol: identify,
//! configure, arm, command, read snapshots.

mod board;
pub mod pci;
mod registers;
mod scale;

pub use board::{Board, BoardError, Identity, Settings, Snapshot, Status};
pub use pci::{Bar, PciCard, PciError, RegisterWindow};
pub use registers::{BusError, Recorder, Registers, Transfer};
pub use scale::{PWM_FREQUENCY_HZ, Scale, ScaleError};
