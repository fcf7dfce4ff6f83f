//! The gateware in rust-hdl, one block a file ([`blocks`]); the chips that are made of them ([`design`]); and what is emitted
//! for them ([`emit`]). [`stimulus`] has what each block is tested with. The language stands here as [`rust_hdl`], in the
//! version that the blocks are written in.
//!
//! ```
//! use hdl::blocks::pwm::Pwm;
//! use hdl::rust_hdl::prelude::*;
//! use hdl::sim::cycle;
//!
//! let mut block = Pwm::default();
//! block.connect_all();
//! (block.enable.next, block.load.next, block.direction.next) = (true, true, true);
//! (block.period.next, block.compare.next) = (10_u16.to_bits(), 4_u16.to_bits());
//! let mut clock = || {
//!     cycle(&mut block, |block, level| block.clock.next = level.into());
//!     block.pwm.val()
//! };
//! // A few periods until the set point is taken over, then four clocks of ten.
//! for _ in 0..50 {
//!     clock();
//! }
//! assert_eq!((0..100).filter(|_| clock()).count(), 40);
//!
//! let verilog = hdl::emit::verilog::emit(&block, "pwm");
//! assert!(verilog.contains("module pwm"));
//! ```

pub mod blocks;
pub mod board;
pub mod design;
pub mod emit;
pub mod primitives;
pub mod program;
pub mod sim;
pub mod stimulus;

pub use rust_hdl;
