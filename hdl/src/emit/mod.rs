//! From rust-hdl blocks to the files in `generated/`.

pub mod ports;
pub mod token;
