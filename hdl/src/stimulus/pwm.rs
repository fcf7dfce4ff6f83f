//! Stimulus for the PWM generator: corners of period, compare and blanking, reversals, disabling.

use super::{columns, generator};
use crate::blocks::pwm::Pwm;
use crate::sim::cycle;
use fixed_kin::pwm::{BLANKING_MASK, Inputs, Outputs, PERIOD_MASK};
use rand::RngExt;
use rust_hdl::prelude::*;

columns!(Inputs { enable, stops, period, blanking, load, compare, direction, sync, up_down });
columns!(Outputs { pwm, dir, period_start, position });

/// The rust-hdl block, fresh from configuration: one call is one clock.
pub fn hardware() -> impl FnMut(&Inputs) -> Outputs {
    let mut block = Pwm::default();
    block.connect_all();
    move |inputs| {
        block.enable.next = inputs.enable;
        block.stops.next = inputs.stops;
        block.period.next = inputs.period.to_bits();
        block.blanking.next = inputs.blanking.to_bits();
        block.load.next = inputs.load;
        block.compare.next = inputs.compare.to_bits();
        block.direction.next = inputs.direction;
        block.sync.next = inputs.sync;
        block.up_down.next = inputs.up_down;
        cycle(&mut block, |b, level| b.clock.next = level.into());
        Outputs {
            pwm: block.pwm.val(),
            dir: block.dir.val(),
            period_start: block.period_start.val(),
            position: block.position.val().to_u16(),
        }
    }
}

/// Segments of random length, each with its own period, blanking and way of loading.
#[must_use]
pub fn stimulus(seed: u64, clocks: usize) -> Vec<Inputs> {
    let mut random = generator(seed);
    let mut rows = Vec::with_capacity(clocks);
    let mut direction = false;
    while rows.len() < clocks {
        let period = match random.random_range(0..12) {
            0 => 0,
            1 => 1,
            2 => PERIOD_MASK,
            3 => random.random_range(0..=PERIOD_MASK),
            _ => random.random_range(2..200_u16),
        };
        let blanking = match random.random_range(0..8) {
            0 => 0,
            1 => 1,
            2 => BLANKING_MASK,
            _ => random.random_range(0..60_u16),
        };
        let drop_of_4096 = [0, 0, 1, 40, 4_096][random.random_range(0..5)];
        let load_interval = [1, u32::from(period).max(1), 7, 500][random.random_range(0..4)];
        let reversal_of_8 = random.random_range(0..=8);
        let up_down = random.random_range(0..3) == 0;
        let sync_of_1024 = [0, 0, 1, 300][random.random_range(0..4)];
        let longest = if period > 200 || blanking > 200 { 30_000 } else { 2_000 };
        for clock in 0..random.random_range(1..longest) {
            let load = clock % load_interval == 0;
            let compare = match random.random_range(0..8) {
                0 => 0,
                1 => 1,
                2 => period.saturating_sub(1),
                3 => period,
                4 => period + u16::from(period < PERIOD_MASK),
                5 => PERIOD_MASK,
                _ => random.random_range(0..=period),
            };
            if load {
                direction ^= random.random_range(0..8) < reversal_of_8;
            }
            let enable = random.random_range(0..4_096) >= drop_of_4096;
            let stops = random.random_range(0..4_096) < drop_of_4096;
            let sync = random.random_range(0..1_024) < sync_of_1024;
            rows.push(Inputs { enable, stops, period, blanking, load, compare, direction, sync, up_down });
        }
    }
    rows.truncate(clocks);
    rows
}
