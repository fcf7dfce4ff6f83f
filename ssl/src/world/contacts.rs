//! Robots, ball and boards as bodies that touch.

use super::World;
use crate::ball::Ball;
use crate::meet::{Body, Touch, part};

/// What is left of the speed of two hulls against each other, or of one against a board. An assumption: plastic covers,
/// nothing of a spring.
const ROBOTS: f64 = 0.2;
/// How often what was moved may have run into others in the same step.
const ROUNDS: usize = 8;
/// Overlaps that are not worth another round, m.
const OVERLAP: f64 = 1e-5;

impl World {
    /// Bodies that ran into each other in this step part.
    pub(super) fn meet(&mut self) {
        for round in 0..ROUNDS {
            let (mut bodies, touches) = self.touches();
            if round > 0 && touches.iter().all(|touch| touch.depth < OVERLAP) || touches.is_empty() {
                return;
            }
            let before = bodies.clone();
            part(&mut bodies, &touches);
            for (robot, (before, after)) in self.robots.values_mut().zip(before.iter().zip(&bodies)) {
                let change = |from: [f64; 2], to: [f64; 2]| [to[0] - from[0], to[1] - from[1]];
                if before != after {
                    robot.strike(change(before.place, after.place), change(before.velocity, after.velocity));
                }
            }
            let ball = &bodies[self.robots.len()];
            [self.ball.position[0], self.ball.position[1]] = ball.place;
            [self.ball.velocity[0], self.ball.velocity[1]] = ball.velocity;
        }
    }

    /// The robots in their order, the ball, and the boards as one body; and which of them overlap.
    fn touches(&self) -> (Vec<Body>, Vec<Touch>) {
        let (ball, boards) = (self.robots.len(), self.robots.len() + 1);
        let mut touches = Vec::new();
        let mut bodies: Vec<Body> = self.robots.values().map(crate::robot::SimulatedRobot::body).collect();
        let radii: Vec<f64> = self.robots.values().map(|robot| robot.kind().hull.radius).collect();
        for j in 1..bodies.len() {
            for i in 0..j {
                let places = [bodies[i].place, bodies[j].place];
                touches.extend(Touch::of_discs([i, j], places, radii[i] + radii[j], ROBOTS));
            }
        }
        for (i, robot) in self.robots.values().enumerate() {
            touches.extend(robot.kind().hull.touch([i, ball], robot.pose(), robot.twist(), &self.ball));
        }
        let ([x, y, _], [vx, vy, _]) = (self.ball.position, self.ball.velocity);
        bodies.push(Body { place: [x, y], velocity: [vx, vy], inverse_mass: 1.0 / Ball::MASS });
        bodies.push(Body::default());
        let half = self.field.half();
        for (i, body) in bodies[..boards].iter().enumerate() {
            let (radius, bounce) = if i == ball { (Ball::RADIUS, Ball::BOARD) } else { (radii[i], ROBOTS) };
            for axis in 0..2 {
                let depth = body.place[axis].abs() + radius - half[axis];
                // The ball's own step leaves it right at the board.
                if depth > -1e-9 {
                    let mut normal = [0.0; 2];
                    normal[axis] = 1.0_f64.copysign(body.place[axis]);
                    touches.push(Touch { bodies: [i, boards], normal, depth, surface: 0.0, bounce });
                }
            }
        }
        (bodies, touches)
    }
}
