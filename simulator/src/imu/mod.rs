//! A simulated ICM-42688-P at its pins: the registers of its data sheet (DS-000347, user bank 0) before the physics of
//! [`model::imu`].
//!
//! ```text
//!  motion ─► model::imu ─► words by the range in force ─► registers ─► bytes ─► MISO
//! ```
//!
//! The register map is written here from the sheet and not taken from the driver, so that a slip in one shows.

mod pins;

pub use model::imu::Chassis;
pub use pins::SpiPins;

use fixed_kin::imu_spi::{NO_AGE, Sample, WORDS};
use model::effects::Applied;
use model::imu::{Imu, ImuModel, Motion, Reading};
use model::plant::GRAVITY;
use runs::robot::{Axis, Robot};
use std::f64::consts::PI;

const DEVICE_CONFIG: u8 = 0x11;
const TEMP_DATA1: u8 = 0x1D;
const INT_STATUS: u8 = 0x2D;
const PWR_MGMT0: u8 = 0x4E;
const GYRO_CONFIG0: u8 = 0x4F;
const ACCEL_CONFIG0: u8 = 0x50;
const INT_CONFIG1: u8 = 0x64;
const INT_SOURCE0: u8 = 0x65;
const SELF_TEST_CONFIG: u8 = 0x70;
const WHO_AM_I: u8 = 0x75;
const REG_BANK_SEL: u8 = 0x76;

/// Registers that a reset does not leave at 0.
const RESET: [(u8, u8); 11] = [
    (0x13, 0x05),
    (INT_STATUS, 0x10),
    (0x4C, 0x30),
    (0x4D, 0x91),
    (GYRO_CONFIG0, 0x06),
    (ACCEL_CONFIG0, 0x06),
    (0x51, 0x16),
    (0x52, 0x11),
    (0x53, 0x0D),
    (INT_CONFIG1, 0x10),
    (INT_SOURCE0, 0x10),
];
/// What the data registers hold while a triad is off.
const INVALID: u16 = 0x8000;
/// What the self-test moves a triad by: rad/s and m/s². The sheet asks for at least 60 °/s and 0.05 g.
const SELF_TEST: [f64; 2] = [100.0 * PI / 180.0, 0.3 * GRAVITY];

/// Where a tick falls in the sensor's own period moves on by this much from tick to tick: its clock is 1 % off at 8 kHz.
const DRIFT: f64 = 0.08;

/// What is wrong with a sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImuFault {
    /// Not there: the lines are pulled up.
    Absent,
    /// Its line is shorted to ground.
    ShortedLow,
    /// It answers, but its data do not change any more.
    Frozen,
    /// The chip is turned by 90° about the body's x axis: its y and z axes are swapped.
    Swapped,
    /// The accelerometer is in a range eight times finer than its register says.
    WrongRange,
    /// Its data-ready line is cut.
    NeverReady,
    /// Another type: an ICM-42605.
    OtherType,
    /// A register bit cannot be set.
    StuckBit,
    /// The gyroscope's mass for the z axis sticks: bias and noise only.
    DeadGyro,
    /// The accelerometer's mass for the x axis sticks.
    DeadForce,
}

impl ImuFault {
    /// For tests and tables that go through every fault.
    pub const ALL: [Self; 10] = [
        Self::Absent,
        Self::ShortedLow,
        Self::Frozen,
        Self::Swapped,
        Self::WrongRange,
        Self::NeverReady,
        Self::OtherType,
        Self::StuckBit,
        Self::DeadGyro,
        Self::DeadForce,
    ];
}

/// A six-axis sensor behind SPI, bit for bit, with the errors of a real one.
#[derive(Clone, Debug)]
pub struct VirtualImu {
    part: Imu,
    axes: [Axis; 3],
    registers: [u8; 128],
    bank: u8,
    words: [u16; WORDS],
    age: u16,
    phase: f64,
    /// What is wrong with it, from now on.
    pub fault: Option<ImuFault>,
}

impl VirtualImu {
    /// A part drawn from the type's tolerances, just powered up, whose motion is told `rate_hz` times a second.
    #[must_use]
    pub fn new(rate_hz: f64, seed: u64) -> Self {
        Self::of(ImuModel::icm_42688_p(rate_hz), seed)
    }

    /// The same of another type or mounting.
    #[must_use]
    pub fn of(model: ImuModel, seed: u64) -> Self {
        let mut sensor = Self {
            part: Imu::new(model, seed),
            axes: Axis::XYZ,
            registers: [0; 128],
            bank: 0,
            words: [INVALID; WORDS],
            age: NO_AGE,
            phase: 0.0,
            fault: None,
        };
        sensor.reset();
        sensor
    }

    /// The sensor that a robot says it has, mounted as it says but for the effects in the robot's file.
    #[must_use]
    pub fn of_robot(robot: &Robot, seed: u64) -> Option<Self> {
        let mount = robot.imu?;
        let model = ImuModel { place: mount.place_m, ..ImuModel::icm_42688_p(robot.control_rate_hz) };
        let mut sensor = Self { axes: mount.axes, ..Self::of(model, seed) };
        sensor.part = sensor.part.with_deviations(&Applied::of(robot).imu);
        if &*mount.sensor == "icm-42605" {
            sensor.fault = Some(ImuFault::OtherType);
        }
        Some(sensor)
    }

    fn reset(&mut self) {
        self.registers = [0; 128];
        for (register, value) in RESET {
            self.registers[usize::from(register)] = value;
        }
        self.bank = 0;
    }

    /// How the chassis moves in the coming control period of a card with this clock.
    pub fn feel(&mut self, motion: &Motion, clock_hz: f64) {
        let mut motion = *motion;
        match self.fault {
            Some(ImuFault::DeadGyro) => motion.omega[2] = 0.0,
            Some(ImuFault::DeadForce) => motion.acceleration[0] = 0.0,
            _ => {}
        }
        let reading = self.part.read(&motion);
        if self.fault != Some(ImuFault::Frozen) {
            self.words = self.measure(&reading);
        }
        let ready = self.registers[usize::from(INT_SOURCE0)] & 0x08 != 0
            && self.registers[usize::from(PWR_MGMT0)] & 0x0F != 0
            && self.fault != Some(ImuFault::NeverReady);
        self.phase = (self.phase + DRIFT).fract();
        // Two clocks are the synchroniser.
        let age = (clock_hz / self.output_hz() * self.phase).min(65_000.0) as u16 + 2;
        self.age = if ready { age } else { NO_AGE };
    }

    /// Its own readings a second.
    fn output_hz(&self) -> f64 {
        match self.registers[usize::from(GYRO_CONFIG0)] & 0x0F {
            rate @ 1..=5 => 64e3 / f64::from(1_u32 << rate),
            _ => 1e3,
        }
    }

    fn measure(&self, reading: &Reading) -> [u16; WORDS] {
        let register = |at: u8| self.registers[usize::from(at)];
        let power = register(PWR_MGMT0);
        let dead = match self.fault {
            Some(ImuFault::DeadGyro) => 0x04,
            Some(ImuFault::DeadForce) => 0x08,
            _ => 0,
        };
        let test = register(SELF_TEST_CONFIG) & !dead;
        let gyro_range = 2000.0 * PI / 180.0 / f64::from(1_u32 << (register(GYRO_CONFIG0) >> 5));
        let finer = if self.fault == Some(ImuFault::WrongRange) { 3 } else { 0 };
        let force_range = 16.0 * GRAVITY / f64::from(1_u32 << (u32::from(register(ACCEL_CONFIG0) >> 5).min(3) + finer));
        let word = |value: f64, range: f64| (value / range * 32_768.0).round().clamp(-32_768.0, 32_767.0) as i16 as u16;
        let chip = |body: [f64; 3]| {
            let mut chip = [0.0; 3];
            self.axes.iter().zip(body).for_each(|(axis, component)| axis.put(component, &mut chip));
            chip
        };
        let turned = |v: [f64; 3]| if self.fault == Some(ImuFault::Swapped) { [v[0], v[2], -v[1]] } else { v };
        let (rates, forces) = (turned(chip(reading.gyro)), turned(chip(reading.acceleration)));
        let mut words = [INVALID; WORDS];
        if power & 0x0F != 0 {
            words[0] = ((reading.temperature_c - 25.0) * 132.48).round() as i16 as u16;
        }
        for axis in 0..3 {
            let tested = |bit: usize, by: f64| if test >> bit & 1 == 1 { by } else { 0.0 };
            if power & 0x03 == 0x03 {
                words[1 + axis] = word(forces[axis] + tested(3 + axis, SELF_TEST[1]), force_range);
            }
            if power & 0x0C == 0x0C {
                words[4 + axis] = word(rates[axis] + tested(axis, SELF_TEST[0]), gyro_range);
            }
        }
        words
    }

    /// What a burst from `first` on brings.
    #[must_use]
    pub fn sample(&self, first: u8) -> Sample {
        let byte = |k: usize| u16::from(self.byte(first.wrapping_add(k as u8)));
        let age = if self.is_silent() { NO_AGE } else { self.age };
        Sample { age, words: std::array::from_fn(|word| byte(2 * word) << 8 | byte(2 * word + 1)) }
    }

    fn is_silent(&self) -> bool {
        matches!(self.fault, Some(ImuFault::Absent | ImuFault::ShortedLow))
    }

    /// What a register sends.
    fn byte(&self, register: u8) -> u8 {
        match self.fault {
            Some(ImuFault::Absent) => return 0xFF,
            Some(ImuFault::ShortedLow) => return 0,
            _ => {}
        }
        let data = register.wrapping_sub(TEMP_DATA1);
        match register {
            REG_BANK_SEL => self.bank,
            // The other banks hold trims that nobody here reads.
            _ if self.bank != 0 => 0,
            WHO_AM_I if self.fault == Some(ImuFault::OtherType) => 0x42,
            WHO_AM_I => 0x47,
            _ if usize::from(data) < 2 * WORDS => {
                self.words[usize::from(data / 2)].to_be_bytes()[usize::from(data % 2)]
            }
            _ => self.registers[usize::from(register & 0x7F)],
        }
    }

    /// One access as the 16 bits on the line have it; what the sensor sends in its second byte.
    pub fn access(&mut self, command: u16) -> u8 {
        let (register, value) = ((command >> 8) as u8 & 0x7F, command as u8);
        if command & 0x8000 != 0 || self.is_silent() {
            return self.byte(register);
        }
        match register {
            REG_BANK_SEL => self.bank = value & 7,
            _ if self.bank != 0 => {}
            DEVICE_CONFIG if value & 1 == 1 => self.reset(),
            WHO_AM_I | INT_STATUS | TEMP_DATA1..=0x2A => {}
            _ => {
                let stuck = if self.fault == Some(ImuFault::StuckBit) { 0x01 } else { 0 };
                self.registers[usize::from(register)] = value & !stuck;
            }
        }
        0
    }
}

#[cfg(test)]
mod tests;
