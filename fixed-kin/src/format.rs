//! Number formats: what a bit of every word means.
//!
//! The formats are types of the `fixed` crate, so that a value cannot be used with another scale
//! than its own. A format is narrower than its 32-bit container where the gateware is: 30 bits for
//! words, 24 for gains, 18 for coefficients. [`Format`] holds that width, and [`Format::round`] is
//! the **only** place where a real number becomes a hardware number.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "checked against the format just before"
)]

use crate::word::{Scale, WORD_BITS};
use fixed::FixedI32;
use fixed::types::extra::{U8, U16, U22, U24, U32};

/// Wheel speed in encoder counts per clock of the local bus: 2⁻³² counts a clock is one LSB
/// (0.0078 counts/s at 33.33 MHz), 30 bits, ±0.125 counts a clock (±4.2 million counts/s).
///
/// The clock is the natural unit of time in gateware; the driver, which measures the clock, is the
/// one place that knows seconds.
pub type Speed = FixedI32<U32>;
/// Duty, also the integrator of the speed loop: 2⁻²⁴ of full drive is one LSB, 30 bits, ±32.
pub type Duty = FixedI32<U24>;
/// Entry of a kinematics matrix: 18 bits, [−2, 2).
pub type Coefficient = FixedI32<U16>;
/// Entry of the odometry matrix, LSB of displacement per count: 30 bits, [−2²¹, 2²¹).
pub type Displacement = FixedI32<U8>;
/// Feed-forward gain, duty LSB per speed LSB: 18 bits, [−2, 2).
pub type FeedForwardGain = FixedI32<U16>;
/// Proportional gain, duty LSB per speed LSB: 24 bits, [−128, 128).
pub type ProportionalGain = FixedI32<U16>;
/// Integral gain times the control period, duty LSB per speed LSB: 24 bits, [−2, 2).
pub type IntegralGain = FixedI32<U22>;

/// Width and binary point of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Format {
    name: &'static str,
    bits: u32,
    fraction: u32,
}

/// A real number that a format cannot hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutOfRange {
    /// The format that was asked.
    pub format: Format,
    /// The value that was offered.
    pub value: f64,
}

impl core::fmt::Display for OutOfRange {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(
            f,
            "{} {} is outside [{}, {}) of its {}-bit format",
            self.format.name,
            self.value,
            -self.format.limit(),
            self.format.limit(),
            self.format.bits
        )
    }
}

impl core::error::Error for OutOfRange {}

impl Format {
    /// [`Speed`]: 30 bits, 2⁻³² counts a clock is one LSB.
    pub const SPEED: Self = Self::new("speed", WORD_BITS, 32);
    /// [`Duty`]: 30 bits, 2⁻²⁴ of full drive is one LSB.
    pub const DUTY: Self = Self::new("duty", WORD_BITS, 24);
    /// [`Coefficient`]: 18 bits, [−2, 2).
    pub const COEFFICIENT: Self = Self::of_operand("kinematics coefficient", Scale::COEFFICIENT);
    /// [`Displacement`]: 30 bits, [−2²¹, 2²¹).
    pub const DISPLACEMENT: Self = Self::new("odometry coefficient", WORD_BITS, 8);
    /// [`FeedForwardGain`]: 18 bits, [−2, 2).
    pub const FEED_FORWARD: Self = Self::new("feed-forward gain", 18, 16);
    /// [`ProportionalGain`]: 24 bits, [−128, 128).
    pub const PROPORTIONAL: Self = Self::of_operand("proportional gain", Scale::WIDE);
    /// [`IntegralGain`]: 24 bits, [−2, 2).
    pub const INTEGRAL: Self = Self::of_operand("integral gain", Scale::FINE);

    /// A signed format of `bits` bits with `fraction` of them after the binary point.
    #[must_use]
    pub(crate) const fn new(name: &'static str, bits: u32, fraction: u32) -> Self {
        Self { name, bits, fraction }
    }

    const fn of_operand(name: &'static str, scale: Scale) -> Self {
        Self::new(name, scale.operand_bits(), scale.fraction_bits())
    }

    /// What the value is, for messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.name
    }

    /// Significant bits, sign included.
    #[must_use]
    pub const fn bits(self) -> u32 {
        self.bits
    }

    /// Bits after the binary point.
    #[must_use]
    pub const fn fraction(self) -> u32 {
        self.fraction
    }

    /// Value of one LSB.
    #[must_use]
    pub fn lsb(self) -> f64 {
        1.0 / (1_u64 << self.fraction) as f64
    }

    /// First value above the range.
    #[must_use]
    pub fn limit(self) -> f64 {
        (1_u64 << (self.bits - 1)) as f64 * self.lsb()
    }

    /// The raw number nearest to `value`; a tie goes to the even one.
    ///
    /// # Errors
    /// [`OutOfRange`] where the format cannot hold the value, or it is no number.
    pub fn round(self, value: f64) -> Result<i32, OutOfRange> {
        let refused = OutOfRange { format: self, value };
        let scaled = value * (1_u64 << self.fraction) as f64;
        let raw = fixed::types::I64F0::checked_from_num(scaled).ok_or(refused)?.to_bits();
        let half = 1_i64 << (self.bits - 1);
        if (-half..half).contains(&raw) { Ok(raw as i32) } else { Err(refused) }
    }
}

/// [`Speed`] words per count a second, times `counts`: per rad/s, say, for the counts of a radian.
#[must_use]
pub fn speed_words(counts: f64, clock_hz: f64) -> f64 {
    counts / clock_hz / Format::SPEED.lsb()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::ToString;

    #[test]
    fn rounds_to_nearest_ties_to_even() {
        let lsb = Format::COEFFICIENT.lsb();
        for (value, raw) in [(0.4, 0), (0.5, 0), (0.6, 1), (1.5, 2), (2.5, 2), (-0.5, 0), (-1.5, -2)] {
            assert_eq!(Format::COEFFICIENT.round(value * lsb), Ok(raw), "{value}");
        }
    }

    #[test]
    fn range_is_half_open() {
        assert_eq!(Format::COEFFICIENT.round(-2.0), Ok(-(1 << 17)));
        assert!(Format::COEFFICIENT.round(2.0).is_err());
        for bad in [f64::NAN, f64::INFINITY, 1e300] {
            assert!(Format::SPEED.round(bad).is_err());
        }
        let text = Format::COEFFICIENT.round(2.5).unwrap_err().to_string();
        assert_eq!(text, "kinematics coefficient 2.5 is outside [-2, 2) of its 18-bit format");
    }

    #[test]
    fn the_types_carry_the_same_binary_point_as_the_formats() {
        assert_eq!(f64::from(Speed::from_bits(1)), Format::SPEED.lsb());
        assert_eq!(f64::from(Duty::from_bits(1)), Format::DUTY.lsb());
        assert_eq!(f64::from(Coefficient::from_bits(1)), Format::COEFFICIENT.lsb());
        assert_eq!(f64::from(ProportionalGain::from_bits(1)), Format::PROPORTIONAL.lsb());
        assert_eq!(f64::from(IntegralGain::from_bits(1)), Format::INTEGRAL.lsb());
    }
}
