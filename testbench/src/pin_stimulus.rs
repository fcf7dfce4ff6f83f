//! Seeded stimulus for every pin of the card's FPGA, and a look whether it did anything.

use fixed_kin::registers as map;
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use simulator::cosim::Layout;

/// The host's bus and every other pin, a row of inputs a clock.
pub struct Stimulus {
    random: ChaCha8Rng,
    columns: [usize; 13],
    width: usize,
    rows: Vec<u32>,
    encoders: [u32; 4],
    stop: u32,
}

const ADS: usize = 0;
const BLAST: usize = 1;
const LW_R: usize = 2;
const LAD: usize = 3;
const DRIVE: usize = 4;

impl Stimulus {
    fn new(layout: &Layout) -> Self {
        let names = [
            "ads_n",
            "blast_n",
            "lw_r",
            "lad",
            "lad.drive",
            "encoder_a",
            "encoder_b",
            "encoder_index",
            "emergency_stop",
            "ball_sensor",
            "host_select",
            "radio_rx",
            "kicker_full",
        ];
        let columns = names.map(|name| layout.input(name).unwrap());
        let (width, rows) = (layout.inputs.len(), Vec::new());
        Self { random: ChaCha8Rng::seed_from_u64(11), columns, width, rows, encoders: [0; 4], stop: 1 }
    }

    /// A drive of this many clocks: every register read from the first clock on, emergency stop pressed and released,
    /// configured, armed, kicking; then any access in any order.
    ///
    /// # Panics
    /// When the layout is not that of the card.
    #[must_use]
    pub fn whole(layout: &Layout, clocks: usize) -> Self {
        let mut stimulus = Self::new(layout);
        // Every register once from the first clock on, pressed and released.
        for register in map::REGISTERS.iter().chain(map::REGISTERS) {
            stimulus.access(register.offset, None);
            stimulus.stop ^= u32::from(register.offset == map::SNAPSHOT_SEQUENCE_END.offset);
        }
        stimulus.stop = 0;
        stimulus.idle(600);
        for (register, value) in
            [(map::TICK_PERIOD, 1_000), (map::PWM_PERIOD, 800), (map::KICKER_PULSE, 3), (map::KICKER_CONTROL, 1)]
        {
            stimulus.access(register.offset, Some(value));
        }
        stimulus.access(map::KICKER_CHARGE_TIMEOUT.offset, Some(500));
        stimulus.commit(&map::CONFIGURATION, &map::COMMIT_CONFIGURATION);
        stimulus.commit(&map::SET_POINTS, &map::COMMIT_SET_POINTS);
        stimulus.arm();
        // The charger's turn: after a first kick the capacitor rests longer than all this.
        stimulus.idle(2_048);
        while stimulus.rows.len() < clocks * stimulus.width {
            stimulus.any();
        }
        stimulus
    }

    /// All rows, one after the other.
    #[must_use]
    pub fn rows(&self) -> &[u32] {
        &self.rows
    }

    fn clock(&mut self, bus: [u32; 5]) {
        for position in &mut self.encoders {
            if self.random.random_range(0..40) == 0 {
                *position = position.wrapping_add(if self.random.random_range(0..8) == 0 { u32::MAX } else { 1 });
            }
        }
        let gray = self.encoders.map(|position| (position ^ position >> 1) & 3);
        let line = |bit: u32| gray.iter().enumerate().fold(0, |word, (axis, lines)| word | (lines >> bit & 1) << axis);
        let [ads, blast, lw_r, lad, drive] = bus;
        let ball = u32::from(self.random.random_range(0..100) == 0);
        let index = self.random.random_range(0..16);
        // Long enough without for the line's filter, and with.
        let full = ((self.rows.len() / self.width) >> 10) as u32 & 1;
        let values = [ads, blast, lw_r, lad, drive, line(0), line(1), index, self.stop, ball, 1, line(0) & 1, full];
        let mut row = vec![0; self.width];
        for (column, value) in self.columns.iter().zip(values) {
            row[*column] = value;
        }
        self.rows.extend(row);
    }

    fn idle(&mut self, clocks: usize) {
        (0..clocks).for_each(|_| self.clock([1, 1, 0, 0, 0]));
    }

    /// An access with time for the longest answer. Data stand long enough for every outcome.
    fn access(&mut self, offset: u16, write: Option<u32>) {
        let mut bus = [1, 1, 0, 0, 0];
        (bus[ADS], bus[LW_R], bus[LAD], bus[DRIVE]) = (0, u32::from(write.is_some()), offset.into(), 1);
        self.clock(bus);
        (bus[ADS], bus[BLAST], bus[LAD], bus[DRIVE]) = (1, 0, write.unwrap_or(0), u32::from(write.is_some()));
        (0..5).for_each(|_| self.clock(bus));
        self.idle(64);
    }

    fn commit(&mut self, base: &map::Register, at: &map::Register) {
        let mut sum = map::CHECKSUM_SEED;
        for index in 0..usize::from(base.words) {
            let shift = self.random.random_range(0..24);
            let word = (self.random.next_u32() as i32 >> shift) as u32;
            self.access(base.at(index), Some(word));
            sum = map::checksum(sum, base.at(index) / 4, word);
        }
        self.access(at.offset, Some(sum));
    }

    fn arm(&mut self) {
        self.access(map::FAULTS.offset, Some(u32::MAX));
        self.access(map::ARM.offset, Some(fixed_kin::safety::ARM_FIRST));
        self.access(map::ARM.offset, Some(fixed_kin::safety::ARM_SECOND));
    }

    fn any(&mut self) {
        match self.random.random_range(0..400) {
            0..8 => self.commit(&map::SET_POINTS, &map::COMMIT_SET_POINTS),
            8 => self.commit(&map::CONFIGURATION, &map::COMMIT_CONFIGURATION),
            9..12 => self.arm(),
            12 => {
                self.stop = 1;
                self.idle(40);
                self.stop = 0;
                self.idle(40);
            }
            13..20 => self.access(map::KICKER_FIRE.offset, Some(map::KICKER_FIRE_WORD)),
            20..200 => {
                let register = map::REGISTERS[self.random.random_range(0..map::REGISTERS.len())];
                let index = self.random.random_range(0..usize::from(register.words));
                let locks = [map::ARM, map::WATCHDOG_TIMEOUT, map::TICK_PERIOD, map::RADIO].map(|r| r.offset);
                let write = self.random.random_bool(0.5) && !locks.contains(&register.offset);
                let word = self.random.next_u32() >> self.random.random_range(0..32);
                self.access(register.at(index), write.then_some(word));
            }
            _ => {
                let offset = map::SNAPSHOT_SEQUENCE.offset + 4 * self.random.random_range(0..24_u16);
                self.access(offset, None);
            }
        }
    }
}

/// Every output but the interrupt moved, so equality says something.
///
/// # Panics
/// When one stood still.
#[track_caller]
pub fn assert_lively(layout: &Layout, rows: &[u32]) {
    let outputs = layout.outputs.len();
    for (column, output) in layout.outputs.iter().enumerate() {
        let changes = rows.chunks(outputs).skip(1_000).filter(|row| row[column] != rows[column]).count();
        assert!(changes > 20 || output.name.starts_with("int_n"), "{} changed {changes} times", output.name);
    }
}
