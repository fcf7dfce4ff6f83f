//! The compiled chip at its shortest control period, 1000 clocks, against the bit-true card, tick by tick.

use testbench::whole_chip::{PERIOD, compare, compiled};

/// Pairs of ticks of two seeds, which differ in their modes.
const PAIRS: u64 = 3_000;

#[test]
fn every_tick_of_the_compiled_chip_equals_the_card() {
    let built = compiled().unwrap_or_else(|error| panic!("{error}"));
    for seed in [5, 6] {
        let seen = compare(&built, seed, PAIRS).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(seen.ticks, 2 * PAIRS);
        assert!(seen.clocks >= seen.ticks * u64::from(PERIOD), "{seen:?}");
        assert!(3 * seen.driven > 2 * PAIRS, "only {} ticks had a duty: the comparison is empty", seen.driven);
        assert!(4 * seen.captured > PAIRS, "only {} reads of a captured index", seen.captured);
    }
}
