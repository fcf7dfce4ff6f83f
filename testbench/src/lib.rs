//! What only tests use: proofs, netlists, place and route, machines under QEMU, faults, blind data.

pub mod blind;
pub mod blinker;
pub mod faults;
pub mod formal;
pub mod netlist;
pub mod open_board;
pub mod pin_stimulus;
pub mod place;
pub mod qemu;
