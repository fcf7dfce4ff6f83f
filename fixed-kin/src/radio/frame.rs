//! Frames to bytes and back.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "bytes of a word"
)]

use super::{
    CRC_BYTES, CRC_RESIDUE, CRC_TAPS, HEAD, HEADER_BYTES, LONGEST_FRAME, MAX_WRITES, WRITE_BYTES, code_of, offset_of,
};
use crate::control::SET_POINT_WORDS;
use crate::registers::{self as map, CHECKSUM_SEED, checksum};
use crate::safety::{ARM_FIRST, ARM_SECOND};
use core::fmt;

/// Why a frame cannot be made, or is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameError {
    /// The first byte is not [`HEAD`].
    Version(u8),
    /// For another robot.
    Robot(u8),
    /// Not as many bytes as the length says, or a length that no frame has.
    Length {
        /// Writes that the frame says it has.
        writes: u8,
        /// Length of what was received, bytes.
        bytes: usize,
    },
    /// The CRC does not fit the bytes before it.
    Checksum,
    /// No frame reaches this register.
    Register {
        /// Byte offset.
        offset: u16,
    },
    /// More writes than a frame holds.
    Full,
    /// A number beyond 15, which no robot has.
    RobotNumber(u8),
}

impl fmt::Display for FrameError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Version(found) => {
                write!(f, "byte 0 is {found:#04x}, not {HEAD:#04x}: no frame, or of another version")
            }
            Self::Robot(robot) => write!(f, "byte 1: the frame is for robot {robot}"),
            Self::Length { writes, bytes } => {
                write!(f, "byte 2 says {writes} writes, of 1 to {MAX_WRITES}, but there are {bytes} bytes")
            }
            Self::Checksum => write!(f, "the CRC is wrong: the frame is damaged"),
            Self::Register { offset } => write!(
                f,
                "no frame reaches the register at {offset:#05x}; those at 000 to 0fc, 400 to 4fc and 600 to 6fc can be written"
            ),
            Self::Full => write!(f, "a frame holds {MAX_WRITES} writes; send the rest in another"),
            Self::RobotNumber(robot) => write!(f, "there is no robot {robot}; they are 0 to 15"),
        }
    }
}

impl core::error::Error for FrameError {}

/// CRC-32 of IEEE 802.3.
#[must_use]
pub fn crc(bytes: &[u8]) -> u32 {
    !register(bytes)
}

/// The CRC's shift register after some bytes.
pub(super) fn register(bytes: &[u8]) -> u32 {
    bytes.iter().fold(u32::MAX, |state, &byte| (0..8).fold(state, |state, bit| step(state, byte >> bit & 1 == 1)))
}

/// The CRC's shift register after one more bit.
pub(super) const fn step(state: u32, bit: bool) -> u32 {
    let feedback = (state & 1 == 1) != bit;
    if feedback { state >> 1 ^ CRC_TAPS } else { state >> 1 }
}

/// A frame in the making.
///
/// ```
/// use fixed_kin::radio::{Frame, decode};
/// use fixed_kin::registers::{SET_POINTS, COMMIT_SET_POINTS};
///
/// let mut frame = Frame::new(3, 17)?;
/// frame.set_points([0, 1 << 20, 0, 0])?;
/// let bytes = frame.bytes();
/// assert_eq!((bytes.len(), bytes[2]), (33, 5));
/// let (sequence, writes) = decode(bytes, 3)?;
/// let offsets: Vec<u16> = writes.map(|(offset, _)| offset).collect();
/// assert_eq!((sequence, offsets[0], offsets[4]), (17, SET_POINTS.offset, COMMIT_SET_POINTS.offset));
/// # Ok::<(), fixed_kin::radio::FrameError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Frame {
    bytes: [u8; LONGEST_FRAME],
    writes: usize,
}

impl Frame {
    /// A frame without writes for a robot, 0 to 15.
    ///
    /// # Errors
    /// [`FrameError::RobotNumber`].
    pub fn new(robot: u8, sequence: u8) -> Result<Self, FrameError> {
        if robot > 15 {
            return Err(FrameError::RobotNumber(robot));
        }
        let mut bytes = [0; LONGEST_FRAME];
        bytes[..HEADER_BYTES].copy_from_slice(&[HEAD, robot, 0, sequence]);
        Ok(Self { bytes, writes: 0 })
    }

    /// Appends a write to the register at a byte offset.
    ///
    /// # Errors
    /// [`FrameError::Register`] where no frame reaches it, [`FrameError::Full`].
    pub fn write(&mut self, offset: u16, data: u32) -> Result<(), FrameError> {
        let code = code_of(offset).ok_or(FrameError::Register { offset })?;
        if self.writes == MAX_WRITES {
            return Err(FrameError::Full);
        }
        let at = HEADER_BYTES + self.writes * WRITE_BYTES;
        self.bytes[at] = code;
        self.bytes[at + 1..at + WRITE_BYTES].copy_from_slice(&data.to_le_bytes());
        self.writes += 1;
        Ok(())
    }

    /// Stages and commits the set points: velocity x, y, rotation and a spare, or wheel speeds.
    ///
    /// # Errors
    /// [`FrameError::Full`].
    pub fn set_points(&mut self, words: [u32; SET_POINT_WORDS]) -> Result<(), FrameError> {
        let mut sum = CHECKSUM_SEED;
        for (index, word) in words.into_iter().enumerate() {
            let offset = map::SET_POINTS.at(index);
            self.write(offset, word)?;
            sum = checksum(sum, offset / 4, word);
        }
        self.write(map::COMMIT_SET_POINTS.offset, sum)
    }

    /// Kicks at once with a pulse in microseconds; `control` as in `kicker_control`.
    ///
    /// # Errors
    /// [`FrameError::Full`].
    pub fn kick(&mut self, control: u32, pulse_us: u32) -> Result<(), FrameError> {
        self.kicker(control, pulse_us)?;
        self.write(map::KICKER_FIRE.offset, map::KICKER_FIRE_WORD)
    }

    /// Sets the kicker's pulse and its control word: charge, kick at the ball sensor, hold.
    ///
    /// # Errors
    /// [`FrameError::Full`].
    pub fn kicker(&mut self, control: u32, pulse_us: u32) -> Result<(), FrameError> {
        self.write(map::KICKER_PULSE.offset, pulse_us)?;
        self.write(map::KICKER_CONTROL.offset, control)
    }

    /// The two writes that arm; set points must have been committed before, for the watchdog.
    ///
    /// # Errors
    /// [`FrameError::Full`].
    pub fn arm(&mut self) -> Result<(), FrameError> {
        self.write(map::ARM.offset, ARM_FIRST)?;
        self.write(map::ARM.offset, ARM_SECOND)
    }

    /// The write that disarms.
    ///
    /// # Errors
    /// [`FrameError::Full`].
    pub fn disarm(&mut self) -> Result<(), FrameError> {
        self.write(map::ARM.offset, 0)
    }

    /// The frame as it goes over the line; one without writes is refused by every receiver.
    pub fn bytes(&mut self) -> &[u8] {
        self.bytes[2] = self.writes as u8;
        let end = HEADER_BYTES + self.writes * WRITE_BYTES;
        let sum = crc(&self.bytes[..end]).to_le_bytes();
        self.bytes[end..end + CRC_BYTES].copy_from_slice(&sum);
        &self.bytes[..end + CRC_BYTES]
    }
}

/// The writes of a frame: byte offset and data.
#[derive(Clone, Copy, Debug)]
pub struct Writes<'a>(&'a [u8]);

impl Iterator for Writes<'_> {
    type Item = (u16, u32);

    fn next(&mut self) -> Option<(u16, u32)> {
        let (&[code, a, b, c, d], rest) = self.0.split_first_chunk::<WRITE_BYTES>()?;
        self.0 = rest;
        Some((offset_of(code), u32::from_le_bytes([a, b, c, d])))
    }
}

/// Sequence number and writes of a frame for `robot`.
///
/// # Errors
/// [`FrameError`]: what is wrong first, in the order of the bytes.
pub fn decode(bytes: &[u8], robot: u8) -> Result<(u8, Writes<'_>), FrameError> {
    let field = |at: usize| bytes.get(at).copied().unwrap_or(0);
    if field(0) != HEAD {
        return Err(FrameError::Version(field(0)));
    }
    if bytes.len() > 1 && field(1) != robot {
        return Err(FrameError::Robot(field(1)));
    }
    let writes = usize::from(field(2));
    let end = HEADER_BYTES + writes * WRITE_BYTES;
    if !(1..=MAX_WRITES).contains(&writes) || bytes.len() != end + CRC_BYTES {
        return Err(FrameError::Length { writes: field(2), bytes: bytes.len() });
    }
    if register(bytes) != CRC_RESIDUE {
        return Err(FrameError::Checksum);
    }
    Ok((field(3), Writes(&bytes[HEADER_BYTES..end])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    fn drive() -> Vec<u8> {
        let mut frame = Frame::new(3, 200).unwrap();
        frame.set_points([7, 0xFFFF_FFF0, 0, 0]).unwrap();
        frame.bytes().to_vec()
    }

    #[test]
    fn the_crc_is_that_of_ethernet() {
        assert_eq!(crc(b"123456789"), 0xCBF4_3926);
        assert_eq!(register(&drive()), CRC_RESIDUE);
    }

    #[test]
    fn what_goes_in_comes_out() {
        let mut frame = Frame::new(15, 9).unwrap();
        let all: Vec<(u16, u32)> =
            (0..MAX_WRITES).map(|i| (offset_of((i % 192) as u8), (i as u32).wrapping_mul(0x9E37_79B9))).collect();
        for &(offset, data) in &all {
            assert_eq!(code_of(offset).map(offset_of), Some(offset));
            frame.write(offset, data).unwrap();
        }
        assert_eq!(frame.write(0, 0), Err(FrameError::Full));
        let (sequence, writes) = decode(frame.bytes(), 15).unwrap();
        assert_eq!((sequence, writes.collect::<Vec<_>>()), (9, all));
    }

    #[test]
    fn what_is_wrong_is_named() {
        let good = drive();
        let with = |at: usize, value: u8| {
            let mut bytes = good.clone();
            bytes[at] = value;
            decode(&bytes, 3).unwrap_err()
        };
        assert_eq!(with(0, 0xA2), FrameError::Version(0xA2));
        assert_eq!(with(1, 4), FrameError::Robot(4));
        assert_eq!(with(2, 6), FrameError::Length { writes: 6, bytes: 33 });
        assert_eq!(with(2, 0), FrameError::Length { writes: 0, bytes: 33 });
        assert_eq!(with(3, 199), FrameError::Checksum);
        assert_eq!(decode(&[], 3).unwrap_err(), FrameError::Version(0));
        assert_eq!(Frame::new(16, 0).unwrap_err(), FrameError::RobotNumber(16));
        for offset in [0x800, 0x500, 0x402, 0xFFFC] {
            assert_eq!(Frame::new(0, 0).unwrap().write(offset, 0), Err(FrameError::Register { offset }));
        }
        assert_eq!(
            decode(Frame::new(3, 0).unwrap().bytes(), 3).unwrap_err(),
            FrameError::Length { writes: 0, bytes: 8 }
        );
    }

    #[test]
    fn up_to_three_flipped_bits_anywhere_are_seen() {
        let good = drive();
        let bits = 8 * good.len();
        let flip = |bytes: &mut Vec<u8>, at: usize| bytes[at / 8] ^= 1 << (at % 8);
        for first in 0..bits {
            for second in first..bits {
                let mut broken = good.clone();
                flip(&mut broken, first);
                if second != first {
                    flip(&mut broken, second);
                }
                assert!(decode(&broken, 3).is_err());
                flip(&mut broken, (first * 31 + second * 17) % bits);
                assert!(broken == good || decode(&broken, 3).is_err());
            }
        }
    }
}
