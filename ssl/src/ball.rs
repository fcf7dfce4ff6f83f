//! The ball: sliding, then rolling; hops of a chip kick; robots and boards that it bounces off.
//!
//! A sphere on a floor: sliding friction slows the ball and spins it up until surface and floor move together, which is at
//! 5/7 of the speed of a kick without spin; from then on only rolling resistance acts. The constants are those that the
//! geometry message tells the teams ([`Ball::SLIDING`] and so on), so that a filter predicts this ball exactly. They are
//! assumptions about a carpet, not measured here.

/// Standard gravity, m/s².
const GRAVITY: f64 = model::plant::GRAVITY;

/// The league's golf ball, in field coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ball {
    /// Centre above the field: x, y, and height of the lowest point over the floor, m.
    pub position: [f64; 3],
    /// m/s.
    pub velocity: [f64; 3],
    /// Speed of the surface by the spin, as a velocity over the floor, m/s: equal to the velocity when rolling.
    pub roll: [f64; 2],
    /// Hops since the last chip kick.
    pub hops: u32,
}

impl Ball {
    /// Radius, m.
    pub const RADIUS: f64 = 0.0215;
    /// kg.
    pub const MASS: f64 = 0.046;
    /// Deceleration while sliding, m/s².
    pub const SLIDING: f64 = 3.0;
    /// Deceleration while rolling, m/s².
    pub const ROLLING: f64 = 0.26;
    /// Share of the speed of a kick without spin at which a solid sphere begins to roll.
    pub const SWITCH: f64 = 5.0 / 7.0;
    /// What is left of the speed over the floor after the first hop and after others, and of the speed upwards.
    pub const HOP: [f64; 3] = [0.75, 0.95, 0.5];
    /// A hop lower than this is none, m.
    const LEAST_HOP: f64 = 0.005;
    /// What is left of the speed against a board around the field.
    pub(crate) const BOARD: f64 = 0.5;

    /// A ball at rest.
    #[must_use]
    pub fn at(x: f64, y: f64) -> Self {
        Self { position: [x, y, 0.0], ..Self::default() }
    }

    /// Whether it is in the air.
    #[must_use]
    pub fn flies(&self) -> bool {
        self.position[2] > 0.0 || self.velocity[2] > 0.0
    }

    /// Kicked from where it is, without spin: velocity over the floor and upwards, m/s.
    pub fn kick(&mut self, velocity: [f64; 3]) {
        self.velocity = velocity;
        self.roll = [0.0; 2];
        self.hops = 0;
    }

    /// Lets `dt` seconds pass; `half` is half the length and width of the floor between its boards, m.
    pub fn step(&mut self, dt: f64, half: [f64; 2]) {
        if self.flies() {
            self.fly(dt);
        } else {
            self.run(dt);
        }
        for (axis, half) in half.into_iter().enumerate() {
            let limit = half - Self::RADIUS;
            if self.position[axis].abs() > limit {
                self.position[axis] = limit.copysign(self.position[axis]);
                if self.velocity[axis] * self.position[axis] > 0.0 {
                    self.velocity[axis] *= -Self::BOARD;
                    self.roll[axis] = 0.0;
                }
            }
        }
    }

    fn fly(&mut self, dt: f64) {
        for axis in 0..2 {
            self.position[axis] += dt * self.velocity[axis];
        }
        // A parabola, exactly.
        self.position[2] += dt * (self.velocity[2] - 0.5 * dt * GRAVITY);
        self.velocity[2] -= dt * GRAVITY;
        if self.position[2] <= 0.0 && self.velocity[2] < 0.0 {
            let [first, others, upwards] = Self::HOP;
            let left = if self.hops == 0 { first } else { others };
            self.hops += 1;
            self.position[2] = 0.0;
            self.velocity = [left * self.velocity[0], left * self.velocity[1], -upwards * self.velocity[2]];
            if self.velocity[2] * self.velocity[2] < 2.0 * GRAVITY * Self::LEAST_HOP {
                self.velocity[2] = 0.0;
            }
            // A ball that touched down rolls.
            self.roll = [self.velocity[0], self.velocity[1]];
        }
    }

    fn run(&mut self, dt: f64) {
        let before = [self.velocity[0], self.velocity[1]];
        let slip = [before[0] - self.roll[0], before[1] - self.roll[1]];
        let slipping = slip[0].hypot(slip[1]);
        // The slip falls by 7/2 of the deceleration, because the spin grows by 5/2 of it.
        let change = Self::SLIDING * dt;
        if slipping > 3.5 * change {
            for (axis, slip) in slip.into_iter().enumerate() {
                let part = change * slip / slipping;
                self.velocity[axis] -= part;
                self.roll[axis] += 2.5 * part;
            }
        } else {
            let rolling = [before[0] - slip[0] / 3.5, before[1] - slip[1] / 3.5];
            let speed = rolling[0].hypot(rolling[1]);
            let left = if speed > 0.0 { (1.0 - Self::ROLLING * dt / speed).max(0.0) } else { 0.0 };
            self.roll = rolling.map(|v| v * left);
            self.velocity = [self.roll[0], self.roll[1], 0.0];
        }
        for (axis, before) in before.into_iter().enumerate() {
            self.position[axis] += 0.5 * dt * (before + self.velocity[axis]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDE: [f64; 2] = [100.0; 2];

    fn kicked(velocity: [f64; 3]) -> Ball {
        let mut ball = Ball::at(0.0, 0.0);
        ball.kick(velocity);
        ball
    }

    #[test]
    fn it_slides_to_five_sevenths_and_then_rolls_out() {
        let mut ball = kicked([6.0, 0.0, 0.0]);
        let mut t = 0.0_f64;
        while (ball.velocity[0] - ball.roll[0]).abs() > 1e-9 {
            ball.step(1e-3, WIDE);
            t += 1e-3;
        }
        // v0 (1 - 5/7) / 3 m/s², and 5/7 of 6 m/s less what a step of rolling took.
        assert!((t - 6.0 * 2.0 / 7.0 / 3.0).abs() < 2e-3, "{t}");
        assert!((ball.velocity[0] - 6.0 * Ball::SWITCH).abs() < 2e-3);
        let (from, speed) = (ball.position[0], ball.velocity[0]);
        for _ in 0..20_000 {
            ball.step(1e-3, WIDE);
        }
        assert_eq!(ball.velocity, [0.0; 3]);
        assert!((ball.position[0] - from - speed * speed / (2.0 * Ball::ROLLING)).abs() < 1e-2);
    }

    #[test]
    fn a_chip_lands_where_the_parabola_ends_and_hops_with_the_losses_told() {
        let mut ball = kicked([3.0, 0.0, 4.0]);
        while ball.hops == 0 {
            ball.step(1e-3, WIDE);
        }
        let flight = 2.0 * 4.0 / GRAVITY;
        assert!((ball.position[0] - 3.0 * flight).abs() < 4e-3, "{ball:?}");
        assert!((ball.velocity[0] - 3.0 * 0.75).abs() < 1e-12 && (ball.velocity[2] - 2.0).abs() < 0.01);
        for _ in 0..5_000 {
            ball.step(1e-3, WIDE);
        }
        assert!(!ball.flies() && ball.hops > 2 && ball.roll == [ball.velocity[0], ball.velocity[1]]);
    }

    #[test]
    fn boards_keep_it_on_the_field() {
        let mut ball = kicked([8.0, 5.0, 0.0]);
        for _ in 0..5_000 {
            ball.step(1e-3, [2.0, 1.0]);
            assert!(ball.position[0].abs() < 2.0 && ball.position[1].abs() < 1.0);
        }
    }
}
