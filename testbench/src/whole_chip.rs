//! The compiled chip at its shortest control period against the bit-true card: the bus is busy while the program runs,
//! encoders turn, indices rise, set points and configurations change; every tick's snapshot is compared, word by word.
//!
//! A seed fixes everything. `tests/core_short_tick.rs` runs some ticks of a seed, `benches/whole_chip.rs` many seeds.

use driver::{Board, BusError, Registers, Scale, Settings};
use fixed_kin::AXES;
use fixed_kin::card::{Card, Pins};
use fixed_kin::control::{CONFIGURATION_WORDS, SetPointMode};
use fixed_kin::registers as map;
use fixed_kin::speed::{EncoderSample, SpeedMode};
use hdl::design::{COMMITTED_VERILOG, NAME};
use hdl::emit::ports::Ports;
use hdl::stimulus::control::word;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::robot::Robot;
use simulator::cosim::{Change, CosimError, Session, Verilated};
use simulator::fpga::edges::{Counter, Motion, lines};

/// Clocks of a control tick here: the shortest that the card takes.
pub const PERIOD: u32 = map::MIN_TICK_PERIOD;
/// Clocks after a tick in which encoders stand still: the host still reads the snapshot of the tick before.
const QUIET: u32 = 150;
/// Clocks after a tick in which the program has ended.
const PROGRAM: u64 = 985;
/// Clocks after a tick at rest at which an index rises, and falls.
const INDEX: [u64; 2] = [700, 800];

/// What a comparison saw.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Seen {
    /// Control ticks compared.
    pub ticks: u64,
    /// Clocks of the chip since it was configured.
    pub clocks: u64,
    /// Pairs of ticks of which the second drove a wheel.
    pub driven: u64,
    /// Reads of a captured index that was not zero.
    pub captured: u64,
}

/// Why chip and card are not the same, or could not be compared.
#[derive(Debug, thiserror::Error)]
pub enum Difference {
    /// The simulation failed.
    #[error(transparent)]
    Cosim(#[from] CosimError),
    /// A transfer failed.
    #[error(transparent)]
    Bus(#[from] BusError),
    /// The driver got no proper answer.
    #[error(transparent)]
    Board(#[from] driver::BoardError),
    /// Words differ.
    #[error("seed {seed}, pair of ticks {pair}: {what}: the chip has {chip:x?}, the card {card:x?}")]
    Words {
        /// Seed of the stimulus.
        seed: u64,
        /// Pair of ticks, from 0.
        pair: u64,
        /// What was compared.
        what: &'static str,
        /// Words as the Verilog gave them.
        chip: Vec<u32>,
        /// Words as the twin gave them.
        card: Vec<u32>,
    },
}

/// The committed Verilog, compiled.
///
/// # Errors
/// A missing tool, by the name of its package.
pub fn compiled() -> Result<Verilated, CosimError> {
    let ports = Ports::parse(COMMITTED_VERILOG, NAME, &["lclk", "synclk"])
        .unwrap_or_else(|error| panic!("the committed chip: {error}"));
    Verilated::build(NAME, COMMITTED_VERILOG, NAME, &ports)
}

struct Chip(Session);

impl Registers for Chip {
    fn read(&mut self, offset: u16) -> Result<u32, BusError> {
        self.0.bus_read(offset.into()).map_err(|error| BusError::read(offset, error))
    }
    fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError> {
        self.0.bus_write(offset.into(), data).map_err(|error| BusError::write(offset, error))
    }
    fn read_block(&mut self, offset: u16, words: &mut [u32]) -> Result<(), BusError> {
        let read = self.0.bus_burst_read(offset.into(), words.len() as u32);
        words.copy_from_slice(&read.map_err(|error| BusError::read(offset, error))?);
        Ok(())
    }
}

/// Writes a group and its commit to chip and card.
fn commit(
    both: [&mut dyn Registers; 2],
    base: &map::Register,
    at: &map::Register,
    words: &[u32],
) -> Result<(), BusError> {
    for bus in both {
        let mut sum = map::CHECKSUM_SEED;
        for (index, &word) in words.iter().enumerate() {
            bus.write(base.at(index), word)?;
            sum = map::checksum(sum, base.at(index) / 4, word);
        }
        bus.write(at.offset, sum)?;
    }
    Ok(())
}

/// Chip and card side by side, after a tick at rest.
struct Pair {
    seed: u64,
    number: u64,
    chip: Board<Chip>,
    card: Board<Card>,
    scale: Scale,
    /// Columns of encoder A, B and index.
    pins: [usize; 3],
    random: ChaCha8Rng,
    counters: [Counter; AXES],
    levels: [u32; AXES],
    /// Counts that each axis moves in a tick.
    speeds: [f64; AXES],
    /// Indices that rise in the rest to come, a bit each.
    rising: u32,
    /// Clock of the last tick.
    tick: u64,
    filter: u8,
    seen: Seen,
}

/// Runs pairs of control ticks of a seed, one at rest and one in motion, from configuration on.
///
/// Odd seeds measure speeds by count and time and take body velocities, even ones by difference and wheel speeds.
///
/// # Errors
/// The first [`Difference`].
pub fn compare(built: &Verilated, seed: u64, pairs: u64) -> Result<Seen, Difference> {
    let mut pair = Pair::new(built, seed)?;
    for _ in 0..pairs {
        pair.run()?;
    }
    pair.seen.clocks = pair.chip.bus.0.clock();
    if !pair.chip.status()?.armed {
        return Err(pair.differs("armed at the end", &[0], &[1]));
    }
    Ok(pair.seen)
}

impl Pair {
    fn new(built: &Verilated, seed: u64) -> Result<Self, Difference> {
        let mut session = built.start()?;
        session.set_port("emergency_stop", 0)?;
        session.set_port("host_select", 1)?;
        let mut pins = [0; 3];
        for (pin, name) in pins.iter_mut().zip(["encoder_a", "encoder_b", "encoder_index"]) {
            *pin = session.layout().input(name)?;
        }
        let clock_hz = 33_333_333.0;
        let robot = Robot { control_rate_hz: clock_hz / f64::from(PERIOD), ..Robot::racbot() };
        let scale = Scale::new(&robot, clock_hz).expect("the built-in robot fits");
        let settings = if seed % 2 == 1 {
            Settings { speed_mode: SpeedMode::CountAndTime, set_point_mode: SetPointMode::Twist, ..Settings::default() }
        } else {
            Settings { speed_mode: SpeedMode::Difference, set_point_mode: SetPointMode::Wheels, ..Settings::default() }
        };
        let (mut chip, mut card) = (Board::new(Chip(session)), Board::new(Card::new(hdl::design::content_hash())));
        chip.configure(&scale, &settings)?;
        card.configure(&scale, &settings)?;
        chip.bus.0.run(2 * u64::from(PERIOD))?;
        card.bus.tick(&Pins::default());
        chip.arm()?;
        card.arm()?;
        // The last tick, from a snapshot; the card's time is moved to it.
        chip.bus.0.run(u64::from(PERIOD))?;
        card.bus.tick(&Pins::default());
        let seen = chip.snapshot()?;
        let now = chip.bus.0.clock();
        let mut tick = now - u64::from((now as u32).wrapping_sub(seen.time) & 0xFF_FFFF);
        while tick + u64::from(PERIOD) < now {
            tick += u64::from(PERIOD);
        }
        card.bus.set_time(tick as u32);
        let filter = card.bus.encoder_filter();
        Ok(Self {
            seed,
            number: 0,
            chip,
            card,
            scale,
            pins,
            random: ChaCha8Rng::seed_from_u64(seed),
            counters: [Counter::default(); AXES],
            levels: [0; AXES],
            speeds: [0.0; AXES],
            rising: 0,
            tick,
            filter,
            seen: Seen::default(),
        })
    }

    /// A tick at rest, then one with edges.
    fn run(&mut self) -> Result<(), Difference> {
        let rest = self.tick + u64::from(PERIOD);
        let end = rest + u64::from(PERIOD);
        if self.number.is_multiple_of(5) {
            self.speeds = std::array::from_fn(|_| match self.random.random_range(0..4) {
                0 => 0.0,
                1 => self.random.random_range(-0.4..0.4),
                _ => self.random.random_range(-60.0..60.0),
            });
        }
        let targets: [f64; AXES] = std::array::from_fn(|axis| self.counters[axis].position + self.speeds[axis]);
        let risen = self.schedule(rest, end, &targets)?;
        let encoders = self.sample([None; AXES], rest);
        let indices = std::array::from_fn(|axis| (risen >> axis & 1 == 1).then_some(encoders[axis].count));
        self.card.bus.tick(&Pins { encoders, indices, ..Pins::default() });
        self.run_to(rest + 3)?;
        self.write()?;
        self.equal(rest)?;

        let encoders = self.sample(targets.map(Some), end);
        let moved = self.card.bus.tick(&Pins { encoders, ..Pins::default() });
        self.seen.driven += u64::from(moved.duties.iter().any(|duty| *duty != 0));
        self.equal(end)?;
        self.index_read()?;
        self.tick = end;
        self.number += 1;
        self.seen.ticks += 2;
        assert!(self.chip.bus.0.clock() < end + u64::from(PERIOD + QUIET), "the host is slower than a tick");
        Ok(())
    }

    /// Edges between rest and end, and indices after it; those that rise in this rest.
    fn schedule(&mut self, rest: u64, end: u64, targets: &[f64; AXES]) -> Result<u32, Difference> {
        let mut changes = Vec::new();
        for (axis, (counter, target)) in self.counters.iter().zip(targets).enumerate() {
            for edge in Motion::new(counter.position, *target, PERIOD, QUIET).edges() {
                changes.push((rest + 1 + u64::from(edge.clock), axis, lines(edge.count)));
            }
        }
        changes.sort_unstable();
        let [a, b, index] = self.pins;
        let mut scheduled = Vec::new();
        for (clock, axis, level) in changes {
            self.levels[axis] = level;
            let levels = &self.levels;
            let bit = |n: u32| levels.iter().enumerate().fold(0, |word, (i, level)| word | ((level >> n) & 1) << i);
            scheduled.push(Change { clock, port: a, value: bit(0) });
            scheduled.push(Change { clock, port: b, value: bit(1) });
        }
        // Now and then indices rise in the rest that follows; those that are armed are captured.
        let risen = self.rising;
        self.rising = if self.number % 4 == 1 { self.random.random_range(0..16_u32) } else { 0 };
        let pulse = INDEX.into_iter().zip([self.rising, 0]);
        scheduled.extend(pulse.map(|(after, value)| Change { clock: end + after, port: index, value }));
        self.chip.bus.0.schedule(&scheduled)?;
        Ok(risen)
    }

    /// The host writes while the program runs; it acts at the next tick.
    fn write(&mut self) -> Result<(), Difference> {
        if self.number.is_multiple_of(3) {
            let words: [u32; 3] = std::array::from_fn(|_| self.random.random_range(-(1 << 25)..1 << 25_i32) as u32);
            let both: [&mut dyn Registers; 2] = [&mut self.chip.bus, &mut self.card.bus];
            commit(both, &map::SET_POINTS, &map::COMMIT_SET_POINTS, &[words[0], words[1], words[2], 0])?;
        }
        if self.number % 47 == 20 {
            let mut words = self.scale.configuration().to_words();
            words[self.random.random_range(0..CONFIGURATION_WORDS * 6 / 10)] = word(&mut self.random);
            let words = words.map(|word| word as u32);
            let both: [&mut dyn Registers; 2] = [&mut self.chip.bus, &mut self.card.bus];
            commit(both, &map::CONFIGURATION, &map::COMMIT_CONFIGURATION, &words)?;
        }
        if self.number % 5 == 2 {
            let word = self.random.random_range(0..256);
            self.chip.bus.write(map::INDEX_ARM.offset, word)?;
            self.card.bus.write(map::INDEX_ARM.offset, word);
        }
        Ok(())
    }

    /// Samples of all counters at the tick at `now`; `None` stands still.
    fn sample(&mut self, targets: [Option<f64>; AXES], now: u64) -> [EncoderSample; AXES] {
        std::array::from_fn(|axis| {
            let to = targets[axis].unwrap_or(self.counters[axis].position);
            self.counters[axis].advance(to, now as u32, PERIOD, QUIET, self.filter)
        })
    }

    fn run_to(&mut self, clock: u64) -> Result<(), CosimError> {
        let session = &mut self.chip.bus.0;
        session.run(clock.saturating_sub(session.clock()))
    }

    fn differs(&self, what: &'static str, chip: &[u32], card: &[u32]) -> Difference {
        Difference::Words { seed: self.seed, pair: self.number, what, chip: chip.to_vec(), card: card.to_vec() }
    }

    /// All words of the snapshot of the tick at a clock, but sequence and time, which begin elsewhere on the card.
    fn equal(&mut self, tick: u64) -> Result<(), Difference> {
        self.run_to(tick + PROGRAM)?;
        let (mut chip, mut card) = ([0; map::SNAPSHOT_WORDS], [0; map::SNAPSHOT_WORDS]);
        self.chip.bus.read_block(map::SNAPSHOT_SEQUENCE.offset, &mut chip)?;
        Registers::read_block(&mut self.card.bus, map::SNAPSHOT_SEQUENCE.offset, &mut card)?;
        let (last, time) = (map::SNAPSHOT_WORDS - 1, tick as u32 & 0xFF_FFFF);
        if chip[0] != chip[last] || chip[2] != time {
            return Err(self.differs("a torn snapshot, or not of this tick", &chip[..3], &[chip[last], 0, time]));
        }
        for words in [&mut chip, &mut card] {
            for private in [0, 2, last] {
                words[private] = 0;
            }
        }
        if chip == card { Ok(()) } else { Err(self.differs("the snapshot", &chip, &card)) }
    }

    fn index_read(&mut self) -> Result<(), Difference> {
        // The status would already show an index that the card sees at its next tick: there is none in every 8th.
        let status = self.number % 8 == 7;
        let axis = (self.number % AXES as u64) as usize;
        let offset = if status { map::INDEX_STATUS.offset } else { map::INDEX_POSITION.at(axis) };
        let (chip, card) = (self.chip.bus.read(offset)?, self.card.bus.read(offset));
        self.seen.captured += u64::from(!status && chip != 0);
        if chip == card { Ok(()) } else { Err(self.differs("a captured index", &[chip], &[card])) }
    }
}
