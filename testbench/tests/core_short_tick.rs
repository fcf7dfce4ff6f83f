//! The compiled chip at its shortest control period, 1000 clocks, against the bit-true card, tick by tick. The bench
//! `whole_chip` does the same for a million ticks and more.

use std::thread;
use testbench::whole_chip::{PERIOD, Seen, compare, compiled};

/// Pairs of ticks of a seed; seeds differ in their modes.
const PAIRS: u64 = 1_000;
/// Seeds of each of two threads.
const SEEDS: [std::ops::Range<u64>; 2] = [5..10, 10..15];
/// Clocks of all seeds together, at least.
const CLOCKS: u64 = 20_000_000;

#[test]
fn every_tick_of_the_compiled_chip_equals_the_card() {
    let built = compiled().unwrap_or_else(|error| panic!("{error}"));
    let run = |seeds: std::ops::Range<u64>| -> Vec<Seen> {
        seeds.map(|seed| compare(&built, seed, PAIRS).unwrap_or_else(|error| panic!("{error}"))).collect()
    };
    let seen: Vec<Seen> = thread::scope(|scope| {
        let threads = SEEDS.map(|seeds| scope.spawn(|| run(seeds)));
        threads.into_iter().flat_map(|thread| thread.join().expect("the comparison holds")).collect()
    });
    for seen in &seen {
        assert_eq!(seen.ticks, 2 * PAIRS);
        assert!(seen.clocks >= seen.ticks * u64::from(PERIOD), "{seen:?}");
        assert!(3 * seen.driven > 2 * PAIRS, "only {} ticks had a duty: the comparison is empty", seen.driven);
        assert!(4 * seen.captured > PAIRS, "only {} reads of a captured index", seen.captured);
    }
    assert!(seen.iter().map(|seen| seen.clocks).sum::<u64>() >= CLOCKS);
}
