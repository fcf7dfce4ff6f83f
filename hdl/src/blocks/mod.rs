//! The blocks of the gateware, one a file.

pub mod clock_monitor;
pub mod divider;
pub mod encoder;
pub mod kicker;
pub mod local_bus;
pub mod multiplier;
pub mod pwm;
pub mod safety;
pub mod sequencer;
