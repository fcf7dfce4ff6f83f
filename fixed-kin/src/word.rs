//! The arithmetic word of the gateware and the four operations on it.
//!
//! Every quantity the sequencer computes with is a **word**: a two's complement number of 30 bits,
//! kept sign-extended in 32. The two spare bits let one 32-bit carry chain add two words, or a
//! radix-4 Booth digit of ±2 times a word, without overflow.
//!
//! | operation | result | rounding | clocks in gateware |
//! |---|---|---|---|
//! | [`add`], [`subtract`] | saturates at ±(2²⁹−1), −2²⁹ | exact | 1 |
//! | [`multiply`] | saturates | half up: ⌊x + ½⌋ | 2 + digits, beside other work |
//! | [`divide`] | saturates at ±(2²⁹−1) | towards zero | 34, beside other work |
//!
//! Nothing here wraps and nothing panics, whatever the arguments.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "clamped to a word just before, or bits that are meant to go"
)]

/// Width of a word in bits.
pub const WORD_BITS: u32 = 30;
/// Largest word, 2²⁹ − 1.
pub const WORD_MAX: i32 = (1 << (WORD_BITS - 1)) - 1;
/// Smallest word, −2²⁹.
pub const WORD_MIN: i32 = -(1 << (WORD_BITS - 1));

/// The nearest word.
#[must_use]
pub fn saturate(value: i64) -> i32 {
    value.clamp(i64::from(WORD_MIN), i64::from(WORD_MAX)) as i32
}

/// Saturating sum of two words.
#[must_use]
pub fn add(a: i32, b: i32) -> i32 {
    saturate(i64::from(a) + i64::from(b))
}

/// Saturating difference of two words.
#[must_use]
pub fn subtract(a: i32, b: i32) -> i32 {
    saturate(i64::from(a) - i64::from(b))
}

/// How the serial multiplier reads its second operand: `digits` radix-4 digits, of which the
/// product keeps all but the last `2·digits − guard` bits. The multiplier has these five and no other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scale {
    digits: u32,
    guard: u32,
}

impl Scale {
    /// 18-bit coefficient with 16 fraction bits, [−2, 2): kinematics.
    pub const COEFFICIENT: Self = Self { digits: 9, guard: 2 };
    /// 24-bit gain with 22 fraction bits, [−2, 2): integral gain.
    pub const FINE: Self = Self { digits: 12, guard: 2 };
    /// 24-bit gain with 16 fraction bits, [−128, 128): proportional gain.
    pub const WIDE: Self = Self { digits: 12, guard: 8 };
    /// 16-bit number of counts, the product in 2⁸: odometry.
    pub const COUNTS: Self = Self { digits: 8, guard: 8 };
    /// 14-bit factor with 12 fraction bits, [−2, 2): a PWM period of up to 8191 clocks, over 2¹².
    pub const PERIOD: Self = Self { digits: 7, guard: 2 };

    /// Radix-4 digits of the multiplier operand, which is read as a signed number of `2·digits` bits.
    #[must_use]
    pub const fn digits(self) -> u32 {
        self.digits
    }

    /// Width of the operand in bits.
    #[must_use]
    pub const fn operand_bits(self) -> u32 {
        2 * self.digits
    }

    /// Fraction bits of the operand, which the product drops.
    #[must_use]
    pub const fn fraction_bits(self) -> u32 {
        2 * self.digits - self.guard
    }
}

/// Product of the word `a` and the operand `b`, rounded half up and saturated.
///
/// Only the low `scale.operand_bits()` bits of `b` count, as a signed number.
#[must_use]
pub fn multiply(a: i32, b: i32, scale: Scale) -> i32 {
    let unused = 32 - scale.operand_bits();
    let b = i64::from((b << unused) >> unused);
    let half = 1_i64 << (scale.fraction_bits() - 1);
    saturate((i64::from(a) * b + half) >> scale.fraction_bits())
}

/// `numerator`·2³² / `denominator` rounded towards zero, saturated at ±(2²⁹ − 1) (also for a
/// denominator of zero, then by the sign of the numerator, zero counting as positive).
///
/// The gateware takes a numerator of |n| < 2²⁴ and a denominator, a time, below 2²⁴.
#[must_use]
pub fn divide(numerator: i32, denominator: u32) -> i32 {
    let magnitude = numerator.unsigned_abs();
    let quotient = if magnitude >= denominator {
        WORD_MAX
    } else {
        let quotient = (u64::from(magnitude) << 32) / u64::from(denominator);
        quotient.min(WORD_MAX as u64) as i32
    };
    if numerator < 0 { -quotient } else { quotient }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn words() -> impl Strategy<Value = i32> {
        prop_oneof![WORD_MIN..=WORD_MAX, Just(WORD_MIN), Just(WORD_MAX), Just(-1), Just(0), Just(1)]
    }

    #[test]
    fn saturation_edges() {
        assert_eq!(add(WORD_MAX, 1), WORD_MAX);
        assert_eq!(add(WORD_MIN, -1), WORD_MIN);
        assert_eq!(subtract(WORD_MIN, 1), WORD_MIN);
        assert_eq!(subtract(0, WORD_MIN), WORD_MAX);
        // −2²⁹ · −2 does not fit.
        assert_eq!(multiply(WORD_MIN, -(1 << 17), Scale::COEFFICIENT), WORD_MAX);
        assert_eq!(multiply(WORD_MIN, (1 << 17) - 1, Scale::COEFFICIENT), WORD_MIN);
    }

    #[test]
    fn rounding_is_half_up() {
        let half = 1 << 15;
        assert_eq!(multiply(1, half, Scale::COEFFICIENT), 1);
        assert_eq!(multiply(-1, half, Scale::COEFFICIENT), 0);
        assert_eq!(multiply(1, half - 1, Scale::COEFFICIENT), 0);
        assert_eq!(multiply(-1, half + 1, Scale::COEFFICIENT), -1);
    }

    #[test]
    fn operand_is_sign_extended_from_its_own_width() {
        assert_eq!(multiply(4, 0x3_FFFF, Scale::COEFFICIENT), multiply(4, -1, Scale::COEFFICIENT));
        assert_eq!(multiply(1 << 20, 0x1234_0000, Scale::COEFFICIENT), 0);
    }

    #[test]
    fn division_edges() {
        assert_eq!(divide(0, 0), WORD_MAX);
        assert_eq!(divide(-1, 0), -WORD_MAX);
        assert_eq!(divide(0, 1), 0);
        assert_eq!(divide(1, 1), WORD_MAX);
        assert_eq!(divide(1, 8), WORD_MAX);
        assert_eq!(divide(-1, 9), -477_218_588);
        assert_eq!(divide(1, 0xFF_FFFF), 256);
        assert_eq!(divide(i32::MIN, 3), -WORD_MAX);
    }

    proptest! {
        /// Within half an LSB of the real product wherever that fits a word.
        #[test]
        fn multiply_is_within_half_an_lsb(a in words(), b in words(), which in 0_usize..5) {
            let scale = [Scale::COEFFICIENT, Scale::FINE, Scale::WIDE, Scale::PERIOD, Scale::COUNTS][which];
            let operand = (b << (32 - scale.operand_bits())) >> (32 - scale.operand_bits());
            let exact = f64::from(a) * f64::from(operand) / f64::from(1_u32 << scale.fraction_bits());
            let got = f64::from(multiply(a, b, scale));
            let bounded = exact.clamp(f64::from(WORD_MIN), f64::from(WORD_MAX));
            prop_assert!((got - bounded).abs() <= 0.5, "{got} for {exact}");
        }

        /// Less than one LSB from the real quotient, on the side of zero.
        #[test]
        fn divide_is_within_one_lsb(n in -(1 << 24)..1 << 24_i32, d in 1_u32..1 << 24) {
            let exact = f64::from(n) * 4_294_967_296.0 / f64::from(d);
            let got = f64::from(divide(n, d));
            if exact.abs() < f64::from(WORD_MAX) {
                prop_assert!(got.abs() <= exact.abs() && (exact - got).abs() < 1.0);
            } else {
                prop_assert_eq!(got, f64::from(WORD_MAX) * exact.signum());
            }
        }
    }
}
