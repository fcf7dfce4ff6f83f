//! Stimulus for the kicker: kicks by request and by ball, charging, disabling in every state.

use super::{columns, generator};
use crate::blocks::kicker::Kicker;
use crate::sim::cycle;
use fixed_kin::kicker::{Inputs, Outputs};
use rand::RngExt;
use rust_hdl::prelude::*;

columns!(Inputs {
    enable,
    microsecond,
    charge_request,
    charge_timeout,
    fire,
    pulse,
    lockout,
    ball,
    arm_on_ball,
    clear,
    full,
    by_time,
});
columns!(Outputs { charge, trigger, ready, state, timed_out, dropped, is_full, on_ball });

/// The rust-hdl block, fresh from configuration: one call is one clock.
pub fn hardware() -> impl FnMut(&Inputs) -> Outputs {
    let mut block = Kicker::default();
    block.connect_all();
    move |inputs| {
        block.enable.next = inputs.enable;
        block.microsecond.next = inputs.microsecond;
        block.charge_request.next = inputs.charge_request;
        block.charge_timeout.next = inputs.charge_timeout.to_bits();
        block.fire.next = inputs.fire;
        block.pulse.next = inputs.pulse.to_bits();
        block.lockout.next = inputs.lockout.to_bits();
        block.ball.next = inputs.ball;
        block.arm_on_ball.next = inputs.arm_on_ball;
        block.clear.next = inputs.clear;
        block.full.next = inputs.full;
        block.by_time.next = inputs.by_time;
        cycle(&mut block, |b, level| b.clock.next = level.into());
        Outputs {
            charge: block.charge.val(),
            trigger: block.trigger.val(),
            ready: block.ready.val(),
            state: block.state.val().to_u8(),
            timed_out: block.timed_out.val(),
            dropped: block.dropped.val(),
            is_full: block.is_full.val(),
            on_ball: block.on_ball.val(),
        }
    }
}

/// Segments of random length, each with its own registers and rates. The strobe mostly comes at
/// every clock, so that a lock-out of 100 000 strobes passes in as many clocks.
#[must_use]
pub fn stimulus(seed: u64, clocks: usize) -> Vec<Inputs> {
    let mut random = generator(seed);
    let mut rows = Vec::with_capacity(clocks);
    while rows.len() < clocks {
        let interval = [1, 1, 1, 1, 2, 33][random.random_range(0..6)];
        let charge_timeout = match random.random_range(0..6) {
            0 => 0,
            1 => 1,
            2 => 0x00FF_FFFF,
            _ => random.random_range(2..5_000_u32),
        };
        let pulse = match random.random_range(0..8) {
            0 => 0,
            1 => 1,
            2 => 9_999,
            3 => 10_000,
            4 => 10_001,
            5 => 0x3FFF,
            _ => random.random_range(2..2_000_u16),
        };
        let lockout = match random.random_range(0..16) {
            0 => 0x000F_FFFF,
            1..=4 => random.random_range(99_998..100_003_u32),
            5..=7 => random.random_range(100_000..150_000_u32),
            _ => random.random_range(0..100_000_u32),
        };
        let fire_interval = [3, 50, 2_000, 1_000_000][random.random_range(0..4)];
        let drop_interval = [5, 3_000, 1_000_000, 1_000_000][random.random_range(0..4)];
        let off_clocks = [1, 3, 200, 30_000][random.random_range(0..4)];
        let level_interval = [20, 2_000, 50_000][random.random_range(0..3)];
        let clear_interval = [2, 100, 5_000][random.random_range(0..3)];
        let mut levels: (bool, bool, bool, bool, bool) = random.random();
        let mut off = 0_u32;
        for clock in 0..random.random_range(1..90_000_u32) {
            if random.random_range(0..drop_interval) == 0 {
                off = random.random_range(1..=off_clocks);
            }
            let enable = off == 0;
            off = off.saturating_sub(1);
            if random.random_range(0..level_interval) == 0 {
                levels = random.random();
            }
            let (charge_request, ball, arm_on_ball, full, by_time) = levels;
            rows.push(Inputs {
                enable,
                microsecond: clock % interval == 0,
                charge_request,
                charge_timeout,
                fire: random.random_range(0..fire_interval) == 0,
                pulse,
                lockout,
                ball: ball ^ (random.random_range(0..60) == 0),
                arm_on_ball,
                clear: random.random_range(0..clear_interval) == 0,
                full: full ^ (random.random_range(0..60) == 0),
                by_time,
            });
        }
    }
    rows.truncate(clocks);
    rows
}
