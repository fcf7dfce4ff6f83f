//! Encoder: rust-hdl simulation = twin, clock by clock on all outputs.

use fixed_kin::encoder::Encoder;
use hdl::stimulus::{compare, encoder};

const CLOCKS: usize = if cfg!(debug_assertions) { 30_000 } else { 2_000_000 };

#[test]
fn simulation_equals_twin() {
    let mut twin = Encoder::default();
    let rows = encoder::stimulus(1, CLOCKS);
    compare(&rows, encoder::hardware(), |row| twin.clock(row)).unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn the_stimulus_reaches_the_corners() {
    let mut twin = Encoder::default();
    let mut errors = 0;
    let mut wraps = 0;
    let mut before = twin.clock(&fixed_kin::encoder::Inputs::default());
    for row in encoder::stimulus(1, 2_000_000) {
        let after = twin.clock(&row);
        errors += u32::from(after.error && !before.error);
        wraps += u32::from(after.count.abs_diff(before.count) > 0x8000);
        before = after;
    }
    assert!(errors > 100 && wraps > 5, "{errors} errors, {wraps} wraps");
}
