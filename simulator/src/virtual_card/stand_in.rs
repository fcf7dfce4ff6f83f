//! A stand-in for the bitstream that only Xilinx's tools can make.
//!
//! **It configures nothing on a real card.** Header, packets, lengths and CRC words are those of a real
//! file for the XC2S200; the frames hold noise, and in the first of them the name of the design that the
//! virtual card is to put in place. So everything from the file to the last dummy word is exercised, but for
//! the meaning of the frames.

use super::select_map::{DeviceCrc, FRAME_WORDS, FRAMES};
use fixed_kin::registers::BOARD_4I65;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// First words of the first frame.
const MARKER: [u32; 3] = [u32::from_be_bytes(*b"STAN"), u32::from_be_bytes(*b"D-IN"), u32::from_be_bytes(*b" RAC")];
/// Words of frame data before the two block RAM columns, and in each of these, as in real files.
const SECTIONS: [(u32, usize); 3] = [(0, 39_366), (0x0200_0000, 1_170), (0x0202_0000, 1_152)];

/// What the first frame says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StandIn {
    /// Hash that the design answers with.
    pub content_hash: u32,
    /// Board whose pins it would drive.
    pub board: u32,
}

impl StandIn {
    /// For the committed design.
    #[must_use]
    pub fn committed() -> Self {
        Self { content_hash: hdl::design::content_hash(), board: BOARD_4I65.word }
    }

    /// What the frames of a configured device hold, if a stand-in configured it.
    #[must_use]
    pub fn of_frames(frames: &[u32]) -> Option<Self> {
        let (marker, rest) = frames.split_first_chunk::<3>()?;
        (*marker == MARKER).then(|| Self { content_hash: rest[0], board: rest[1] })
    }

    /// A `.bit` file of exactly the real size.
    #[must_use]
    pub fn bit(&self) -> Vec<u8> {
        Self::file("rac4i65-stand-in.ncd", &self.stream())
    }

    /// A `.bit` file that is as right as any, of a design by this name that is none of ours.
    #[must_use]
    pub fn foreign(design: &str) -> Vec<u8> {
        Self::file(design, &Self::stream_of(&Self::noise(0)))
    }

    fn file(design: &str, stream: &[u8]) -> Vec<u8> {
        let mut file = vec![0, 9, 0x0F, 0xF0, 0x0F, 0xF0, 0x0F, 0xF0, 0x0F, 0xF0, 0, 0, 1];
        let fields = [(b'a', design), (b'b', "2s200pq208"), (b'c', "2005/01/01"), (b'd', "00:00:00")];
        for (tag, text) in fields {
            file.push(tag);
            file.extend(((text.len() + 1) as u16).to_be_bytes());
            file.extend(text.as_bytes());
            file.push(0);
        }
        file.push(b'e');
        file.extend((stream.len() as u32).to_be_bytes());
        file.extend_from_slice(stream);
        file
    }

    /// The same for a PROM programmer: no header, bits of every byte reversed.
    #[must_use]
    pub fn prom(&self) -> Vec<u8> {
        self.stream().into_iter().map(u8::reverse_bits).collect()
    }

    /// The bitstream alone.
    #[must_use]
    pub fn stream(&self) -> Vec<u8> {
        let mut frames = Self::noise(self.content_hash.into());
        frames[..3].copy_from_slice(&MARKER);
        (frames[3], frames[4]) = (self.content_hash, self.board);
        Self::stream_of(&frames)
    }

    /// Frames, the first of them blank.
    fn noise(seed: u64) -> Vec<u32> {
        let mut frames = vec![0; FRAMES * FRAME_WORDS];
        let mut noise = ChaCha8Rng::seed_from_u64(seed);
        frames[FRAME_WORDS..].fill_with(|| noise.next_u32());
        frames
    }

    fn stream_of(frames: &[u32]) -> Vec<u8> {
        let mut out = Packets::default();
        out.words.extend([u32::MAX, 0xAA99_5566]);
        out.command(7);
        out.register(11, &[FRAME_WORDS as u32 - 1]);
        out.register(9, &[0x0080_5F1D]);
        out.register(6, &[0]);
        out.command(9);
        let mut rest = frames;
        for (index, (address, words)) in SECTIONS.into_iter().enumerate() {
            let (section, behind) = rest.split_at(words);
            rest = behind;
            out.register(1, &[address]);
            if index == 0 {
                out.command(1);
            }
            out.register(2, section);
        }
        out.check();
        out.command(3);
        out.register(2, rest);
        out.command(5);
        out.register(5, &[0]);
        out.check();
        out.words.extend([0; 4]);
        out.words.into_iter().flat_map(u32::to_be_bytes).collect()
    }
}

#[derive(Debug, Default)]
struct Packets {
    words: Vec<u32>,
    crc: DeviceCrc,
}

impl Packets {
    fn register(&mut self, register: u32, data: &[u32]) {
        const WRITE: u32 = 2 << 27;
        let header = 1 << 29 | WRITE | register << 13;
        if data.len() < 1 << 11 {
            self.words.push(header | data.len() as u32);
        } else {
            self.words.extend([header, 2 << 29 | WRITE | data.len() as u32]);
        }
        for &word in data {
            self.words.push(word);
            self.crc.feed(register, word);
        }
    }

    fn command(&mut self, command: u32) {
        self.register(4, &[command]);
        if command == 7 {
            self.crc = DeviceCrc::default();
        }
    }

    fn check(&mut self) {
        self.words.extend([1 << 29 | 2 << 27 | 1, self.crc.value()]);
        self.crc = DeviceCrc::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_has_the_size_and_the_last_words_of_a_real_file() {
        let stream = StandIn::committed().stream();
        assert_eq!(stream.len(), 166_980);
        // In real files the last frame is zero, and then the last CRC word is 38FE; ours is noise.
        assert_eq!(stream[stream.len() - 16..], [0; 16]);
        let bit = StandIn::committed().bit();
        assert!((167_050..167_070).contains(&bit.len()), "{}", bit.len());
        assert_ne!(StandIn::committed().stream(), StandIn { content_hash: 1, ..StandIn::committed() }.stream());
    }
}
