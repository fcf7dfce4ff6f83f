//! Clock monitor: rust-hdl simulation = twin, edge by edge.

use fixed_kin::clock_monitor::{ClockMonitor, Inputs};
use hdl::stimulus::{clock_monitor, compare};

const MOMENTS: usize = if cfg!(debug_assertions) { 50_000 } else { 3_000_000 };

#[test]
fn simulation_equals_twin() {
    let mut twin = ClockMonitor::default();
    let rows = clock_monitor::stimulus(5, MOMENTS);
    compare(&rows, clock_monitor::hardware(), |row| twin.clock(row)).unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn the_stimulus_reaches_the_corners() {
    let mut twin = ClockMonitor::default();
    let mut before = twin.clock(&Inputs::default());
    let mut changes = 0;
    for row in clock_monitor::stimulus(5, 3_000_000) {
        let after = twin.clock(&row);
        changes += u32::from(after != before);
        before = after;
    }
    assert!(changes > 1_000, "{changes} changes");
}
