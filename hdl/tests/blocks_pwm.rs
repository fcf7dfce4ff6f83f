//! PWM: rust-hdl simulation = twin, clock by clock on all outputs.

use fixed_kin::pwm::{Inputs, Pwm};
use hdl::stimulus::{compare, pwm};

const CLOCKS: usize = if cfg!(debug_assertions) { 30_000 } else { 2_000_000 };

#[test]
fn simulation_equals_twin() {
    let mut twin = Pwm::default();
    let rows = pwm::stimulus(3, CLOCKS);
    compare(&rows, pwm::hardware(), |row| twin.clock(row)).unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn the_stimulus_reaches_the_corners() {
    let mut twin = Pwm::default();
    let mut before = twin.clock(&Inputs::default());
    let (mut edges, mut turns, mut full) = (0, 0, 0);
    for row in pwm::stimulus(3, 2_000_000) {
        let after = twin.clock(&row);
        edges += u32::from(after.pwm && !before.pwm);
        turns += u32::from(after.dir != before.dir);
        full += u32::from(after.pwm && before.pwm && before.period_start && row.period > 1);
        before = after;
    }
    assert!(edges > 3_000 && turns > 1_000 && full > 1_000, "{edges} pulses, {turns} reversals, {full} full periods");
}
