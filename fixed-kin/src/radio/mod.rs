//! The radio link: how a robot without a PC is told what to do.
//!
//! A frame carries writes to the registers, the same that a host makes over its bus: staged set points
//! and their commit, the kicker's registers, the two words that arm, or a robot's whole configuration.
//! So limits, watchdog, time-outs and the rules of arming are those of the bus. A frame acts as a whole or
//! not at all.
//!
//! | byte | what |
//! |---|---|
//! | 0 | [`HEAD`]: version of the frame, 1 |
//! | 1 | robot, 0 to 15; frames for others are not looked at |
//! | 2 | length: number of writes n, 1 to [`MAX_WRITES`] |
//! | 3 | sequence number, one more in every frame, wrapping |
//! | 4 + 5i | register of write i: word address, bits 5:0; page, bits 7:6: 0 the plain registers (000), 1 configuration (400), 2 set points (600) |
//! | 5 + 5i … 8 + 5i | its data, lowest byte first |
//! | 4 + 5n … 7 + 5n | CRC-32 of all before, lowest byte first: IEEE 802.3, as in Ethernet and zip |
//!
//! On the line: 8 bits, no parity, one stop bit, [`CLOCKS_PER_BIT`] clocks a bit (115,200 baud). A frame
//! stands between two silences of two bytes' time ([`GAP_BYTES`]) and acts with the second: after anything
//! wrong the receiver hears nothing until the next silence, so that it never takes the middle of a frame
//! for its beginning, nor a frame for whole that goes on. A sequence number must differ from the last one taken, and while armed lie 1 to 127
//! ahead of it: a frame that is repeated or comes late does nothing.
//!
//! A drive frame has five writes and takes 2.9 ms, a configuration of 71 writes 32 ms. The CRC finds every
//! error of up to five bits in a frame of up to 268 bits, a drive frame, and of up to four bits in one of
//! up to 2974 bits (Koopman, *32-Bit Cyclic Redundancy Codes for Internet Applications*, DSN 2002). It is no
//! signature: who knows the format can command the robot.

mod block;
mod frame;
mod link;

pub use block::{Inputs, Outputs, Radio};
pub use frame::{Frame, FrameError, Writes, crc, decode};
pub use link::{Link, Refusal};

/// First byte of a frame: its version.
pub const HEAD: u8 = 0xA1;
/// Most writes in a frame.
pub const MAX_WRITES: usize = 95;
/// Bytes before the first write.
pub const HEADER_BYTES: usize = 4;
/// Length of a register write in a frame: an offset and its word.
pub const WRITE_BYTES: usize = 5;
/// Length of the CRC-32 at the end of a frame.
pub const CRC_BYTES: usize = 4;
/// Bytes of a frame with [`MAX_WRITES`] register writes.
pub const LONGEST_FRAME: usize = HEADER_BYTES + MAX_WRITES * WRITE_BYTES + CRC_BYTES;
/// Clocks a bit on the line: 115,340 baud at 33.33 MHz, 114,187 on the open board's 33 MHz.
pub const CLOCKS_PER_BIT: u16 = 289;
/// Bytes' time of silence before and after a frame; the receiver is content with half a tenth less.
pub const GAP_BYTES: u32 = 2;
/// What is left in the CRC's register after a whole undamaged frame.
pub const CRC_RESIDUE: u32 = 0xDEBB_20E3;
/// Taps of the CRC in the order of the line.
pub const CRC_TAPS: u32 = 0xEDB8_8320;
/// Clocks after configuration in which the straps are read.
pub const STRAP_CLOCKS: u8 = 15;

/// Byte offset of the register that a frame calls by `code`.
#[must_use]
pub const fn offset_of(code: u8) -> u16 {
    let page = [0, 4, 6, 7][(code >> 6) as usize];
    page * 256 + (code & 63) as u16 * 4
}

/// What a frame calls the register at a byte offset; `None` if no frame reaches it.
#[must_use]
pub const fn code_of(offset: u16) -> Option<u8> {
    let page = match offset / 256 {
        0 => 0,
        4 => 1,
        6 => 2,
        _ => return None,
    };
    if offset.is_multiple_of(4) { Some(page << 6 | (offset / 4 % 64) as u8) } else { None }
}
