//! How old a snapshot of the compiled chip is: word 0 is of the tick that finished last, whatever the reader's
//! rhythm and however long it holds, at the shortest control period and above.

use fixed_kin::registers as map;
use hdl::design::{COMMITTED_VERILOG, NAME};
use hdl::emit::ports::Ports;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use simulator::cosim::{Session, Verilated};

/// Clocks in which the program certainly ends, and an access of the bus.
const PROGRAM: u32 = 1_000;
const ACCESS: u32 = 8;

struct Reader {
    chip: Session,
    period: u32,
    /// A tick by number and time.
    anchor: Option<(u32, u32)>,
    oldest: u32,
    readings: u32,
}

impl Reader {
    fn new(built: &Verilated, period: u32) -> Self {
        let mut chip = built.start().unwrap();
        for port in ["emergency_stop", "host_select", "radio_rx"] {
            chip.set_port(port, 1).unwrap();
        }
        chip.bus_write(map::TICK_PERIOD.offset.into(), period).unwrap();
        chip.run(u64::from(2 * period + PROGRAM)).unwrap();
        Self { chip, period, anchor: None, oldest: 0, readings: 0 }
    }

    fn read(&mut self, register: &map::Register) -> u32 {
        self.chip.bus_read(register.offset.into()).unwrap()
    }

    fn pause(&mut self, clocks: u32) {
        self.chip.run(clocks.into()).unwrap();
    }

    /// Word 0, a pause, the time of the tick, and, unless the reader stays in the middle, the last word.
    fn snapshot(&mut self, hold: u32, release: bool) {
        let sequence = self.read(&map::SNAPSHOT_SEQUENCE);
        let now = self.chip.clock() as u32;
        self.pause(hold);
        let time = self.read(&map::SNAPSHOT_TIME);
        let (number, then) = *self.anchor.get_or_insert((sequence, time));
        let expected = then.wrapping_add(sequence.wrapping_sub(number).wrapping_mul(self.period));
        assert_eq!(time, expected & 0xFF_FFFF, "tick {sequence} has the time of another, hold {hold}");
        if release {
            assert_eq!(self.read(&map::SNAPSHOT_SEQUENCE_END), sequence, "torn, hold {hold}");
        }
        let age = now.wrapping_sub(time) & 0xFF_FFFF;
        let limit = self.period + PROGRAM + ACCESS;
        assert!(age <= limit, "tick {sequence} is {age} clocks old at period {}, hold {hold}", self.period);
        self.oldest = self.oldest.max(age);
        self.readings += 1;
    }
}

#[test]
fn word_0_is_never_older_than_a_period_and_the_program() {
    let ports = Ports::parse(COMMITTED_VERILOG, NAME, &["lclk", "synclk"]).unwrap();
    let built = Verilated::build(NAME, COMMITTED_VERILOG, NAME, &ports).unwrap_or_else(|error| panic!("{error}"));
    let mut random = ChaCha8Rng::seed_from_u64(3);
    for period in [map::MIN_TICK_PERIOD, 1_001, 1_024, 1_500, 2_003, 5_000] {
        let mut reader = Reader::new(&built, period);
        // One after the other, then with pauses between, inside, and both.
        (0..200).for_each(|_| reader.snapshot(0, true));
        for _ in 0..200 {
            let mut pause = || match random.random_range(0..3) {
                0 => 0,
                1 => random.random_range(0..20),
                _ => random.random_range(0..6 * period),
            };
            let (before, hold) = (pause(), pause());
            reader.pause(before);
            reader.snapshot(hold, random.random_bool(0.7));
        }
        // A rhythm of one or two periods, in every phase: each reading ends where the next begins.
        for periods in [1, 2] {
            for phase in (0..period).step_by(97) {
                reader.pause(phase);
                for release in [true, true, false, false] {
                    let begun = reader.chip.clock() as u32;
                    reader.snapshot(periods * period / 2, release);
                    let taken = reader.chip.clock() as u32 - begun;
                    reader.pause((periods * period).saturating_sub(taken));
                }
            }
        }
        println!("period {period}: {} readings, the oldest {} clocks", reader.readings, reader.oldest);
    }
}
