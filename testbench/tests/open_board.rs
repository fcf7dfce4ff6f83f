//! The core on an open board: driven through its serial line against fixed-kin, its line disturbed,
//! its bitstream made.

use driver::{Board, Registers, Scale, Settings};
use fixed_kin::AXES;
use fixed_kin::card::{Card, Pins};
use fixed_kin::control::SetPointMode;
use fixed_kin::registers as map;
use fixed_kin::serial_host::{FRAME_TIMEOUT, Reply, read_request, reply, write_request};
use fixed_kin::speed::SpeedMode;
use hdl::emit::open_board::NAME;
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::robot::Robot;
use simulator::cosim::Change;
use simulator::fpga::edges::{Counter, Motion, lines};
use std::process::Command;
use testbench::open_board::{BYTE, OpenBoard, verilog};
use testbench::place::Device;

const CLOCK_HZ: f64 = 33e6;
/// Long, because a snapshot takes 80,000 clocks over the line.
const PERIOD: u32 = 400_000;
/// Encoders stand still while the host talks.
const QUIET: u32 = 300_000;
const TICKS: usize = 40;

fn board() -> OpenBoard {
    let mut board = OpenBoard::new().unwrap_or_else(|error| panic!("{error}"));
    board.session.run(600).unwrap();
    board
}

fn snapshot(bus: &mut impl Registers) -> [u32; map::SNAPSHOT_WORDS] {
    let mut words = [0; map::SNAPSHOT_WORDS];
    bus.read_block(map::SNAPSHOT_SEQUENCE.offset, &mut words).unwrap();
    assert_eq!(words[0], words[map::SNAPSHOT_WORDS - 1], "torn snapshot");
    words
}

#[test]
fn driven_through_its_serial_line_it_equals_fixed_kin() {
    let mut robot = Robot::racbot();
    robot.control_rate_hz = CLOCK_HZ / f64::from(PERIOD);
    let scale = Scale::new(&robot, CLOCK_HZ).unwrap();
    let settings =
        Settings { speed_mode: SpeedMode::CountAndTime, set_point_mode: SetPointMode::Wheels, ..Settings::default() };
    let (mut real, mut twin) = (Board::new(board()), Board::new(Card::new(hdl::design::content_hash())));
    let identity = real.identify().unwrap();
    assert_eq!((identity.board, identity.clock_hz), (map::BOARD_HX8K, CLOCK_HZ as u32));
    let refused = real.identify_as(map::BOARD_4I65).unwrap_err().to_string();
    assert!(refused.contains("pins of another board"), "{refused}");
    real.configure(&scale, &settings).unwrap();
    twin.configure(&scale, &settings).unwrap();
    real.bus.write(map::WATCHDOG_TIMEOUT.offset, 0xFF_FFFF).unwrap();
    twin.bus.write(map::WATCHDOG_TIMEOUT.offset, 0xFF_FFFF);
    real.bus.session.run(u64::from(PERIOD) + 2_000).unwrap();
    twin.bus.tick(&Pins::default());
    real.arm().unwrap();
    twin.arm().unwrap();

    let session = &mut real.bus.session;
    session.run(u64::from(PERIOD)).unwrap();
    twin.bus.tick(&Pins::default());
    let seen = snapshot(&mut real.bus);
    let now = real.bus.session.clock();
    let mut tick = now - u64::from((now as u32).wrapping_sub(seen[2]) & 0xFF_FFFF);
    while tick + u64::from(PERIOD) < now {
        tick += u64::from(PERIOD);
    }
    twin.bus.set_time(tick as u32);
    let filter = twin.bus.encoder_filter();
    let columns = ["encoder_a", "encoder_b"].map(|name| real.bus.session.layout().input(name).unwrap());

    let mut random = ChaCha8Rng::seed_from_u64(6);
    let (mut counters, mut levels) = ([Counter::default(); AXES], [0_u32; AXES]);
    let (mut moving, mut duties) = (0, 0);
    for number in 0..TICKS {
        let speeds = std::array::from_fn::<_, AXES, _>(|_| {
            fixed_kin::format::Speed::from_bits(random.random_range(-(1 << 22)..1 << 22))
        });
        real.set_wheel_speeds(&speeds).unwrap();
        twin.set_wheel_speeds(&speeds).unwrap();
        let targets = counters.map(|counter| counter.position + random.random_range(-300.0..300.0));
        let mut changes = Vec::new();
        for axis in 0..AXES {
            for edge in Motion::new(counters[axis].position, targets[axis], PERIOD, QUIET).edges() {
                changes.push((tick + 1 + u64::from(edge.clock), axis, lines(edge.count)));
            }
        }
        changes.sort_unstable();
        let mut scheduled = Vec::new();
        for (clock, axis, level) in changes {
            levels[axis] = level;
            for (bit, port) in columns.into_iter().enumerate() {
                let value = levels.iter().enumerate().fold(0, |word, (axis, level)| word | (level >> bit & 1) << axis);
                scheduled.push(Change { clock, port, value });
            }
        }
        real.bus.session.schedule(&scheduled).unwrap();
        tick += u64::from(PERIOD);
        assert!(real.bus.session.clock() + u64::from(PERIOD) < tick + u64::from(QUIET), "the host is late");
        let now = real.bus.session.clock();
        real.bus.session.run(tick + 1_000 - now).unwrap();
        let encoders =
            std::array::from_fn(|axis| counters[axis].advance(targets[axis], tick as u32, PERIOD, QUIET, filter));
        twin.bus.tick(&Pins { encoders, ..Pins::default() });

        let (mut got, mut expected) = (snapshot(&mut real.bus), [0; map::SNAPSHOT_WORDS]);
        twin.bus.read_block(map::SNAPSHOT_SEQUENCE.offset, &mut expected);
        for words in [&mut got, &mut expected] {
            for private in [0, 2, map::SNAPSHOT_WORDS - 1] {
                words[private] = 0;
            }
        }
        assert_eq!(got, expected, "tick {number}");
        moving += usize::from(got[8..12].iter().any(|word| *word != 0));
        duties += usize::from(got[16..20].iter().any(|word| *word != 0));
    }
    assert!(moving > TICKS / 2 && duties > TICKS / 2, "{moving} ticks moved, {duties} drove");
    println!("{TICKS} ticks through the serial line, {} clocks, 0 words differ", real.bus.session.clock());
}

#[test]
fn a_disturbed_line_does_nothing_and_recovers() {
    let mut board = board();
    let mut random = ChaCha8Rng::seed_from_u64(8);
    let mut leds = 0x5A;
    board.write(map::LEDS.offset, leds).unwrap();
    let (mut refused, mut silent, mut halves) = (0, 0, 0);
    for _ in 0..300 {
        let mut frame = write_request(map::LEDS.offset, random.next_u32() & 0xFF).to_vec();
        match random.random_range(0..4) {
            // A frame that ends early: forgotten after its time-out.
            0 => {
                frame.truncate(random.random_range(1..8));
                assert!(board.exchange(&frame).unwrap().is_empty());
                board.session.run(u64::from(FRAME_TIMEOUT) + 2 * BYTE).unwrap();
                halves += 1;
            }
            // Bytes that begin no frame.
            1 => {
                let noise: Vec<u8> = (0..5).map(|_| random.random_range(0..b'R')).collect();
                assert!(board.exchange(&noise).unwrap().is_empty());
            }
            2 => {
                leds = random.random_range(0..256);
                board.write(map::LEDS.offset, leds).unwrap();
            }
            _ => {
                for _ in 0..random.random_range(1..3) {
                    let at = random.random_range(0..64);
                    frame[at / 8] ^= 1 << (at % 8);
                }
                if reply(&frame).is_some() || frame == write_request(map::LEDS.offset, u32::from(frame[3])) {
                    continue;
                }
                match reply(&board.exchange(&frame).unwrap()) {
                    Some(Reply::Refused) => refused += 1,
                    // The damage made it a frame of another kind or none; its rest is forgotten too.
                    other => {
                        assert!(!matches!(other, Some(Reply::Written)), "{frame:x?} was written");
                        board.session.run(u64::from(FRAME_TIMEOUT) + 2 * BYTE).unwrap();
                        silent += 1;
                    }
                }
            }
        }
        assert_eq!(board.read(map::LEDS.offset).unwrap(), leds);
        assert_eq!(board.session.get_port("led").unwrap(), leds);
    }
    println!("{refused} refused, {silent} not heard, {halves} cut off");
    assert!(refused > 30 && silent > 0 && halves > 40, "{refused} {silent} {halves}");
    // An address beyond the window.
    let mut beyond = read_request(0);
    beyond[2] = 0x40;
    beyond[3] = fixed_kin::serial_host::crc(&beyond[..3]);
    assert_eq!(reply(&board.exchange(&beyond).unwrap()), Some(Reply::Refused));
}

#[test]
fn open_tools_make_its_bitstream() {
    let pins = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../generated/rac_hx8k.pcf")).unwrap();
    let placed = Device::Ice40Hx8k.place(&verilog(), NAME, 33, Some(&pins)).unwrap_or_else(|error| panic!("{error}"));
    let reached = placed.megahertz.iter().find(|(clock, _)| clock.starts_with("clock")).expect("the PLL's clock").1;
    assert!(*reached >= 33.0, "{placed:?}");
    let run = |tool: &str, from: &str, to: &str| {
        let status = Command::new(tool).args([from, to]).current_dir(&placed.folder).status();
        assert!(status.expect("Debian package fpga-icestorm").success(), "{tool}");
        std::fs::read(placed.folder.join(to)).unwrap()
    };
    let bitstream = run("icepack", "placed.asc", "rac_hx8k.bin");
    let again = run("iceunpack", "rac_hx8k.bin", "again.asc");
    run("icepack", "again.asc", "again.bin");
    assert_eq!(std::fs::read(placed.folder.join("again.bin")).unwrap(), bitstream);
    assert!(bitstream.len() > 130_000 && again.len() > 100_000, "{} bytes", bitstream.len());
    let used = |cell: &str| placed.cells.get(cell).copied().unwrap_or_default();
    println!(
        "{NAME}: {} bytes, {reached:.1} MHz, {:?} logic cells, {:?} memories, {:?} pins",
        bitstream.len(),
        used("ICESTORM_LC"),
        used("ICESTORM_RAM"),
        used("SB_IO")
    );
}
