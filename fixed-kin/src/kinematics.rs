//! Inverse kinematics by coefficient matrix: equation (4) of the paper. Its inverse, from counts, is
//! [`crate::pose::displacement`].
//!
//! The matrix is computed in floating point from the robot's geometry, calibrated skew included,
//! and rounded by [`Format::round`](crate::format::Format::round). A body velocity is a word
//! whose unit the driver chooses as a power of two, so that the coefficients use their 18 bits.
//!
//! Every product is rounded to a word by itself and the sums saturate, in the order of the axes.
//! With three terms the result is within 1.5 LSB of the exact matrix product of the *rounded*
//! coefficients; a coefficient itself is within 2⁻¹⁷.

use crate::AXES;
use crate::format::{Coefficient, Speed};
use crate::word::{Scale, add, multiply};

/// Components of a body velocity: x to the right, y forward, rotation counter-clockwise.
pub const TWIST: usize = 3;

/// Row `i` gives the speed of wheel `i` from the body velocity: rows of M/r.
pub type InverseMatrix = [[Coefficient; TWIST]; AXES];

/// Wheel speed of one axis from a body velocity in words: one row of equation (4).
#[must_use]
pub fn inverse(row: &[Coefficient; TWIST], twist: &[i32; TWIST]) -> Speed {
    let products = row.iter().zip(twist).map(|(c, &value)| multiply(value, c.to_bits(), Scale::COEFFICIENT));
    Speed::from_bits(products.fold(0, add))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::word::{WORD_MAX, WORD_MIN};
    use proptest::prelude::*;

    #[test]
    fn sums_saturate() {
        let row = [Coefficient::MAX, Coefficient::from_bits((1 << 17) - 1), Coefficient::from_bits((1 << 17) - 1)];
        assert_eq!(inverse(&row, &[WORD_MAX; 3]).to_bits(), WORD_MAX);
        assert_eq!(inverse(&row, &[0, WORD_MIN, WORD_MIN]).to_bits(), WORD_MIN);
    }

    proptest! {
        #[test]
        fn within_half_an_lsb_per_term(
            row in prop::array::uniform3(-(1 << 17)..1 << 17_i32),
            twist in prop::array::uniform3(-(1 << 26)..1 << 26_i32),
        ) {
            let exact: f64 = (0..3).map(|k| f64::from(row[k]) * f64::from(twist[k]) / 65_536.0).sum();
            let got = f64::from(inverse(&row.map(Coefficient::from_bits), &twist).to_bits());
            prop_assert!((got - exact).abs() <= 1.5);
        }
    }
}
