//! Stimulus for the clock monitor: bus clocks of all rates, stops around the limit.

use super::{Columns, columns, generator};
use crate::blocks::clock_monitor::ClockMonitor;
use crate::sim::cycle;
use fixed_kin::clock_monitor::{Inputs, Outputs};
use rand::RngExt;
use rust_hdl::prelude::*;

/// The block has no inputs but its clocks: the word has a bit for each that rises, `lclk` first.
impl Columns for Inputs {
    const NAMES: &'static [&'static str] = &["rising"];

    fn append_to(&self, row: &mut Vec<u32>) {
        row.push(u32::from(self.lclk) | u32::from(self.synclk) << 1);
    }
}
columns!(Outputs { lclk_dead });

/// The rust-hdl block, fresh from configuration: one call is one moment.
pub fn hardware() -> impl FnMut(&Inputs) -> Outputs {
    let mut block = ClockMonitor::default();
    block.connect_all();
    move |inputs| {
        cycle(&mut block, |b, level| {
            b.lclk.next = (level && inputs.lclk).into();
            b.synclk.next = (level && inputs.synclk).into();
        });
        Outputs { lclk_dead: block.lclk_dead.val() }
    }
}

/// `moments` edges in order of time; one clock at a time, so that no simulator has to choose.
#[must_use]
pub fn stimulus(seed: u64, moments: usize) -> Vec<Inputs> {
    const CRYSTAL_PS: u64 = 20_000;
    let mut random = generator(seed);
    let mut rows = Vec::with_capacity(moments);
    let (mut lclk_ps, mut synclk_ps) = (7_u64, CRYSTAL_PS);
    while rows.len() < moments {
        let period_ps = match random.random_range(0..6) {
            0 => 40_000,
            1 => random.random_range(20_100..200_000),
            2 => random.random_range(600_000..700_000),
            _ => 30_000 + random.random_range(0..20),
        };
        for _ in 0..random.random_range(1..1_500) {
            if lclk_ps <= synclk_ps {
                lclk_ps += period_ps;
                rows.push(Inputs { lclk: true, synclk: false });
            } else {
                synclk_ps += CRYSTAL_PS;
                rows.push(Inputs { lclk: false, synclk: true });
            }
        }
        // Now and then a pause: mostly around the limit of 32 crystal clocks, sometimes for long.
        lclk_ps += match random.random_range(0..4) {
            0 => 0,
            1 => random.random_range(0..100) * CRYSTAL_PS,
            _ => random.random_range(29 * CRYSTAL_PS..36 * CRYSTAL_PS),
        };
    }
    rows.truncate(moments);
    rows
}
