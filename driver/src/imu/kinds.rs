//! Types of inertial sensor: what the driver writes at start and how it reads the fourteen bytes.

use std::f64::consts::PI;

/// Standard gravity, m/s².
pub(super) const GRAVITY: f64 = 9.806_65;

/// What a word of the fourteen bytes is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Raw, by the scale and offset of the kind.
    Temperature,
    /// Specific force along an axis of the chip, 0 to 2.
    Acceleration(usize),
    /// Rate of turn about an axis of the chip, 0 to 2.
    Gyro(usize),
}

/// A type of sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kind {
    /// Name, as `robot.toml` has it.
    pub name: &'static str,
    /// Identification register and its value.
    pub who_am_i: (u8, u8),
    /// Register and value that reset the sensor; it is ready 10 ms later.
    pub reset: (u8, u8),
    /// Registers and values after that, in order, each read back.
    pub settings: &'static [(u8, u8)],
    /// First of the fourteen registers.
    pub first: u8,
    /// What the seven words are.
    pub order: [Channel; 7],
    /// The first byte of a word is its lower one.
    pub low_first: bool,
    /// The line's clock rests high.
    pub mode_3: bool,
    /// Fastest clock of the line, Hz.
    pub fastest_hz: f64,
    /// Rate of turn of a unit, rad/s.
    pub gyro: f64,
    /// Specific force of a unit, m/s².
    pub acceleration: f64,
    /// °C of a unit, and at 0.
    pub temperature: [f64; 2],
    /// Noise density of the gyroscope, rad/s/√Hz.
    pub gyro_noise: f64,
}

use Channel::{Acceleration, Gyro, Temperature};

/// TDK ICM-42688-P, data sheet DS-000347: ±2000 °/s, ±16 g, 8 kHz, low noise, data ready on INT1, push-pull, active
/// high, pulses of 8 µs.
pub const ICM_42688_P: Kind = Kind {
    name: "icm-42688-p",
    who_am_i: (0x75, 0x47),
    reset: (0x11, 0x01),
    settings: &[
        (0x14, 0x03), // INT_CONFIG: INT1 push-pull, active high
        (0x64, 0x60), // INT_CONFIG1: 8 µs pulses, INT_ASYNC_RESET off as the sheet asks
        (0x65, 0x08), // INT_SOURCE0: data ready on INT1
        (0x4F, 0x03), // GYRO_CONFIG0: ±2000 °/s, 8 kHz
        (0x50, 0x03), // ACCEL_CONFIG0: ±16 g, 8 kHz
        (0x4E, 0x0F), // PWR_MGMT0: both in low-noise mode
    ],
    first: 0x1D,
    order: [Temperature, Acceleration(0), Acceleration(1), Acceleration(2), Gyro(0), Gyro(1), Gyro(2)],
    low_first: false,
    mode_3: true,
    fastest_hz: 24e6,
    gyro: 2000.0 * PI / 180.0 / 32_768.0,
    acceleration: 16.0 * GRAVITY / 32_768.0,
    temperature: [1.0 / 132.48, 25.0],
    gyro_noise: 0.0028 * PI / 180.0,
};

/// Its elder with the same registers.
pub const ICM_42605: Kind =
    Kind { name: "icm-42605", who_am_i: (0x75, 0x42), gyro_noise: 0.0038 * PI / 180.0, ..ICM_42688_P };

/// All types.
pub const KINDS: [&Kind; 2] = [&ICM_42688_P, &ICM_42605];

/// The type of a name.
#[must_use]
pub fn kind(name: &str) -> Option<&'static Kind> {
    KINDS.into_iter().find(|kind| kind.name == name)
}
