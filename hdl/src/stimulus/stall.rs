//! Stimulus for the stall detector: wheels that turn, tremble, toggle and stand, drive around the threshold.

use super::{columns, generator};
use crate::blocks::stall::Stall;
use crate::sim::cycle;
use fixed_kin::stall::{Inputs, Outputs};
use rand::RngExt;
use rust_hdl::prelude::*;

columns!(Inputs { enable, step, up, load, compare, threshold, window, clear });
columns!(Outputs { stalled });

/// The rust-hdl block, fresh from configuration: one call is one clock.
pub fn hardware() -> impl FnMut(&Inputs) -> Outputs {
    let mut block = Stall::default();
    block.connect_all();
    move |inputs| {
        block.enable.next = inputs.enable;
        block.step.next = inputs.step;
        block.up.next = inputs.up;
        block.load.next = inputs.load;
        block.compare.next = inputs.compare.to_bits();
        block.threshold.next = inputs.threshold.to_bits();
        block.window.next = inputs.window;
        block.clear.next = inputs.clear;
        cycle(&mut block, |b, level| b.clock.next = level.into());
        Outputs { stalled: block.stalled.val() }
    }
}

/// Segments of random length, each with its own motion, drive and windows.
#[must_use]
pub fn stimulus(seed: u64, clocks: usize) -> Vec<Inputs> {
    let mut random = generator(seed);
    let mut rows = Vec::with_capacity(clocks);
    while rows.len() < clocks {
        let threshold = [0, 1, 400, 8_191, random.random_range(0..8_192_u16)][random.random_range(0..5)];
        let steps_of_256 = [0, 2, 30, 128, 256][random.random_range(0..5)];
        let up_of_8 = [0, 3, 4, 5, 8][random.random_range(0..5)];
        let toggles = random.random_range(0..3) == 0;
        let weak_of_256 = [0, 0, 3, 128][random.random_range(0..4)];
        let window_interval = [1, 2, 30, 200][random.random_range(0..4)];
        let drop_of_4096 = [0, 0, 8, 2_048][random.random_range(0..4)];
        let mut up = false;
        for clock in 0..random.random_range(1..2_000_u32) {
            let step = random.random_range(0..256) < steps_of_256;
            if step {
                up = if toggles { !up } else { random.random_range(0..8) < up_of_8 };
            }
            let weak = random.random_range(0..256) < weak_of_256;
            let compare = if weak { threshold } else { (threshold + random.random_range(1..3)).min(8_191) };
            rows.push(Inputs {
                enable: random.random_range(0..4_096) >= drop_of_4096,
                step,
                up,
                load: random.random_range(0..5) == 0,
                compare,
                threshold,
                window: clock % window_interval == 0,
                clear: random.random_range(0..40) == 0,
            });
        }
    }
    rows.truncate(clocks);
    rows
}
