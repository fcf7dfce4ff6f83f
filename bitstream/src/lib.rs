//! XC2S200 bitstreams: what is in a `.bit` file, and what the device makes of it.
//!
//! Nothing of the robot is in here.

#[cfg(feature = "device")]
pub mod configuration;
pub mod container;
#[cfg(feature = "device")]
pub mod device;
#[cfg(feature = "device")]
pub mod element;
#[cfg(feature = "device")]
pub mod flow;
#[cfg(feature = "device")]
pub mod netlist;
#[cfg(feature = "device")]
pub mod report;
#[cfg(feature = "device")]
pub mod simulation;
#[cfg(feature = "device")]
pub mod verilog;
