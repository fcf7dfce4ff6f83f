//! What a card says of itself, and what it is told before it is armed.

use crate::scale::PWM_FREQUENCY_HZ;
use fixed_kin::AXES;
use fixed_kin::control::SetPointMode;
use fixed_kin::format::{Duty, Speed};
use fixed_kin::registers as map;
use fixed_kin::safety::Fault;
use fixed_kin::speed::SpeedMode;
use std::fmt;

/// Identification registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Identity {
    /// Register map version.
    pub version: u32,
    /// Hash of the Verilog the bitstream was made from.
    pub content_hash: u32,
    /// How many axes it controls.
    pub axes: u32,
    /// Board whose pins it drives.
    pub board: map::Target,
    /// Nominal clock, Hz.
    pub clock_hz: u32,
}

/// How the card is to work.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Whether speeds come from counts alone or from counts and the time of the edges.
    pub speed_mode: SpeedMode,
    /// Whether set points are a body velocity or a speed for each wheel.
    pub set_point_mode: SetPointMode,
    /// PWM frequency, Hz.
    pub pwm_hz: f64,
    /// Silence of the host after which the outputs go off, s.
    pub watchdog_s: f64,
    /// Silence of the host after which the wheels are to stand, s; at least five control periods.
    pub set_point_s: f64,
    /// Whether the card keeps a pose.
    pub odometry: bool,
    /// PWM and DIR pins pulse forward and backward, instead of magnitude and sign.
    pub up_down: bool,
    /// Duty above which a wheel must move; 1 or more switches the stall detection off.
    pub stall_duty: f64,
    /// Time in which it must, s.
    pub stall_s: f64,
    /// Time for which the kicker may charge without getting full, s, up to 16; 0 leaves the kicker's setting alone.
    pub kicker_charge_s: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            speed_mode: SpeedMode::CountAndTime,
            set_point_mode: SetPointMode::Twist,
            pwm_hz: PWM_FREQUENCY_HZ,
            watchdog_s: 0.05,
            set_point_s: 0.03,
            odometry: true,
            up_down: false,
            stall_duty: 0.5,
            stall_s: 0.2,
            kicker_charge_s: 0.0,
        }
    }
}

/// Live state of the card.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Status {
    /// Outputs may be on.
    pub armed: bool,
    /// A set point was committed since arming.
    pub set_points_valid: bool,
    /// The emergency stop is pressed or open.
    pub emergency_stop: bool,
    /// The ball sensor sees the ball.
    pub ball: bool,
}

impl Status {
    pub(super) fn of(word: u32) -> Self {
        Self {
            armed: map::STATUS_ARMED.is_set(word),
            set_points_valid: map::STATUS_SET_POINTS_VALID.is_set(word),
            emergency_stop: map::STATUS_EMERGENCY_STOP.is_set(word),
            ball: map::STATUS_BALL.is_set(word),
        }
    }
}

/// What keeps or kept a card from being armed: sticky registers, as they read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Standing {
    /// The word of the register `faults`, a bit each cause.
    pub faults: u32,
    /// Axes with an encoder error, a bit each.
    pub encoder_errors: u32,
    /// Axes that stalled, a bit each.
    pub stalls: u32,
}

impl Standing {
    /// Whether there is anything worth telling. That the watchdog bit while nobody commanded is not, nor a stop
    /// that was pressed and released: both also stand after every power-up.
    #[must_use]
    pub fn is_notable(&self) -> bool {
        let expected = u32::from(Fault::Watchdog.mask() | Fault::EmergencyStop.mask());
        self.faults & !expected != 0 || self.encoder_errors != 0 || self.stalls != 0
    }
}

impl fmt::Display for Standing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&fault_names(self.faults))?;
        for (what, axes) in [("encoder error", self.encoder_errors), ("stall", self.stalls)] {
            let axes: Vec<String> =
                (0..AXES).filter(|axis| axes >> axis & 1 == 1).map(|axis| (axis + 1).to_string()).collect();
            if !axes.is_empty() {
                write!(f, "; {what} on axis {}", axes.join(", "))?;
            }
        }
        Ok(())
    }
}

/// One control tick as the card saw it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Snapshot {
    /// Number of the tick.
    pub sequence: u32,
    /// Status at the tick.
    pub status: Status,
    /// The word of the register `faults`, a bit each cause.
    pub faults: u32,
    /// Clocks at the tick, low 24 bits.
    pub time: u32,
    /// Encoder counts, wrapping.
    pub counts: [i32; AXES],
    /// Speeds as measured at the tick.
    pub speeds: [Speed; AXES],
    /// Set points in force.
    pub references: [Speed; AXES],
    /// Duties that the PI loops gave, before they become compare values.
    pub duties: [Duty; AXES],
    /// Pose, see [`Scale::pose`](crate::Scale::pose); zero while the card keeps none.
    pub pose: [i32; 3],
}

impl Snapshot {
    pub(super) fn of(words: &[u32; map::SNAPSHOT_WORDS]) -> Self {
        let word = |register: &map::Register, index: usize| {
            words[usize::from(register.at(index) - map::SNAPSHOT_SEQUENCE.offset) / 4]
        };
        let signed = |register: &map::Register, index: usize| word(register, index).cast_signed();
        Self {
            sequence: words[0],
            status: Status::of(word(&map::SNAPSHOT_STATUS, 0)),
            faults: word(&map::SNAPSHOT_FAULTS, 0),
            time: word(&map::SNAPSHOT_TIME, 0),
            counts: std::array::from_fn(|i| signed(&map::SNAPSHOT_COUNT, i)),
            speeds: std::array::from_fn(|i| Speed::from_bits(signed(&map::SNAPSHOT_SPEED, i))),
            references: std::array::from_fn(|i| Speed::from_bits(signed(&map::SNAPSHOT_REFERENCE, i))),
            duties: std::array::from_fn(|i| Duty::from_bits(signed(&map::SNAPSHOT_DUTY, i))),
            pose: std::array::from_fn(|k| signed(&map::SNAPSHOT_POSE, k)),
        }
    }
}

/// Names of the set bits of a fault register.
#[must_use]
pub fn fault_names(faults: u32) -> String {
    let names: Vec<_> =
        map::FAULT_FIELDS.iter().filter(|field| field.of(faults) == 1).map(|field| field.name).collect();
    if names.is_empty() { "none shown".to_owned() } else { names.join(", ") }
}
