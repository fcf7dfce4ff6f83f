//! The configuration logic of a Spartan-II XC2S200, as its byte-wide port shows it.
//!
//! Written from the device's side, apart from the driver's reader of files: bytes come one a strobe, the
//! first configuration bit on data line 0. Sources: Xilinx application notes 138, 151 and 176 by way of
//! code written against them; sizes from files for this device. Two things are **assumptions**: with frames
//! of another length, or too few of them, DONE stays low and INIT high; DONE rises 16 clocks after the last
//! right CRC word that follows the start command.

use bitstream::container::packets::{Packet, Packets};
use bitstream::container::{FRAME_WORDS, FRAMES};
use std::time::Duration;

/// PROGRAM must be low so long.
const PROGRAM_LOW: Duration = Duration::from_nanos(300);
/// Clearing takes so long after PROGRAM; at most 100 µs on a real device.
const CLEARING: Duration = Duration::from_micros(60);
/// 16 clocks of 33 MHz.
const START_UP: Duration = Duration::from_nanos(480);
const SYNC: u32 = 0xAA99_5566;

/// The CRC register as the device has it: shifts left, taps at 15, 2 and 0.
#[derive(Clone, Copy, Debug, Default)]
pub struct DeviceCrc(u16);

impl DeviceCrc {
    /// A register write.
    pub fn feed(&mut self, register: u32, word: u32) {
        let bits = u64::from(word) | u64::from(register & 0xF) << 32;
        for n in 0..36 {
            let out = self.0 >> 15 ^ (bits >> n & 1) as u16;
            self.0 = self.0 << 1 ^ if out & 1 == 1 { 0x8005 } else { 0 };
        }
    }

    /// As a CRC word of a bitstream has it.
    #[must_use]
    pub fn value(self) -> u32 {
        u32::from(self.0.reverse_bits())
    }
}

/// Where the device stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// PROGRAM low since then: all clear, pins float.
    Held(Duration),
    /// Clearing until then.
    Clearing(Duration),
    /// Takes bytes.
    Ready,
    /// A CRC word was wrong.
    CrcError,
    /// DONE rises then.
    Starting(Duration),
}

/// See the module.
#[derive(Clone, Debug)]
pub struct SelectMap {
    phase: Phase,
    /// Before PROGRAM fell, for a pulse too short to count.
    before: Option<Phase>,
    shift: u32,
    synced: bool,
    bytes_of_word: u32,
    /// Register and words still to come.
    packet: (u32, u32),
    /// The next word is the first of its packet.
    fresh: bool,
    crc: DeviceCrc,
    frame_length: Option<u32>,
    writes: Vec<(u32, Vec<u32>)>,
    frame_words: usize,
    start: bool,
}

impl SelectMap {
    /// A device just powered, which clears itself.
    #[must_use]
    pub fn new(now: Duration) -> Self {
        Self {
            phase: Phase::Clearing(now + CLEARING),
            before: None,
            shift: 0,
            synced: false,
            bytes_of_word: 0,
            packet: (0, 0),
            fresh: true,
            crc: DeviceCrc::default(),
            frame_length: None,
            writes: Vec::new(),
            frame_words: 0,
            start: false,
        }
    }

    /// The level of PROGRAM at this time.
    pub fn program(&mut self, high: bool, now: Duration) {
        match (high, self.phase) {
            (false, Phase::Held(_)) => {}
            (false, phase) => {
                self.before = Some(phase);
                self.phase = Phase::Held(now);
            }
            (true, Phase::Held(since)) if now.saturating_sub(since) < PROGRAM_LOW => {
                self.phase = self.before.take().unwrap_or(Phase::Held(since));
            }
            (true, Phase::Held(_)) => *self = Self::new(now),
            (true, _) => {}
        }
    }

    /// The DONE line.
    #[must_use]
    pub fn done(&self, now: Duration) -> bool {
        matches!(self.phase, Phase::Starting(at) if now >= at)
    }

    /// The INIT line.
    #[must_use]
    pub fn init(&self, now: Duration) -> bool {
        match self.phase {
            Phase::Held(_) | Phase::CrcError => false,
            Phase::Clearing(until) => now >= until,
            Phase::Ready | Phase::Starting(_) => true,
        }
    }

    /// What was written to the registers since the sync word.
    #[must_use]
    pub fn packets(&self) -> Packets {
        let write = |(register, words): &(u32, Vec<u32>)| Packet::Write {
            header: 0,
            register: *register,
            words: words.clone(),
            offset: 0,
        };
        Packets { lead: 0, packets: self.writes.iter().map(write).collect(), rest: Vec::new() }
    }

    /// Whether the same was written as by these packets.
    #[must_use]
    pub fn has(&self, packets: &Packets) -> bool {
        let theirs = packets.packets.iter().filter_map(|packet| match packet {
            Packet::Write { register, words, .. } if !words.is_empty() => Some((*register, words)),
            _ => None,
        });
        self.writes.iter().map(|(register, words)| (*register, words)).eq(theirs)
    }

    /// A byte on the data lines with chip select; WRITE low is the caller's business.
    pub fn strobe(&mut self, lanes: u8, now: Duration) {
        match self.phase {
            Phase::Clearing(until) if now >= until => self.phase = Phase::Ready,
            Phase::Ready => {}
            _ => return,
        }
        // Data line 0 carries the highest bit.
        self.shift = self.shift << 8 | u32::from(lanes.reverse_bits());
        if !self.synced {
            self.synced = self.shift == SYNC;
            self.bytes_of_word = 0;
            return;
        }
        self.bytes_of_word += 1;
        if self.bytes_of_word == 4 {
            self.bytes_of_word = 0;
            self.word(self.shift, now);
        }
    }

    fn word(&mut self, word: u32, now: Duration) {
        let (register, left) = self.packet;
        if left > 0 {
            self.packet.1 -= 1;
            match self.writes.last_mut() {
                Some((_, words)) if !self.fresh => words.push(word),
                _ => self.writes.push((register, vec![word])),
            }
            self.fresh = false;
            self.write(register, word, now);
            return;
        }
        self.fresh = true;
        match (word >> 29, word >> 27 & 3) {
            (1, 2) => self.packet = (word >> 13 & 0xF, word & 0x7FF),
            (2, 2) => self.packet = (register, word & 0x07FF_FFFF),
            _ => {}
        }
    }

    fn write(&mut self, register: u32, word: u32, now: Duration) {
        match register {
            0 => {
                let right = word == self.crc.value();
                self.crc = DeviceCrc::default();
                if !right {
                    self.phase = Phase::CrcError;
                } else if self.start && self.whole() {
                    self.phase = Phase::Starting(now + START_UP);
                }
                return;
            }
            2 => self.frame_words += 1,
            4 if word == 5 => self.start = true,
            11 => self.frame_length = Some(word + 1),
            _ => {}
        }
        self.crc.feed(register, word);
        if register == 4 && word == 7 {
            self.crc = DeviceCrc::default();
        }
    }

    fn whole(&self) -> bool {
        self.frame_length == Some(FRAME_WORDS as u32) && self.frame_words == FRAMES * FRAME_WORDS
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::circuit::committed;

    const LATER: Duration = Duration::from_millis(1);

    fn after(bytes: impl IntoIterator<Item = u8>) -> SelectMap {
        let mut device = SelectMap::new(Duration::ZERO);
        for byte in bytes {
            device.strobe(byte, LATER);
        }
        device
    }

    fn lanes() -> Vec<u8> {
        committed().lanes().to_vec()
    }

    #[test]
    fn the_tail_of_real_bitstreams_gives_their_last_crc_word() {
        let mut crc = DeviceCrc::default();
        crc.feed(4, 3);
        (0..18).for_each(|_| crc.feed(2, 0));
        crc.feed(4, 5);
        crc.feed(5, 0);
        assert_eq!(crc.value(), 0x38FE);
    }

    #[test]
    fn a_right_stream_configures() {
        let device = after(lanes());
        assert!(device.init(LATER) && !device.done(LATER) && device.done(2 * LATER));
        assert!(device.has(&committed().packets));
        let decode = |packets: &Packets| {
            bitstream::configuration::Configuration::from_packets(bitstream::device::Device::xc2s200(), packets)
        };
        assert_eq!(decode(&device.packets()).unwrap(), decode(&committed().packets).unwrap());
    }

    #[test]
    fn wrong_order_of_bits_and_short_streams_do_nothing() {
        let device = after(lanes().into_iter().map(u8::reverse_bits));
        assert!(device.init(LATER) && !device.done(2 * LATER));
        let device = after(lanes().into_iter().take(166_980 - 20));
        assert!(device.init(LATER) && !device.done(2 * LATER));
    }

    #[test]
    fn a_flipped_bit_drops_init() {
        let mut lanes = lanes();
        lanes[90_000] ^= 4;
        let device = after(lanes);
        assert!(!device.init(2 * LATER) && !device.done(2 * LATER));
    }

    #[test]
    fn program_clears_unless_its_pulse_is_too_short() {
        let mut device = after(lanes());
        device.program(false, 2 * LATER);
        assert!(!device.done(2 * LATER) && !device.init(2 * LATER));
        device.program(true, 2 * LATER + Duration::from_nanos(100));
        assert!(device.done(3 * LATER));
        device.program(false, 3 * LATER);
        device.program(true, 4 * LATER);
        assert!(!device.done(5 * LATER) && !device.init(4 * LATER) && device.init(5 * LATER));
    }

    #[test]
    fn bytes_before_init_are_lost() {
        let mut device = SelectMap::new(LATER);
        for byte in lanes() {
            device.strobe(byte, LATER);
        }
        assert!(!device.done(9 * LATER));
    }
}
