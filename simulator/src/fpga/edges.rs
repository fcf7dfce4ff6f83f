//! From a wheel's motion to encoder edges, and from edges to what the counter shows.
//!
//! A position in counts has the edge up to count k where it crosses k from below, the edge down from
//! k where it crosses k from above; the counter shows the floor. Edge times are whole clocks after
//! the control tick: clock 0 is the first rising edge after it.

use fixed_kin::encoder::edge_delay;
use fixed_kin::speed::{EncoderSample, TIME_BITS};

/// A change of the lines by one count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Edge {
    /// Rising clock edges between the tick and the first that samples the new level.
    pub clock: u32,
    /// Count after it.
    pub count: i64,
    /// Counting up.
    pub up: bool,
}

/// Motion within a control period.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    from: f64,
    /// What the counter shows before and after.
    shown: [i64; 2],
    way: f64,
    span: f64,
    period: u32,
    quiet: u32,
}

/// The floor; a conversion, where `f64::floor` is a function call.
fn shown(position: f64) -> i64 {
    let towards_zero = position as i64;
    towards_zero.saturating_sub(i64::from(towards_zero as f64 > position))
}

impl Motion {
    /// A linear motion between two positions in the part of a period after `quiet` clocks.
    #[must_use]
    pub fn new(from: f64, to: f64, period: u32, quiet: u32) -> Self {
        let quiet = quiet.min(period - 1);
        Self { from, shown: [shown(from), shown(to)], way: to - from, span: f64::from(period - quiet), period, quiet }
    }

    /// Number of edges.
    #[must_use]
    pub fn len(&self) -> u64 {
        self.shown[1].abs_diff(self.shown[0])
    }

    /// Whether the encoder stands still.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Edge `index`, in the order of time.
    #[must_use]
    #[inline]
    pub fn edge(&self, index: u64) -> Edge {
        let (start, up) = (self.shown[0], self.way > 0.0);
        let (count, line) = if up {
            let count = start + 1 + index as i64;
            (count, count)
        } else {
            let line = start - index as i64;
            (line - 1, line)
        };
        let fraction = ((line as f64 - self.from) / self.way).clamp(0.0, 1.0);
        let clock = self.quiet + (fraction * self.span) as u32;
        Edge { clock: clock.min(self.period - 1), count, up }
    }

    /// From the first to the last.
    pub fn edges(&self) -> impl Iterator<Item = Edge> + '_ {
        (0..self.len()).map(|index| self.edge(index))
    }
}

/// The lines of an encoder at a count: A in bit 0, B in bit 1; A leads B counting up.
#[must_use]
pub fn lines(count: i64) -> u32 {
    [0b00, 0b01, 0b11, 0b10][count.rem_euclid(4) as usize]
}

/// An encoder and its counter, edge by edge but without clocks: what the gateware's counter shows
/// at each tick, synchroniser and filter included.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counter {
    /// Position at the last tick.
    pub position: f64,
    sample: EncoderSample,
    /// Edges of the last period that were still in the filter at its tick, and how many.
    late: [(u32, Edge); 4],
    waiting: usize,
}

impl Counter {
    /// A period of `period` clocks that ends with the tick at time `now`; returns the sample of that tick.
    pub fn advance(&mut self, to: f64, now: u32, period: u32, quiet: u32, filter: u8) -> EncoderSample {
        let delay = edge_delay(filter);
        let motion = Motion::new(self.position, to, period, quiet);
        self.position = to;
        let before = now.wrapping_sub(period);
        if let Some(&(time, edge)) = self.late[..self.waiting].last() {
            self.count(time, edge);
        }
        // The edge sampled at clock m after the tick is counted at m + delay, in time for the next
        // tick if that is before it.
        let mut counted = motion.len();
        while counted > 0 {
            let last = motion.edge(counted - 1);
            if last.clock + 1 + delay < period {
                self.count(before.wrapping_add(1 + last.clock + delay), last);
                break;
            }
            counted -= 1;
        }
        self.waiting = 0;
        for (slot, index) in self.late.iter_mut().zip(counted..motion.len()) {
            let edge = motion.edge(index);
            *slot = (before.wrapping_add(1 + edge.clock + delay), edge);
            self.waiting += 1;
        }
        self.sample
    }

    fn count(&mut self, time: u32, edge: Edge) {
        self.sample =
            EncoderSample { count: edge.count as u16, edge_time: time & ((1 << TIME_BITS) - 1), direction: edge.up };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_are_where_the_position_crosses_a_count() {
        let up: Vec<_> = Motion::new(-0.5, 1.5, 1_000, 0).edges().collect();
        assert_eq!(up, [Edge { clock: 250, count: 0, up: true }, Edge { clock: 750, count: 1, up: true }]);
        let down: Vec<_> = Motion::new(1.5, -0.5, 1_000, 0).edges().collect();
        assert_eq!(down, [Edge { clock: 250, count: 0, up: false }, Edge { clock: 750, count: -1, up: false }]);
        assert!(Motion::new(0.2, 0.9, 1_000, 0).is_empty());
    }

    #[test]
    fn quiet_clocks_are_quiet() {
        assert!(Motion::new(0.0, 40.5, 5_000, 1_400).edges().all(|edge| edge.clock >= 1_400));
    }

    /// The closed form equals the clock-level twin of the encoder.
    #[test]
    fn the_counter_equals_the_encoder_clock_by_clock() {
        use fixed_kin::encoder::{Encoder, Inputs};
        let filter = 3;
        let period = 1_000_u32;
        let (mut counter, mut encoder) = (Counter::default(), Encoder::default());
        let quiet = |a, b, sample, now| Inputs { a, b, filter, sample, now, ..Inputs::default() };
        let mut pins = 0;
        let mut position = 0.0;
        for now in 0..=period {
            encoder.clock(&quiet(false, false, now == period, now));
        }
        for (tick, step) in [3.7, -1.2, 0.3, 25.0, -25.0, 0.9, 0.0, -0.6, 0.6, 37.3, -40.0, 0.1].into_iter().enumerate()
        {
            let before = period * (tick as u32 + 1);
            let target = position + step;
            let expected = counter.advance(target, before + period, period, 0, filter);
            let edges: Vec<_> = Motion::new(position, target, period, 0).edges().collect();
            position = target;
            for clock in 0..period {
                for edge in edges.iter().filter(|edge| edge.clock == clock) {
                    pins = lines(edge.count);
                }
                let sample = clock == period - 1;
                encoder.clock(&quiet(pins & 1 == 1, pins & 2 == 2, sample, before + 1 + clock));
            }
            let got = encoder.outputs();
            assert!(!got.error, "tick {tick}");
            assert_eq!(
                (got.count, got.edge_time, got.direction),
                (expected.count, expected.edge_time, expected.direction),
                "tick {tick}"
            );
        }
    }
}
