//! What a robot without a PC gets over its radio instead of a host on the bus.

mod base_station;
mod line;

pub use base_station::{BaseStation, Sent};
pub use line::{HexLine, Line, SerialLine};

use crate::{Board, BoardError, Recorder, Scale, Settings, Transfer};
use fixed_kin::card::Card;
use fixed_kin::control::SET_POINT_WORDS;
use fixed_kin::radio::{Frame, FrameError};

/// Why there is no such frame.
#[derive(Debug, thiserror::Error)]
pub enum RadioError {
    /// The configuration does not fit the card.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// It does not fit a frame.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// The line does not take it.
    #[error("the line: {0}")]
    Line(#[from] std::io::Error),
}

/// The frame that configures and arms a robot: registers, gains, matrices and limits as
/// [`Board::configure`] writes them, set points of zero, the two words that arm.
///
/// It acts as a whole or not at all, so a robot that is armed by it has all of its configuration. A robot
/// that has switched off is armed again by the same frame under a new sequence number; faults that were
/// seen are cleared by it, one that stands keeps the robot off.
///
/// # Errors
/// [`RadioError`]: values that no register takes, or a robot number above 15.
pub fn boot(robot: u8, sequence: u8, scale: &Scale, settings: &Settings) -> Result<Frame, RadioError> {
    let mut frame = Frame::new(robot, sequence)?;
    let mut board = Board::new(Recorder::new(Card::new(0)));
    board.configure(scale, settings)?;
    for transfer in &board.bus.transfers {
        if let Transfer::Write(offset, data) = *transfer {
            frame.write(offset, data)?;
        }
    }
    frame.write(fixed_kin::registers::FAULTS.offset, u32::MAX)?;
    frame.set_points([0; SET_POINT_WORDS])?;
    frame.arm()?;
    Ok(frame)
}
