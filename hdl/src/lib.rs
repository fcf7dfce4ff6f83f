//! The gateware in rust-hdl, one block a file.

pub mod blocks;
pub mod emit;
pub mod sim;
