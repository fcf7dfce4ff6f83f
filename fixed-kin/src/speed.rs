//! Wheel speed from encoder counts, by count and time (M/T) or by plain difference.
//!
//! M/T divides the counts between two edges by the time between those same edges, so that a slow
//! wheel, which gives one edge in many control ticks, is measured as exactly as a fast one. The
//! error is one clock of edge time in the whole interval plus one LSB of the quotient; both are
//! tested below.
//!
//! Three cases where a plain M/T quotient is wrong, and what is done:
//! - **Reversal.** The edge up from count c and the edge down to c are at the *same* place of the
//!   encoder, its line c. So lines are subtracted, not counts: a wheel that trembles on one line
//!   stands still.
//! - **No edge in this tick.** The wheel cannot have turned a full count in the `age` since its
//!   last edge, so the speed falls to at most 1/age.
//! - **No edge for [`EDGE_TIMEOUT`].** Speed is zero, and the next edge has no partner; until
//!   there is one the plain difference over the tick is used.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "counters wrap by design"
)]

use crate::format::Speed;
use crate::word::divide;

/// Width of the edge time stamps and of the time at a control tick.
pub const TIME_BITS: u32 = 24;

/// Clocks without an edge after which a wheel stands still: 2²³, 0.25 s at 33.33 MHz (4 counts/s).
pub const EDGE_TIMEOUT: u32 = 1 << 23;

const TIME_MASK: u32 = (1 << TIME_BITS) - 1;

/// How speed is measured; the register `mode` selects it for all axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SpeedMode {
    /// Count difference of one control tick over the tick period.
    #[default]
    Difference,
    /// Count difference between edges over the time between them.
    CountAndTime,
}

/// What an encoder counter shows at a control tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EncoderSample {
    /// Wrapping 16-bit count.
    pub count: u16,
    /// Time of the last edge, 24 bits.
    pub edge_time: u32,
    /// Direction of the last edge, true = counting up.
    pub direction: bool,
}

/// Speed measurement of one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SpeedState {
    /// Position since power-up, in counts, wrapping at 32 bits.
    pub count: i32,
    /// Speed at the last control tick.
    pub speed: Speed,
    edge_time: u32,
    line: u16,
    edge_valid: bool,
}

impl EncoderSample {
    /// The line of the encoder at which the last edge was: the lower of the two counts beside it.
    #[must_use]
    pub fn line(&self) -> u16 {
        self.count.wrapping_sub(u16::from(self.direction))
    }
}

impl SpeedState {
    /// One control tick at time `now` (24 bits) after a tick of `tick_period` clocks.
    ///
    /// Counts more than 2¹⁵ − 1 apart between two ticks alias, as in any wrapping counter.
    pub fn step(&mut self, sample: EncoderSample, now: u32, tick_period: u32, mode: SpeedMode) -> Speed {
        let difference = i32::from(sample.count.wrapping_sub(self.count as u16) as i16);
        self.count = self.count.wrapping_add(difference);
        self.speed = match mode {
            SpeedMode::Difference => by_difference(difference, tick_period),
            SpeedMode::CountAndTime => self.by_count_and_time(difference, sample, now, tick_period),
        };
        self.speed
    }

    fn by_count_and_time(&mut self, difference: i32, sample: EncoderSample, now: u32, tick_period: u32) -> Speed {
        let between_edges = sample.edge_time.wrapping_sub(self.edge_time) & TIME_MASK;
        if between_edges == 0 {
            return self.without_edge(now);
        }
        let speed = if self.edge_valid {
            let lines = sample.line().wrapping_sub(self.line) as i16;
            Speed::from_bits(divide(i32::from(lines), between_edges))
        } else {
            by_difference(difference, tick_period)
        };
        self.edge_time = sample.edge_time;
        self.line = sample.line();
        self.edge_valid = true;
        speed
    }

    fn without_edge(&mut self, now: u32) -> Speed {
        let age = now.wrapping_sub(self.edge_time) & TIME_MASK;
        if !self.edge_valid || age >= EDGE_TIMEOUT {
            self.edge_valid = false;
            return Speed::ZERO;
        }
        let bound = Speed::from_bits(divide(1, age));
        self.speed.clamp(-bound, bound)
    }
}

/// Speed from the counts of one control tick.
#[must_use]
pub fn by_difference(counts: i32, tick_period: u32) -> Speed {
    Speed::from_bits(divide(counts, tick_period))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::Format;

    const TICK: u32 = 33_333;

    /// An ideal wheel at a constant speed, sampled every tick: edges at k / rate.
    fn measure(counts_per_clock: f64, ticks: u32, mode: SpeedMode) -> std::vec::Vec<f64> {
        let mut state = SpeedState::default();
        (1..=ticks)
            .map(|tick| {
                let now = f64::from(tick) * f64::from(TICK);
                let position = (now * counts_per_clock.abs()).floor();
                let edge = (position / counts_per_clock.abs()).ceil();
                let signed = if counts_per_clock < 0.0 { -position } else { position };
                let sample = EncoderSample {
                    count: (signed as i64) as u16,
                    edge_time: (edge as u64 as u32) & TIME_MASK,
                    direction: counts_per_clock > 0.0,
                };
                f64::from(state.step(sample, (now as u64 as u32) & TIME_MASK, TICK, mode))
            })
            .collect()
    }

    #[test]
    fn count_and_time_is_within_a_thousandth_from_10_to_a_million_counts_a_second() {
        let mut rows = std::vec::Vec::new();
        for counts_per_second in [10.0, 33.0, 100.0, 1e3, 7.7e3, 1e5, 1e6_f64] {
            let mut worst = [0.0_f64; 2];
            for sign in [-1.0, 1.0] {
                let rate = sign * counts_per_second / 33_333_333.0;
                // From the second edge on: at every tick, edges or not.
                let settled = (2.0 / counts_per_second * 1000.0) as usize + 2;
                let ticks = (7.0 / counts_per_second * 1000.0) as u32 + 2_000;
                for (mode, worst) in [SpeedMode::CountAndTime, SpeedMode::Difference].into_iter().zip(&mut worst) {
                    for speed in measure(rate, ticks, mode).into_iter().skip(settled) {
                        *worst = worst.max((speed / rate - 1.0).abs());
                    }
                }
            }
            rows.push(std::vec![
                std::format!("{counts_per_second}"),
                std::format!("{:.1e}", worst[0]),
                std::format!("{:.1e}", worst[1])
            ]);
            assert!(worst[0] < 1e-3, "{counts_per_second} counts/s: relative error {:.2e}", worst[0]);
        }
        let table = measured::Table {
            name: "speed",
            title: "Worst relative error of a measured speed at any control tick of 1 kHz, ideal wheel, both ways",
            command: "cargo test --release -p fixed-kin count_and_time",
            columns: &["counts/s", "by count and time", "plain difference"],
        };
        table.check(&rows);
    }

    #[test]
    fn difference_mode_has_the_quantum_of_one_count_a_tick() {
        let rate = 0.4 / f64::from(TICK);
        let quantum = 1.0 / f64::from(TICK);
        for speed in measure(rate, 100, SpeedMode::Difference) {
            assert!(speed == 0.0 || (speed - quantum).abs() < Format::SPEED.lsb());
        }
    }

    #[test]
    fn a_stopped_wheel_decays_and_reaches_zero_at_the_time_out() {
        let mut state = SpeedState::default();
        let moving = |count, edge_time| EncoderSample { count, edge_time, direction: true };
        state.step(moving(1, 100), TICK, TICK, SpeedMode::CountAndTime);
        state.step(moving(2, TICK + 100), 2 * TICK, TICK, SpeedMode::CountAndTime);
        let mut before = state.speed;
        for tick in 3..300_u32 {
            let now = tick * TICK;
            let speed = state.step(moving(2, TICK + 100), now & TIME_MASK, TICK, SpeedMode::CountAndTime);
            let age = now - TICK - 100;
            assert!(speed <= before && speed >= 0);
            assert_eq!(speed == 0, age >= EDGE_TIMEOUT, "age {age}");
            before = speed;
        }
    }

    #[test]
    fn trembling_on_one_line_is_no_speed() {
        let mut state = SpeedState::default();
        state.step(EncoderSample { count: 1, edge_time: 10, direction: true }, TICK, TICK, SpeedMode::CountAndTime);
        // Back over the same line just before the tick and forth just after it: 9 clocks apart.
        let back = EncoderSample { count: 0, edge_time: 2 * TICK - 4, direction: false };
        assert_eq!(state.step(back, 2 * TICK, TICK, SpeedMode::CountAndTime), 0);
        let forth = EncoderSample { count: 1, edge_time: 2 * TICK + 5, direction: true };
        assert_eq!(state.step(forth, 3 * TICK, TICK, SpeedMode::CountAndTime), 0);
    }

    #[test]
    fn count_extends_over_the_wrap_of_the_counter() {
        let mut state = SpeedState::default();
        for step in 1..=10_i32 {
            let sample = EncoderSample { count: (step * 20_000) as u16, ..EncoderSample::default() };
            state.step(sample, 0, TICK, SpeedMode::Difference);
            assert_eq!(state.count, step * 20_000);
        }
    }
}
