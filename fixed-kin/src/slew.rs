//! Slew limit of a speed set point: how much it may change in a control tick.
//!
//! ```text
//! reference += clip(target − reference, fall, rise)
//! ```
//!
//! `fall` is at most zero, `rise` at least; both zero, the reset state, hold the reference where it is,
//! at zero. The widest words are no limit, but for a step of more than 2²⁹ − 1, which takes two
//! ticks. While disarmed the reference is zero.

use crate::format::Speed;
use crate::word::{add, subtract};

/// Limits of one axis, speed per control tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SlewLimits {
    /// Largest step down, negative. Above `rise`, `fall` wins.
    pub fall: Speed,
    /// Largest step up.
    pub rise: Speed,
}

impl SlewLimits {
    /// As good as none.
    pub const NONE: Self =
        Self { fall: Speed::from_bits(crate::word::WORD_MIN), rise: Speed::from_bits(crate::word::WORD_MAX) };

    /// The reference after a control tick.
    #[must_use]
    pub fn step(&self, reference: Speed, target: Speed) -> Speed {
        let difference = subtract(target.to_bits(), reference.to_bits());
        let step = difference.min(self.rise.to_bits()).max(self.fall.to_bits());
        Speed::from_bits(add(reference.to_bits(), step))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn speed(bits: i32) -> Speed {
        Speed::from_bits(bits)
    }

    #[test]
    fn all_zero_holds_and_none_follows() {
        for target in [-(1 << 28), -1, 0, 1, 1 << 28] {
            assert_eq!(SlewLimits::default().step(Speed::ZERO, speed(target)), Speed::ZERO);
            assert_eq!(SlewLimits::NONE.step(speed(1 << 27), speed(target)), speed(target));
        }
    }

    #[test]
    fn a_step_becomes_a_ramp_that_ends_exactly() {
        let limits = SlewLimits { fall: speed(-300), rise: speed(100) };
        let mut reference = Speed::ZERO;
        for n in 1..=11 {
            reference = limits.step(reference, speed(1_050));
            assert_eq!(reference, speed((n * 100).min(1_050)));
        }
        for n in 1..=4 {
            reference = limits.step(reference, Speed::ZERO);
            assert_eq!(reference, speed((1_050 - n * 300).max(0)));
        }
    }
}
