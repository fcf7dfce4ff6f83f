//! Encoder cables, whole and broken.

/// How the two lines of an encoder reach the card.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Wiring {
    /// As they should.
    #[default]
    Whole,
    /// One line cut at this position: the other toggles alone, and the count with it, by one.
    Cut(f64),
    /// A on B and B on A, from this position on.
    Swapped(f64),
    /// Both together: every edge changes both at once, which no encoder does. The count stays.
    Shorted(f64),
    /// Neither line changes: both are cut, or the wheel is blocked. The count stays.
    Silent(f64),
    /// Mended: as they should, counting on from a position that is so much smaller.
    Mended(f64),
    /// The lines of another axis, from 0, whose position is so much greater.
    Crossed(usize, f64),
}

impl Wiring {
    /// What the counter follows, where the encoders really are.
    pub(super) fn position(self, axis: usize, real: &[f64]) -> f64 {
        let own = real[axis];
        match self {
            Self::Whole => own,
            // A is high at counts 1 and 2 of every four.
            Self::Cut(at) => at.floor() + if (1..=2).contains(&(own.floor() as i64).rem_euclid(4)) { 1.5 } else { 0.5 },
            Self::Swapped(at) => 2.0 * at - own,
            Self::Shorted(at) | Self::Silent(at) => at,
            Self::Mended(offset) => own - offset,
            Self::Crossed(other, offset) => real.get(other).map_or(own, |position| position - offset),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cut_line_toggles_and_swapped_lines_count_backwards() {
        let counts = |wiring: Wiring| -> Vec<i64> {
            (0..6).map(|k| wiring.position(0, &[f64::from(k) + 0.1, 50.0]).floor() as i64).collect()
        };
        assert_eq!(counts(Wiring::Whole), [0, 1, 2, 3, 4, 5]);
        assert_eq!(counts(Wiring::Cut(0.3)), [0, 1, 1, 0, 0, 1]);
        assert_eq!(counts(Wiring::Swapped(0.0)), [-1, -2, -3, -4, -5, -6]);
        assert_eq!(counts(Wiring::Shorted(2.5)), [2; 6]);
        assert_eq!(counts(Wiring::Silent(2.5)), [2; 6]);
        assert_eq!(counts(Wiring::Mended(4.0)), [-4, -3, -2, -1, 0, 1]);
        assert_eq!(counts(Wiring::Crossed(1, 8.0)), [42; 6]);
    }
}
