//! The gateware in rust-hdl, one block a file.

pub mod blocks;
pub mod board;
pub mod design;
pub mod emit;
pub mod primitives;
pub mod program;
pub mod sim;
pub mod stimulus;
