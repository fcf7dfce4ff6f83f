//! The host's side of the card: registers, units, and the board that drives the robot.
//!
//! [`bitstream`] reads and checks files, [`load`] brings them onto the card and verifies what runs there.
//!
//! Two seams. [`PciCard`] is what loading needs: bytes and words in the card's windows.
//! [`Registers`] is what control needs: whatever answers aligned 32-bit reads and writes can be driven,
//! the bit-true model as well as compiled Verilog; a [`RegisterWindow`] makes it of a card.
//! [`Scale`] is the one place that knows seconds and radians; [`Board`] is the protocol: identify,
//! configure, arm, command, read snapshots. [`imu`] is the inertial sensor behind it. [`drive`] is the control loop over all that, [`realtime`] its
//! time, [`recording`] its way to a file.
//!
//! ```
//! use driver::{Board, Scale, Settings, fault_names};
//! use fixed_kin::card::{Card, Pins};
//! use runs::frames::Twist;
//! use runs::robot::Robot;
//!
//! // The bit-true card is a bus like any other; a real one is a `RegisterWindow`.
//! let scale = Scale::new(&Robot::racbot(), 33_333_333.0)?;
//! let mut board = Board::new(Card::new(0));
//! board.identify()?;
//! board.configure(&scale, &Settings::default())?;
//! board.bus.tick(&Pins::default());
//! board.arm()?;
//! board.set_twist(&scale, Twist::new(0.0, 0.5, 0.0))?;
//! board.bus.tick(&Pins::default());
//! assert!(board.snapshot()?.duties.iter().any(|duty| *duty != 0));
//!
//! // The emergency stop switches off, and off it stays until somebody arms anew.
//! board.bus.tick(&Pins { emergency_stop: true, ..Pins::default() });
//! board.bus.tick(&Pins::default());
//! assert!(!board.status()?.armed);
//! assert_eq!(fault_names(board.first_fault()?), "emergency-stop");
//! board.arm()?;
//! assert!(board.status()?.armed);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

// A file in which casts are the point says so itself.
#![cfg_attr(not(test), warn(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_possible_wrap))]

pub use ::bitstream::container as bitstream;
mod board;
pub mod design;
pub mod drive;
pub mod imu;
pub mod load;
mod observation;
pub mod pci;
pub mod plx9030;
pub mod radio;
pub mod realtime;
pub mod recording;
mod registers;
mod scale;

pub use board::{Board, BoardError, Identity, Settings, Snapshot, Standing, Status, fault_names};
pub use observation::Observation;
pub use pci::{Bar, PciCard, PciError, RegisterWindow};
pub use registers::{BusError, Recorder, Registers, Transfer};
pub use scale::{PWM_FREQUENCY_HZ, Scale, ScaleError};
