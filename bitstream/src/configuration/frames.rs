//! Frames in packets: where a configuration stands in a file.
//!
//! Frame data goes through a pipeline of one frame: what arrives pushes the frame before it into the memory, so
//! every burst ends with a frame of padding. The memory's columns follow each other; a new address empties the
//! pipeline. A frame is 17 words of 32 bits, bit 0 of the frame lowest but four, and a word of zeros.

use super::Configuration;
use crate::container::packets::{
    COMMAND, CONTROL, CRC, FRAME_ADDRESS, FRAME_DATA, FRAME_LENGTH, LAST_FRAME, MASK, OPTIONS, Packet, Packets,
    RESET_CRC, START, SWITCH_CLOCK, WRITE_CONFIGURATION,
};
use crate::container::{self, FRAME_WORDS, Header};
use crate::device::{Bit, Device, FRAME_BITS, FRAMES, FrameAddress};

/// Words of a frame that hold its bits.
const DATA_WORDS: usize = FRAME_WORDS - 1;
/// Bits of padding below bit 0.
const PAD_BITS: usize = DATA_WORDS * 32 - FRAME_BITS;

/// Frames that are no configuration of this device.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FrameError {
    /// No frame has this address.
    #[error(
        "the frame address at byte {offset:#x} is {address:#010x}, where the device has no frame; the file is for another device"
    )]
    Address {
        /// Byte of the file.
        offset: usize,
        /// What was written.
        address: u32,
    },
    /// Not whole frames.
    #[error(
        "the frame data at byte {offset:#x} has {words} words, which are no whole frames of {FRAME_WORDS}; the file is damaged"
    )]
    Part {
        /// Byte of the file.
        offset: usize,
        /// How many words of frame data it holds.
        words: usize,
    },
    /// Frames without a place.
    #[error("the frame data at byte {offset:#x} goes on after the last frame of the device; the file is damaged")]
    Beyond {
        /// Byte of the file.
        offset: usize,
    },
    /// Frames that are not written.
    #[error(
        "frame {first} ({address:#010x}) and {others} others are not written; partial bitstreams configure no whole device"
    )]
    Missing {
        /// The one with the lowest index of all frames of the device.
        first: u16,
        /// As in the packet to FAR.
        address: u32,
        /// How many more.
        others: usize,
    },
}

/// What a file says besides the frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StartUp {
    /// Register COR: order of the start-up, configuration clock.
    pub options: u32,
    /// Register CTL.
    pub control: u32,
}

impl Default for StartUp {
    /// Outputs at phase 5, write enable at 4, reset released at 6, DONE at 6, clock CCLK, no wait for loops: as the
    /// card's maker has it (XAPP151, "Configuration options register").
    fn default() -> Self {
        Self { options: 0x0080_5F1D, control: 0 }
    }
}

impl Configuration {
    /// The configuration that packets write.
    ///
    /// # Errors
    /// When frames are missing, have no place or are no whole frames.
    pub fn from_packets(device: &Device, packets: &Packets) -> Result<Self, FrameError> {
        let mut configuration = Self::zero();
        let mut written = vec![false; FRAMES];
        let mut pipeline = Pipeline::default();
        for packet in &packets.packets {
            let Packet::Write { register, words, offset, .. } = packet else { continue };
            for place in pipeline.take(device, *register, words, *offset)? {
                let Place { frame, data } = place;
                written[usize::from(frame)] = true;
                for bit in 0..FRAME_BITS {
                    let (word, shift) = position(bit);
                    configuration.set_bit(Bit { frame, bit: bit as u16 }, data[word] >> shift & 1 == 1);
                }
            }
        }
        let mut missing = written.iter().enumerate().filter(|(_, written)| !**written).map(|(frame, _)| frame as u16);
        match missing.next() {
            None => Ok(configuration),
            Some(first) => Err(FrameError::Missing {
                first,
                address: device.frame_address(first).map_or(0, |address| address.0),
                others: missing.count(),
            }),
        }
    }

    /// Writes the configuration into packets that have its frames; everything else in them stays.
    ///
    /// # Errors
    /// When the packets do not hold the device's frames.
    pub fn store(&self, device: &Device, packets: &mut Packets) -> Result<(), FrameError> {
        // The last frame of a packet may be pushed by the next packet, so places are found before words change.
        let mut places: Vec<(usize, usize, u16)> = Vec::new();
        let mut pipeline = Pipeline::default();
        let mut pending: Option<(usize, usize)> = None;
        for (n, packet) in packets.packets.iter().enumerate() {
            let Packet::Write { register, words, offset, .. } = packet else { continue };
            let frames = pipeline.take(device, *register, words, *offset)?;
            match *register {
                FRAME_ADDRESS => pending = None,
                FRAME_DATA => {
                    let arrived = (0..words.len() / FRAME_WORDS).map(|k| (n, k));
                    let pushed: Vec<_> = pending.into_iter().chain(arrived).collect();
                    places.extend(pushed.iter().zip(&frames).map(|((n, k), place)| (*n, *k, place.frame)));
                    pending = pushed.last().copied();
                }
                _ => {}
            }
        }
        for (n, k, frame) in places {
            let Packet::Write { words, .. } = &mut packets.packets[n] else { continue };
            let data = &mut words[k * FRAME_WORDS..(k + 1) * FRAME_WORDS];
            for bit in 0..FRAME_BITS {
                let (word, shift) = position(bit);
                let value = u32::from(self.bit(Bit { frame, bit: bit as u16 }));
                data[word] = data[word] & !(1 << shift) | value << shift;
            }
        }
        Ok(())
    }

    /// A whole bitstream, in the order of registers that the vendor's tools write.
    #[must_use]
    pub fn packets(&self, device: &Device, start_up: StartUp) -> Packets {
        let mut packets = Packets { lead: 4, packets: Vec::new(), rest: Vec::new() };
        let mut write = |register: u32, words: Vec<u32>| write(&mut packets.packets, register, words);
        write(COMMAND, vec![RESET_CRC]);
        write(FRAME_LENGTH, vec![FRAME_WORDS as u32 - 1]);
        write(OPTIONS, vec![start_up.options]);
        write(MASK, vec![0]);
        write(COMMAND, vec![SWITCH_CLOCK]);
        let columns = device.frame_columns();
        let interconnect: u16 = columns.iter().filter(|column| column.block == 0).map(|column| column.frames).sum();
        let contents: Vec<_> = columns.iter().filter(|column| column.block == 1).collect();
        let bursts = std::iter::once((FrameAddress(0), interconnect))
            .chain(contents.iter().map(|column| (FrameAddress::new(1, column.major.into(), 0), column.frames)));
        for (n, (address, frames)) in bursts.enumerate() {
            // The last burst has its padding after the command that announces it.
            let padding = u16::from(n < contents.len());
            write(FRAME_ADDRESS, vec![address.0]);
            if n == 0 {
                write(COMMAND, vec![WRITE_CONFIGURATION]);
            }
            write(FRAME_DATA, vec![0; usize::from(frames + padding) * FRAME_WORDS]);
        }
        write(CRC, vec![0]);
        write(COMMAND, vec![LAST_FRAME]);
        write(FRAME_DATA, vec![0; FRAME_WORDS]);
        write(COMMAND, vec![START]);
        write(CONTROL, vec![start_up.control]);
        write(CRC, vec![0]);
        packets.packets.extend(std::iter::repeat_n(Packet::Idle(0), 4));
        let stored = self.store(device, &mut packets);
        debug_assert!(stored.is_ok());
        packets
    }

    /// A `.bit` file.
    #[must_use]
    pub fn file(&self, device: &Device, header: &Header, start_up: StartUp) -> Vec<u8> {
        let stream = self.packets(device, start_up).encode();
        debug_assert_eq!(stream.len(), container::BYTES);
        let mut file = header.encode(stream.len());
        file.extend(stream);
        file
    }
}

/// A frame that reaches the memory.
struct Place {
    frame: u16,
    data: Vec<u32>,
}

/// The pipeline of one frame before the memory.
#[derive(Default)]
struct Pipeline {
    next: u16,
    waiting: Option<Place>,
}

impl Pipeline {
    /// Takes a register write; what it pushes into the memory.
    fn take(&mut self, device: &Device, register: u32, words: &[u32], offset: usize) -> Result<Vec<Place>, FrameError> {
        match register {
            FRAME_ADDRESS => {
                for address in words {
                    let found = device.frame_at(FrameAddress(*address));
                    self.next = found.ok_or(FrameError::Address { offset, address: *address })?;
                    self.waiting = None;
                }
                Ok(Vec::new())
            }
            FRAME_DATA if !words.len().is_multiple_of(FRAME_WORDS) => {
                Err(FrameError::Part { offset, words: words.len() })
            }
            FRAME_DATA => {
                let mut pushed = Vec::new();
                for data in words.chunks(FRAME_WORDS) {
                    if let Some(place) = self.waiting.take() {
                        if usize::from(place.frame) >= FRAMES {
                            return Err(FrameError::Beyond { offset });
                        }
                        pushed.push(place);
                    }
                    self.waiting = Some(Place { frame: self.next, data: data.to_vec() });
                    self.next = self.next.saturating_add(1);
                }
                Ok(pushed)
            }
            _ => Ok(Vec::new()),
        }
    }
}

/// Word and shift of a bit in a frame.
fn position(bit: usize) -> (usize, usize) {
    let at = bit + PAD_BITS;
    (DATA_WORDS - 1 - at / 32, at % 32)
}

/// Appends a write, with a header of type 2 where the words do not fit type 1.
fn write(packets: &mut Vec<Packet>, register: u32, words: Vec<u32>) {
    const TYPE_1_WRITE: u32 = 1 << 29 | 2 << 27;
    const TYPE_2_WRITE: u32 = 2 << 29 | 2 << 27;
    const TYPE_1_WORDS: usize = 2_047;
    // Offsets matter to readers only.
    let offset = 0;
    let header = TYPE_1_WRITE | register << 13;
    if words.len() <= TYPE_1_WORDS {
        packets.push(Packet::Write { header: header | words.len() as u32, register, words, offset });
    } else {
        packets.push(Packet::Write { header, register, words: Vec::new(), offset });
        packets.push(Packet::Write { header: TYPE_2_WRITE | words.len() as u32, register, words, offset });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::container::Bitstream;

    fn noise(seed: u64) -> Configuration {
        let mut configuration = Configuration::zero();
        let mut state = seed;
        for frame in 0..FRAMES as u16 {
            for bit in 0..FRAME_BITS as u16 {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                configuration.set_bit(Bit { frame, bit }, state >> 60 & 1 == 1);
            }
        }
        configuration
    }

    #[test]
    fn any_configuration_survives_a_file_and_the_file_is_accepted() {
        let device = Device::xc2s200();
        let header = Header { design: "noise.ncd".into(), part: container::PART.into(), ..Header::default() };
        for seed in 0..3 {
            let configuration = noise(seed);
            let file = configuration.file(device, &header, StartUp::default());
            let read = Bitstream::parse(&file).expect("what we write can be read");
            assert_eq!((read.header.as_ref(), read.summary.crc_checks), (Some(&header), 2));
            assert_eq!(Configuration::from_packets(device, &read.packets), Ok(configuration));
            assert_eq!(read.encode(&read.packets), file);
            assert_eq!(read.packets.last(OPTIONS), Some(0x0080_5F1D));
        }
    }

    #[test]
    fn packets_of_a_file_take_another_configuration() {
        let device = Device::xc2s200();
        let mut packets = noise(1).packets(device, StartUp { options: 0x0080_3F2D, control: 0 });
        noise(2).store(device, &mut packets).expect("the device's frames");
        assert_eq!(packets, noise(2).packets(device, StartUp { options: 0x0080_3F2D, control: 0 }));
    }

    #[test]
    fn frames_that_fit_no_device_are_named() {
        let device = Device::xc2s200();
        let change = |change: &dyn Fn(&mut u32, &mut Vec<u32>)| {
            let mut packets = Configuration::blank(device).packets(device, StartUp::default());
            for packet in &mut packets.packets {
                if let Packet::Write { register, words, .. } = packet {
                    change(register, words);
                }
            }
            Configuration::from_packets(device, &packets).expect_err("not the device's frames")
        };
        let address = change(&|register, words| {
            if *register == FRAME_ADDRESS && words[0] != 0 {
                words[0] = 0x0600_0000;
            }
        });
        assert!(matches!(address, FrameError::Address { address: 0x0600_0000, .. }), "{address}");
        let part = change(&|register, words| {
            if *register == FRAME_DATA && !words.is_empty() {
                words.pop();
            }
        });
        assert!(matches!(part, FrameError::Part { .. }), "{part}");
        let missing = change(&|register, words| {
            if *register == FRAME_DATA && words.len() > 30_000 {
                words.truncate(18 * 100);
            }
        });
        assert_eq!(
            missing.to_string(),
            "frame 99 (0x00045600) and 2086 others are not written; partial bitstreams configure no whole device"
        );
        let beyond = change(&|register, words| {
            if *register == FRAME_DATA && words.len() == 64 * 18 {
                words.extend(vec![0; 18 * 9]);
            }
        });
        assert!(matches!(beyond, FrameError::Beyond { .. }), "{beyond}");
    }
}
