//! The three FPGAs over the driver: same registers, same motion, same words.

use driver::{Board, Scale, Settings};
use fixed_kin::AXES;
use fixed_kin::control::SetPointMode;
use fixed_kin::registers as map;
use fixed_kin::speed::SpeedMode;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::frames::Twist;
use runs::robot::{Layout, Robot};
use simulator::fpga::{BitTrue, Fpga, Kind, QUIET_CLOCKS};

const CLOCK_HZ: f64 = 33_333_333.0;

fn robot(rate_hz: f64) -> Robot {
    let mut robot = Robot::racbot();
    robot.layout = Layout::Rac { body_radius_m: 0.085, skew_rad: [0.07, -0.05, 0.03] };
    robot.control_rate_hz = rate_hz;
    robot
}

/// Drives some ticks and gives the words of every snapshot but sequence and time.
fn drive(fpga: &mut dyn Fpga, settings: &Settings, rate_hz: f64, ticks: usize) -> Vec<Vec<u32>> {
    let robot = robot(rate_hz);
    let scale = Scale::new(&robot, CLOCK_HZ).unwrap();
    let mut board = Board::new(fpga);
    board.identify().unwrap();
    board.configure(&scale, settings).unwrap();
    // Nobody is on the sensor's lines, which are pulled up: as dead as can be, and read at the slowest rate.
    let reads = u32::from(settings.set_point_mode == SetPointMode::Twist);
    let control = map::IMU_ENABLE.place(reads) | map::IMU_HALF.place(3) | map::IMU_FIRST.place(0x1D);
    board.bus.write(map::IMU_CONTROL.offset, control).unwrap();
    board.bus.advance(&[0.0; AXES]).unwrap();
    board.arm().unwrap();
    board.bus.advance(&[0.0; AXES]).unwrap();

    let mut random = ChaCha8Rng::seed_from_u64(3);
    let mut positions = [0.0; AXES];
    let mut speeds = [0.0; AXES];
    let fastest = f64::from(scale.tick_period - QUIET_CLOCKS.min(scale.tick_period - 1)) / 12.0;
    let mut words = Vec::new();
    for tick in 0..ticks {
        if tick % 7 == 0 {
            let mut pick = |limit: f64| random.random_range(-limit..limit);
            let twist = Twist { vx: pick(2.0), vy: pick(2.0), omega: pick(8.0) };
            if settings.set_point_mode == SetPointMode::Twist {
                board.set_twist(&scale, twist).unwrap();
            } else {
                let mut words = [fixed_kin::format::Speed::ZERO; AXES];
                for (word, speed) in words.iter_mut().zip(robot.geometry().unwrap().wheel_speeds(twist)) {
                    *word = scale.speed_word(speed);
                }
                board.set_wheel_speeds(&words).unwrap();
            }
            speeds = std::array::from_fn(|_| match random.random_range(0..4) {
                0 => 0.0,
                1 => random.random_range(-0.3..0.3),
                _ => random.random_range(-fastest..fastest),
            });
        }
        for (position, speed) in positions.iter_mut().zip(speeds) {
            *position += speed;
        }
        board.bus.advance(&positions).unwrap();
        let mut snapshot = vec![0; map::SNAPSHOT_WORDS_WITH_IMU];
        let (before, imu) = snapshot.split_at_mut(map::SNAPSHOT_WORDS);
        before[0] = board.bus.read(map::SNAPSHOT_SEQUENCE.offset).unwrap();
        board.bus.read_block(map::SNAPSHOT_IMU.offset, imu).unwrap();
        board.bus.read_block(map::SNAPSHOT_STATUS.offset, &mut before[1..]).unwrap();
        assert_eq!(before[0], before[map::SNAPSHOT_WORDS - 1], "torn snapshot");
        for private in [0, 2, map::SNAPSHOT_WORDS - 1] {
            snapshot[private] = 0;
        }
        words.push(snapshot);
    }
    words
}

fn compare(kind: Kind, rate_hz: f64, ticks: usize) {
    for (speed_mode, set_point_mode) in
        [(SpeedMode::CountAndTime, SetPointMode::Twist), (SpeedMode::Difference, SetPointMode::Wheels)]
    {
        let settings = Settings { speed_mode, set_point_mode, ..Settings::default() };
        let expected = drive(&mut BitTrue::new().with_quiet_clocks(QUIET_CLOCKS), &settings, rate_hz, ticks);
        let moving = |words: &[u32]| words.iter().any(|word| *word != 0);
        let live = expected.iter().filter(|words| moving(&words[8..11]) && moving(&words[16..19])).count();
        assert!(2 * live > expected.len(), "only {live} of {ticks} ticks move: the comparison is empty");
        let mut hardware = kind.open().unwrap_or_else(|error| panic!("{error}"));
        let got = drive(&mut *hardware, &settings, rate_hz, ticks);
        for (tick, (got, expected)) in got.iter().zip(&expected).enumerate() {
            assert_eq!(got, expected, "{kind}, {speed_mode:?}, {set_point_mode:?}, tick {tick}");
        }
    }
}

#[test]
fn rust_hdl_equals_the_bit_true_model_through_its_pins() {
    compare(Kind::RustHdl, 8_000.0, if cfg!(debug_assertions) { 5 } else { 60 });
}

#[test]
fn compiled_verilog_equals_the_bit_true_model_through_its_pins() {
    compare(Kind::Verilog, 1_000.0, 150);
    compare(Kind::Verilog, 8_000.0, 1_500);
}
