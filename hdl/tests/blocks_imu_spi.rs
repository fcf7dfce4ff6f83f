//! Reader of the inertial sensor: rust-hdl simulation = twin, clock by clock on all outputs.

use fixed_kin::imu_spi::{ImuSpi, NO_AGE};
use hdl::stimulus::{compare, imu_spi};

const CLOCKS: usize = if cfg!(debug_assertions) { 30_000 } else { 2_000_000 };

#[test]
fn simulation_equals_twin() {
    let mut twin = ImuSpi::default();
    let rows = imu_spi::stimulus(6, CLOCKS);
    compare(&rows, imu_spi::hardware(), |row| twin.clock(row)).unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn the_stimulus_reaches_the_corners() {
    let mut twin = ImuSpi::default();
    let mut before = twin.outputs();
    let (mut bursts, mut accesses, mut ages, mut early) = (0, 0, 0, 0);
    for row in imu_spi::stimulus(6, 2_000_000) {
        let after = twin.clock(&row);
        bursts += u32::from(before.reading && !after.busy);
        accesses += u32::from(before.busy && !before.reading && !after.busy);
        early += u32::from(row.tick && before.busy);
        ages += u32::from(row.read_word == 0 && ![0, NO_AGE].contains(&after.read_data));
        before = after;
    }
    assert!(bursts > 500 && accesses > 300 && early > 100, "{bursts} {accesses} {early}");
    assert!(ages > 10_000, "{ages}");
}
