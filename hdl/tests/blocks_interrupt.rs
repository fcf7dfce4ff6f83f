//! Interrupt: rust-hdl simulation = twin, clock by clock on all outputs.

use fixed_kin::interrupt::Interrupt;
use hdl::stimulus::{compare, interrupt};

const CLOCKS: usize = if cfg!(debug_assertions) { 30_000 } else { 2_000_000 };

#[test]
fn simulation_equals_twin() {
    let mut twin = Interrupt::default();
    let rows = interrupt::stimulus(7, CLOCKS);
    compare(&rows, interrupt::hardware(), |row| twin.clock(row)).unwrap_or_else(|e| panic!("{e}"));
}
