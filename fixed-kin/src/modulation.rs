//! From a duty to what the PWM generator compares with.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "13 bits of a word"
)]

use crate::format::Duty;
use crate::word::{Scale, multiply, subtract};

/// Sign and magnitude for the PWM generator of one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Modulation {
    /// Clocks of the period in which the output is high; `compare == period` is 100 %.
    pub compare: u16,
    /// Direction pin, true = negative duty.
    pub reverse: bool,
}

/// Rounds |duty|·period to clocks, half up; a duty of ±1 gives exactly the period, 0 exactly 0.
///
/// `period` has 13 bits. A duty beyond ±1 gives more than the period, which the generator
/// takes as 100 %, up to the 13 bits of `compare`.
#[must_use]
pub fn modulate(duty: Duty, period: u16) -> Modulation {
    let raw = duty.to_bits();
    let reverse = raw < 0;
    let magnitude = if reverse { subtract(0, raw) } else { raw };
    let scaled = multiply(magnitude, i32::from(period & 0x1FFF), Scale::PERIOD);
    let clocks = crate::word::add(scaled, 1 << 11) >> 12;
    Modulation { compare: (clocks as u16) & 0x1FFF, reverse }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn full_and_no_drive_are_exact_for_every_period() {
        for period in 0..8192_u16 {
            assert_eq!(modulate(Duty::ONE, period), Modulation { compare: period, reverse: false });
            assert_eq!(modulate(-Duty::ONE, period).compare, period);
            assert_eq!(modulate(Duty::ZERO, period), Modulation::default());
        }
    }

    #[test]
    fn within_half_a_clock_and_one_lsb() {
        for raw in (-(1 << 24)..=1 << 24).step_by(4_099) {
            let exact = f64::from(raw).abs() / f64::from(1 << 24) * 1_667.0;
            let got = modulate(Duty::from_bits(raw), 1_667);
            assert!((f64::from(got.compare) - exact).abs() <= 0.501, "{raw}");
            assert_eq!(got.reverse, raw < 0);
        }
    }
}
