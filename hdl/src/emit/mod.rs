//! From rust-hdl blocks to the files in `generated/`.
//!
//! ```text
//! block --> verilog  readable modules  --> top  joined to the board's pins --> hash  signed
//! board --> ucf      pins and timing
//!           ise      the project that makes a bitstream of them
//! heads --> blocks   the page of the blocks
//! ```

mod always;
pub mod blocks;
pub mod hash;
pub mod ise;
mod module;
pub mod open_board;
mod pins;
pub mod ports;
pub mod registers;
pub mod token;
pub mod top;
pub mod ucf;
pub mod verilog;
pub mod wavejson;
