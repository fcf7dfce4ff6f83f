//! Driving a rust-hdl block directly, clock by clock.
//!
//! This is about five times faster than rust-hdl's threaded `Simulation`, which suits test benches
//! that own the clock anyway.

use rust_hdl::prelude::Block;

/// Passes through the block after which a design that has not settled is called oscillating.
const MAX_PASSES: usize = 200;

/// Lets every combinational path settle.
///
/// # Panics
/// If the block still changes after 200 passes: a combinational loop, which is a bug in the block.
pub fn settle<B: Block>(block: &mut B) {
    for _ in 0..MAX_PASSES {
        block.update_all();
        if !block.has_changed() {
            return;
        }
    }
    panic!("the block does not settle: combinational loop");
}

/// One clock cycle: `set_clock` drives the clock inputs with the level it is given.
///
/// Inputs set before the call are what the rising edge samples; outputs read after it are those
/// that hold until the next edge.
pub fn cycle<B: Block>(block: &mut B, mut set_clock: impl FnMut(&mut B, bool)) {
    set_clock(block, false);
    settle(block);
    set_clock(block, true);
    settle(block);
}
