//! Bit-true twin of the block that reads an inertial sensor over SPI at every control tick.
//!
//! A burst sends a register's address and reads [`WORDS`] words of two bytes, highest byte first; an access,
//! which the host asks for while bursts are off, is one byte each way. Neither asks the sensor for anything but
//! bits, so that both take as long with a dead sensor as with a good one: [`burst_clocks`] is below the shortest
//! control period for every value of `half`.

#![allow(clippy::cast_possible_truncation, reason = "bytes of shift registers: the bits above are those that leave")]

use crate::registers::{IMU_ENABLE, IMU_VALUE, MIN_TICK_PERIOD};

/// Words of a burst.
pub const WORDS: usize = 7;
/// Words of a snapshot that are the sensor's: the age, then those of the burst.
pub const SNAPSHOT_IMU_WORDS: usize = WORDS + 1;
/// The age that says that there is none: no data-ready edge, or the sensor is not read.
pub const NO_AGE: u16 = u16::MAX;
/// The flag of the command's first bit: read.
pub const READ_FLAG: u16 = 0x8000;

/// First half of a burst and of an access, counted to 255, which is the trail.
const BURST_START: u8 = 14;
const ACCESS_START: u8 = 222;

/// Clocks from the first with chip select low to the last, for a burst.
#[must_use]
pub const fn burst_clocks(half: u8) -> u32 {
    (256 - BURST_START as u32) * (half as u32 % 4 + 1)
}

/// The same for an access.
#[must_use]
pub const fn access_clocks(half: u8) -> u32 {
    (256 - ACCESS_START as u32) * (half as u32 % 4 + 1)
}

// A burst begins two clocks after the tick's and must be over before the next.
const _: () = assert!(burst_clocks(3) + 2 < MIN_TICK_PERIOD);

/// What a burst brings, at the granularity of control ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample {
    /// Clocks from the last rise of the data-ready line to the tick, [`NO_AGE`] where there was none.
    pub age: u16,
    /// Words in the order in which the sensor sent them.
    pub words: [u16; WORDS],
}

impl Default for Sample {
    /// No sensor: lines that are pulled up.
    fn default() -> Self {
        Self { age: NO_AGE, words: [u16::MAX; WORDS] }
    }
}

/// Reader at the granularity of control ticks: bursts and accesses take no time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Port {
    request: Option<u16>,
    value: u8,
}

impl Port {
    /// The host asks for an access, where bursts are off. Until somebody answers, nobody does.
    pub fn access(&mut self, control: u32, command: u32) {
        if !IMU_ENABLE.is_set(control) {
            (self.request, self.value) = (Some(command as u16), u8::MAX);
        }
    }

    /// An access since the last call, for whoever stands behind the pins.
    pub fn take(&mut self) -> Option<u16> {
        self.request.take()
    }

    /// The byte that the sensor sent in it.
    pub fn answer(&mut self, byte: u8) {
        self.value = byte;
    }

    /// `imu_status`.
    #[must_use]
    pub fn status(&self) -> u32 {
        IMU_VALUE.place(self.value.into())
    }

    /// A control tick puts the sensor's words into its snapshot; without bursts they stay as they are there.
    pub fn tick(&mut self, control: u32, sample: &Sample, words: &mut [u32]) {
        let enabled = IMU_ENABLE.is_set(control);
        let age = if enabled { sample.age } else { NO_AGE };
        let read = sample.words.iter().filter(|_| enabled);
        for (word, value) in words.iter_mut().zip([&age].into_iter().chain(read)) {
            *word = u32::from(*value);
            self.value = if enabled { *value as u8 } else { self.value };
        }
    }
}

/// What the block sees at one clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// A control tick.
    pub tick: bool,
    /// Bank of the snapshot that the last tick began, 0 to 2.
    pub bank: u8,
    /// Read the sensor at every tick.
    pub enable: bool,
    /// The line's clock rests high (mode 3), not low (mode 0).
    pub idle_high: bool,
    /// Half a period of the line's clock in clocks, less one: 0 to 3.
    pub half: u8,
    /// First register of a burst, 7 bits.
    pub first: u8,
    /// The host asks for an access.
    pub access: bool,
    /// Its 16 bits: read flag, register, data.
    pub command: u16,
    /// Line from the sensor.
    pub miso: bool,
    /// Data-ready line of the sensor.
    pub ready: bool,
    /// Bank of the memory that is read.
    pub read_bank: u8,
    /// Word to read, 3 bits.
    pub read_word: u8,
}

/// Outputs of the block after a clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outputs {
    /// Chip select, low = selected.
    pub cs_n: bool,
    /// Clock of the line.
    pub sclk: bool,
    /// Line to the sensor.
    pub mosi: bool,
    /// A burst or an access is on its way.
    pub busy: bool,
    /// A burst is.
    pub reading: bool,
    /// The byte that the last access read.
    pub value: u8,
    /// The word at the address of the clock.
    pub read_data: u16,
}

/// State of the block.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ImuSpi {
    live: bool,
    starts: bool,
    run: bool,
    burst: bool,
    halves: u8,
    phase: u8,
    shift: u16,
    clock_high: bool,
    mosi: bool,
    ready: [bool; 3],
    left: u16,
    words: [u16; 4 * SNAPSHOT_IMU_WORDS],
    read_data: u16,
}

impl ImuSpi {
    /// One clock. What a read gives of the word that is written in the same clock is not defined.
    pub fn clock(&mut self, inputs: &Inputs) -> Outputs {
        let address = |bank: u8, word: u8| usize::from(bank % 4) * SNAPSHOT_IMU_WORDS + usize::from(word % 8);
        let (run, live, starts) = (self.run, self.live, self.starts);
        self.read_data = self.words[address(inputs.read_bank, inputs.read_word)];
        if starts {
            self.words[address(inputs.bank, 0)] = !self.left;
        }
        self.age(inputs.ready);
        self.live = inputs.enable && (live || !run);
        self.starts = inputs.tick;
        let half = inputs.half % 4;
        if !run {
            self.phase = 0;
            self.clock_high = inputs.idle_high;
            if starts && live {
                self.begin(true, BURST_START, READ_FLAG | u16::from(inputs.first % 128) << 8);
            } else if inputs.access && !inputs.enable && !live {
                self.begin(false, ACCESS_START, inputs.command);
            }
        } else if self.phase == half {
            self.phase = 0;
            let place = address(inputs.bank, self.halves >> 5);
            let data = self.burst && self.halves >> 5 != 0;
            if data && self.halves & 31 == 30 && !starts {
                self.words[place] = self.shift;
            }
            self.edge(inputs, data);
        } else {
            self.phase = (self.phase + 1) % 4;
        }
        self.outputs()
    }

    fn begin(&mut self, burst: bool, halves: u8, shift: u16) {
        (self.run, self.burst, self.halves, self.shift) = (true, burst, halves, shift);
    }

    /// The end of a half of the line's clock: low halves have odd numbers.
    fn edge(&mut self, inputs: &Inputs, data: bool) {
        match self.halves {
            u8::MAX => (self.run, self.burst) = (false, false),
            halves if halves % 2 == 1 => {
                self.clock_high = true;
                self.shift = self.shift << 1 | u16::from(inputs.miso);
            }
            halves => {
                self.clock_high = halves == u8::MAX - 1 && inputs.idle_high;
                self.mosi = self.shift & READ_FLAG != 0 && !data;
            }
        }
        self.halves = self.halves.wrapping_add(1);
    }

    fn age(&mut self, ready: bool) {
        let rises = self.ready[1] && !self.ready[2];
        self.left = match (self.live, rises) {
            (false, _) => 0,
            (true, true) => NO_AGE,
            (true, false) => self.left.saturating_sub(1),
        };
        self.ready = [ready, self.ready[0], self.ready[1]];
    }

    /// The outputs after the last clock.
    #[must_use]
    pub fn outputs(&self) -> Outputs {
        Outputs {
            cs_n: !self.run,
            sclk: self.clock_high,
            mosi: self.mosi,
            busy: self.run,
            reading: self.burst,
            value: self.shift as u8,
            read_data: self.read_data,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    /// A shift register that answers on falling edges with bytes of its own, as a sensor does.
    #[derive(Default)]
    struct Slave {
        answers: Vec<u8>,
        heard: Vec<bool>,
        sclk: bool,
        miso: bool,
    }

    impl Slave {
        fn see(&mut self, outputs: &Outputs) {
            if outputs.cs_n {
                self.heard.clear();
            } else if outputs.sclk && !self.sclk {
                self.heard.push(outputs.mosi);
                let bit = self.heard.len();
                self.miso = self.answers.get(bit / 8).is_some_and(|byte| byte >> (7 - bit % 8) & 1 == 1);
            }
            self.sclk = outputs.sclk;
        }
    }

    const ANSWER: [u8; 15] = [0xFF, 1, 2, 0x83, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14];

    fn with_slave(inputs: Inputs, clocks: u32) -> (ImuSpi, Vec<bool>, u32) {
        let mut block = ImuSpi::default();
        let mut slave = Slave { answers: ANSWER.to_vec(), ..Slave::default() };
        block.clock(&Inputs { tick: false, access: false, ..inputs });
        let (mut selected, mut heard) = (0, Vec::new());
        for clock in 0..clocks {
            let first = clock == 0;
            let outputs = block.clock(&Inputs {
                tick: inputs.tick && first,
                access: inputs.access && first,
                miso: slave.miso,
                ready: inputs.ready && clock > 0,
                ..inputs
            });
            slave.see(&outputs);
            selected += u32::from(!outputs.cs_n);
            if !slave.heard.is_empty() {
                heard.clone_from(&slave.heard);
            }
        }
        assert!(!block.outputs().busy);
        (block, heard, selected)
    }

    fn byte(bits: &[bool]) -> u8 {
        bits.iter().fold(0, |byte, &bit| byte << 1 | u8::from(bit))
    }

    #[test]
    fn a_burst_brings_fourteen_bytes_in_both_modes_at_every_rate() {
        for (half, idle_high) in (0..4).flat_map(|half| [(half, false), (half, true)]) {
            let inputs =
                Inputs { tick: true, enable: true, idle_high, half, first: 0x1D, bank: 2, ..Inputs::default() };
            let (block, heard, selected) = with_slave(inputs, MIN_TICK_PERIOD);
            assert_eq!(selected, burst_clocks(half));
            assert_eq!(heard.len(), 120, "half {half}, mode 3 {idle_high}");
            assert_eq!(byte(&heard[..8]), 0x9D);
            assert!(heard[8..].iter().all(|bit| !bit), "nothing is said after the command");
            let words: Vec<u16> = ANSWER[1..].chunks(2).map(|b| u16::from(b[0]) << 8 | u16::from(b[1])).collect();
            assert_eq!(block.words[17..24], words);
            assert_eq!(block.words[16], NO_AGE);
            assert!(block.words[..16].iter().all(|word| *word == 0), "other banks");
        }
    }

    #[test]
    fn an_access_is_two_bytes_and_only_while_bursts_are_off() {
        for half in 0..4 {
            let inputs = Inputs { access: true, command: 0xF5A3, half, ..Inputs::default() };
            let (block, heard, selected) = with_slave(inputs, 200);
            assert_eq!((selected, heard.len()), (access_clocks(half), 16));
            assert_eq!((byte(&heard[..8]), byte(&heard[8..])), (0xF5, 0xA3));
            assert_eq!(block.outputs().value, ANSWER[1]);
            assert_eq!(block.words, [0; 32]);
            let (_, heard, _) = with_slave(Inputs { enable: true, ..inputs }, 200);
            assert!(heard.is_empty());
        }
    }

    #[test]
    fn the_age_is_that_at_the_tick() {
        let mut block = ImuSpi::default();
        let inputs = Inputs { enable: true, ..Inputs::default() };
        for (high, low, expected) in [(10, 90, 100), (70_000, 0, NO_AGE), (1, 65_533, 65_534), (1, 65_600, NO_AGE)] {
            block.clock(&inputs);
            // The edge is seen at the third clock.
            for clock in 0..high + low + 2 {
                block.clock(&Inputs { ready: clock < high, ..inputs });
            }
            block.clock(&Inputs { tick: true, ..inputs });
            block.clock(&inputs);
            assert_eq!(block.words[0], expected, "{high} {low}");
            while block.clock(&inputs).busy {}
        }
        let idle = Inputs { ready: true, ..Inputs::default() };
        for tick in [false, false, false, false, true, false] {
            block.clock(&Inputs { tick, ..idle });
        }
        assert_eq!(block.words[0], NO_AGE, "off");
    }

    #[test]
    fn enabling_waits_for_an_access() {
        let mut block = ImuSpi::default();
        let off = Inputs { half: 3, ..Inputs::default() };
        block.clock(&Inputs { access: true, ..off });
        let on = Inputs { enable: true, ..off };
        for clock in 0..access_clocks(3) {
            let outputs = block.clock(&Inputs { tick: clock == 5, ..on });
            assert!(!outputs.reading);
        }
        assert!(!block.outputs().busy);
        block.clock(&on);
        block.clock(&Inputs { tick: true, ..on });
        assert!(block.clock(&on).reading);
    }
}
