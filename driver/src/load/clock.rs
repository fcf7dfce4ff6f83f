//! The real clock of the local bus, measured against the host's.

use crate::pci::{PciCard, PciError, RegisterWindow};
use crate::registers::{BusError, Registers};
use fixed_kin::registers::TIME;
use std::time::Duration;

/// Readings at either end; the quickest counts, for it knows best when it was.
const READINGS: u32 = 8;

/// A clock that cannot be measured.
#[derive(Debug, thiserror::Error)]
pub enum ClockError {
    /// A register could not be read.
    #[error(transparent)]
    Bus(#[from] BusError),
    /// An access the system refused.
    #[error(transparent)]
    Pci(#[from] PciError),
    /// No clock.
    #[error(
        "the card's clock stands still: `time` reads {0} twice, {1:?} apart; without its clock the card does nothing"
    )]
    Still(u32, Duration),
}

/// Frequency of the local bus clock, Hz, over about this time.
///
/// # Errors
/// [`ClockError`] where the card does not answer or its clock stands.
pub fn measure_clock<C: PciCard>(card: &mut C, over: Duration) -> Result<f64, ClockError> {
    let mut window = RegisterWindow::new(card);
    // The median of three: a single word that was misread, or a host that was held up, does not count.
    let mut measured = [0.0; 3];
    for frequency in &mut measured {
        let (first_at, first) = reading(&mut window)?;
        window.card.sleep(over / 3);
        let (last_at, last) = reading(&mut window)?;
        let (clocks, time) = (last.wrapping_sub(first), last_at.saturating_sub(first_at));
        if clocks == 0 || time.is_zero() {
            return Err(ClockError::Still(last, time));
        }
        *frequency = f64::from(clocks) / time.as_secs_f64();
    }
    measured.sort_by(f64::total_cmp);
    Ok(measured[1])
}

/// The card's time, and the host's at that moment.
fn reading<C: PciCard>(window: &mut RegisterWindow<C>) -> Result<(Duration, u32), ClockError> {
    let mut best: Option<(Duration, Duration, u32)> = None;
    for _ in 0..READINGS {
        let before = window.card.now();
        let clocks = window.read(TIME.offset)?;
        let took = window.card.now().saturating_sub(before);
        if best.is_none_or(|(shortest, ..)| took < shortest) {
            best = Some((took, before + took / 2, clocks));
        }
    }
    best.map(|(_, at, clocks)| (at, clocks)).ok_or(ClockError::Still(0, Duration::ZERO))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pci::Bar;

    /// A card whose clock runs at a frequency while the host's time passes; an access takes 2 µs.
    struct Ticking {
        now: Duration,
        hz: f64,
        /// Accesses so far, and the one whose word is misread.
        accesses: usize,
        misread: Option<usize>,
    }

    impl Ticking {
        fn at(hz: f64) -> Self {
            Self { now: Duration::from_millis(7), hz, accesses: 0, misread: None }
        }
    }

    impl PciCard for Ticking {
        fn read32(&mut self, _: Bar, _: u32) -> Result<u32, PciError> {
            self.now += Duration::from_micros(1);
            let clocks = (self.now.as_secs_f64() * self.hz) as u64 as u32;
            self.now += Duration::from_micros(1);
            self.accesses += 1;
            Ok(if self.misread == Some(self.accesses) { clocks ^ 0x0040_0000 } else { clocks })
        }
        fn write32(&mut self, _: Bar, _: u32, _: u32) -> Result<(), PciError> {
            Ok(())
        }
        fn write8(&mut self, _: Bar, _: u32, _: u8) -> Result<(), PciError> {
            Ok(())
        }
        fn has(&self, _: Bar) -> bool {
            true
        }
        fn now(&mut self) -> Duration {
            self.now
        }
        fn sleep(&mut self, time: Duration) {
            self.now += time;
        }
    }

    const OVER: Duration = Duration::from_millis(60);

    #[test]
    fn a_frequency_is_known_to_a_clock_in_each_third() {
        for hz in [25e6, 33_333_333.0, 34e6] {
            let measured = measure_clock(&mut Ticking::at(hz), OVER).unwrap();
            // One clock of a third at either end.
            assert!((measured - hz).abs() < 2.0 * 3.0 / OVER.as_secs_f64(), "{measured} of {hz}");
        }
    }

    #[test]
    fn one_misread_word_does_not_count() {
        for misread in 1..=6 * READINGS as usize {
            let mut card = Ticking { misread: Some(misread), ..Ticking::at(33e6) };
            let measured = measure_clock(&mut card, OVER).unwrap();
            assert!((measured - 33e6).abs() < 2.0 * 3.0 / OVER.as_secs_f64(), "{misread}: {measured}");
        }
    }

    #[test]
    fn a_clock_that_stands_has_no_frequency() {
        assert!(
            matches!(measure_clock(&mut Ticking::at(0.0), OVER), Err(ClockError::Still(0, time)) if !time.is_zero())
        );
    }
}
