//! What a robot was last told, as the body velocity of every tick.

use driver::drive::Steer;
use model::trajectory::Limits;
use runs::frames::{Pose, Twist};
use runs::geometry::{Geometry, GeometryError};
use runs::robot::Robot;
use std::cell::RefCell;
use std::rc::Rc;

/// Silence after which a robot is to stand, s: the league's simulators do so.
pub const SILENCE_S: f64 = 0.1;

/// A velocity in one of two frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// In the robot's body frame.
    Local(Twist),
    /// Along the field's axes: m/s, m/s, rad/s.
    Global([f64; 3]),
}

/// A kick, as soon as the ball is there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kick {
    /// m/s, of the ball against the robot, in three dimensions.
    pub speed: f64,
    /// Elevation, rad.
    pub angle: f64,
}

/// What a robot is to do until it is told otherwise.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Order {
    /// How to move; `None`: to stand.
    pub motion: Option<Motion>,
    /// Kick to give; `None`: none.
    pub kick: Option<Kick>,
    /// Speed of the dribbler, rpm.
    pub dribbler_rpm: f64,
}

/// Limits of the commanded velocity: what the motors allow, or less.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Caps {
    /// While it becomes faster: m/s², rad/s².
    pub speed_up: [f64; 2],
    /// While it becomes slower: m/s², rad/s².
    pub brake: [f64; 2],
    /// m/s, rad/s.
    pub velocity: [f64; 2],
}

impl Caps {
    /// What a robot's motors allow.
    #[must_use]
    pub fn of(limits: &Limits) -> Self {
        let acceleration = [limits.acceleration, limits.angular_acceleration];
        Self { speed_up: acceleration, brake: acceleration, velocity: [limits.speed, f64::INFINITY] }
    }
}

/// The pilot of one robot.
///
/// It brings the body velocity to the commanded one no faster than the [`Caps`] allow, and slows the whole twist down
/// where a wheel would be too fast; below these limits a command is passed on as it is. After [`SILENCE_S`] without an
/// order the robot is to stand, and neither kicks nor dribbles.
#[derive(Clone, Debug)]
pub struct Pilot {
    geometry: Geometry,
    limits: Limits,
    /// Limits in force.
    pub caps: Caps,
    /// The heading that turns global velocities, where somebody knows better than the robot.
    pub heading: Option<f64>,
    order: Order,
    /// Since the last order, s.
    silence_s: f64,
    velocity: Twist,
}

impl Pilot {
    /// The pilot of a robot at rest, without an order.
    ///
    /// # Errors
    /// [`GeometryError`] where the wheels cannot drive the robot.
    pub fn new(robot: &Robot) -> Result<Self, GeometryError> {
        let limits = Limits::of(robot)?;
        Ok(Self {
            geometry: robot.geometry()?,
            caps: Caps::of(&limits),
            limits,
            heading: None,
            order: Order::default(),
            silence_s: f64::INFINITY,
            velocity: Twist::default(),
        })
    }

    /// What the motors allow.
    #[must_use]
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// The kinematics that the robot believes in.
    #[must_use]
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// A new order. An order without a motion leaves the motion as it was.
    pub fn order(&mut self, order: Order) {
        let motion = order.motion.or(self.order_in_force().motion);
        self.order = Order { motion, ..order };
        self.silence_s = 0.0;
    }

    /// The order in force: after [`SILENCE_S`] none.
    #[must_use]
    pub fn order_in_force(&self) -> Order {
        if self.silence_s > SILENCE_S { Order::default() } else { self.order }
    }

    /// Whether nothing is asked for but to stand.
    #[must_use]
    pub fn asks_for_rest(&self) -> bool {
        let rest = |motion| match motion {
            Motion::Local(twist) => twist == Twist::default(),
            Motion::Global(velocity) => velocity == [0.0; 3],
        };
        self.order_in_force().motion.is_none_or(rest)
    }

    /// The velocity to begin from, after a teleport or a fault.
    pub fn begin(&mut self, velocity: Twist) {
        self.velocity = velocity;
    }

    /// Lets time pass without a robot that could drive.
    pub fn wait(&mut self, dt: f64) {
        self.silence_s += dt;
        self.velocity = Twist::default();
    }

    /// The body velocity for the coming `dt` seconds.
    fn velocity(&mut self, heading: f64, dt: f64) -> Twist {
        self.silence_s += dt;
        let wanted = match self.order_in_force().motion {
            None => Twist::default(),
            Some(Motion::Local(twist)) => twist,
            Some(Motion::Global(velocity)) => Pose::new(0.0, 0.0, heading).body_twist(velocity),
        };
        let [fastest, fastest_turn] = self.caps.velocity;
        let share = (fastest / wanted.speed().max(1e-9)).min(1.0);
        let wanted = Twist::new(wanted.vx * share, wanted.vy * share, wanted.omega.clamp(-fastest_turn, fastest_turn));
        let wanted = self.limits.within_wheel_speed(wanted, &self.geometry);
        let now = self.velocity;
        let slower = |to: f64, from: f64, i: usize| if to < from { self.caps.brake[i] } else { self.caps.speed_up[i] };
        let (dx, dy) = (wanted.vx - now.vx, wanted.vy - now.vy);
        let step = slower(wanted.speed(), now.speed(), 0) * dt;
        let share = (step / dx.hypot(dy).max(1e-12)).min(1.0);
        let turn = slower(wanted.omega.abs(), now.omega.abs(), 1) * dt;
        let omega = now.omega + (wanted.omega - now.omega).clamp(-turn, turn);
        let next = Twist::new(now.vx + share * dx, now.vy + share * dy, omega);
        self.velocity = self.limits.within_wheel_speed(next, &self.geometry);
        self.velocity
    }
}

/// A pilot that a session steers by and a front gives orders to; clones are the same one.
#[derive(Clone, Debug)]
pub struct SharedPilot(pub Rc<RefCell<Pilot>>);

impl Steer for SharedPilot {
    fn command(&mut self, pose: Pose, dt: f64) -> Option<Twist> {
        let mut pilot = self.0.borrow_mut();
        let heading = pilot.heading.unwrap_or(pose.theta);
        Some(pilot.velocity(heading, dt))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pilot() -> Pilot {
        Pilot::new(&Robot::racbot()).unwrap()
    }

    fn told(motion: Motion) -> Pilot {
        let mut pilot = pilot();
        pilot.order(Order { motion: Some(motion), ..Order::default() });
        pilot
    }

    #[test]
    fn a_command_is_reached_by_the_acceleration_and_kept_to_the_bit() {
        let asked = Twist::new(0.02, 0.04, -0.5);
        let mut pilot = told(Motion::Local(asked));
        let first = pilot.velocity(0.0, 1e-3);
        assert!((first.speed() - 1e-3 * pilot.caps.speed_up[0]).abs() < 1e-12, "{first:?}");
        let last = (0..80).map(|_| pilot.velocity(0.0, 1e-3)).last().unwrap();
        assert_eq!(last, asked);
    }

    #[test]
    fn a_tenth_of_a_second_of_silence_brings_it_to_rest() {
        let mut pilot = told(Motion::Local(Twist::new(0.0, 0.1, 0.0)));
        let speeds: Vec<f64> = (0..300).map(|_| pilot.velocity(0.0, 1e-3).speed()).collect();
        assert!(speeds[98] > 0.09 && speeds[105] < speeds[98], "{:?}", &speeds[95..110]);
        assert_eq!(speeds[299], 0.0);
        assert!(pilot.asks_for_rest());
    }

    #[test]
    fn global_velocities_are_turned_by_the_heading() {
        let mut pilot = told(Motion::Global([0.05, 0.0, 0.0]));
        let heading = std::f64::consts::FRAC_PI_2;
        let last = (0..90).map(|_| pilot.velocity(heading, 1e-3)).last().unwrap();
        assert!(last.vx.abs() < 1e-12 && (last.vy + 0.05).abs() < 1e-12, "{last:?}");
    }

    #[test]
    fn a_wheel_that_would_be_too_fast_slows_the_whole_twist() {
        let mut pilot = told(Motion::Local(Twist::new(3e38, 3e38, 3e38)));
        let last = (0..99).map(|_| pilot.velocity(0.0, 1.0)).last().unwrap();
        let fastest = pilot.geometry.wheel_speeds(last).iter().fold(0.0, |m: f64, w| m.max(w.abs()));
        assert!(fastest <= pilot.limits.wheel_speed * (1.0 + 1e-9) && last.speed().is_finite());
    }
}
