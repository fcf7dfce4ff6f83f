//! Bits and fields of the registers that have some, each by its name and in its register's table.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "constants that fit their field"
)]

use super::Field;
use crate::AXES;

pub(super) const fn bit(name: &'static str, bit: u32, text: &'static str) -> Field {
    bits(name, bit, 1, text)
}

pub(super) const fn bits(name: &'static str, bit: u32, width: u32, text: &'static str) -> Field {
    Field { name, bit, width, text, block: "" }
}

/// A fault and the block that raises it.
const fn fault(name: &'static str, bit: u32, block: &'static str, text: &'static str) -> Field {
    Field { name, bit, width: 1, text, block }
}

/// No valid set-point commit for [`WATCHDOG_TIMEOUT`](super::WATCHDOG_TIMEOUT); disarms.
pub const FAULT_WATCHDOG: Field =
    fault("watchdog", 0, "safety", "no valid set-point commit for `watchdog_timeout`; disarms");
/// Emergency stop input high or open; disarms.
pub const FAULT_EMERGENCY_STOP: Field =
    fault("emergency-stop", 1, "safety", "emergency stop input high or open; disarms");
/// An axis of [`ENCODER_FAULT_MASK`](super::ENCODER_FAULT_MASK) has its bit in [`ENCODER_ERROR`](super::ENCODER_ERROR); disarms.
pub const FAULT_ENCODER: Field =
    fault("encoder", 2, "encoder", "an axis of `encoder_fault_mask` has its bit in `encoder_error`; disarms");
/// A commit had the wrong checksum or number of words; nothing changed, reported only.
pub const FAULT_COMMIT: Field =
    fault("commit", 3, "commit", "a commit had the wrong checksum or number of words; nothing changed, reported only");
/// LCLK stood still, seen by the crystal; disarms.
pub const FAULT_EXTERNAL: Field =
    fault("external", 4, "clock_monitor", "LCLK stood still, seen by the crystal; disarms");
/// The second word of arming came while a cause stood, or out of order; reported only.
pub const FAULT_ARM_REFUSED: Field = fault(
    "arm-refused",
    5,
    "safety",
    "the second word of arming came while a cause stood, or out of order; reported only",
);
/// An axis of [`ENCODER_FAULT_MASK`](super::ENCODER_FAULT_MASK) has its bit in [`STALL`](super::STALL); disarms.
pub const FAULT_STALL: Field =
    fault("stall", 6, "stall", "an axis of `encoder_fault_mask` has its bit in `stall`; disarms");

/// Bits of [`FAULTS`](super::FAULTS) and [`FIRST_FAULT`](super::FIRST_FAULT); the order of [`crate::safety::Fault`].
pub const FAULT_FIELDS: [Field; 7] =
    [FAULT_WATCHDOG, FAULT_EMERGENCY_STOP, FAULT_ENCODER, FAULT_COMMIT, FAULT_EXTERNAL, FAULT_ARM_REFUSED, FAULT_STALL];

/// Outputs may be on.
pub const STATUS_ARMED: Field = bit("armed", 0, "outputs may be on");
/// A set point was committed since arming and has not timed out.
pub const STATUS_SET_POINTS_VALID: Field =
    bit("set-points-valid", 1, "a set point was committed since arming and has not timed out");
/// Emergency stop input, live.
pub const STATUS_EMERGENCY_STOP: Field = bit("emergency-stop", 2, "emergency stop input, live");
/// Ball sensor, live.
pub const STATUS_BALL: Field = bit("ball", 3, "ball sensor, live");
/// A commit of set points waits for the next tick.
pub const STATUS_SET_POINTS_PENDING: Field =
    bit("set-points-pending", 4, "a commit of set points waits for the next tick");
/// A commit of the configuration waits for the next tick.
pub const STATUS_CONFIGURATION_PENDING: Field =
    bit("configuration-pending", 5, "a commit of the configuration waits for the next tick");

/// Bits of [`STATUS`](super::STATUS).
pub const STATUS_FIELDS: [Field; 6] = [
    STATUS_ARMED,
    STATUS_SET_POINTS_VALID,
    STATUS_EMERGENCY_STOP,
    STATUS_BALL,
    STATUS_SET_POINTS_PENDING,
    STATUS_CONFIGURATION_PENDING,
];

/// A control tick has ended: its snapshot is there.
pub const INTERRUPT_TICK: Field = bit("tick", 0, "a control tick has ended: its snapshot is there");
/// The outputs went off, by a fault or by the host.
pub const INTERRUPT_DISARMED: Field = bit("disarmed", 1, "the outputs went off, by a fault or by the host");

/// Bits of [`INTERRUPT_ENABLE`](super::INTERRUPT_ENABLE) and [`INTERRUPT_STATUS`](super::INTERRUPT_STATUS).
pub const INTERRUPT_FIELDS: [Field; 2] = [INTERRUPT_TICK, INTERRUPT_DISARMED];

/// The reader of an inertial sensor.
pub const BLOCKS_IMU: Field = bit("imu", 20, "reader of an inertial sensor over SPI");

/// Fields of [`BLOCKS`](super::BLOCKS).
pub const BLOCK_FIELDS: [Field; 12] = [
    bits("encoders", 0, 4, "quadrature counters with index capture and stall detection"),
    bits("drives", 4, 4, "PWM generators"),
    bits("loops", 8, 4, "PI speed loops with feed-forward"),
    bit("count-and-time", 12, "speed by count and time"),
    bit("inverse-kinematics", 13, "body velocity to wheel speeds"),
    bit("odometry", 14, "pose"),
    bit("kicker", 15, "kicker"),
    bit("snapshot", 16, "coherent snapshots"),
    bit("clock-monitor", 17, "monitor on the 50 MHz crystal"),
    bit("interrupt", 18, "control-tick interrupt"),
    bit("radio", 19, "radio input"),
    BLOCKS_IMU,
];

/// Value of [`BLOCKS`](super::BLOCKS).
pub const BLOCKS_VALUE: u32 = {
    let counts = [AXES as u32, AXES as u32, AXES as u32, 1, 1, 1, 1, 1, 1, 1, 1, 1];
    let mut value = 0;
    let mut field = 0;
    while field < BLOCK_FIELDS.len() {
        value |= BLOCK_FIELDS[field].place(counts[field]);
        field += 1;
    }
    value
};
