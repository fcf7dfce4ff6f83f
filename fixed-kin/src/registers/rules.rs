//! What a driver must know beside the table: rules, each as one sentence, and frames of the radio.

use crate::radio;

/// A rule of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rule {
    /// Name, in `snake_case`.
    pub name: &'static str,
    /// What a writer must keep to, one sentence.
    pub text: &'static str,
}

/// A part of a radio frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FramePart {
    /// Name, in `snake_case`.
    pub name: &'static str,
    /// Where it begins, in bytes; n is the number of writes, i counts them from 0.
    pub at: &'static str,
    /// How many bytes it takes.
    pub bytes: usize,
    /// The value it must have, if there is one.
    pub value: Option<u8>,
    /// What the description of the frame says of it.
    pub text: &'static str,
}

/// Everything that holds for more than one register.
pub const RULES: [Rule; 8] = [
    Rule {
        name: "access",
        text: "aligned 32-bit words at byte offsets in BAR 5; on the local bus the same offsets on LAD with ADS#, bit 31 of \
               LAD the highest bit of the word; reserved offsets read 0 and ignore writes, write-only registers read 0",
    },
    Rule {
        name: "staging",
        text: "words of `set_points` and `configuration` are staged: write every word of one group of registers exactly once, \
               none of the other, then the checksum to its commit register; all act together at the next control tick, or, \
               with a wrong sum or number of words, nothing does and `faults` shows commit; words have 30 bits, two's \
               complement, the upper two of the 32 are replaced by the sign",
    },
    Rule {
        name: "checksum",
        text: "start with the seed; for every staged write in the order of the writes: sum = rotate_left(sum, 1) xor data xor \
               (byte offset / 4), in 32 bits, data as written; any order of the words is taken; every commit, right or wrong, \
               starts with the seed again",
    },
    Rule { name: "arming", text: super::ARMING },
    Rule {
        name: "faults",
        text: "`faults` is cleared by writing ones: each clears its bit, in `first_fault` too; a cause that still stands sets \
               its bit again at once; `encoder_error` and `stall` are such causes and are cleared at their own registers first",
    },
    Rule {
        name: "snapshot",
        text: "read `snapshot_sequence`, any of the other words, then `snapshot_sequence_end`: all are of one control tick, the \
               last that had finished when the first was read; a reader may take its time, and may begin again at any word 0",
    },
    Rule {
        name: "reset",
        text: "the reset value is what a register reads after configuration while nothing is connected to the pins, which the \
               FPGA pulls up, before the first control tick; bits of the live mask follow pins or time",
    },
    Rule {
        name: "content_hash",
        text: "CRC-32 of IEEE 802.3 and zip (reflected polynomial edb88320, start and final exclusive or ffffffff) over the \
               bytes of rac4i65.v with the eight hexadecimal digits of `localparam content_hash = 32'h........;` replaced by \
               00000000",
    },
];

/// The frame of the radio, in the order of its bytes; see [`crate::radio`].
pub const FRAME: [FramePart; 7] = [
    FramePart { name: "head", at: "0", bytes: 1, value: Some(radio::HEAD), text: "version of the frame" },
    FramePart { name: "robot", at: "1", bytes: 1, value: None, text: "0 to 15, as the straps `robot_number`" },
    FramePart { name: "writes", at: "2", bytes: 1, value: None, text: "number of writes n, 1 to 95" },
    FramePart {
        name: "sequence",
        at: "3",
        bytes: 1,
        value: None,
        text: "one more in every frame, wrapping; must differ from the last one taken, while armed lie 1 to 127 ahead of it",
    },
    FramePart {
        name: "register",
        at: "4 + 5 i",
        bytes: 1,
        value: None,
        text: "word in its page, bits 5:0, and page, bits 7:6: 0 byte offset 0x000, 1 0x400, 2 0x600",
    },
    FramePart { name: "data", at: "5 + 5 i", bytes: 4, value: None, text: "the word written, lowest byte first" },
    FramePart {
        name: "crc",
        at: "4 + 5 n",
        bytes: radio::CRC_BYTES,
        value: None,
        text: "CRC-32 as of the content hash over all bytes before, lowest byte first",
    },
];

/// How frames go over the line.
pub const FRAME_LINE: &str = "8 bits, lowest first, no parity, one stop bit, idle high, 289 clocks a bit (115340 baud at 33.33 MHz); \
     two bytes' time of silence before and after a frame, which acts as a whole with the second silence or not at all";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radio::{CLOCKS_PER_BIT, HEADER_BYTES, MAX_WRITES, WRITE_BYTES};
    use std::string::ToString;

    #[test]
    fn the_numbers_in_the_text_are_those_of_the_code() {
        let numbers = [HEADER_BYTES, WRITE_BYTES, MAX_WRITES].map(|number| number.to_string());
        assert_eq!(FRAME[4].at, std::format!("{} + {} i", numbers[0], numbers[1]));
        assert_eq!(FRAME[6].at, std::format!("{} + {} n", numbers[0], numbers[1]));
        assert!(FRAME[2].text.ends_with(&numbers[2]));
        assert!(FRAME_LINE.contains(&std::format!("{CLOCKS_PER_BIT} clocks a bit")));
    }
}
