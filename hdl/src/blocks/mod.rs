//! The blocks of the gateware, one a file.

pub mod clock_monitor;
pub mod encoder;
pub mod kicker;
pub mod local_bus;
pub mod pwm;
pub mod safety;
