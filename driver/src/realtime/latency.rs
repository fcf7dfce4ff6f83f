//! How late the timer wakes the loop, as cyclictest measures it.

use super::{Clock, Timer, Wake};
use hdrhistogram::Histogram;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Longest latency told apart, ns; a longer one counts as this.
const LONGEST_NS: u64 = 10_000_000_000;

/// Latencies of a loop: their distribution, in a fixed piece of memory.
#[derive(Clone, Debug)]
pub struct Latency {
    nanoseconds: Histogram<u64>,
    /// Of the newest cycle.
    pub last: Duration,
    /// Ticks left out.
    pub missed: u64,
}

impl Default for Latency {
    fn default() -> Self {
        Self::new()
    }
}

impl Latency {
    /// None yet; allocates all it will ever need.
    ///
    /// # Panics
    /// Never: the bounds are right.
    #[must_use]
    pub fn new() -> Self {
        let nanoseconds = Histogram::new_with_bounds(1, LONGEST_NS, 2).expect("bounds are in order");
        Self { nanoseconds, last: Duration::ZERO, missed: 0 }
    }

    /// Takes a wake-up; nothing is allocated.
    pub fn add(&mut self, wake: &Wake) {
        self.last = wake.late;
        self.missed += wake.missed;
        self.nanoseconds
            .saturating_record(u64::try_from(wake.late.as_nanos()).unwrap_or(LONGEST_NS).clamp(1, LONGEST_NS));
    }

    /// Wake-ups seen.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.nanoseconds.len()
    }

    /// Shortest, mean and longest, µs.
    #[must_use]
    pub fn min_mean_max_us(&self) -> [f64; 3] {
        [self.nanoseconds.min() as f64, self.nanoseconds.mean(), self.nanoseconds.max() as f64].map(|ns| ns * 1e-3)
    }

    /// The latency that a share of all wake-ups does not exceed, µs.
    #[must_use]
    pub fn quantile_us(&self, share: f64) -> f64 {
        self.nanoseconds.value_at_quantile(share) as f64 * 1e-3
    }

    /// Wake-ups between powers of two: upper bound in µs and how many, from the first to the last that has any.
    #[must_use]
    pub fn histogram(&self) -> Vec<(f64, u64)> {
        let mut bars: Vec<(f64, u64)> = self
            .nanoseconds
            .iter_log(1_000, 2.0)
            .map(|step| ((step.value_iterated_to() as f64 + 1.0) * 1e-3, step.count_since_last_iteration()))
            .collect();
        while bars.last().is_some_and(|(_, count)| *count == 0) {
            bars.pop();
        }
        let empty = bars.iter().take_while(|(_, count)| *count == 0).count();
        bars.drain(..empty);
        bars
    }
}

/// Wakes up `ticks` times with this period, doing nothing else.
pub fn measure_latency(
    clock: &mut impl Clock,
    period: Duration,
    ticks: u64,
    stop: &AtomicBool,
    mut progress: impl FnMut(&Latency),
) -> Latency {
    let mut latency = Latency::new();
    let mut timer = Timer::new(period, clock);
    while latency.count() < ticks && !stop.load(Ordering::Relaxed) {
        latency.add(&timer.wait(clock));
        progress(&latency);
    }
    latency
}

#[cfg(test)]
mod tests {
    use super::*;

    fn latency(late_us: &[u64]) -> Latency {
        let mut latency = Latency::new();
        for &late in late_us {
            latency.add(&Wake { late: Duration::from_micros(late), missed: late / 1_000, ..Wake::default() });
        }
        latency
    }

    #[test]
    fn figures_and_histogram_agree_with_what_went_in() {
        let seen = latency(&[3, 3, 5, 40, 2_500]);
        let [min, mean, max] = seen.min_mean_max_us();
        assert!((min - 3.0).abs() < 0.05 && (mean - 510.2).abs() < 5.0 && (max / 2_500.0 - 1.0).abs() < 0.01);
        assert_eq!((seen.count(), seen.missed), (5, 2));
        assert!((seen.quantile_us(0.5) - 5.0).abs() < 0.1);
        let bars = seen.histogram();
        assert_eq!(bars.iter().map(|(_, count)| count).sum::<u64>(), 5);
        assert_eq!(bars[0], (4.0, 2));
        assert_eq!(bars.last().unwrap().1, 1);
    }

    #[test]
    fn nothing_seen_is_no_histogram_and_a_huge_latency_is_no_panic() {
        assert!(Latency::new().histogram().is_empty());
        let seen = latency(&[u64::MAX / 2_000]);
        assert_eq!(seen.count(), 1);
    }
}
