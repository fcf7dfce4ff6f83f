//! Bitstream files: read, checked to the last packet, and known good before a card is touched.
//!
//! ```text
//!  .bit file     preamble │ a design │ b part │ c date │ d time │ e length, bitstream │
//!  bitstream     FF… │ AA995566 │ packets with two CRC words │ dummy words
//!  PROM file     the bitstream alone, every byte with its bits in reverse
//! ```
//!
//! Format: the parser of LinuxCNC (`bitfile.c`) and nine different files made by Xilinx's tools for this
//! device, 2005 to 2009; packets and CRC: Xilinx application note 151, checked on the same files.

mod crc;
mod error;
mod header;
pub mod packets;
mod registers;

pub use crc::Crc;
pub use error::{BitstreamError, Fault};
pub use header::Header;

use packets::{Packets, Summary};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Device and package of the card, as files name it.
pub const PART: &str = "2s200pq208";
/// Bytes of a bitstream for it: 1,335,840 bits (Xilinx DS001, table 8).
pub const BYTES: usize = 166_980;
/// Words of a configuration frame.
pub const FRAME_WORDS: usize = 18;
/// Frames of the device.
pub const FRAMES: usize = 2_317;
/// The word that begins the packets.
pub const SYNC: u32 = 0xAA99_5566;

/// Longest file that is read at all.
const LONGEST_FILE: u64 = 16 << 20;

/// Order of the bits in a file's bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// As in `.bit` files: the first bit is the highest of its byte. Sent bit-reversed.
    Bit,
    /// As PROM programmers want it: already reversed, sent as it is.
    Prom,
}

/// A bitstream that this device will take.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bitstream {
    /// What the file says of itself; a PROM or raw file says nothing.
    pub header: Option<Header>,
    /// How the file had its bits.
    pub order: Order,
    /// What the packets do.
    pub summary: Summary,
    /// What the configuration logic is told, word by word.
    pub packets: Packets,
    /// Bytes of the file before the bitstream.
    head: Vec<u8>,
    /// Bytes as they go over the bus, the first configuration bit on data line 0.
    lanes: Vec<u8>,
}

impl Bitstream {
    /// Reads and checks a file.
    ///
    /// # Errors
    /// [`BitstreamError`] names the file, the place in it and the fault.
    pub fn open(path: &Path) -> Result<Self, BitstreamError> {
        let about = |fault: Fault| BitstreamError { file: path.display().to_string(), fault };
        let io = |cause: std::io::Error| about(Fault::Io(cause.to_string()));
        let mut bytes = Vec::new();
        File::open(path).map_err(io)?.take(LONGEST_FILE + 1).read_to_end(&mut bytes).map_err(io)?;
        if bytes.len() as u64 > LONGEST_FILE {
            return Err(about(Fault::TooLong));
        }
        Self::parse(&bytes).map_err(about)
    }

    /// Checks the content of a file.
    ///
    /// # Errors
    /// [`Fault`], with byte offsets in the file.
    pub fn parse(file: &[u8]) -> Result<Self, Fault> {
        let (header, start, stream) = if header::begins(file) {
            let (header, range) = header::parse(file)?;
            if !header.part.eq_ignore_ascii_case(PART) {
                return Err(Fault::Part { found: header.part });
            }
            (Some(header), range.start, &file[range])
        } else {
            refuse_other_formats(file)?;
            (None, 0, file)
        };
        let Some((order, _)) = packets::sync(stream) else { return Err(Fault::NoSync { searched: stream.len() }) };
        if stream.len() != BYTES {
            return Err(Fault::Length { found: stream.len() });
        }
        let reversed = || stream.iter().map(|byte| byte.reverse_bits()).collect::<Vec<u8>>();
        let ((summary, packets), lanes) = match order {
            Order::Bit => (packets::walk(stream, start)?, reversed()),
            Order::Prom => (packets::walk(&reversed(), start)?, stream.to_vec()),
        };
        Ok(Self { header, order, summary, packets, head: file[..start].to_vec(), lanes })
    }

    /// The file again: its header with these packets, their CRC computed anew, in the file's order of bits.
    #[must_use]
    pub fn encode(&self, packets: &Packets) -> Vec<u8> {
        let reverse = |byte: u8| if self.order == Order::Prom { byte.reverse_bits() } else { byte };
        self.head.iter().copied().chain(packets.encode().into_iter().map(reverse)).collect()
    }

    /// Bytes as they go over the bus, one 8-bit write each.
    #[must_use]
    pub fn lanes(&self) -> &[u8] {
        &self.lanes
    }
}

/// Files people take for a bitstream.
fn refuse_other_formats(file: &[u8]) -> Result<(), Fault> {
    let text = |prefix: &str| file.starts_with(prefix.as_bytes());
    if file.is_empty() {
        return Err(Fault::Empty);
    }
    let kind = if text("Xilinx ASCII Bitstream") {
        "a rawbits file (.rbt)"
    } else if text(":") {
        "a PROM file in Intel hexadecimal (.mcs)"
    } else if text("S0") || text("S1") || text("S2") || text("S3") {
        "a PROM file in Motorola hexadecimal (.exo)"
    } else if file.starts_with(&[0x1F, 0x8B]) || text("PK") {
        "a compressed file"
    } else {
        return Ok(());
    };
    Err(Fault::Format { kind })
}
