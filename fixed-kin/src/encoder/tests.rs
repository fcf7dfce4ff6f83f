//! Requirements on the encoder, stated on pins and counts.

use super::*;
use proptest::prelude::*;

const LINES: [(bool, bool); 4] = [(false, false), (true, false), (true, true), (false, true)];

/// Pins of an ideal encoder at a position in counts.
fn lines(position: i64) -> (bool, bool) {
    LINES[position.rem_euclid(4) as usize]
}

/// A channel driven clock by clock, sampled at every clock.
struct Bench {
    encoder: Encoder,
    filter: u8,
    now: u32,
    out: Outputs,
}

impl Bench {
    fn new(filter: u8, position: i64) -> Self {
        let mut bench = Self { encoder: Encoder::default(), filter, now: TIME_MASK - 50, out: Outputs::default() };
        bench.hold(lines(position), 25);
        bench
    }

    fn hold(&mut self, (a, b): (bool, bool), clocks: u32) {
        for _ in 0..clocks {
            let inputs = Inputs { a, b, filter: self.filter, sample: true, now: self.now, ..Inputs::default() };
            self.out = self.encoder.clock(&inputs);
            self.now = (self.now + 1) & TIME_MASK;
        }
    }
}

proptest! {
    /// Whatever the wheel does, the count is its position, as long as edges are further
    /// apart than the filter is long.
    #[test]
    fn count_is_the_position(
        filter in 0..=15_u8,
        start in -4..4_i64,
        walk in prop::collection::vec((any::<bool>(), 0..40_u32), 0..300),
    ) {
        let mut bench = Bench::new(filter, start);
        let mut position = start;
        for (up, extra) in walk {
            position += if up { 1 } else { -1 };
            bench.hold(lines(position), u32::from(filter) + 1 + extra);
        }
        bench.hold(lines(position), 25);
        prop_assert_eq!(bench.out.count, (position - start) as u16);
        prop_assert!(!bench.out.error);
    }

    /// A pulse on one line of at most `filter` clocks leaves no trace.
    #[test]
    fn glitches_never_count(
        filter in 1..=15_u8,
        start in 0..4_i64,
        glitches in prop::collection::vec((any::<bool>(), 1..=15_u32, 1..30_u32), 1..200),
    ) {
        let mut bench = Bench::new(filter, start);
        let (a, b) = lines(start);
        for (on_a, width, pause) in glitches {
            bench.hold((a ^ on_a, b ^ !on_a), width.min(u32::from(filter)));
            bench.hold((a, b), pause);
            prop_assert_eq!((bench.out.live_a, bench.out.live_b), (a, b));
        }
        bench.hold((a, b), 25);
        prop_assert_eq!(bench.out.count, 0);
        prop_assert!(!bench.out.error);
    }
}

#[test]
fn the_count_changes_exactly_after_the_stated_delay() {
    for filter in 0..=15 {
        for (position, next) in [(0, 1), (1, 2), (2, 3), (3, 4), (0, -1), (-1, -2), (-2, -3), (-3, -4)] {
            let mut bench = Bench::new(filter, position);
            // The samples show the state before the edge, so the new count appears one later.
            let first_seen = bench.now;
            bench.hold(lines(next), edge_delay(filter) + 1);
            assert_eq!(bench.out.count, 0, "filter {filter}");
            bench.hold(lines(next), 1);
            assert_eq!(bench.out.count, (next - position) as u16, "filter {filter}");
            assert_eq!(bench.out.direction, next > position);
            let pin_time = bench.out.edge_time.wrapping_sub(edge_delay(filter)) & TIME_MASK;
            assert_eq!(pin_time, first_seen, "filter {filter}");
        }
    }
}

#[test]
fn both_lines_at_once_is_an_error_that_stays_and_does_not_count() {
    for start in 0..4 {
        let mut bench = Bench::new(3, start);
        bench.hold(lines(start + 2), 30);
        assert!(bench.out.error);
        assert_eq!(bench.out.count, 0);
        bench.hold(lines(start + 3), 30);
        assert!(bench.out.error);
        assert_eq!(bench.out.count, 1);
        let (a, b) = lines(start + 3);
        let clear = Inputs { a, b, filter: 3, clear_error: true, ..Inputs::default() };
        assert!(!bench.encoder.clock(&clear).error);
    }
}

#[test]
fn an_error_at_the_clock_of_its_clearing_is_kept() {
    let mut bench = Bench::new(0, 0);
    for _ in 0..10 {
        let inputs = Inputs { a: true, b: true, clear_error: true, ..Inputs::default() };
        if bench.encoder.clock(&inputs).error {
            return;
        }
    }
    panic!("the error was lost");
}

#[test]
fn lines_that_are_high_at_power_up_neither_count_nor_fail() {
    for (a, b) in LINES {
        let mut encoder = Encoder::default();
        for _ in 0..100 {
            let out = encoder.clock(&Inputs { a, b, sample: true, ..Inputs::default() });
            assert_eq!((out.count, out.error), (0, false));
        }
    }
}

#[test]
fn the_count_wraps_both_ways() {
    let mut bench = Bench::new(0, 0);
    bench.hold(lines(-1), 10);
    assert_eq!(bench.out.count, 0xFFFF);
    for position in 0..=0x1_0000 {
        bench.hold(lines(position), 1);
    }
    bench.hold(lines(0x1_0000), 10);
    assert_eq!(bench.out.count, 0);
}

#[test]
fn samples_are_coherent_and_hold() {
    let mut bench = Bench::new(0, 0);
    bench.hold(lines(1), 10);
    let latched = bench.out;
    for position in 2..50 {
        let (a, b) = lines(position);
        let out = bench.encoder.clock(&Inputs { a, b, now: 7, ..Inputs::default() });
        assert_eq!((out.count, out.edge_time, out.direction), (latched.count, latched.edge_time, latched.direction));
    }
}

#[test]
fn a_pulse_just_long_enough_keeps_its_length() {
    for filter in 0..=15 {
        let mut bench = Bench::new(filter, 0);
        let width = u32::from(filter) + 1;
        let mut high = 0;
        for clock in 0..4 * width + 10 {
            bench.hold(lines(i64::from(clock < width)), 1);
            high += u32::from(bench.out.live_a);
        }
        assert_eq!(high, width, "filter {filter}");
    }
}

/// What takes steps as they come has each of them once, with its direction: the count has it in the clock after, and the
/// sample of the count in that to come.
#[test]
fn a_step_is_told_before_it_is_counted() {
    let mut bench = Bench::new(2, 0);
    let (mut position, mut steps, mut told) = (0, 0, Outputs::default());
    for up in [true, true, false, true, false, false, false, true, true, true] {
        position += if up { 1 } else { -1 };
        for _ in 0..8 {
            let before = bench.out;
            bench.hold(lines(position), 1);
            let moved = bench.out.count.wrapping_sub(before.count).cast_signed();
            assert_eq!(moved, i16::from(told.step) * if told.up { 1 } else { -1 });
            steps += i32::from(before.step);
            told = before;
        }
    }
    assert_eq!(steps, 10);
}
