//! The compiled chip at its shortest control period, 1000 clocks, against the bit-true card: the bus
//! is busy while the program runs, every tick is compared.

use driver::{Board, BusError, Registers, Scale, Settings};
use fixed_kin::AXES;
use fixed_kin::card::{Card, Pins};
use fixed_kin::control::{CONFIGURATION_WORDS, SetPointMode};
use fixed_kin::registers as map;
use fixed_kin::speed::SpeedMode;
use hdl::design::{COMMITTED_VERILOG, NAME};
use hdl::emit::ports::Ports;
use hdl::stimulus::control::word;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::robot::Robot;
use simulator::cosim::{Change, Session, Verilated};
use simulator::fpga::edges::{Counter, Motion, lines};

const PERIOD: u32 = map::MIN_TICK_PERIOD;
const TICKS: usize = 12_000;
/// Clocks after a tick in which encoders stand still: the host still reads the snapshot of the tick before.
const QUIET: u32 = 150;
/// Clocks after a tick in which the program has ended.
const PROGRAM: u64 = 970;
/// Clocks after a tick at rest at which an index rises, and falls.
const INDEX: [u64; 2] = [700, 800];

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
fn commit(both: [&mut dyn Registers; 2], base: &map::Register, at: &map::Register, words: &[u32]) {
    for bus in both {
        let mut sum = map::CHECKSUM_SEED;
        for (index, &word) in words.iter().enumerate() {
            bus.write(base.at(index), word).unwrap();
            sum = map::checksum(sum, base.at(index) / 4, word);
        }
        bus.write(at.offset, sum).unwrap();
    }
}

fn snapshot(bus: &mut dyn Registers) -> [u32; map::SNAPSHOT_WORDS] {
    let mut words = [0; map::SNAPSHOT_WORDS];
    bus.read_block(map::SNAPSHOT_SEQUENCE.offset, &mut words).unwrap();
    assert_eq!(words[0], words[map::SNAPSHOT_WORDS - 1], "torn snapshot");
    words
}

#[test]
fn every_tick_of_the_compiled_chip_equals_the_card() {
    let ports = Ports::parse(COMMITTED_VERILOG, NAME, &["lclk", "synclk"]).unwrap();
    let built = Verilated::build(NAME, COMMITTED_VERILOG, NAME, &ports).unwrap_or_else(|error| panic!("{error}"));
    let mut session = built.start().unwrap();
    session.set_port("emergency_stop", 0).unwrap();
    session.set_port("host_select", 1).unwrap();
    let [a, b, index] = ["encoder_a", "encoder_b", "encoder_index"].map(|name| session.layout().input(name).unwrap());

    let clock_hz = 33_333_333.0;
    let mut robot = Robot::racbot();
    robot.control_rate_hz = clock_hz / f64::from(PERIOD);
    let scale = Scale::new(&robot, clock_hz).unwrap();
    let settings =
        Settings { speed_mode: SpeedMode::CountAndTime, set_point_mode: SetPointMode::Twist, ..Settings::default() };
    let (mut chip, mut card) = (Board::new(Chip(session)), Board::new(Card::new(hdl::design::content_hash())));
    chip.configure(&scale, &settings).unwrap();
    card.configure(&scale, &settings).unwrap();
    let session = &mut chip.bus.0;
    session.run(2 * u64::from(PERIOD)).unwrap();
    card.bus.tick(&Pins::default());
    chip.arm().unwrap();
    card.arm().unwrap();

    // The last tick, from a snapshot; the card's time is moved to it.
    chip.bus.0.run(u64::from(PERIOD)).unwrap();
    card.bus.tick(&Pins::default());
    let seen = snapshot(&mut chip.bus);
    let now = chip.bus.0.clock();
    let mut tick = now - u64::from((now as u32).wrapping_sub(seen[2]) & 0xFF_FFFF);
    while tick + u64::from(PERIOD) < now {
        tick += u64::from(PERIOD);
    }

    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut counters = [Counter::default(); AXES];
    let mut levels = [0_u32; AXES];
    let mut speeds = [0.0; AXES];
    let (mut duties, mut captured, mut rising) = (0_u32, 0_u32, 0_u32);
    card.bus.set_time(tick as u32);
    let filter = card.bus.encoder_filter();
    for number in 0..TICKS / 2 {
        if number % 5 == 0 {
            speeds = std::array::from_fn(|_| match random.random_range(0..4) {
                0 => 0.0,
                1 => random.random_range(-0.4..0.4),
                _ => random.random_range(-60.0..60.0),
            });
        }
        // A tick at rest, then a period with edges, scheduled before it begins.
        let rest = tick + u64::from(PERIOD);
        let end = rest + u64::from(PERIOD);
        let targets: [f64; AXES] = std::array::from_fn(|axis| counters[axis].position + speeds[axis]);
        let mut changes = Vec::new();
        for axis in 0..AXES {
            for edge in Motion::new(counters[axis].position, targets[axis], PERIOD, QUIET).edges() {
                changes.push((rest + 1 + u64::from(edge.clock), axis, lines(edge.count)));
            }
        }
        changes.sort_unstable();
        let mut scheduled = Vec::new();
        for (clock, axis, level) in changes {
            levels[axis] = level;
            let bit = |n: u32| levels.iter().enumerate().fold(0, |word, (i, level)| word | ((level >> n) & 1) << i);
            scheduled.push(Change { clock, port: a, value: bit(0) });
            scheduled.push(Change { clock, port: b, value: bit(1) });
        }
        // Now and then indices rise in the rest that follows; those that are armed are captured.
        let risen = rising;
        rising = if number % 4 == 1 { random.random_range(0..16_u32) } else { 0 };
        let pulse = INDEX.into_iter().zip([rising, 0]);
        scheduled.extend(pulse.map(|(after, value)| Change { clock: end + after, port: index, value }));
        chip.bus.0.schedule(&scheduled).unwrap();

        let encoders = pins(&mut counters, [None; AXES], rest, filter);
        let indices = std::array::from_fn(|axis| (risen >> axis & 1 == 1).then_some(encoders[axis].count));
        card.bus.tick(&Pins { encoders, indices, ..Pins::default() });
        run_to(&mut chip.bus, rest + 3);
        // The host writes while the program runs; it acts at the next tick.
        if number % 3 == 0 {
            let twist = std::array::from_fn::<_, 3, _>(|_| random.random_range(-(1 << 25)..1 << 25_i32) as u32);
            let both: [&mut dyn Registers; 2] = [&mut chip.bus, &mut card.bus];
            commit(both, &map::SET_POINTS, &map::COMMIT_SET_POINTS, &[twist[0], twist[1], twist[2], 0]);
        }
        if number % 47 == 20 {
            let mut words = scale.configuration().to_words();
            words[random.random_range(0..CONFIGURATION_WORDS * 6 / 10)] = word(&mut random);
            let words = words.map(|word| word as u32);
            let both: [&mut dyn Registers; 2] = [&mut chip.bus, &mut card.bus];
            commit(both, &map::CONFIGURATION, &map::COMMIT_CONFIGURATION, &words);
        }
        if number % 5 == 2 {
            let word = random.random_range(0..256);
            chip.bus.write(map::INDEX_ARM.offset, word).unwrap();
            card.bus.write(map::INDEX_ARM.offset, word);
        }
        compare(&mut chip.bus, &mut card.bus, rest, number);

        let encoders = pins(&mut counters, targets.map(Some), end, filter);
        let moved = card.bus.tick(&Pins { encoders, ..Pins::default() });
        duties += u32::from(moved.duties.iter().any(|duty| *duty != 0));
        compare(&mut chip.bus, &mut card.bus, end, number);
        let offset = [map::INDEX_POSITION.at(number % AXES), map::INDEX_STATUS.offset][usize::from(number % 8 == 7)];
        // The status would already show an index that the card sees at its next tick: there is none in every 8th.
        let (got, expected) = (chip.bus.read(offset).unwrap(), card.bus.read(offset));
        assert_eq!(got, expected, "tick {number}, offset {offset:#x}");
        captured += u32::from(offset != map::INDEX_STATUS.offset && got != 0);
        tick = end;
        assert!(chip.bus.0.clock() < tick + u64::from(PERIOD + QUIET), "the host is slower than a tick");
    }
    assert!(duties as usize > TICKS / 3, "only {duties} ticks had a duty: the comparison is empty");
    assert!(captured as usize > TICKS / 8, "only {captured} reads of a captured index");
    let status = chip.status().unwrap();
    assert!(status.armed, "disarmed on the way");
}

/// Samples of all counters at the tick at `now`; `None` stands still.
fn pins(
    counters: &mut [Counter; AXES],
    targets: [Option<f64>; AXES],
    now: u64,
    filter: u8,
) -> [fixed_kin::speed::EncoderSample; AXES] {
    std::array::from_fn(|axis| {
        let to = targets[axis].unwrap_or(counters[axis].position);
        counters[axis].advance(to, now as u32, PERIOD, QUIET, filter)
    })
}

fn run_to(chip: &mut Chip, clock: u64) {
    let now = chip.0.clock();
    chip.0.run(clock.saturating_sub(now)).unwrap();
}

fn compare(chip: &mut Chip, card: &mut Card, tick: u64, number: usize) {
    run_to(chip, tick + PROGRAM);
    let mut got = snapshot(chip);
    let mut expected = [0; map::SNAPSHOT_WORDS];
    card.read_block(map::SNAPSHOT_SEQUENCE.offset, &mut expected).unwrap();
    assert_eq!(got[2], tick as u32 & 0xFF_FFFF, "tick {number} is not where it should be");
    for words in [&mut got, &mut expected] {
        for private in [0, 2, map::SNAPSHOT_WORDS - 1] {
            words[private] = 0;
        }
    }
    assert_eq!(got, expected, "tick {number}");
}
