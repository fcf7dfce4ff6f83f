//! Directions around a middle, worked out once: sine and cosine of every ray would be half of a picture's time.

use std::f32::consts::TAU;
use std::sync::LazyLock;

/// Directions a turn in the table; what is asked for divides it.
const ALL: usize = 96;

static TABLE: LazyLock<[[f32; 2]; ALL]> = LazyLock::new(|| {
    std::array::from_fn(|k| {
        let (s, c) = (TAU * k as f32 / ALL as f32).sin_cos();
        [c, s]
    })
});

/// Cosine and sine of `count` angles evenly around, from the right down.
pub(super) fn directions(count: usize) -> impl Iterator<Item = [f32; 2]> {
    debug_assert!(ALL.is_multiple_of(count), "{count} directions");
    TABLE.iter().step_by(ALL / count).copied()
}
