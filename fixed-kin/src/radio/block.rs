//! Bit-true twin of the radio block: levels of the line in, writes to the core out, clock by clock.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "bytes of a word"
)]

use super::frame::step;
use super::{
    CLOCKS_PER_BIT, CRC_BYTES, CRC_RESIDUE, GAP_BYTES, HEAD, Link, MAX_WRITES, STRAP_CLOCKS, WRITE_BYTES, offset_of,
};
use crate::serial::Receiver;

/// Pins, strobes and levels the block sees at one clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// The line, idle high.
    pub rx: bool,
    /// Strap: high or open = the host on the bus commands, low = the radio.
    pub host_select: bool,
    /// Strap: the robot's number, open = 15.
    pub robot: u8,
    /// Outputs may be on.
    pub armed: bool,
    /// The core takes the word that is offered.
    pub taken: bool,
    /// Strobe: `radio` is written, which `armed` locks.
    pub select_write: bool,
    /// Its bit 0.
    pub select: bool,
}

/// Outputs of the block after a clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// A word is offered to the core.
    pub offer: bool,
    /// Its word address.
    pub address: u16,
    /// What is written there.
    pub data: u32,
    /// The radio commands.
    pub selected: bool,
    /// Frames taken, wrapping.
    pub accepted: u8,
    /// Frames that did nothing, wrapping.
    pub dropped: u8,
}

/// What the next byte is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Stage {
    #[default]
    Head,
    Robot,
    Length,
    Sequence,
    Payload,
    Crc,
    Done,
}

/// State of the radio block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Radio {
    receiver: Receiver,
    link: Link,
    low_1: bool,
    low_2: bool,
    robot_1: u8,
    settling: u8,
    steady: bool,
    selected: bool,
    /// The next byte may be a frame's; not so after anything wrong, until a silence.
    listening: bool,
    /// Bits' time of silence.
    quiet: u8,
    stage: Stage,
    /// Byte of the write, or of the CRC.
    inner: u8,
    /// Writes to come.
    count: u8,
    total: u8,
    sequence: u8,
    crc: u32,
    memory: [u8; 512],
    pointer: u16,
    fetched: u8,
    playing: bool,
    gather: u8,
    offer: bool,
    code: u8,
    data: u32,
}

impl Default for Radio {
    fn default() -> Self {
        Self::new(CLOCKS_PER_BIT)
    }
}

impl Radio {
    /// A block just configured, for a line on which a bit takes so many clocks, 4 to 511 and held within.
    #[must_use]
    pub const fn new(clocks_per_bit: u16) -> Self {
        Self {
            receiver: Receiver::new(clocks_per_bit),
            link: Link::new(0),
            low_1: false,
            low_2: false,
            robot_1: 0,
            settling: 0,
            steady: false,
            selected: false,
            listening: false,
            quiet: 0,
            stage: Stage::Head,
            inner: 0,
            count: 0,
            total: 0,
            sequence: 0,
            crc: 0,
            memory: [0; 512],
            pointer: 0,
            fetched: 0,
            playing: false,
            gather: 0,
            offer: false,
            code: 0,
            data: 0,
        }
    }

    /// A rising edge of the clock, with what the block sees before it.
    pub fn clock(&mut self, inputs: &Inputs) -> Outputs {
        let hearing = self.receiver.hearing();
        let silent = self.quiet == 10 * GAP_BYTES as u8;
        self.straps(inputs);
        let boundary = silent && !self.playing && (!self.listening || self.stage != Stage::Head);
        self.play(inputs.taken);
        if boundary {
            self.judge(inputs.armed);
        }
        let heard = self.receiver.clock(inputs.rx, true);
        if silent {
            self.crc = u32::MAX;
        } else if heard.bit {
            self.crc = step(self.crc, heard.level);
        }
        if !heard.level || hearing {
            self.quiet = 0;
        } else if heard.bit_time && !silent {
            self.quiet += 1;
        }
        if self.listening {
            match heard.byte {
                Some(byte) => self.take(byte),
                None if heard.broken => self.refuse(),
                None => {}
            }
        }
        self.outputs()
    }

    /// The outputs after the last clock.
    #[must_use]
    pub fn outputs(&self) -> Outputs {
        Outputs {
            offer: self.offer,
            address: offset_of(self.code) / 4,
            data: self.data,
            selected: self.selected,
            accepted: self.link.accepted,
            dropped: self.link.dropped,
        }
    }

    /// Straps are read once, after the last of seven clocks at one level.
    fn straps(&mut self, inputs: &Inputs) {
        let low = self.low_2;
        if self.settling != STRAP_CLOCKS {
            if self.settling == STRAP_CLOCKS - 1 {
                self.selected = self.steady && low;
                self.link.robot = self.robot_1;
            }
            self.steady = low && (self.steady || self.settling == STRAP_CLOCKS / 2);
            self.settling += 1;
        }
        if inputs.select_write && !inputs.armed {
            self.selected = inputs.select;
        }
        self.low_2 = self.low_1;
        self.low_1 = !inputs.host_select;
        self.robot_1 = inputs.robot & 15;
    }

    /// Five bytes from the memory, then a word is offered until it is taken.
    fn play(&mut self, taken: bool) {
        let fetched = self.fetched;
        self.fetched = self.memory[usize::from(self.pointer)];
        if !self.playing {
            return;
        }
        if self.offer {
            if taken {
                self.offer = false;
                self.count -= 1;
                self.playing = self.count != 0;
            }
            return;
        }
        if self.gather != 0 {
            self.code = self.data as u8;
            self.data = self.data >> 8 | u32::from(fetched) << 24;
        }
        if self.gather == WRITE_BYTES as u8 {
            self.gather = 0;
            self.offer = true;
        } else {
            self.gather += 1;
            self.pointer += 1;
        }
    }

    /// A silence: what came before it is a frame, or it is none.
    fn judge(&mut self, armed: bool) {
        let began = self.listening;
        let whole = self.stage == Stage::Done && self.crc == CRC_RESIDUE;
        self.listening = true;
        self.stage = Stage::Head;
        if !began {
            return;
        }
        if !whole || !self.link.is_fresh(self.sequence, armed) {
            self.link.dropped = self.link.dropped.wrapping_add(1);
            return;
        }
        self.link.last = self.sequence;
        self.link.accepted = self.link.accepted.wrapping_add(1);
        if self.selected {
            self.listening = false;
            self.playing = true;
            self.count = self.total;
            self.pointer = 0;
        }
    }

    fn refuse(&mut self) {
        self.listening = false;
        self.stage = Stage::Head;
        self.link.dropped = self.link.dropped.wrapping_add(1);
    }

    fn take(&mut self, byte: u8) {
        self.stage = match self.stage {
            Stage::Head if byte == HEAD => Stage::Robot,
            Stage::Robot if byte == self.link.robot => Stage::Length,
            Stage::Robot => {
                self.listening = false;
                Stage::Head
            }
            Stage::Length if (1..=MAX_WRITES as u8).contains(&byte) => {
                self.total = byte;
                self.count = byte;
                self.pointer = 0;
                self.inner = 0;
                Stage::Sequence
            }
            Stage::Sequence => {
                self.sequence = byte;
                Stage::Payload
            }
            Stage::Payload => {
                self.memory[usize::from(self.pointer)] = byte;
                self.pointer += 1;
                self.inner += 1;
                if self.inner == WRITE_BYTES as u8 {
                    self.inner = 0;
                    self.count -= 1;
                }
                if self.count == 0 { Stage::Crc } else { Stage::Payload }
            }
            Stage::Crc => {
                self.inner += 1;
                if self.inner == CRC_BYTES as u8 { Stage::Done } else { Stage::Crc }
            }
            Stage::Head | Stage::Length | Stage::Done => return self.refuse(),
        };
    }
}

#[cfg(test)]
mod tests {
    use super::super::Frame;
    use super::*;
    use crate::registers as map;
    use std::vec::Vec;

    const BIT: u16 = 8;
    const ROBOT: u8 = 3;

    /// Plays levels of a bit's time each; the writes that came out.
    fn play(radio: &mut Radio, levels: impl IntoIterator<Item = bool>) -> Vec<(u16, u32)> {
        let mut writes = Vec::new();
        for rx in levels.into_iter().flat_map(|level| [level; BIT as usize]) {
            let offered = radio.outputs();
            if offered.offer {
                writes.push((offered.address * 4, offered.data));
            }
            radio.clock(&Inputs { rx, robot: ROBOT, taken: offered.offer, ..Inputs::default() });
        }
        writes
    }

    /// Bytes between two silences.
    fn hear(radio: &mut Radio, bytes: &[u8]) -> Vec<(u16, u32)> {
        let silence = [true; 40];
        let levels =
            bytes.iter().flat_map(|byte| (0..10).map(move |bit| (u32::from(*byte) << 1 | 1 << 9) >> bit & 1 == 1));
        play(radio, silence.into_iter().chain(levels).chain(silence))
    }

    #[test]
    fn a_frame_acts_whole_and_undamaged_or_not_at_all() {
        let mut radio = Radio::new(BIT);
        let frame = |sequence: u8| {
            let mut frame = Frame::new(ROBOT, sequence).unwrap();
            frame.kicker(5, 2_000).unwrap();
            frame.bytes().to_vec()
        };
        assert_eq!(hear(&mut radio, &frame(1)), [(map::KICKER_PULSE.offset, 2_000), (map::KICKER_CONTROL.offset, 5)]);
        let counted = |radio: &Radio| (radio.outputs().accepted, radio.outputs().dropped);
        assert_eq!(counted(&radio), (1, 0));
        let whole = frame(2);
        for at in [3, 5, whole.len() - 1] {
            let mut damaged = whole.clone();
            damaged[at] ^= 0x10;
            assert_eq!(hear(&mut radio, &damaged), [], "byte {at} is damaged");
        }
        assert_eq!(hear(&mut radio, &whole[..whole.len() - 1]), [], "a byte is missing");
        assert_eq!(counted(&radio), (1, 4));
    }
}
