//! What a robot without a PC gets over its radio instead of a host on the bus.

mod base_station;
mod line;

pub use base_station::{BaseStation, Sent};
pub use line::{HexLine, Line, SerialLine};

use crate::{Board, BoardError, Recorder, Scale, Settings, Transfer};
use fixed_kin::card::Card;
use fixed_kin::control::SET_POINT_WORDS;
use fixed_kin::radio::{Frame, FrameError};
use fixed_kin::registers as map;

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
/// that has switched off is armed again by the same frame under a new sequence number: stalls, encoder errors and
/// faults that were seen are cleared by it, as [`Board::arm`] does; one whose cause stands keeps the robot off.
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
    frame.set_points([0; SET_POINT_WORDS])?;
    for sticky in [&map::STALL, &map::ENCODER_ERROR, &map::FAULTS] {
        frame.write(sticky.offset, u32::MAX)?;
    }
    frame.arm()?;
    Ok(frame)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fixed_kin::card::Pins;
    use runs::frames::Twist;
    use runs::robot::Robot;

    const ROBOT: u8 = 3;

    #[test]
    fn a_boot_frame_arms_again_after_an_encoder_error_and_after_a_stall() {
        let scale = Scale::new(&Robot::racbot(), 33_333_333.0).unwrap();
        let mut sequence = 0_u8;
        let mut next = || {
            sequence = sequence.wrapping_add(1);
            sequence
        };
        let mut card = Card::slave(0, ROBOT);
        card.tick(&Pins::default());
        let boots = |card: &mut Card, sequence: u8| {
            card.receive(boot(ROBOT, sequence, &scale, &Settings::default()).unwrap().bytes()).unwrap();
            card.armed()
        };
        assert!(boots(&mut card, next()));
        card.tick(&Pins { encoder_errors: 0b0001, ..Pins::default() });
        assert!(!card.armed());
        assert!(boots(&mut card, next()), "the encoder's error stands, {:#x}", card.read(map::FAULTS.offset));
        // Driven, and no encoder moves.
        let mut ticks = 0;
        while card.armed() && ticks < 1_000 {
            let mut frame = Frame::new(ROBOT, next()).unwrap();
            let [x, y, omega] = scale.twist_words(Twist { vx: 1.0, vy: 0.0, omega: 0.0 }).map(|word| word as u32);
            frame.set_points([x, y, omega, 0]).unwrap();
            card.receive(frame.bytes()).unwrap();
            card.tick(&Pins::default());
            ticks += 1;
        }
        assert_ne!(card.read(map::STALL.offset), 0);
        assert!(boots(&mut card, next()), "the stall stands, {:#x}", card.read(map::FAULTS.offset));
        // What stands keeps the robot off.
        card.tick(&Pins { emergency_stop: true, ..Pins::default() });
        assert!(!boots(&mut card, next()));
    }
}
