//! A robot without a PC on a bad radio link: whatever the line does, no wrong command, and off in time.

use driver::{Scale, Settings, radio::boot};
use fixed_kin::card::{Card, Pins};
use fixed_kin::radio::{CLOCKS_PER_BIT, Frame, Inputs, Radio, decode};
use fixed_kin::registers as map;
use hdl::design::{COMMITTED_VERILOG, NAME};
use hdl::emit::ports::Ports;
use measured::Table;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::frames::Twist;
use runs::robot::Robot;
use simulator::cosim::{Change, Verilated};

const CLOCK_HZ: f64 = 33_333_333.0;
const ROBOT: u8 = 6;
const BIT: u64 = CLOCKS_PER_BIT as u64;
/// Clocks from frame to frame: 5 ms.
const PERIOD: u64 = 166_667;

/// What the line does to a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Noise {
    None,
    FlippedBits,
    Spikes,
    LostByte,
    DoubledByte,
    CutShort,
    Garbage,
    Repeated,
}

impl Noise {
    const ALL: [Self; 8] = [
        Self::None,
        Self::FlippedBits,
        Self::Spikes,
        Self::LostByte,
        Self::DoubledByte,
        Self::CutShort,
        Self::Garbage,
        Self::Repeated,
    ];

    /// The line's level changes for a frame: clock from its beginning, level.
    fn levels(self, bytes: &[u8], random: &mut ChaCha8Rng) -> Vec<(u64, bool)> {
        let mut bytes = bytes.to_vec();
        let at = random.random_range(0..bytes.len());
        match self {
            Self::LostByte => drop(bytes.remove(at)),
            Self::DoubledByte => bytes.insert(at, bytes[at]),
            Self::CutShort => bytes.truncate(at),
            Self::Garbage => bytes = (0..random.random_range(1..48)).map(|_| random.random()).collect(),
            _ => {}
        }
        let mut bits: Vec<bool> =
            bytes.iter().flat_map(|byte| (0..10).map(|bit| (u32::from(*byte) << 1 | 1 << 9) >> bit & 1 == 1)).collect();
        if self == Self::FlippedBits {
            for _ in 0..random.random_range(1..12) {
                let at = random.random_range(0..bits.len());
                bits[at] = !bits[at];
            }
        }
        let mut levels: Vec<_> = (0..).map(|n| n * BIT).zip(bits).collect();
        if self == Self::Spikes {
            // Short pulses anywhere, also in the silence after the frame.
            for _ in 0..random.random_range(1..30) {
                let from = random.random_range(0..PERIOD - 1_000);
                let until = from + random.random_range(1..2 * BIT);
                let level =
                    |clock: u64| levels.iter().rev().find(|(at, _)| *at <= clock).is_none_or(|(_, level)| *level);
                let (inside, after) = (!level(from), level(until));
                levels.retain(|(at, _)| !(from..=until).contains(at));
                levels.extend([(from, inside), (until, after)]);
                levels.sort_unstable();
            }
        }
        let end = levels.last().map_or(0, |(clock, _)| clock + BIT).max(bytes.len() as u64 * 10 * BIT);
        levels.push((end, true));
        levels
    }
}

/// The sender of one robot, and what of it is to be believed.
struct Sender {
    random: ChaCha8Rng,
    scale: Scale,
    sequence: u8,
    last: Vec<u8>,
}

impl Sender {
    fn new(seed: u64) -> Self {
        let scale = Scale::new(&Robot::racbot(), CLOCK_HZ).unwrap();
        Self { random: ChaCha8Rng::seed_from_u64(seed), scale, sequence: 0, last: Vec::new() }
    }

    fn boot(&mut self) -> Vec<u8> {
        self.sequence = self.sequence.wrapping_add(1);
        // No wheel turns here, which is no stall.
        let settings = Settings { stall_duty: 1.0, ..Settings::default() };
        boot(ROBOT, self.sequence, &self.scale, &settings).unwrap().bytes().to_vec()
    }

    /// A random velocity; now and then a kick.
    fn drive(&mut self) -> Vec<u8> {
        self.sequence = self.sequence.wrapping_add(1);
        let mut pick = |limit: f64| self.random.random_range(-limit..limit);
        let twist = Twist { vx: pick(2.0), vy: pick(2.0), omega: pick(8.0) };
        let [x, y, omega] = self.scale.twist_words(twist).map(|word| word as u32);
        let mut frame = Frame::new(ROBOT, self.sequence).unwrap();
        frame.set_points([x, y, omega, 0]).unwrap();
        if self.random.random_range(0..20) == 0 {
            frame.kick(0, 3_000).unwrap();
        }
        frame.bytes().to_vec()
    }

    /// Noise and the line's levels for the next drive frame, which is also returned.
    fn next(&mut self, noise: Noise) -> (Vec<u8>, Vec<(u64, bool)>) {
        let frame = if noise == Noise::Repeated { self.last.clone() } else { self.drive() };
        let levels = noise.levels(&frame, &mut self.random);
        self.last.clone_from(&frame);
        (frame, levels)
    }
}

fn writes(frame: &[u8]) -> Vec<(u16, u32)> {
    decode(frame, ROBOT).unwrap().1.collect()
}

/// The bit-true radio on a line, and the words that came out of it.
struct Link {
    radio: Radio,
    words: Vec<(u16, u32)>,
}

impl Link {
    fn new() -> Self {
        let mut link = Self { radio: Radio::default(), words: Vec::new() };
        link.play(&[], 20_000, false);
        link
    }

    fn play(&mut self, levels: &[(u64, bool)], clocks: u64, armed: bool) {
        let (mut rx, mut changes) = (true, levels.iter().peekable());
        for clock in 0..clocks {
            while let Some((_, level)) = changes.next_if(|(at, _)| *at <= clock) {
                rx = *level;
            }
            let before = self.radio.outputs();
            if before.offer {
                self.words.push((before.address * 4, before.data));
            }
            let taken = before.offer;
            self.radio.clock(&Inputs { rx, robot: ROBOT, armed, taken, ..Inputs::default() });
        }
    }
}

/// Thousands of frames through the bit-true receiver: each comes out whole, as it was sent and in its
/// turn, or not at all. The card that takes them is off in time when they stop.
#[test]
fn whatever_the_line_does_no_command_is_wrong() {
    const FRAMES: usize = if cfg!(debug_assertions) { 20 } else { 600 };
    let table = Table {
        name: "radio",
        title: "Radio frames on a bad line, three of four spoilt, through the bit-true receiver: all acted as sent or not at all",
        command: "cargo test --release -p testbench --test radio",
        columns: &["noise", "frames", "acted as sent", "dropped", "wrong"],
    };
    let mut rows = Vec::new();
    for (seed, noise) in (0..).zip(Noise::ALL) {
        let (mut sender, mut link) = (Sender::new(seed), Link::new());
        let mut card = Card::slave(0, ROBOT);
        card.tick(&Pins::default());
        let boot = sender.boot();
        link.play(&Noise::None.levels(&boot, &mut sender.random), 2 * (boot.len() as u64 * 10 * BIT), false);
        assert_eq!(link.words, writes(&boot), "the boot frame");
        card.receive(&boot).unwrap();
        assert!(card.armed());
        let (mut taken, mut heard) = (0, 0);
        for _ in 0..FRAMES {
            let spoilt = sender.random.random_range(0..4) != 0;
            let noise = if spoilt { noise } else { Noise::None };
            let (frame, levels) = sender.next(noise);
            link.words.clear();
            link.play(&levels, PERIOD, true);
            heard += 1;
            if !link.words.is_empty() {
                assert!(noise != Noise::Repeated, "a repeated frame acted");
                assert_eq!(link.words, writes(&frame), "{noise:?}");
                taken += 1;
            }
        }
        let counts = [heard, taken, heard - taken, 0].map(|count| count.to_string());
        rows.push([&[format!("{noise:?}")], &counts[..]].concat());
        assert!(taken >= FRAMES / 8 && (noise == Noise::None) == (taken == heard), "{noise:?}: {taken}");
    }
    if !cfg!(debug_assertions) {
        table.check(&rows);
    }
}

/// The whole chip's Verilog with its straps for a robot without a PC.
#[test]
fn the_chip_obeys_whole_frames_and_switches_off_without_them() {
    let ports = Ports::parse(COMMITTED_VERILOG, NAME, &["lclk", "synclk"]).unwrap();
    let built = Verilated::build(NAME, COMMITTED_VERILOG, NAME, &ports).unwrap_or_else(|error| panic!("{error}"));
    let mut session = built.start().unwrap();
    for (pin, level) in [("emergency_stop", 0), ("host_select", 0), ("robot_number", ROBOT.into()), ("radio_rx", 1)] {
        session.set_port(pin, level).unwrap();
    }
    let rx = session.layout().input("radio_rx").unwrap();
    session.run(20_000).unwrap();
    let send = |session: &mut simulator::cosim::Session, levels: &[(u64, bool)], clocks: u64| {
        let now = session.clock();
        let change = |(at, level): &(u64, bool)| Change { clock: now + at, port: rx, value: u32::from(*level) };
        session.schedule(&levels.iter().map(change).collect::<Vec<_>>()).unwrap();
        session.run(clocks).unwrap();
    };
    let set_points = |session: &mut simulator::cosim::Session| -> Vec<u32> {
        session.bus_burst_read(map::ACTIVE_SET_POINTS.offset.into(), 4).unwrap()
    };
    let mut sender = Sender::new(77);
    // A host's writes do nothing here, but for switching off.
    session.bus_write(map::LEDS.offset.into(), 0x5A).unwrap();
    assert_eq!(session.bus_read(map::LEDS.offset.into()).unwrap(), 0);
    let boot = sender.boot();
    let levels = Noise::None.levels(&boot, &mut sender.random);
    send(&mut session, &levels, boot.len() as u64 * 10 * BIT + 20_000);
    assert_eq!(session.get_port("enable_n").unwrap(), 0, "armed by the boot frame");

    let (mut in_force, mut taken, mut frames) = (vec![0; 4], 0, 0);
    for _ in 0..160 {
        let kind = sender.random.random_range(0..Noise::ALL.len());
        let noise = if sender.random.random_range(0..3) == 0 { Noise::ALL[kind] } else { Noise::None };
        let (frame, levels) = sender.next(noise);
        send(&mut session, &levels, PERIOD);
        frames += 1;
        let now = set_points(&mut session);
        if now != in_force {
            let sent: Vec<u32> = writes(&frame)[..4].iter().map(|(_, word)| map::stored_word(*word) as u32).collect();
            assert_eq!(now, sent, "{noise:?}");
            in_force = now;
            taken += 1;
        }
    }
    assert_eq!(session.get_port("enable_n").unwrap(), 0, "a lossy link keeps the robot on");
    assert!(taken > frames / 2 && taken < frames, "{taken} of {frames}");

    // The line is cut, in the middle of a frame; then a sender babbles without end.
    let (_, levels) = sender.next(Noise::CutShort);
    send(&mut session, &levels, PERIOD);
    let mut off_after = PERIOD;
    while session.get_port("enable_n").unwrap() == 0 {
        let noise: Vec<(u64, bool)> = (0..100).map(|n| (n * 100, sender.random.random())).collect();
        send(&mut session, &noise, 10_000);
        off_after += 10_000;
        assert!(off_after < 2_100_000, "still on");
    }
    println!("{taken} of {frames} frames taken by the Verilog, 0 wrong; off within {off_after} clocks of the last");
    assert_eq!(session.get_port("pwm").unwrap(), 0);
    // Drive frames do not switch it on again; a new boot frame does.
    send(&mut session, &[(0, true)], 20_000);
    let (_, levels) = sender.next(Noise::None);
    send(&mut session, &levels, PERIOD);
    assert_eq!(session.get_port("enable_n").unwrap(), 0xF);
    let boot = sender.boot();
    let levels = Noise::None.levels(&boot, &mut sender.random);
    send(&mut session, &levels, boot.len() as u64 * 10 * BIT + 20_000);
    assert_eq!(session.get_port("enable_n").unwrap(), 0);
    session.bus_write(map::ARM.offset.into(), 0).unwrap();
    assert_eq!(session.get_port("enable_n").unwrap(), 0xF, "a host can switch off");
}

/// Off within the watchdog's time and a control tick of the last frame.
#[test]
fn a_silent_link_switches_off_in_time() {
    let mut sender = Sender::new(5);
    let mut card = Card::slave(0, ROBOT);
    card.tick(&Pins::default());
    card.receive(&sender.boot()).unwrap();
    card.receive(&sender.drive()).unwrap();
    let mut ticks = 0;
    while card.armed() {
        card.tick(&Pins::default());
        ticks += 1;
    }
    assert!((48..=52).contains(&ticks), "{ticks} ms");
}
