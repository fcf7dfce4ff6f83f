//! Inverse and direct kinematics by coefficient matrix: equations (4) and (5) of the paper.
//!
//! The matrices are computed in floating point from the robot's geometry, calibrated skew included,
//! and rounded by [`Format::round`](crate::format::Format::round). A body velocity is a word
//! whose unit the driver chooses as a power of two, so that the coefficients use their 18 bits.
//!
//! Every product is rounded to a word by itself and the sums saturate, in the order of the axes.
//! With N terms the result is within N/2 LSB of the exact matrix product of the *rounded*
//! coefficients; a coefficient itself is within 2⁻¹⁷.

use crate::AXES;
use crate::format::{Coefficient, Speed};
use crate::word::{Scale, add, multiply};

/// Components of a body velocity: x to the right, y forward, rotation counter-clockwise.
pub const TWIST: usize = 3;

/// Row `i` gives the speed of wheel `i` from the body velocity: rows of M/r.
pub type InverseMatrix = [[Coefficient; TWIST]; AXES];
/// Row `k` gives component `k` of the body velocity from the wheel speeds: rows of r·M⁻¹.
pub type DirectMatrix = [[Coefficient; AXES]; TWIST];

/// Wheel speed of one axis from a body velocity in words: one row of equation (4).
#[must_use]
pub fn inverse(row: &[Coefficient; TWIST], twist: &[i32; TWIST]) -> Speed {
    Speed::from_bits(dot(row, twist))
}

/// Body velocity in words from all wheel speeds: equation (5).
#[must_use]
pub fn direct(matrix: &DirectMatrix, speeds: &[Speed; AXES]) -> [i32; TWIST] {
    let raw = speeds.map(Speed::to_bits);
    [0, 1, 2].map(|k| dot(&matrix[k], &raw))
}

fn dot<const N: usize>(row: &[Coefficient; N], column: &[i32; N]) -> i32 {
    row.iter()
        .zip(column)
        .map(|(coefficient, &value)| multiply(value, coefficient.to_bits(), Scale::COEFFICIENT))
        .fold(0, add)
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

        #[test]
        fn direct_is_within_half_an_lsb_per_wheel(
            row in prop::array::uniform4(-(1 << 17)..1 << 17_i32),
            speeds in prop::array::uniform4(-(1 << 26)..1 << 26_i32),
        ) {
            let exact: f64 = (0..4).map(|i| f64::from(row[i]) * f64::from(speeds[i]) / 65_536.0).sum();
            let matrix = [row.map(Coefficient::from_bits); 3];
            let got = direct(&matrix, &speeds.map(Speed::from_bits));
            prop_assert!((f64::from(got[1]) - exact).abs() <= 2.0);
        }
    }
}
