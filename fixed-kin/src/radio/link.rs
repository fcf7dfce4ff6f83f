//! What a robot keeps of its link, frame by frame.

use super::{FrameError, Writes, decode};

/// Why a frame did nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// It is none, or not for this robot.
    Frame(FrameError),
    /// Repeated, or older than the last one taken.
    Sequence {
        /// Its number.
        found: u8,
        /// That of the last one taken.
        last: u8,
    },
}

/// Sequence and counters of a robot's link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// The robot that frames must name.
    pub robot: u8,
    /// Sequence number of the last frame taken.
    pub last: u8,
    /// Frames taken, wrapping.
    pub accepted: u8,
    /// Frames that did nothing, wrapping; those for other robots are not counted.
    pub dropped: u8,
}

impl Link {
    /// The link of a robot just switched on.
    #[must_use]
    pub const fn new(robot: u8) -> Self {
        Self { robot: robot & 15, last: 0xFF, accepted: 0, dropped: 0 }
    }

    /// Whether a sequence number would be taken: another than the last, and ahead of it while armed.
    #[must_use]
    pub const fn is_fresh(&self, sequence: u8, armed: bool) -> bool {
        let ahead = sequence.wrapping_sub(self.last);
        ahead != 0 && !(armed && ahead >= 128)
    }

    /// Judges what came between two silences and gives its writes.
    ///
    /// # Errors
    /// [`Refusal`]; the counters know it, too.
    pub fn take<'a>(&mut self, bytes: &'a [u8], armed: bool) -> Result<Writes<'a>, Refusal> {
        match decode(bytes, self.robot) {
            Ok((sequence, writes)) if self.is_fresh(sequence, armed) => {
                self.last = sequence;
                self.accepted = self.accepted.wrapping_add(1);
                Ok(writes)
            }
            Ok((found, _)) => {
                self.dropped = self.dropped.wrapping_add(1);
                Err(Refusal::Sequence { found, last: self.last })
            }
            Err(error) => {
                let other = matches!(error, FrameError::Robot(_));
                self.dropped = self.dropped.wrapping_add(u8::from(!other));
                Err(Refusal::Frame(error))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radio::Frame;
    use std::vec::Vec;

    fn frame(sequence: u8) -> Vec<u8> {
        let mut frame = Frame::new(2, sequence).unwrap();
        frame.disarm().unwrap();
        frame.bytes().to_vec()
    }

    #[test]
    fn repeated_and_old_frames_do_nothing() {
        let mut link = Link::new(2);
        assert!(link.take(&frame(0), false).is_ok());
        assert_eq!(link.take(&frame(0), false).unwrap_err(), Refusal::Sequence { found: 0, last: 0 });
        assert!(link.take(&frame(127), true).is_ok());
        assert!(link.take(&frame(126), true).is_err());
        assert!(link.take(&frame(255), true).is_err());
        assert!(link.take(&frame(254), true).is_ok());
        // A sender that starts again is heard once the robot is off.
        assert!(link.take(&frame(0), false).is_ok());
        assert_eq!((link.accepted, link.dropped), (4, 3));
    }

    #[test]
    fn frames_for_others_are_not_counted() {
        let mut link = Link::new(3);
        assert!(link.take(&frame(5), false).is_err());
        assert_eq!((link.accepted, link.dropped, link.last), (0, 0, 0xFF));
    }
}
