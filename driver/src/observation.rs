//! What somebody who only looks may see of a card, beside whoever drives it.

use crate::{Board, BoardError, Registers, Snapshot, Status};
use fixed_kin::AXES;
use fixed_kin::control::SET_POINT_WORDS;
use fixed_kin::format::Duty;
use fixed_kin::registers as map;

/// Live registers, and a snapshot where nobody is disturbed by one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// Live status.
    pub status: Status,
    /// Sticky faults.
    pub faults: u32,
    /// What came first.
    pub first_fault: u32,
    /// Commits accepted and rejected, wrapping at 2^16.
    pub commits: [u32; 2],
    /// Clocks since configuration, wrapping.
    pub time: u32,
    /// Encoder lines A, B and index of every axis.
    pub lines: [[bool; 3]; AXES],
    /// Axes whose encoder made an illegal step.
    pub encoder_errors: u32,
    /// Set points in force.
    pub set_points: [i32; SET_POINT_WORDS],
    /// Integrators of the speed loops, as duty.
    pub integrals: [f64; AXES],
    /// Kicker status register.
    pub kicker: u32,
    /// Counts, speeds and duties of one tick; nothing while the card is armed, because reading a snapshot
    /// latches it, and the one who drives would get that instead of a new one.
    pub snapshot: Option<Snapshot>,
}

impl Observation {
    /// Looks; nothing is written.
    ///
    /// # Errors
    /// A card that does not answer.
    pub fn of<R: Registers>(board: &mut Board<R>) -> Result<Self, BoardError> {
        let status = board.status()?;
        let mut read = |register: &map::Register, index: usize| board.bus.read(register.at(index));
        let commits = read(&map::COMMITS, 0)?;
        let lines = read(&map::ENCODER_LINES, 0)?;
        let mut set_points = [0; SET_POINT_WORDS];
        for (index, word) in set_points.iter_mut().enumerate() {
            *word = read(&map::ACTIVE_SET_POINTS, index)?.cast_signed();
        }
        let mut integrals = [0.0; AXES];
        for (index, integral) in integrals.iter_mut().enumerate() {
            *integral = f64::from(Duty::from_bits(read(&map::INTEGRALS, index)?.cast_signed()));
        }
        let line = |bit: usize| lines >> bit & 1 == 1;
        let mut seen = Self {
            status,
            faults: read(&map::FAULTS, 0)?,
            first_fault: read(&map::FIRST_FAULT, 0)?,
            commits: [map::COMMITS_ACCEPTED.of(commits), map::COMMITS_REJECTED.of(commits)],
            time: read(&map::TIME, 0)?,
            lines: std::array::from_fn(|axis| [line(2 * axis), line(2 * axis + 1), line(8 + axis)]),
            encoder_errors: read(&map::ENCODER_ERROR, 0)?,
            set_points,
            integrals,
            kicker: read(&map::KICKER_STATUS, 0)?,
            snapshot: None,
        };
        if !status.armed {
            seen.snapshot = Some(board.snapshot()?);
        }
        Ok(seen)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Recorder, Transfer};
    use fixed_kin::card::{Card, Pins};

    #[test]
    fn looking_writes_nothing_and_leaves_the_snapshot_of_a_drive_alone() {
        let mut board = Board::new(Recorder::new(Card::new(3)));
        board.bus.inner.tick(&Pins { emergency_stop: true, ..Pins::default() });
        let seen = Observation::of(&mut board).unwrap();
        assert!(seen.status.emergency_stop && seen.snapshot.is_some_and(|s| s.sequence == 1));
        assert!(board.bus.transfers.iter().all(|transfer| matches!(transfer, Transfer::Read(..))));
        let mut board = Board::new(Recorder::new(Card::new(3)));
        board.bus.inner.tick(&Pins::default());
        board.arm().unwrap();
        board.bus.transfers.clear();
        let seen = Observation::of(&mut board).unwrap();
        assert!(seen.status.armed && seen.snapshot.is_none() && seen.commits[0] == 1);
        let snapshot = map::SNAPSHOT_SEQUENCE.offset..=map::SNAPSHOT_SEQUENCE_END.offset;
        assert!(!board.bus.transfers.iter().any(|t| matches!(t, Transfer::Read(at, _) if snapshot.contains(at))));
    }
}
