//! The blocks of the gateware, one a file.

pub mod clock_monitor;
pub mod commit;
pub mod core;
pub mod crc;
pub mod decoder;
pub mod divider;
pub mod encoder;
pub mod imu_spi;
pub mod interrupt;
pub mod kicker;
pub mod local_bus;
pub mod multiplier;
pub mod pwm;
pub mod radio;
pub mod register_file;
pub mod safety;
pub mod sequencer;
pub mod serial_host;
pub mod serial_receiver;
pub mod snapshot;
pub mod snapshot_address;
pub mod stall;
pub mod timebase;
pub mod trigonometry;
