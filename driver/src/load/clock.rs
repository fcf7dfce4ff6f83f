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
