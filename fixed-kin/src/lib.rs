//! Bit-true reference of the motion control gateware.
#![no_std]

#[cfg(test)]
extern crate std;

pub mod card;
pub mod clock_monitor;
pub mod commit;
pub mod control;
pub mod encoder;
pub mod format;
pub mod kicker;
pub mod kinematics;
pub mod local_bus;
pub mod modulation;
pub mod pi;
pub mod pwm;
pub mod registers;
pub mod safety;
pub mod speed;
pub mod word;

/// Axes of the core: three wheels and a spare, which is a fourth wheel or the dribbler.
pub const AXES: usize = 4;
