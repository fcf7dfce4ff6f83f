//! What is wrong with a bitstream file, where, and what to do.

use super::{BYTES, FRAME_WORDS, FRAMES, PART};

/// A file that will not be sent to a card.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}: {fault}")]
pub struct BitstreamError {
    /// As it was named on the command line.
    pub file: String,
    /// What is wrong.
    pub fault: Fault,
}

/// A fault, with byte offsets in the file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Fault {
    /// It cannot be read.
    #[error("{0}")]
    Io(String),
    /// Nothing in it.
    #[error("the file is empty")]
    Empty,
    /// Larger than any bitstream.
    #[error("the file is larger than 16 MiB; it is no bitstream for this card")]
    TooLong,
    /// Another kind of file.
    #[error("this is {kind}; give the .bit file that the same build made")]
    Format {
        /// What it is instead, as far as its first bytes tell.
        kind: &'static str,
    },
    /// The header ends early, or a length in it points beyond the end.
    #[error("{what} at byte {offset:#x} goes on beyond the end of the file ({length} bytes); the file is cut short")]
    Truncated {
        /// What was read.
        what: String,
        /// Where it begins.
        offset: usize,
        /// Bytes of the file.
        length: usize,
    },
    /// A header field that makes no sense.
    #[error("field '{field}' of the header, at byte {offset:#x}, {why}; make the file anew")]
    Field {
        /// Its letter.
        field: char,
        /// Where it begins.
        offset: usize,
        /// What is wrong.
        why: &'static str,
    },
    /// A required field is missing.
    #[error("the header has no field '{field}' ({meaning}); make the file anew")]
    Missing {
        /// Its letter.
        field: char,
        /// What it holds.
        meaning: &'static str,
    },
    /// Bytes after the last field.
    #[error("{count} bytes follow the bitstream, from byte {offset:#x}; is this two files in one?")]
    Trailing {
        /// How many.
        count: usize,
        /// Where they begin.
        offset: usize,
    },
    /// Another device or package.
    #[error("the file is for {found}, the card has {PART}; choose that part in the project and build again")]
    Part {
        /// What the file is for.
        found: String,
    },
    /// Too short or too long.
    #[error("the bitstream has {found} bytes, {PART} takes {BYTES}; it is for another device or cut short")]
    Length {
        /// Its bytes.
        found: usize,
    },
    /// No bitstream at all.
    #[error("no sync word (aa995566) in {searched} bytes, in either order of bits; this is no Xilinx bitstream")]
    NoSync {
        /// Bytes looked through.
        searched: usize,
    },
    /// A packet that cannot be.
    #[error("the packet at byte {offset:#x} ({word:#010x}) {why}; the file is damaged")]
    Packet {
        /// Offset in the file, bytes.
        offset: usize,
        /// Its header.
        word: u32,
        /// What is wrong.
        why: &'static str,
    },
    /// The frames are of another length.
    #[error(
        "the frame length register is set to {found} at byte {offset:#x}, {PART} has frames of {FRAME_WORDS} words; the file is for another device"
    )]
    FrameLength {
        /// Offset in the file, bytes.
        offset: usize,
        /// What is written to it.
        found: u32,
    },
    /// A stored checksum that is not that of the words before it.
    #[error(
        "the CRC word at byte {offset:#x} does not match: {stored:#06x} stored, {computed:#06x} computed; the file is damaged"
    )]
    Crc {
        /// Offset in the file, bytes.
        offset: usize,
        /// In the file.
        stored: u16,
        /// Over the packets before it.
        computed: u16,
    },
    /// No CRC over the configuration.
    #[error("the bitstream has no CRC word after its frames; build it with the CRC on")]
    NoCrc,
    /// Not the whole device.
    #[error("the bitstream configures {words} words, {PART} has {}; partial and compressed bitstreams cannot be loaded", FRAMES * FRAME_WORDS)]
    Frames {
        /// Words of frame data.
        words: usize,
    },
    /// It would never start.
    #[error("the bitstream has no start command; the FPGA would stay idle")]
    NoStart,
}
