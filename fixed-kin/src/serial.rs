//! Bit-true twin of the serial receiver: levels of an asynchronous line to bytes.
//!
//! Eight bits, lowest first, no parity, one stop bit, idle high. A start bit that is gone in its
//! middle was a spike; every bit is looked at once, in its middle. One [`Receiver::clock`] is one
//! rising edge of the FPGA clock.

/// Strobes of the receiver in a clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Heard {
    /// The line behind the synchroniser, true = high.
    pub level: bool,
    /// A bit's time has passed, also while nothing is heard.
    pub bit_time: bool,
    /// A start bit begins.
    pub start: bool,
    /// A data bit is read: it is `level`.
    pub bit: bool,
    /// A byte is whole.
    pub byte: Option<u8>,
    /// A stop bit was low: no byte.
    pub broken: bool,
}

/// The receiver's state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Receiver {
    clocks_per_bit: u16,
    low_1: bool,
    low_2: bool,
    hearing: bool,
    clocks: u16,
    bit: u8,
    shift: u8,
}

impl Receiver {
    /// A receiver on a quiet line; a bit takes `clocks_per_bit` clocks, 4 to 511 and held within.
    #[must_use]
    pub const fn new(clocks_per_bit: u16) -> Self {
        let clocks_per_bit = match clocks_per_bit {
            0..4 => 4,
            512.. => 511,
            clocks => clocks,
        };
        Self { clocks_per_bit, low_1: false, low_2: false, hearing: false, clocks: 0, bit: 0, shift: 0 }
    }

    /// A byte is on its way.
    #[must_use]
    pub const fn hearing(&self) -> bool {
        self.hearing
    }

    /// The line behind the synchroniser, true = high.
    #[must_use]
    pub const fn level(&self) -> bool {
        !self.low_2
    }

    /// One clock; `enable` lets a new byte begin. The strobes are those in force before the edge.
    pub fn clock(&mut self, line: bool, enable: bool) -> Heard {
        let before = *self;
        let level = !before.low_2;
        let due = before.clocks == 0;
        let mut heard = Heard { level, bit_time: due, ..Heard::default() };
        self.clocks = if due { self.clocks_per_bit - 1 } else { before.clocks - 1 };
        self.low_1 = !line;
        self.low_2 = before.low_1;
        if !before.hearing {
            heard.start = !level && enable;
            if heard.start {
                self.hearing = true;
                self.clocks = self.clocks_per_bit / 2 - 1;
                self.bit = 0;
            }
            return heard;
        }
        if !due {
            return heard;
        }
        self.bit = before.bit + 1;
        match before.bit {
            0 => self.hearing = !level,
            9 => {
                self.hearing = false;
                heard.byte = level.then_some(before.shift);
                heard.broken = !level;
            }
            _ => {
                heard.bit = true;
                self.shift = before.shift >> 1 | u8::from(level) << 7;
            }
        }
        heard
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hear(levels: impl IntoIterator<Item = bool>) -> std::vec::Vec<Heard> {
        let mut receiver = Receiver::new(8);
        levels.into_iter().map(|level| receiver.clock(level, true)).collect()
    }

    fn byte(value: u8, stop: bool) -> impl Iterator<Item = bool> {
        let bits = u32::from(value) << 1 | u32::from(stop) << 9 | 1 << 10;
        (0..11 * 8).map(move |clock| bits >> (clock / 8) & 1 == 1)
    }

    #[test]
    fn every_byte_is_heard() {
        for value in 0..=255 {
            let heard = hear(byte(value, true));
            let bytes: std::vec::Vec<_> = heard.iter().filter_map(|h| h.byte).collect();
            assert_eq!(bytes, [value]);
            assert_eq!(heard.iter().filter(|h| h.bit).count(), 8);
        }
    }

    #[test]
    fn a_spike_is_no_byte_and_a_low_stop_bit_is_broken() {
        let heard = hear((0..200).map(|clock| !(10..13).contains(&clock)));
        assert!(heard.iter().all(|h| h.byte.is_none() && !h.broken && !h.bit));
        let heard = hear(byte(0x55, false));
        assert!(heard.iter().any(|h| h.broken) && heard.iter().all(|h| h.byte.is_none()));
    }
}
