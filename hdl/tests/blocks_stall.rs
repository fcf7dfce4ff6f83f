//! Stall detector: rust-hdl simulation = twin, clock by clock on all outputs.

use fixed_kin::stall::Stall;
use hdl::stimulus::{compare, stall};

const CLOCKS: usize = if cfg!(debug_assertions) { 30_000 } else { 2_000_000 };

#[test]
fn simulation_equals_twin() {
    let mut twin = Stall::default();
    let rows = stall::stimulus(6, CLOCKS);
    compare(&rows, stall::hardware(), |row| twin.clock(row)).unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn the_stimulus_reaches_the_corners() {
    let mut twin = Stall::default();
    let mut before = false;
    let mut stalls = 0;
    for row in stall::stimulus(6, 2_000_000) {
        let after = twin.clock(&row).stalled;
        stalls += u32::from(after && !before);
        before = after;
    }
    assert!(stalls > 3_000, "{stalls} stalls");
}
