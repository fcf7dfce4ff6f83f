//! The packets of a bitstream, walked as the device will.
//!
//! A packet is a header word and the data words of one register:
//!
//! | bits | 31:29 | 28:27 | 26:13 | 10:0 |
//! |---|---|---|---|---|
//! | type 1 | 1 | 0 none, 1 read, 2 write | register | words |
//! | type 2 | 2 | as above | words in 26:0, to the register of the packet before | |

pub use super::registers::*;

use super::crc::Crc;
use super::{FRAME_WORDS, FRAMES, Fault, Order, SYNC};

/// The sync word stands this near to the beginning.
const SYNC_WITHIN: usize = 256;

/// What the packets of a bitstream do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// Packets with a header of their own.
    pub packets: usize,
    /// Words of frame data.
    pub frame_words: usize,
    /// CRC words that were right; a wrong one is an error.
    pub crc_checks: usize,
}

/// A packet, or a word that does nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Packet {
    /// A word between packets.
    Idle(u32),
    /// A write to a register.
    Write {
        /// The header as it stands.
        header: u32,
        /// Number in the packet's header, see XAPP151.
        register: u32,
        /// What is written.
        words: Vec<u32>,
        /// Byte of the file at which the first word stands.
        offset: usize,
    },
}

/// A bitstream taken apart, so that putting it together again gives the same bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Packets {
    /// Dummy bytes (FF) before the sync word.
    pub lead: usize,
    /// What follows it.
    pub packets: Vec<Packet>,
    /// Bytes after the last whole word.
    pub rest: Vec<u8>,
}

impl Packets {
    /// The bytes, in `.bit` order, with the CRC words computed anew.
    #[must_use]
    pub fn encode(&self) -> Vec<u8> {
        let mut bytes = vec![0xFF; self.lead];
        let mut crc = Crc::default();
        let mut push = |word: u32| bytes.extend(word.to_be_bytes());
        push(SYNC);
        for packet in &self.packets {
            match packet {
                Packet::Idle(word) => push(*word),
                Packet::Write { header, register, words, .. } => {
                    push(*header);
                    for word in words {
                        push(if *register == CRC { crc.0.into() } else { *word });
                        crc.update(*register, *word);
                    }
                }
            }
        }
        bytes.extend(&self.rest);
        bytes
    }

    /// The last value written to a register.
    #[must_use]
    pub fn last(&self, wanted: u32) -> Option<u32> {
        self.packets.iter().rev().find_map(|packet| match packet {
            Packet::Write { register, words, .. } if *register == wanted => words.last().copied(),
            _ => None,
        })
    }
}

/// Where the sync word is, and in which order of bits.
pub(super) fn sync(stream: &[u8]) -> Option<(Order, usize)> {
    let plain = SYNC.to_be_bytes();
    let reversed = plain.map(u8::reverse_bits);
    stream.windows(4).take(SYNC_WITHIN).enumerate().find_map(|(at, window)| {
        let order = if window == plain {
            Order::Bit
        } else if window == reversed {
            Order::Prom
        } else {
            return None;
        };
        Some((order, at))
    })
}

/// Walks a bitstream in `.bit` order that begins at byte `start` of its file.
pub(super) fn walk(stream: &[u8], start: usize) -> Result<(Summary, Packets), Fault> {
    let Some((Order::Bit, at)) = sync(stream) else { return Err(Fault::NoSync { searched: stream.len() }) };
    if let Some(stray) = stream[..at].iter().position(|byte| *byte != 0xFF) {
        let word = u32::from(stream[stray]);
        return Err(Fault::Packet { offset: start + stray, word, why: "stands before the sync word" });
    }
    let walk = Walk {
        stream,
        start,
        at: at + 4,
        crc: Crc::default(),
        summary: Summary::default(),
        started: false,
        checked: false,
    };
    walk.run(Packets { lead: at, packets: Vec::new(), rest: Vec::new() })
}

struct Walk<'a> {
    stream: &'a [u8],
    /// Of the stream in its file.
    start: usize,
    at: usize,
    crc: Crc,
    summary: Summary,
    started: bool,
    /// No frame data since the last CRC check.
    checked: bool,
}

impl Walk<'_> {
    fn word(&mut self) -> Option<u32> {
        let bytes = self.stream.get(self.at..self.at + 4)?;
        self.at += 4;
        Some(u32::from_be_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
    }

    /// Offset of the last word in the file.
    fn offset(&self) -> usize {
        self.start + self.at - 4
    }

    fn run(mut self, mut all: Packets) -> Result<(Summary, Packets), Fault> {
        let mut register = None;
        while let Some(header) = self.word() {
            let offset = self.offset();
            let fault = |why| Fault::Packet { offset, word: header, why };
            let (kind, operation) = (header >> 29, header >> 27 & 3);
            let words = match (kind, operation) {
                (0, _) if header == 0 => {
                    all.packets.push(Packet::Idle(header));
                    continue;
                }
                (1, 0) => {
                    all.packets.push(Packet::Idle(header));
                    continue;
                }
                (1, 2) => {
                    let address = header >> 13 & 0x3FFF;
                    if address >= REGISTERS {
                        return Err(fault("writes a register that the device has not"));
                    }
                    register = Some(address);
                    header & 0x7FF
                }
                (2, 2) if register.is_some() => header & 0x07FF_FFFF,
                (2, 2) => return Err(fault("has no register")),
                (1 | 2, 1) => return Err(fault("reads back, which a card cannot answer while it is loaded")),
                _ => return Err(fault("is of no known type")),
            };
            let Some(address) = register else { return Err(fault("has no register")) };
            if words as usize > (self.stream.len() - self.at) / 4 {
                return Err(fault("has more words than the file"));
            }
            self.summary.packets += 1;
            let offset = self.start + self.at;
            let mut data = Vec::with_capacity(words as usize);
            for _ in 0..words {
                let word = self.word().unwrap_or_default();
                self.write(address, word)?;
                data.push(word);
            }
            all.packets.push(Packet::Write { header, register: address, words: data, offset });
        }
        all.rest = self.stream[self.at..].to_vec();
        if !self.checked {
            return Err(Fault::NoCrc);
        }
        if self.summary.frame_words != FRAMES * FRAME_WORDS {
            return Err(Fault::Frames { words: self.summary.frame_words });
        }
        if !self.started {
            return Err(Fault::NoStart);
        }
        Ok((self.summary, all))
    }

    fn write(&mut self, register: u32, data: u32) -> Result<(), Fault> {
        if register == CRC {
            let (stored, computed) = (data as u16, self.crc.0);
            if data > u32::from(u16::MAX) || stored != computed {
                return Err(Fault::Crc { offset: self.offset(), stored, computed });
            }
            self.summary.crc_checks += 1;
            self.checked = true;
        }
        self.crc.update(register, data);
        match register {
            FRAME_DATA => {
                self.summary.frame_words += 1;
                self.checked = false;
            }
            FRAME_LENGTH if data as usize != FRAME_WORDS - 1 => {
                return Err(Fault::FrameLength { offset: self.offset(), found: data });
            }
            COMMAND if data == START => self.started = true,
            _ => {}
        }
        Ok(())
    }
}
