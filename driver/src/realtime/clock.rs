//! Time as a control loop sees it: the machine's, or that of a simulation.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "nanoseconds below 1e9, seconds since power-up"
)]

use rustix::thread::{ClockId, clock_nanosleep_absolute};
use rustix::time::{Timespec, clock_gettime};
use std::time::Duration;

/// A clock that never runs backwards.
pub trait Clock {
    /// Time since some fixed moment.
    fn now(&mut self) -> Duration;

    /// Returns at this time or later; at once where it is past.
    fn sleep_until(&mut self, at: Duration);
}

impl<C: Clock + ?Sized> Clock for &mut C {
    fn now(&mut self) -> Duration {
        (**self).now()
    }
    fn sleep_until(&mut self, at: Duration) {
        (**self).sleep_until(at);
    }
}

impl<C: Clock + ?Sized> Clock for Box<C> {
    fn now(&mut self) -> Duration {
        (**self).now()
    }
    fn sleep_until(&mut self, at: Duration) {
        (**self).sleep_until(at);
    }
}

/// `CLOCK_MONOTONIC`: not set by anybody, the same in every process.
#[derive(Clone, Copy, Debug, Default)]
pub struct MonotonicClock;

impl Clock for MonotonicClock {
    fn now(&mut self) -> Duration {
        let now = clock_gettime(rustix::time::ClockId::Monotonic);
        Duration::new(now.tv_sec.unsigned_abs(), now.tv_nsec.unsigned_abs() as u32)
    }

    fn sleep_until(&mut self, at: Duration) {
        let at = Timespec { tv_sec: at.as_secs() as i64, tv_nsec: i64::from(at.subsec_nanos()) };
        // A signal ends a sleep early; its handler has left a note, and the loop looks at it anyway.
        while clock_nanosleep_absolute(ClockId::Monotonic, &at) == Err(rustix::io::Errno::INTR) {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sleep_ends_at_its_time_and_the_past_does_not_wait() {
        let mut clock = MonotonicClock;
        let begun = clock.now();
        let at = begun + Duration::from_millis(3);
        clock.sleep_until(at);
        assert!(clock.now() >= at);
        // What is past returns at all: a relative sleep would take as long as the machine has run.
        clock.sleep_until(begun);
        clock.sleep_until(Duration::ZERO);
    }
}
