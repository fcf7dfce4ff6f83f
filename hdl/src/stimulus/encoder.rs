//! Stimulus for the encoder: wheels at all speeds, glitches, illegal transitions, wraps.

use super::{columns, generator};
use crate::blocks::encoder::Encoder;
use crate::sim::cycle;
use fixed_kin::encoder::{Inputs, Outputs, TIME_MASK};
use rand::RngExt;
use rust_hdl::prelude::*;

columns!(Inputs { a, b, filter, sample, now, clear_error, index, arm_index });
columns!(Outputs {
    count,
    edge_time,
    direction,
    error,
    live_a,
    live_b,
    step,
    up,
    live_index,
    index_count,
    index_event,
    index_waiting,
    index_seen,
});

/// The rust-hdl block, fresh from configuration: one call is one clock.
pub fn hardware() -> impl FnMut(&Inputs) -> Outputs {
    let mut block = Encoder::default();
    block.connect_all();
    move |inputs| {
        block.a.next = inputs.a;
        block.b.next = inputs.b;
        block.filter.next = inputs.filter.to_bits();
        block.sample.next = inputs.sample;
        block.now.next = inputs.now.to_bits();
        block.clear_error.next = inputs.clear_error;
        block.index.next = inputs.index;
        block.arm_index.next = inputs.arm_index;
        cycle(&mut block, |b, level| b.clock.next = level.into());
        Outputs {
            count: block.count.val().to_u16(),
            edge_time: block.edge_time.val().to_u32(),
            direction: block.direction.val(),
            error: block.error.val(),
            live_a: block.live_a.val(),
            live_b: block.live_b.val(),
            step: block.step.val(),
            up: block.up.val(),
            live_index: block.live_index.val(),
            index_count: block.index_count.val().to_u16(),
            index_event: block.index_event.val(),
            index_waiting: block.index_waiting.val(),
            index_seen: block.index_seen.val(),
        }
    }
}

/// Segments of random length, each with its own filter, speed, disturbance and sampling.
#[must_use]
pub fn stimulus(seed: u64, clocks: usize) -> Vec<Inputs> {
    const LINES: [(bool, bool); 4] = [(false, false), (true, false), (true, true), (false, true)];
    let mut random = generator(seed);
    let mut rows = Vec::with_capacity(clocks);
    let mut position: u32 = random.random_range(0..4);
    let mut now = TIME_MASK - 1_000;
    while rows.len() < clocks {
        let filter = match random.random_range(0..4) {
            0 => 0,
            1 => 15,
            _ => random.random_range(0..16),
        };
        // Around the filter length, where an edge just counts or just does not, and far from it.
        let spacing = match random.random_range(0..3) {
            0 => 1,
            1 => u32::from(filter) + random.random_range(0..3),
            _ => random.random_range(1..200),
        };
        let up_of_8 = *[0, 1, 4, 7, 8].get(random.random_range(0..5)).unwrap_or(&8);
        let glitches_of_256 = [0, 0, 4, 64, 200][random.random_range(0..5)];
        let illegal_of_256 = [0, 0, 0, 20][random.random_range(0..4)];
        let index_every = [8, 40, 2_048][random.random_range(0..3)];
        let sampling = [1, 2, 50, 333][random.random_range(0..4)];
        let mut length = random.random_range(1..3_000);
        // Now and then a long run in one direction at full speed, so that the 16-bit count wraps.
        let (filter, spacing, up_of_8, glitches_of_256, illegal_of_256) = if random.random_range(0..100) == 0 {
            length = 70_000;
            (0, 1, 8 * random.random_range(0..2), 0, 0)
        } else {
            (filter, spacing, up_of_8, glitches_of_256, illegal_of_256)
        };
        let mut wait = spacing;
        for _ in 0..length {
            wait = wait.saturating_sub(1);
            if wait == 0 {
                wait = spacing.max(1);
                let up = random.random_range(0..8) < up_of_8;
                position = if up { position.wrapping_add(1) } else { position.wrapping_sub(1) };
                if random.random_range(0..256) < illegal_of_256 {
                    position = position.wrapping_add(1);
                }
            }
            let (mut a, mut b) = LINES[(position % 4) as usize];
            if random.random_range(0..256) < glitches_of_256 {
                a ^= random.random::<bool>();
                b ^= random.random::<bool>();
            }
            rows.push(Inputs {
                a,
                b,
                filter,
                sample: random.random_range(0..sampling) == 0,
                now,
                clear_error: random.random_range(0..64) == 0,
                index: position % index_every < 2 && random.random_range(0..256) >= glitches_of_256,
                arm_index: random.random_range(0..32) == 0,
            });
            now = if random.random_range(0..5_000) == 0 { random.random() } else { now.wrapping_add(1) } & TIME_MASK;
        }
    }
    rows.truncate(clocks);
    rows
}
