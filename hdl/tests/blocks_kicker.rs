//! Kicker: rust-hdl simulation = twin, clock by clock on all outputs.

use fixed_kin::kicker::{Inputs, Kicker, State};
use hdl::stimulus::{compare, kicker};

const CLOCKS: usize = if cfg!(debug_assertions) { 150_000 } else { 3_000_000 };

#[test]
fn simulation_equals_twin() {
    let mut twin = Kicker::default();
    let rows = kicker::stimulus(4, CLOCKS);
    compare(&rows, kicker::hardware(), |row| twin.clock(row)).unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn the_stimulus_reaches_the_corners() {
    let mut twin = Kicker::default();
    let mut before = twin.clock(&Inputs::default());
    let (mut pulses, mut full_lockouts, mut aborted, mut timeouts, mut interrupted) = (0, 0, 0, 0, 0);
    for row in kicker::stimulus(4, 3_000_000) {
        let after = twin.clock(&row);
        pulses += u32::from(after.trigger && !before.trigger);
        full_lockouts += u32::from(before.state == State::Lockout as u8 && after.state < 2);
        aborted += u32::from(before.trigger && !row.enable);
        timeouts += u32::from(after.timed_out && !before.timed_out);
        interrupted += u32::from(before.charge && after.state == State::Pending as u8);
        before = after;
    }
    let seen = [pulses, full_lockouts, aborted, timeouts, interrupted];
    assert!(seen.iter().zip([15, 15, 2, 20, 3]).all(|(&n, least)| n >= least), "{seen:?}");
}
