//! A period that does not drift.

use super::Clock;
use std::time::Duration;

/// Ticks at whole multiples of a period. A tick that was slept through is counted and left out: ticks
/// that come in a burst would command a robot by old news.
#[derive(Clone, Copy, Debug)]
pub struct Timer {
    period: Duration,
    next: Duration,
}

/// One wake-up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wake {
    /// Time of the tick.
    pub at: Duration,
    /// How long after the tick the loop ran.
    pub late: Duration,
    /// Ticks left out since the last wake-up.
    pub missed: u64,
}

impl Timer {
    /// A timer whose first tick is one period from now.
    ///
    /// # Panics
    /// Where the period is zero.
    pub fn new(period: Duration, clock: &mut impl Clock) -> Self {
        assert!(!period.is_zero(), "a timer needs a period");
        Self { period, next: clock.now() + period }
    }

    /// Time between two wake-ups.
    #[must_use]
    pub fn period(&self) -> Duration {
        self.period
    }

    /// Moves all coming ticks, to keep clear of another clock's.
    pub fn shift(&mut self, by: Duration) {
        self.next += by;
    }

    /// Sleeps until the next tick.
    pub fn wait(&mut self, clock: &mut impl Clock) -> Wake {
        clock.sleep_until(self.next);
        let now = clock.now();
        let late = now.saturating_sub(self.next);
        let missed = late.as_nanos() / self.period.as_nanos();
        let at = self.next + duration(self.period.as_nanos() * missed);
        self.next = at + self.period;
        Wake { at, late, missed: u64::try_from(missed).unwrap_or(u64::MAX) }
    }
}

fn duration(nanoseconds: u128) -> Duration {
    Duration::from_nanos(u64::try_from(nanoseconds).unwrap_or(u64::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A clock that oversleeps as told.
    struct Sleepy {
        now: Duration,
        oversleeps: Vec<u64>,
    }

    impl Clock for Sleepy {
        fn now(&mut self) -> Duration {
            self.now
        }
        fn sleep_until(&mut self, at: Duration) {
            let over = Duration::from_micros(self.oversleeps.pop().unwrap_or(0));
            self.now = self.now.max(at) + over;
        }
    }

    #[test]
    fn ticks_stay_on_the_grid_and_missed_ones_are_counted() {
        let mut clock = Sleepy { now: Duration::from_millis(7), oversleeps: vec![0, 999, 3_400, 1_000, 20] };
        let mut timer = Timer::new(Duration::from_millis(1), &mut clock);
        let wakes: Vec<_> = (0..5).map(|_| timer.wait(&mut clock)).collect();
        let seen: Vec<_> = wakes.iter().map(|w| (w.at.as_micros(), w.late.as_micros(), w.missed)).collect();
        assert_eq!(seen, [(8_000, 20, 0), (10_000, 1_000, 1), (14_000, 3_400, 3), (15_000, 999, 0), (16_000, 0, 0)]);
        timer.shift(Duration::from_micros(250));
        assert_eq!(timer.wait(&mut clock).at, Duration::from_micros(17_250));
    }
}
