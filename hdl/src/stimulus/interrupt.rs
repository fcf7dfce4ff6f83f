//! Stimulus for the interrupt block: events, enables and clearing in every order.

use super::{columns, generator};
use crate::blocks::interrupt::Interrupt;
use crate::sim::cycle;
use fixed_kin::interrupt::{Inputs, Outputs};
use rand::RngExt;
use rust_hdl::prelude::*;

columns!(Inputs { done, armed, enable, clear });
columns!(Outputs { int_n, status });

/// The rust-hdl block, fresh from configuration: one call is one clock.
pub fn hardware() -> impl FnMut(&Inputs) -> Outputs {
    let mut block = Interrupt::default();
    block.connect_all();
    move |inputs| {
        block.done.next = inputs.done;
        block.armed.next = inputs.armed;
        block.enable.next = inputs.enable.to_bits();
        block.clear.next = inputs.clear.to_bits();
        cycle(&mut block, |b, level| b.clock.next = level.into());
        Outputs { int_n: block.int_n.val(), status: block.status.val().to_u8() }
    }
}

/// Independent events, each at a rate of its own.
#[must_use]
pub fn stimulus(seed: u64, clocks: usize) -> Vec<Inputs> {
    let mut random = generator(seed);
    let mut armed = false;
    (0..clocks)
        .map(|_| {
            armed ^= random.random_range(0..10) == 0;
            let clear = if random.random_range(0..3) == 0 { random.random_range(0..4) } else { 0 };
            Inputs { done: random.random_range(0..4) == 0, armed, enable: random.random_range(0..4), clear }
        })
        .collect()
}
