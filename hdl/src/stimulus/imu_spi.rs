//! Stimulus for the reader of the inertial sensor: bursts and accesses of every rate and mode, a line that
//! answers anything, is stuck or silent, ticks that come as they must and too early.

use super::{columns, generator};
use crate::blocks::imu_spi::ImuSpi;
use crate::sim::cycle;
use fixed_kin::imu_spi::{Inputs, Outputs};
use rand::RngExt;
use rust_hdl::prelude::*;

columns!(Inputs { tick, bank, enable, idle_high, half, first, access, command, miso, ready, read_bank, read_word });
columns!(Outputs { cs_n, sclk, mosi, busy, reading, value, read_data });

/// The rust-hdl block, fresh from configuration: one call is one clock.
pub fn hardware() -> impl FnMut(&Inputs) -> Outputs {
    let mut block = ImuSpi::default();
    block.connect_all();
    move |inputs| {
        block.tick.next = inputs.tick;
        block.bank.next = inputs.bank.to_bits();
        block.enable.next = inputs.enable;
        block.idle_high.next = inputs.idle_high;
        block.half.next = inputs.half.to_bits();
        block.first.next = inputs.first.to_bits();
        block.access.next = inputs.access;
        block.command.next = inputs.command.to_bits();
        block.miso.next = inputs.miso;
        block.ready.next = inputs.ready;
        block.read_bank.next = inputs.read_bank.to_bits();
        block.read_word.next = inputs.read_word.to_bits();
        cycle(&mut block, |b, level| b.clock.next = level.into());
        Outputs {
            cs_n: block.cs_n.val(),
            sclk: block.sclk.val(),
            mosi: block.mosi.val(),
            busy: block.busy.val(),
            reading: block.reading.val(),
            value: block.value.val().to_u8(),
            read_data: block.read_data.val().to_u16(),
        }
    }
}

/// Segments of random length, each with its own settings, line and ticks. Never reads the bank that is written.
#[must_use]
pub fn stimulus(seed: u64, clocks: usize) -> Vec<Inputs> {
    let mut random = generator(seed);
    let mut rows = Vec::with_capacity(clocks);
    let (mut bank, mut tick) = (0, false);
    while rows.len() < clocks {
        let enable = random.random_range(0..4) > 0;
        let (idle_high, half) = (random.random_range(0..2) == 0, random.random_range(0..4));
        let first = random.random_range(0..128);
        let period = [1_000, 1_000, 1_003, 70_000, 130, 7][random.random_range(0..6)];
        let ready_period = [0, 700, 997, 66_000, 3][random.random_range(0..5)];
        let ones_of_8 = [0, 2, 4, 8][random.random_range(0..4)];
        let length = random.random_range(1..6_u32) * [300, 1_100, 1_100, 40_000][random.random_range(0..4)];
        for clock in 0..length {
            // The snapshot's bank changes with the clock after the tick.
            if tick {
                bank = random.random_range(0..3);
            }
            tick = clock % period == period - 1;
            rows.push(Inputs {
                tick,
                bank,
                enable,
                idle_high,
                half,
                first,
                access: random.random_range(0..200) == 0,
                command: random.random_range(0..=u16::MAX),
                miso: random.random_range(0..8) < ones_of_8,
                ready: ready_period > 0 && clock % ready_period > ready_period / 2,
                read_bank: (bank + random.random_range(1..4)) % 4,
                read_word: random.random_range(0..8),
            });
        }
    }
    rows.truncate(clocks);
    rows
}
