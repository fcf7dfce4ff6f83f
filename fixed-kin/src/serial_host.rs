//! Frames of the serial host port, which an open board has in place of the PCI bridge.
//!
//! ```text
//! request   'R' address(2)         crc     word address, lowest byte first
//!           'W' address(2) data(4) crc
//! reply     'r' data(4) crc      'w' crc      'e' crc: wrong CRC or address, nothing was done
//! ```
//!
//! The CRC covers everything before it: x⁸ + x² + x + 1, lowest bit first, started with ones.

/// Clocks a bit on the line: 1 Mbaud at 33 MHz.
pub const CLOCKS_PER_BIT: u32 = 33;
/// Clocks of silence after which an unfinished frame is forgotten.
pub const FRAME_TIMEOUT: u32 = 8_192;
/// Longest reply in bytes.
pub const LONGEST_REPLY: usize = 6;

/// CRC of a frame without its last byte; over a whole frame it is 0.
#[must_use]
pub fn crc(bytes: &[u8]) -> u8 {
    bytes
        .iter()
        .fold(0xFF, |crc, byte| (0..8).fold(crc ^ byte, |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xE0 } else { crc >> 1 }))
}

/// Request to read the word at a byte offset, a multiple of 4.
#[must_use]
pub fn read_request(offset: u16) -> [u8; 4] {
    let [low, high] = (offset / 4).to_le_bytes();
    let head = [b'R', low, high];
    [head[0], head[1], head[2], crc(&head)]
}

/// Request to write the word at a byte offset, a multiple of 4.
#[must_use]
pub fn write_request(offset: u16, data: u32) -> [u8; 8] {
    let mut frame = [0; 8];
    frame[0] = b'W';
    frame[1..3].copy_from_slice(&(offset / 4).to_le_bytes());
    frame[3..7].copy_from_slice(&data.to_le_bytes());
    frame[7] = crc(&frame[..7]);
    frame
}

/// What the board answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reply {
    /// The word read.
    Read(u32),
    /// Answer to a write: it has been made on the bus.
    Written,
    /// The request was damaged; nothing was done.
    Refused,
}

/// A reply from its bytes; `None` if they are none.
#[must_use]
pub fn reply(bytes: &[u8]) -> Option<Reply> {
    if crc(bytes) != 0 {
        return None;
    }
    match *bytes {
        [b'r', a, b, c, d, _] => Some(Reply::Read(u32::from_le_bytes([a, b, c, d]))),
        [b'w', _] => Some(Reply::Written),
        [b'e', _] => Some(Reply::Refused),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_whole_frame_has_no_remainder() {
        assert_eq!(crc(&read_request(0x844)), 0);
        assert_eq!(crc(&write_request(0xFFFC, 0xDEAD_BEEF)), 0);
    }

    #[test]
    fn every_flipped_bit_or_pair_of_bits_is_seen() {
        let frame = write_request(0x038, 0x4152_4D31);
        for first in 0..64 {
            for second in first..64 {
                let mut broken = frame;
                broken[first / 8] ^= 1 << (first % 8);
                if second != first {
                    broken[second / 8] ^= 1 << (second % 8);
                }
                assert_ne!(crc(&broken), 0, "bits {first} and {second}");
            }
        }
    }

    #[test]
    fn replies_are_told_apart() {
        let sealed = |head: &[u8]| {
            let mut bytes = [0; LONGEST_REPLY];
            bytes[..head.len()].copy_from_slice(head);
            bytes[head.len()] = crc(head);
            reply(&bytes[..=head.len()])
        };
        assert_eq!(sealed(&[b'r', 1, 2, 3, 4]), Some(Reply::Read(0x0403_0201)));
        assert_eq!(sealed(b"w"), Some(Reply::Written));
        assert_eq!(sealed(b"e"), Some(Reply::Refused));
        assert_eq!(sealed(b"x"), None);
        assert_eq!(reply(b"w\0"), None);
    }
}
