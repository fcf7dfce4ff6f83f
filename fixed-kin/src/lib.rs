//! Bit-true reference of the motion control gateware.
#![no_std]

#[cfg(test)]
extern crate std;

pub mod encoder;
pub mod kicker;
pub mod pwm;
pub mod safety;
