//! A contact that sticks, creeps and slides: spring and damper in series with a creep element and a friction limit.

/// Elastic, viscous and plastic contact along one direction.
///
/// The slip speed `v` is shared by the deflection `z` and by creep: `v = ż + c·F`, with `F = k·z + d·ż` and
/// `|F| ≤ limit`. Where the limit is reached the deflection stays at the limit and the rest of `v` is sliding. All three
/// parts take energy or store it; none gives any.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bristle {
    /// Stiffness k, N/m.
    pub(crate) stiffness: f64,
    /// Damping d, N s/m.
    pub(crate) damping: f64,
    /// Deflection z, m.
    deflection: f64,
    /// Slip speed left over by the friction limit in the last step, m/s.
    pub(crate) sliding: f64,
}

impl Bristle {
    pub(crate) fn new(stiffness: f64, damping: f64) -> Self {
        Self { stiffness, damping, deflection: 0.0, sliding: 0.0 }
    }

    /// Force (N) that opposes `slip` (m/s) over the next `step` seconds; `creep` in m/s/N, `limit` in N.
    pub(crate) fn advance(&mut self, step: f64, slip: f64, creep: f64, limit: f64) -> f64 {
        let rate = (slip - creep * self.stiffness * self.deflection) / (1.0 + creep * self.damping);
        let stretched = self.deflection + step * rate;
        let force = self.stiffness * stretched + self.damping * rate;
        if force.abs() <= limit {
            self.deflection = stretched;
            self.sliding = 0.0;
            force
        } else {
            let held = limit.copysign(force) / self.stiffness;
            self.sliding = slip - (held - self.deflection) / step;
            self.deflection = held;
            limit.copysign(force)
        }
    }

    /// Energy stored in the spring, J.
    pub(crate) fn energy(&self) -> f64 {
        0.5 * self.stiffness * self.deflection * self.deflection
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_pull_is_held_and_a_large_one_slides_at_the_limit() {
        let mut bristle = Bristle::new(1e4, 2.0);
        let mut force = 0.0;
        for _ in 0..100 {
            force = bristle.advance(1e-4, 0.001, 0.0, 1.0);
        }
        assert!((force - (0.1 + 0.002)).abs() < 1e-9, "held {force}");
        for _ in 0..1000 {
            force = bristle.advance(1e-4, 0.1, 0.0, 1.0);
        }
        assert!((force - 1.0).abs() < 1e-12);
        assert!((bristle.sliding - 0.1).abs() < 1e-9);
    }

    #[test]
    fn creep_settles_at_slip_over_creep_constant() {
        let mut bristle = Bristle::new(1e4, 2.0);
        let mut force = 0.0;
        for _ in 0..20_000 {
            force = bristle.advance(1e-4, 0.003, 0.001, 10.0);
        }
        assert!((force - 3.0).abs() < 1e-6, "{force}");
    }
}
