//! Coulomb friction that holds still at zero speed.

/// How often the gear's loss is made to agree with the torque it is a share of. The error shrinks
/// by the gear's loss each time, and starts from the step before.
pub(super) const GEAR_ROUNDS: usize = 2;

/// What is left of a push when friction of up to `limit` works against it: 0 if it holds.
pub(super) fn soft(push: f64, limit: f64) -> f64 {
    push.signum() * (push.abs() - limit).max(0.0)
}
