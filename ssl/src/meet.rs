//! Bodies on the floor that touch: none goes through another.
//!
//! Discs without friction. What closes is stopped by impulses along the normals, which agree with each other after a few
//! sweeps over all touches; what already overlaps is moved apart the same way. Impulses push and never pull.

/// Speed of approach up to which nothing bounces, m/s: bodies that lean on each other stay together.
const LEANING: f64 = 0.05;
/// Change in a sweep below which impulses agree, m/s, and moves, m.
const AGREED: [f64; 2] = [1e-6, 1e-6];
/// Sweeps at most. A ball between two robots, each fifty times as heavy, takes the most of them.
const SWEEPS: usize = 300;

/// A body as others meet it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Body {
    /// Centre, m.
    pub place: [f64; 2],
    /// m/s.
    pub velocity: [f64; 2],
    /// 1/kg; 0 for what nothing moves.
    pub inverse_mass: f64,
}

/// Two bodies that overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Indices of the two bodies that touch.
    pub bodies: [usize; 2],
    /// Direction from the first to the second, of length 1.
    pub normal: [f64; 2],
    /// By how much they overlap, m.
    pub depth: f64,
    /// Speed along the normal that the first one's surface has beside that of its centre, m/s.
    pub surface: f64,
    /// What is left of the speed of approach.
    pub bounce: f64,
}

impl Touch {
    /// Two discs of these radii, if they overlap. On the same spot any direction is right.
    #[must_use]
    pub fn of_discs(bodies: [usize; 2], places: [[f64; 2]; 2], radii: f64, bounce: f64) -> Option<Self> {
        let apart = [0, 1].map(|axis| places[1][axis] - places[0][axis]);
        let distance = apart[0].hypot(apart[1]);
        let normal = if distance > 1e-9 { apart.map(|x| x / distance) } else { [1.0, 0.0] };
        (distance < radii).then_some(Self { bodies, normal, depth: radii - distance, surface: 0.0, bounce })
    }

    fn closing(&self, bodies: &[Body]) -> f64 {
        let [a, b] = self.bodies.map(|i| bodies[i].velocity);
        self.surface - along(self.normal, [b[0] - a[0], b[1] - a[1]])
    }
}

fn along(normal: [f64; 2], of: [f64; 2]) -> f64 {
    normal[0] * of[0] + normal[1] * of[1]
}

/// Bodies that touch close no longer and no longer overlap.
pub fn part(bodies: &mut [Body], touches: &[Touch]) {
    let wanted: Vec<f64> = touches
        .iter()
        .map(|touch| Some(touch.closing(bodies)).filter(|speed| *speed > LEANING).map_or(0.0, |v| -touch.bounce * v))
        .collect();
    sweep(
        bodies,
        touches,
        AGREED[0],
        |touch, number, bodies| touch.closing(bodies) - wanted[number],
        |b| &mut b.velocity,
    );
    let from: Vec<[f64; 2]> = bodies.iter().map(|body| body.place).collect();
    let depth = |touch: &Touch, _: usize, bodies: &[Body]| {
        let [a, b] = touch.bodies.map(|i| [0, 1].map(|axis| bodies[i].place[axis] - from[i][axis]));
        touch.depth - along(touch.normal, [b[0] - a[0], b[1] - a[1]])
    };
    sweep(bodies, touches, AGREED[1], depth, |b| &mut b.place);
}

/// Projected Gauss-Seidel: every touch takes away what is `left` of its speed or depth, as long as it pushes.
fn sweep(
    bodies: &mut [Body],
    touches: &[Touch],
    agreed: f64,
    left: impl Fn(&Touch, usize, &[Body]) -> f64,
    of: impl Fn(&mut Body) -> &mut [f64; 2],
) {
    let mut pushes = vec![0.0_f64; touches.len()];
    for _ in 0..SWEEPS {
        let mut change = 0.0_f64;
        for (number, touch) in touches.iter().enumerate() {
            let inverse_masses = touch.bodies.map(|i| bodies[i].inverse_mass);
            let both = inverse_masses[0] + inverse_masses[1];
            if both <= 0.0 {
                continue;
            }
            let push = (pushes[number] + left(touch, number, bodies) / both).max(0.0);
            let more = push - pushes[number];
            pushes[number] = push;
            for ((body, inverse_mass), sign) in touch.bodies.into_iter().zip(inverse_masses).zip([-1.0, 1.0]) {
                for (value, n) in of(&mut bodies[body]).iter_mut().zip(touch.normal) {
                    *value += sign * more * inverse_mass * n;
                }
            }
            change = change.max((more * both).abs());
        }
        if change < agreed {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(x: f64, y: f64, velocity: [f64; 2], mass: f64) -> Body {
        Body { place: [x, y], velocity, inverse_mass: 1.0 / mass }
    }

    /// All pairs of discs of these radii that overlap.
    fn touches(bodies: &[Body], radii: &[f64]) -> Vec<Touch> {
        let pairs = (1..bodies.len()).flat_map(|j| (0..j).map(move |i| [i, j]));
        pairs
            .filter_map(|[i, j]| Touch::of_discs([i, j], [bodies[i].place, bodies[j].place], radii[i] + radii[j], 0.2))
            .collect()
    }

    #[test]
    fn two_robots_part_with_the_momentum_they_had() {
        let mut bodies = [body(0.0, 0.0, [1.0, 0.3], 2.0), body(0.17, 0.02, [-0.5, 0.0], 3.0)];
        let before = bodies;
        let found = touches(&bodies, &[0.09; 2]);
        part(&mut bodies, &found);
        let momentum = |of: &[Body], axis: usize| of.iter().map(|b| b.velocity[axis] / b.inverse_mass).sum::<f64>();
        assert!((0..2).all(|axis| (momentum(&before, axis) - momentum(&bodies, axis)).abs() < 1e-12));
        let apart = [0, 1].map(|axis| bodies[1].place[axis] - bodies[0].place[axis]);
        assert!((apart[0].hypot(apart[1]) - 0.18).abs() < 1e-6, "{apart:?}");
        let (was, is) = (found[0].closing(&before), found[0].closing(&bodies));
        assert!(was > 1.0 && (is + 0.2 * was).abs() < 1e-9, "{was} {is}");
        assert_eq!(touches(&[body(0.0, 0.0, [9.0, 0.0], 1.0), body(0.181, 0.0, [0.0; 2], 1.0)], &[0.09; 2]), []);
    }

    #[test]
    fn what_parts_already_and_what_stands_on_one_spot_is_moved_only() {
        let mut bodies = [body(0.0, 0.0, [-1.0, 0.0], 2.0), body(0.1, 0.0, [1.0, 0.0], 2.0)];
        let found = touches(&bodies, &[0.09; 2]);
        part(&mut bodies, &found);
        assert_eq!([bodies[0].velocity, bodies[1].velocity], [[-1.0, 0.0], [1.0, 0.0]]);
        let mut same = [body(0.3, 0.3, [0.0; 2], 2.0); 2];
        let found = touches(&same, &[0.09; 2]);
        part(&mut same, &found);
        assert!((same[1].place[0] - same[0].place[0] - 0.18).abs() < 1e-6, "{same:?}");
    }

    #[test]
    fn a_light_body_between_two_heavy_ones_stops_both() {
        let mut bodies =
            [body(0.0, 0.0, [1.0, 0.0], 2.4), body(0.11, 0.0, [0.0; 2], 0.046), body(0.22, 0.0, [-1.0, 0.0], 2.4)];
        let found = touches(&bodies, &[0.09, 0.0215, 0.09]);
        assert_eq!(found.len(), 2);
        part(&mut bodies, &found);
        assert!(found.iter().all(|touch| touch.closing(&bodies) < 1e-3), "{bodies:?}");
        let gap = bodies[2].place[0] - bodies[0].place[0] - 2.0 * (0.09 + 0.0215);
        assert!(gap > -1e-4, "{gap}");
    }
}
