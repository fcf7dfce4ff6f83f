//! A robot's outside: hull, mouth, dribbler, and where the ball touches it.

use crate::ball::Ball;
use crate::meet::Touch;
use runs::frames::{Pose, Twist};

/// A robot's outside: a round hull with a flat front, where dribbler and kicker are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hull {
    /// m.
    pub radius: f64,
    /// m.
    pub height: f64,
    /// From the centre to the front, m.
    pub front: f64,
}

/// What is left of the ball's speed against a hull and against a mouth, whose dribbler is soft.
const HULL: f64 = 0.5;
const MOUTH: f64 = 0.1;
/// Half the width of the mouth, m, and how far before the front the ball sensor sees, m.
const HALF_MOUTH: f64 = 0.035;
const SEEN: f64 = 0.003;
/// How far before the front the dribbler reaches, m.
const REACH: f64 = 0.01;
/// Acceleration with which a dribbler at full speed holds the ball, m/s², and that speed, rpm. An assumption: the floor
/// takes 3 m/s² of it, for a ball that is held slides, and 4 m/s² are more than a team's robot brakes with.
const HOLD: f64 = 7.0;
const FULL_RPM: f64 = 1000.0;
/// How fast a dribbler draws the ball in, 1/s.
const DRAW: f64 = 10.0;

impl Hull {
    /// A hull by the league's rules, a kicker's front as the teams have it.
    #[must_use]
    pub const fn standard() -> Self {
        Self { radius: 0.09, height: 0.15, front: 0.073 }
    }

    /// The ball's centre in the robot's body frame: to the right and forward, m.
    fn place(pose: Pose, ball: &Ball) -> [f64; 2] {
        pose.rotate_to_body([ball.position[0] - pose.x, ball.position[1] - pose.y])
    }

    /// Whether the ball sensor sees the ball.
    #[must_use]
    pub fn sees(&self, pose: Pose, ball: &Ball) -> bool {
        self.in_mouth(pose, ball, SEEN)
    }

    fn in_mouth(&self, pose: Pose, ball: &Ball, reach: f64) -> bool {
        let [right, forward] = Self::place(pose, ball);
        right.abs() < HALF_MOUTH
            && forward > 0.0
            && forward < self.front + Ball::RADIUS + reach
            && ball.position[2] < Ball::RADIUS
    }

    /// Where ball and robot overlap, as bodies of these numbers, the robot the first.
    #[must_use]
    pub fn touch(&self, bodies: [usize; 2], pose: Pose, twist: Twist, ball: &Ball) -> Option<Touch> {
        if ball.position[2] > self.height {
            return None;
        }
        let [right, forward] = Self::place(pose, ball);
        let flat = (self.radius * self.radius - self.front * self.front).max(0.0).sqrt();
        // The front turns with the robot; the rest of the hull is round, and its turn moves no ball.
        if forward > 0.0 && right.abs() < flat {
            let depth = self.front + Ball::RADIUS - forward;
            let [x, y] = pose.rotate_to_world([0.0, 1.0]);
            let touch = Touch { bodies, normal: [x, y], depth, surface: twist.omega * right, bounce: MOUTH };
            return (depth > 0.0).then_some(touch);
        }
        let places = [[pose.x, pose.y], [ball.position[0], ball.position[1]]];
        Touch::of_discs(bodies, places, self.radius + Ball::RADIUS, HULL)
    }

    /// The dribbler holds the ball for `dt` seconds: towards the middle of the mouth, no harder than rubber can.
    pub fn dribble(&self, pose: Pose, twist: Twist, dribbler_rpm: f64, ball: &mut Ball, dt: f64) {
        if dribbler_rpm <= 0.0 || !self.in_mouth(pose, ball, REACH) {
            return;
        }
        let place = Self::place(pose, ball);
        let [right, forward] = place;
        // The velocity of the robot's body where the ball is, in its frame.
        let body = [twist.vx - twist.omega * forward, twist.vy + twist.omega * right];
        let velocity = pose.rotate_to_body([ball.velocity[0], ball.velocity[1]]);
        let middle = [0.0, self.front + Ball::RADIUS];
        let most = HOLD * (dribbler_rpm / FULL_RPM).min(1.0) * dt;
        let wanted = [0, 1].map(|axis| body[axis] + DRAW * (middle[axis] - place[axis]) - velocity[axis]);
        let share = (most / wanted[0].hypot(wanted[1]).max(1e-12)).min(1.0);
        let velocity = [0, 1].map(|axis| velocity[axis] + share * wanted[axis]);
        [ball.velocity[0], ball.velocity[1]] = pose.rotate_to_world(velocity);
        ball.roll = [0.0; 2];
    }

    /// A kick where the ball sensor sees the ball: forward, added to the robot's own velocity.
    pub fn kick(&self, pose: Pose, twist: Twist, speed: f64, angle: f64, ball: &mut Ball) {
        if self.sees(pose, ball) {
            let [x, y] = pose.rotate_to_world([twist.vx, twist.vy + speed * angle.cos()]);
            ball.kick([x, y, speed * angle.sin()]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::meet::{Body, part};

    const DT: f64 = 1e-3;

    /// The ball against a robot that nothing moves.
    fn meet(hull: &Hull, pose: Pose, twist: Twist, ball: &mut Ball) {
        let body = |place: [f64; 2], velocity: [f64; 2], inverse_mass| Body { place, velocity, inverse_mass };
        let velocity = pose.rotate_to_world([twist.vx, twist.vy]);
        let [x, y, _] = ball.position;
        let mut bodies = [
            body([pose.x, pose.y], velocity, 0.0),
            body([x, y], [ball.velocity[0], ball.velocity[1]], 1.0 / Ball::MASS),
        ];
        if let Some(touch) = hull.touch([0, 1], pose, twist, ball) {
            part(&mut bodies, &[touch]);
            [ball.position[0], ball.position[1]] = bodies[1].place;
            [ball.velocity[0], ball.velocity[1]] = bodies[1].velocity;
        }
    }

    fn rolling(x: f64, y: f64, velocity: [f64; 3]) -> Ball {
        Ball { velocity, roll: [velocity[0], velocity[1]], ..Ball::at(x, y) }
    }

    #[test]
    fn a_ball_bounces_off_the_hull_and_never_lies_inside() {
        let hull = Hull::standard();
        for (from, velocity) in
            [([-1.0, 0.0], [2.0, 0.0, 0.0]), ([0.0, 1.0], [0.0, -2.0, 0.0]), ([0.6, -0.6], [-1.0, 1.0, 0.0])]
        {
            let mut ball = rolling(from[0], from[1], velocity);
            for _ in 0..1_000 {
                ball.step(DT, [5.0; 2]);
                meet(&hull, Pose::default(), Twist::default(), &mut ball);
                let [right, forward] = [ball.position[0], ball.position[1]];
                assert!(right.hypot(forward) > hull.front + Ball::RADIUS - 1e-6, "{ball:?}");
            }
            let back = ball.velocity[0] * velocity[0] + ball.velocity[1] * velocity[1];
            assert!(back <= 0.0, "{ball:?}");
        }
    }

    #[test]
    fn the_dribbler_holds_the_ball_backwards_and_loses_it_when_hurried() {
        let hull = Hull::standard();
        for (acceleration, holds) in [(3.0, true), (8.0, false)] {
            let mut ball = Ball::at(0.0, hull.front + Ball::RADIUS);
            let (mut pose, mut speed) = (Pose::default(), 0.0);
            for _ in 0..500 {
                speed -= acceleration * DT;
                pose.y += speed * DT;
                ball.step(DT, [50.0; 2]);
                hull.dribble(pose, Twist::new(0.0, speed, 0.0), 1_000.0, &mut ball, DT);
                meet(&hull, pose, Twist::new(0.0, speed, 0.0), &mut ball);
            }
            assert_eq!(hull.sees(pose, &ball) || hull.in_mouth(pose, &ball, REACH), holds, "{acceleration}: {ball:?}");
        }
    }

    #[test]
    fn a_kick_adds_to_the_robots_own_speed_and_needs_the_ball() {
        let hull = Hull::standard();
        let mut ball = Ball::at(0.0, hull.front + Ball::RADIUS);
        hull.kick(Pose::default(), Twist::new(0.0, 1.0, 0.0), 4.0, 0.0, &mut ball);
        assert_eq!(ball.velocity, [0.0, 5.0, 0.0]);
        let mut far = Ball::at(0.0, 0.2);
        hull.kick(Pose::default(), Twist::default(), 4.0, 0.0, &mut far);
        assert_eq!(far.velocity, [0.0; 3]);
    }
}
