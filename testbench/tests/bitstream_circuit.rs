//! The bits of the committed bitstream, decoded, as a chip: against fixed-kin, against the emitted Verilog at every
//! pin and clock, and behind the virtual card, where also other bits do what they say.

use bitstream::configuration::Configuration;
use bitstream::container::Bitstream;
use bitstream::device::Device;
use bitstream::element::Io;
use driver::load::{Options, inspect, load};
use driver::{Board, PciCard, RegisterWindow, Scale, Settings};
use fixed_kin::registers::COOKIE;
use fixed_kin::speed::SpeedMode;
use hdl::design::{COMMITTED_VERILOG, NAME};
use hdl::emit::ports::Ports;
use runs::frames::Twist;
use runs::robot::Robot;
use simulator::chip::Chip;
use simulator::circuit::{Circuit, LCLK_PS, committed, decode};
use simulator::closed_loop::Drive;
use simulator::cosim::Verilated;
use simulator::cross_check::{Traced, play};
use simulator::fpga::{BitTrue, Decoded, QUIET_CLOCKS};
use simulator::virtual_card::VirtualCard;
use std::time::Duration;
use testbench::blinker::{WORD, blinker};
use testbench::pin_stimulus::{Stimulus, assert_lively};

/// Control ticks of the chip at 8 kHz.
const TICKS: usize = 400;
/// Clocks of the comparison of all pins, from configuration.
const CLOCKS: usize = 500_000;
/// A slow bus clock, Hz: 5,000 clocks a control tick.
const CLOCK_HZ: f64 = 1e6;

#[test]
fn the_decoded_bits_equal_fixed_kin() {
    let mut drive = Drive { speed_mode: SpeedMode::CountAndTime, limit_s: TICKS as f64 / 8_000.0, ..Drive::fig_6() };
    drive.moving = Twist::new(0.6, 0.5, 0.5);
    drive.believed.control_rate_hz = 8_000.0;
    let mut traced = Traced::new(BitTrue::new().with_quiet_clocks(QUIET_CLOCKS));
    drive.run(&mut traced, |_| {}).unwrap();
    let check = play(&traced.into_trace(), Decoded::new().unwrap(), |_| {}).unwrap();
    assert_eq!(check.difference, None);
    assert!(check.ticks >= TICKS && check.live_words > 10 * TICKS, "{check:?}");
    println!("bits: {} ticks, {} clocks, {} words, 0 differ", check.ticks, check.clocks, check.words);
}

#[test]
fn every_pin_of_the_decoded_bits_equals_the_verilog_at_every_clock() {
    let ports = Ports::parse(COMMITTED_VERILOG, NAME, &["lclk", "synclk"]).unwrap();
    let verilog = Verilated::build(NAME, COMMITTED_VERILOG, NAME, &ports).unwrap_or_else(|error| panic!("{error}"));
    let stimulus = Stimulus::whole(verilog.layout(), CLOCKS);
    let expected = verilog.run(stimulus.rows()).unwrap();
    let netlist = decode(&committed().packets).unwrap();
    let mut circuit = Circuit::with_periods(&netlist, [LCLK_PS; 2]).unwrap();
    let layout = circuit.layout().clone();
    let (outputs, mut clocks) = (layout.outputs.len(), 0);
    circuit
        .batch(stimulus.rows(), |clock, got| {
            let expected = &expected[clock * outputs..(clock + 1) * outputs];
            let wrong: Vec<_> =
                layout.outputs.iter().zip(got.iter().zip(expected)).filter(|(_, (a, b))| a != b).collect();
            assert!(wrong.is_empty(), "clock {clock}: {wrong:x?}");
            clocks += 1;
            true
        })
        .unwrap();
    assert!(clocks >= CLOCKS);
    assert_lively(&layout, &expected);
    println!("bits: {clocks} clocks, all pins, 0 differ");
}

fn card() -> VirtualCard {
    let robot = Robot { control_rate_hz: 200.0, ..Robot::racbot() };
    VirtualCard::new(&robot).unwrap().with_clock(CLOCK_HZ)
}

/// Whether the robot moves as [`drive`] tells it.
fn as_told(twist: Twist) -> bool {
    (twist.vx - 0.2).abs() < 0.05 && (twist.vy - 0.4).abs() < 0.05 && twist.omega.abs() < 0.3
}

/// Drives ahead with what is loaded; how fast the robot then is.
fn drive(card: VirtualCard, clock_hz: f64) -> (Twist, Board<RegisterWindow<VirtualCard>>) {
    let robot = Robot { control_rate_hz: 200.0, ..Robot::racbot() };
    let scale = Scale::new(&robot, clock_hz).unwrap();
    let mut board = Board::new(RegisterWindow::new(card));
    board.configure(&scale, &Settings::default()).unwrap();
    board.bus.card.sleep(Duration::from_millis(11));
    board.arm().unwrap();
    for _ in 0..120 {
        board.set_twist(&scale, Twist { vx: 0.2, vy: 0.4, omega: 0.0 }).unwrap();
        board.bus.card.sleep(Duration::from_millis(5));
    }
    assert!(board.snapshot().unwrap().status.armed);
    (board.bus.card.machine().plant().twist(), board)
}

#[test]
fn loaded_bits_drive_the_robot_and_their_watchdog_stops_it() {
    let mut card = card().with_decoded_bits();
    let loaded = load(&mut card, &committed(), &Options::default(), |_| {}).unwrap();
    assert!((loaded.clock_hz / CLOCK_HZ - 1.0).abs() < 2e-3, "{}", loaded.clock_hz);
    let (twist, mut board) = drive(card, loaded.clock_hz);
    assert!(as_told(twist), "{twist:?}");
    board.bus.card.sleep(Duration::from_millis(60));
    assert!(!board.status().unwrap().armed, "the watchdog sleeps");
    assert_eq!(board.bus.card.failure(), None);
}

#[test]
fn another_design_behaves_as_that_design() {
    let bitstream = Bitstream::parse(&blinker()).unwrap();
    let mut card = card();
    let error = load(&mut card, &bitstream, &Options::default(), |_| {}).unwrap_err();
    assert!(error.to_string().contains("cookie reads 0x424c4e4b"), "{error}");
    // Refused, it was cleared; as a chip of its own it blinks and answers.
    let mut circuit = Circuit::new(&decode(&bitstream.packets).unwrap()).unwrap();
    let mut words = [0; 3];
    circuit.read(COOKIE.offset, &mut words).unwrap();
    assert_eq!(words, [WORD; 3]);
    let led = circuit.layout().output("led_n").unwrap();
    let before = circuit.get(&[led]).unwrap()[0];
    circuit.run(3 * 256).unwrap();
    assert_eq!((before - circuit.get(&[led]).unwrap()[0]) & 0xFF, 3);
}

/// A file with other frames, all CRC words right.
fn repacked(file: &Bitstream, configuration: &Configuration) -> Bitstream {
    let mut packets = file.packets.clone();
    configuration.store(Device::xc2s200(), &mut packets).unwrap();
    Bitstream::parse(&file.encode(&packets)).unwrap()
}

/// The committed file with one configuration bit flipped: the inverter before the driver of this port's pad.
fn inverted(port: &str, bit: usize) -> Bitstream {
    let device = Device::xc2s200();
    let good = committed();
    let mut configuration = Configuration::from_packets(device, &good.packets).unwrap();
    let pin = hdl::board::Board::mesa_4i65_7i30().port(port)[bit].place.pin();
    let site = device.pad(pin).unwrap().site;
    let before = configuration.clone();
    let mut io = Io::read(device, &configuration, site).unwrap().unwrap();
    io.invert_o = !io.invert_o;
    io.write(device, &mut configuration, site).unwrap();
    assert_eq!(before.differences(&configuration).count(), 1);
    repacked(&good, &configuration)
}

#[test]
fn a_flipped_frame_bit_with_right_crc_shows_as_wrong_behaviour() {
    // On the bus: the design answers, wrongly.
    let mut card = card();
    let error = load(&mut card, &inverted("lad", 0), &Options::default(), |_| {}).unwrap_err();
    assert!(error.to_string().contains("cookie reads 0x52414335"), "{error}");
    assert!(inspect(&mut card).unwrap().identity.is_none());
    // On a motor: nothing on the bus tells, the robot does.
    let mut card = self::card();
    let loaded = load(&mut card, &inverted("pwm", 0), &Options::default(), |_| {}).unwrap();
    let (twist, _) = drive(card, loaded.clock_hz);
    assert!(!as_told(twist), "{twist:?}");
}

#[test]
fn bits_that_make_no_circuit_answer_nothing() {
    let device = Device::xc2s200();
    let good = committed();
    let mut configuration = Configuration::from_packets(device, &good.packets).unwrap();
    // Everything on: switches fight.
    for (tile, _) in device.tiles_of("CLB").take(20) {
        for attribute in &device.class(tile).attributes {
            configuration.set_pattern(device, tile, attribute, u64::MAX);
        }
    }
    let bitstream = repacked(&good, &configuration);
    let mut card = card();
    let error = load(&mut card, &bitstream, &Options { tries: 1, ..Options::default() }, |_| {}).unwrap_err();
    assert!(error.to_string().contains("outputs off"), "{error}");
}
