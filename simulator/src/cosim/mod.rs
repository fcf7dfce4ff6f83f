//! Emitted Verilog under other people's simulators.
//!
//! ```text
//!                 ports::Ports  read from a block or a header, never listed by hand
//!                      |
//!   Verilog ----+--> Verilated --> batch: rows in, rows out      millions of steps
//!               |         `-----> Session: pins, bus, recording  a whole chip in a loop
//!               +--> icarus     --> batch, four-valued           thousands of steps
//!               `--> lint       --> findings, and a gate
//! ```
//!
//! One **step** is what [`hdl::sim::cycle`] does: inputs applied with the clocks low, everything
//! settles, the clocks rise, everything settles, outputs are read.
//!
//! Builds go to `RACBOT_COSIM_DIR`, or Cargo's scratch folder, and are reused while the design is
//! unchanged. A tool that is not installed is an error that names its Debian package.

mod bus;
mod bus_config;
mod error;
pub mod folder;
pub mod icarus;
mod layout;
pub mod lint;
mod session;
mod verilated;

pub use bus::BusOperation;
pub use bus_config::BusConfig;
pub use error::CosimError;
pub use hdl::emit::ports;
pub use hdl::emit::ports::{Direction, Port, Ports};
pub use layout::{Clocks, Column, Layout, Levels};
pub use session::{Change, Session};
pub use verilated::Verilated;
