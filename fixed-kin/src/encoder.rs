//! Bit-true twin of the quadrature encoder block: filter, ×4 decoding, count and edge time.
//!
//! One [`Encoder::clock`] is one rising edge of the FPGA clock; the outputs are those that hold
//! until the next edge. Formats: count 16 bits and times 24 bits, both unsigned and wrapping, which
//! whoever extends them relies on. Nothing saturates and no input panics.
//!
//! Convention: A leads B counts up. A transition of both lines at once is illegal: it sets the
//! sticky error and does not count.

/// Width mask of the free-running time.
pub const TIME_MASK: u32 = 0x00FF_FFFF;

/// Clocks from the edge that first samples a changed pin to the edge that changes the count.
///
/// The count therefore changes at edge n + `edge_delay`, if edge n is the first to see the new
/// level, and `edge_time` is the value of `now` at that edge: subtract the delay to get the time
/// of the pin. The pin itself changed up to one clock before edge n. The latched outputs show an
/// edge from the first `sample` after the count has changed: a change *at* the sampling edge is in
/// the next sample.
#[must_use]
pub const fn edge_delay(filter: u8) -> u32 {
    // Two synchroniser flops, filter + 1 equal clocks of which the first is the second flop's
    // successor, one clock to decode.
    (filter & 15) as u32 + 3
}

/// Clocks at power-up in which the levels of the lines are taken over without counting.
pub const SETTLING_CLOCKS: u32 = 3;

/// Two-flop synchroniser and glitch filter of one pin.
///
/// The filtered value follows the synchronised pin after `limit + 1` consecutive ticks at which
/// it differs; a single equal clock in between, tick or not, starts anew.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GlitchFilter {
    first: bool,
    second: bool,
    run: u8,
    /// The filtered level.
    pub value: bool,
}

impl GlitchFilter {
    /// One clock. `limit` is 4 bits; `load` takes the synchronised level over unfiltered.
    pub fn clock(&mut self, pin: bool, tick: bool, limit: u8, load: bool) {
        let Self { first, second, run, value } = *self;
        self.second = first;
        self.first = pin;
        if load || second == value {
            self.run = 0;
        } else if tick {
            self.run = if run >= limit & 15 { 0 } else { run + 1 };
        }
        if load || (second != value && tick && run >= limit & 15) {
            self.value = second;
        }
    }

    /// The level behind the synchroniser, before the filter.
    #[must_use]
    pub fn synchronised(&self) -> bool {
        self.second
    }
}

/// Pins and registers the encoder sees at one clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// Raw line A.
    pub a: bool,
    /// Raw line B.
    pub b: bool,
    /// Filter length, 4 bits: a line changes after `filter + 1` equal clocks.
    pub filter: u8,
    /// Control tick: latches count, edge time and direction.
    pub sample: bool,
    /// Free-running time in clocks, 24 bits.
    pub now: u32,
    /// Clears the sticky error, unless a new one comes at the same clock.
    pub clear_error: bool,
}

/// Outputs of the encoder after a clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// Count at the last sample.
    pub count: u16,
    /// Time of the last counted edge at the last sample, 24 bits.
    pub edge_time: u32,
    /// Direction of the last counted edge at the last sample, true = up.
    pub direction: bool,
    /// Sticky: both lines changed at once.
    pub error: bool,
    /// Filtered line A.
    pub live_a: bool,
    /// Filtered line B.
    pub live_b: bool,
}

/// State of one encoder channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Encoder {
    line_a: GlitchFilter,
    line_b: GlitchFilter,
    settling: u32,
    last_a: bool,
    last_b: bool,
    count: u16,
    edge_time: u32,
    direction: bool,
    outputs: Outputs,
}

impl Encoder {
    /// One clock.
    pub fn clock(&mut self, inputs: &Inputs) -> Outputs {
        let before = *self;
        let settled = before.settling >= SETTLING_CLOCKS;
        if !settled {
            self.settling += 1;
        }
        self.line_a.clock(inputs.a, true, inputs.filter, !settled);
        self.line_b.clock(inputs.b, true, inputs.filter, !settled);

        let (a, b) = (before.line_a.value, before.line_b.value);
        self.last_a = if settled { a } else { before.line_a.synchronised() };
        self.last_b = if settled { b } else { before.line_b.synchronised() };
        let change_a = settled && a != before.last_a;
        let change_b = settled && b != before.last_b;
        if change_a != change_b {
            self.direction = a != before.last_b;
            self.count = if self.direction { before.count.wrapping_add(1) } else { before.count.wrapping_sub(1) };
            self.edge_time = inputs.now & TIME_MASK;
        }
        if inputs.sample {
            self.outputs.count = before.count;
            self.outputs.edge_time = before.edge_time;
            self.outputs.direction = before.direction;
        }
        self.outputs.error = (before.outputs.error && !inputs.clear_error) || (change_a && change_b);
        self.outputs.live_a = self.line_a.value;
        self.outputs.live_b = self.line_b.value;
        self.outputs
    }
}

#[cfg(test)]
mod tests {
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
                let inputs = Inputs { a, b, filter: self.filter, sample: true, now: self.now, clear_error: false };
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
            assert_eq!(
                (out.count, out.edge_time, out.direction),
                (latched.count, latched.edge_time, latched.direction)
            );
        }
    }
}
