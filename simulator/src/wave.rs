//! Scenes of the chip's life, clock by clock, as VCD for a waveform viewer (GTKWave, Surfer).
//!
//! The rust-hdl core plays them, so no other tool is needed. All pins are shown, and LAD with what it
//! carries: the bridge's word, the card's, or high impedance.

use driver::{Board, BoardError, BusError, Registers, Scale, Settings};
use fixed_kin::radio::{CLOCKS_PER_BIT, Frame, FrameError, GAP_BYTES};
use fixed_kin::registers as map;
use fixed_kin::speed::SpeedMode;
use hdl::blocks::core::Core;
use hdl::board::Board as Board4I65;
use hdl::sim::cycle;
use runs::robot::Robot;
use rust_hdl::prelude::*;
use std::fmt::Write as _;

/// What is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scene {
    /// A burst read of the identification, a write, a read of a reserved word.
    Bus,
    /// Commit of set points, arm sequence, control ticks, PWM.
    Arm,
    /// A wheel that is told to turn the other way: DIR and PWM with their blanking.
    Reversal,
    /// Charging, trigger pulse, lock-out.
    Kick,
    /// Armed and driving, then the emergency stop opens.
    Stop,
    /// A robot without a PC: a frame on the radio's line that arms.
    Radio,
}

/// A scene that could not be played: a fault of the core or of the built-in robot.
#[derive(Debug, thiserror::Error)]
pub enum WaveError {
    /// The core did not do what it was asked to.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// A frame that cannot be made.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// The robot's gains do not fit their words.
    #[error(transparent)]
    Scale(#[from] driver::ScaleError),
}

/// Nanoseconds of half a period of LCLK.
const HALF_PERIOD: u64 = 15;
/// Clocks until the monitor believes in both clocks.
const POWER_UP: u32 = 600;
/// Control ticks a second: few clocks between them, so that a few fit a screen.
const RATE_HZ: f64 = 8_000.0;
/// The robot that the straps name.
const ROBOT: u8 = 6;
/// Clocks of a control period.
const TICK: u32 = 4_167;

/// The VCD text of a scene and the clocks it shows.
///
/// # Errors
/// [`WaveError`].
pub fn record(scene: Scene) -> Result<(String, u64), WaveError> {
    let mut board = Board::new(Stage::new(scene == Scene::Radio));
    board.bus.wait(POWER_UP);
    play(&mut board, scene)?;
    Ok((board.bus.vcd(), board.bus.clock))
}

fn play(board: &mut Board<Stage>, scene: Scene) -> Result<(), WaveError> {
    if scene == Scene::Bus {
        board.bus.access(map::COOKIE.offset, &mut Words::Read(&mut [0; 6]));
        board.write_checked(&map::LEDS, 0x5A)?;
        board.bus.access(0xFFF8, &mut Words::Read(&mut [0; 2]));
        return Ok(());
    }
    if scene == Scene::Radio {
        board.bus.send(&arming_frame()?);
        return Ok(());
    }
    let robot = Robot { control_rate_hz: RATE_HZ, ..Robot::racbot() };
    let scale = Scale::new(&robot, f64::from(map::NOMINAL_CLOCK_HZ))?;
    board.configure(&scale, &Settings { speed_mode: SpeedMode::CountAndTime, ..Settings::default() })?;
    // Locked while armed, and zero means never.
    board.write_checked(&map::KICKER_CHARGE_TIMEOUT, 1_000)?;
    board.bus.wait(TICK);
    let wheels = |speed: f64| [scale.speed_word(speed); fixed_kin::AXES];
    board.set_wheel_speeds(&wheels(3.0))?;
    board.arm()?;
    board.set_wheel_speeds(&wheels(3.0))?;
    board.bus.wait(3 * TICK);
    match scene {
        Scene::Bus | Scene::Arm | Scene::Radio => {}
        Scene::Reversal => {
            board.set_wheel_speeds(&wheels(-3.0))?;
            board.bus.wait(3 * TICK);
        }
        Scene::Kick => {
            board.write_checked(&map::KICKER_PULSE, 50)?;
            board.write_checked(&map::KICKER_CONTROL, 1)?;
            board.bus.wait(2_000);
            board.bus.write(map::KICKER_FIRE.offset, map::KICKER_FIRE_WORD).map_err(BoardError::from)?;
            // A millisecond passes between charger and trigger, then the pulse.
            board.bus.wait(38_000);
        }
        Scene::Stop => {
            board.bus.core.emergency_stop.next = true;
            board.bus.wait(60);
            board.bus.core.emergency_stop.next = false;
            board.bus.wait(2 * TICK);
        }
    }
    Ok(())
}

/// Set points of zero, and the two words that arm.
fn arming_frame() -> Result<Vec<u8>, FrameError> {
    let mut frame = Frame::new(ROBOT, 1)?;
    frame.set_points([0; fixed_kin::control::SET_POINT_WORDS])?;
    frame.arm()?;
    Ok(frame.bytes().to_vec())
}

/// What a bus cycle moves.
enum Words<'a> {
    Read(&'a mut [u32]),
    Write(&'a [u32]),
}

/// Pins of the board table with their widths, LCLK first.
fn pins() -> Vec<(String, u32)> {
    let table = Board4I65::mesa_4i65_7i30().check().unwrap_or_default();
    table.into_iter().map(|(name, width)| (name, width.map_or(1, u32::from))).collect()
}

struct Stage {
    core: Box<Core>,
    clock: u64,
    /// The bridge drives LAD.
    bridge: bool,
    pins: Vec<(String, u32)>,
    shown: Vec<Option<Option<u32>>>,
    changes: String,
}

impl Stage {
    fn new(slave: bool) -> Self {
        let mut core = Box::new(hdl::design::core());
        core.ads_n.next = true;
        core.blast_n.next = true;
        core.emergency_stop.next = false;
        core.host_select.next = !slave;
        core.robot_number.next = u64::from(ROBOT).to_bits();
        core.radio_rx.next = true;
        core.imu_miso.next = true;
        core.imu_ready.next = true;
        let pins = pins();
        let shown = vec![None; pins.len()];
        Self { core, clock: 0, bridge: false, pins, shown, changes: String::new() }
    }

    /// Level of a pin of the board table; `None` is high impedance.
    fn level(&self, name: &str) -> Option<u32> {
        let core = &self.core;
        let bit = u32::from;
        Some(match name {
            "lclk" | "synclk" => 1,
            "ads_n" => bit(core.ads_n.val()),
            "blast_n" => bit(core.blast_n.val()),
            "lw_r" => bit(core.lw_r.val()),
            "lad" if self.bridge => core.lad_in.val().index() as u32,
            "lad" if core.lad_drive.val() => core.lad_out.val().index() as u32,
            "ready_n" => bit(core.ready_n.val()),
            "int_n" => bit(core.int_n.val()),
            "led_n" => core.led_n.val().index() as u32,
            "encoder_a" => core.encoder_a.val().index() as u32,
            "encoder_b" => core.encoder_b.val().index() as u32,
            "encoder_index" => core.encoder_index.val().index() as u32,
            "pwm" => core.pwm.val().index() as u32,
            "dir" => core.dir.val().index() as u32,
            "enable_n" => core.enable_n.val().index() as u32,
            "kicker_charge_n" => bit(core.kicker_charge_n.val()),
            "kicker_trigger_n" => bit(core.kicker_trigger_n.val()),
            "kicker_discharge" => bit(core.kicker_discharge.val()),
            "kicker_full" => bit(core.kicker_full.val()),
            "emergency_stop" => bit(core.emergency_stop.val()),
            "ball_sensor" => bit(core.ball_sensor.val()),
            "radio_rx" => bit(core.radio_rx.val()),
            "host_select" => bit(core.host_select.val()),
            "imu_cs_n" => bit(core.imu_cs_n.val()),
            "imu_sclk" => bit(core.imu_sclk.val()),
            "imu_mosi" => bit(core.imu_mosi.val()),
            "imu_miso" => bit(core.imu_miso.val()),
            "imu_ready" => bit(core.imu_ready.val()),
            "robot_number" => core.robot_number.val().index() as u32,
            _ => return None,
        })
    }

    /// A frame on the radio's line, and the silence after it.
    fn send(&mut self, bytes: &[u8]) {
        let gap = 10 * (GAP_BYTES + 1) * u32::from(CLOCKS_PER_BIT);
        self.wait(gap);
        for byte in bytes {
            for bit in 0..10 {
                self.core.radio_rx.next = (u32::from(*byte) << 1 | 1 << 9) >> bit & 1 == 1;
                self.wait(CLOCKS_PER_BIT.into());
            }
        }
        self.wait(gap);
    }

    fn step(&mut self) {
        cycle(&mut *self.core, |core, level| {
            core.lclk.next = level.into();
            core.synclk.next = level.into();
        });
        let _ = writeln!(self.changes, "#{}", 2 * HALF_PERIOD * self.clock);
        for index in 0..self.pins.len() {
            let (name, width) = &self.pins[index];
            let (pin, clock) = (self.level(name), name.ends_with("clk"));
            if clock || self.shown[index] != Some(pin) {
                self.shown[index] = Some(pin);
                let _ = writeln!(self.changes, "{}", value(index, *width, pin));
            }
        }
        let _ = writeln!(self.changes, "#{}", 2 * HALF_PERIOD * self.clock + HALF_PERIOD);
        for index in (0..self.pins.len()).filter(|index| self.pins[*index].0.ends_with("clk")) {
            let _ = writeln!(self.changes, "0{}", symbol(index));
        }
        self.clock += 1;
    }

    fn wait(&mut self, clocks: u32) {
        (0..clocks).for_each(|_| self.step());
    }

    /// One burst.
    fn access(&mut self, offset: u16, words: &mut Words) {
        let write = matches!(words, Words::Write(_));
        self.core.ads_n.next = false;
        self.core.lw_r.next = write;
        self.core.lad_in.next = u64::from(offset).to_bits();
        self.bridge = true;
        self.step();
        self.core.ads_n.next = true;
        self.bridge = write;
        let count = match words {
            Words::Read(words) => words.len(),
            Words::Write(words) => words.len(),
        };
        for index in 0..count {
            self.core.blast_n.next = index + 1 < count;
            if let Words::Write(words) = words {
                self.core.lad_in.next = u64::from(words[index]).to_bits();
            }
            // The bus block answers always, and within 66 clocks: testbench/proofs/bus.v.
            while self.core.ready_n.val() {
                self.step();
            }
            if let Words::Read(words) = words {
                words[index] = self.core.lad_out.val().index() as u32;
            }
            self.step();
        }
        self.core.blast_n.next = true;
        self.core.lw_r.next = false;
        self.bridge = false;
        self.wait(2);
    }

    fn vcd(&self) -> String {
        let mut text = String::from("$comment rac4i65, all pins; written by racbot wave $end\n$timescale 1ns $end\n");
        text.push_str("$scope module rac4i65 $end\n");
        for (index, (name, width)) in self.pins.iter().enumerate() {
            let range = if *width == 1 { String::new() } else { format!(" [{}:0]", width - 1) };
            let _ = writeln!(text, "$var wire {width} {} {name}{range} $end", symbol(index));
        }
        text + "$upscope $end\n$enddefinitions $end\n" + &self.changes
    }
}

impl Registers for Stage {
    fn read(&mut self, offset: u16) -> Result<u32, BusError> {
        let mut word = [0];
        self.access(offset, &mut Words::Read(&mut word));
        Ok(word[0])
    }

    fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError> {
        self.access(offset, &mut Words::Write(&[data]));
        Ok(())
    }
}

/// The symbol of a pin in the file.
fn symbol(index: usize) -> char {
    char::from(b'!' + index as u8)
}

fn value(index: usize, width: u32, pin: Option<u32>) -> String {
    let width = width as usize;
    match pin {
        Some(level) if width == 1 => format!("{level}{}", symbol(index)),
        Some(word) => format!("b{word:b} {}", symbol(index)),
        None => format!("b{} {}", "z".repeat(width), symbol(index)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(pin: &str) -> usize {
        pins().iter().position(|(name, _)| name == pin).unwrap()
    }

    /// Times at which a one-bit pin goes low, in clocks.
    fn falls(vcd: &str, pin: &str) -> Vec<u64> {
        let index = place(pin);
        let (mut time, mut falls) = (0, Vec::new());
        for line in vcd.lines() {
            match line.strip_prefix('#') {
                Some(digits) => time = digits.parse().unwrap(),
                None if line == format!("0{}", symbol(index)) => falls.push(time / (2 * HALF_PERIOD)),
                None => {}
            }
        }
        falls
    }

    #[test]
    fn the_bus_scene_shows_its_cycles() {
        let (vcd, _) = record(Scene::Bus).unwrap();
        assert_eq!(falls(&vcd, "ads_n").len(), 4);
        assert_eq!(falls(&vcd, "ready_n").len(), 6 + 2 + 2);
        assert!(vcd.contains(&format!("b{:b} {}", u32::from_be_bytes(*b"RAC4"), symbol(place("lad")))));
        assert!(vcd.contains(&format!("b{} {}", "z".repeat(32), symbol(place("lad")))));
    }

    #[test]
    fn every_pin_of_the_board_is_shown() {
        let mut stage = Stage::new(false);
        stage.bridge = true;
        assert_eq!(stage.pins.len(), 29);
        for (name, _) in &stage.pins {
            assert!(stage.level(name).is_some(), "{name} has no level; add it to Stage::level");
        }
    }

    #[test]
    fn the_radio_scene_arms_with_the_silence_after_the_frame() {
        let (vcd, clocks) = record(Scene::Radio).unwrap();
        let enables = place("enable_n");
        let on = vcd.find(&format!("\nb0 {}\n", symbol(enables))).expect("the bridges go on");
        let time: u64 = vcd[..on].rsplit('#').next().unwrap().lines().next().unwrap().parse().unwrap();
        let bit = u64::from(CLOCKS_PER_BIT);
        let sent = u64::from(POWER_UP) + (30 + arming_frame().unwrap().len() as u64 * 10) * bit;
        let waited = (time / (2 * HALF_PERIOD) - sent) / bit;
        assert!((17..=21).contains(&waited) && clocks > sent, "{waited} bits after the frame");
    }

    #[test]
    fn the_kick_scene_fires_once_after_charging() {
        let (vcd, clocks) = record(Scene::Kick).unwrap();
        let (charge, trigger) = (falls(&vcd, "kicker_charge_n"), falls(&vcd, "kicker_trigger_n"));
        assert_eq!(trigger.len(), 1);
        assert!(charge[0] < trigger[0] && trigger[0] < clocks, "{charge:?} {trigger:?}");
    }
}
