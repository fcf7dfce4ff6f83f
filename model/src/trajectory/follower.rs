//! A controller for real robots: limits, corners, stops.

use super::{Limits, SetPoint, length_of};
use crate::motor::Axis;
use runs::frames::{Pose, Twist, wrap_angle};
use runs::geometry::{Geometry, GeometryError};
use runs::robot::Robot;

/// How closely to follow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FollowerOptions {
    /// How far the robot may swing out behind a set point it passes, m: sets the speed in corners.
    pub corner_m: f64,
    /// Distance at which a set point counts as reached, m.
    pub tolerance_m: f64,
    /// Error at which a heading counts as reached, rad.
    pub tolerance_rad: f64,
    /// Correction of an error across the path, and of a heading, 1/s.
    pub gain: f64,
    /// Without coming nearer for this long the robot counts as stuck, s.
    pub patience_s: f64,
    /// Lag of the speed loops, s: the command leads by as much while it accelerates.
    pub lead_s: f64,
}

impl Default for FollowerOptions {
    fn default() -> Self {
        Self { corner_m: 0.03, tolerance_m: 0.01, tolerance_rad: 0.02, gain: 4.0, patience_s: 3.0, lead_s: 0.0 }
    }
}

impl FollowerOptions {
    /// The defaults, with the lag of this robot's speed loops: its mass against the torque that the
    /// proportional gain makes of a speed error.
    ///
    /// # Errors
    /// [`GeometryError`] if the robot's wheels cannot drive it.
    pub fn of(robot: &Robot) -> Result<Self, GeometryError> {
        let geometry = robot.geometry()?;
        let stiffness = robot.pi.kp * Axis::of(robot).winding_torque(robot.supply_v, 0.0);
        let rows = geometry.inverse().row_iter();
        let damping = stiffness * 0.5 * rows.map(|r| r[0] * r[0] + r[1] * r[1]).sum::<f64>();
        // A loop without proportional gain has no lag that could be led.
        let lead_s = if damping > 0.0 { (robot.mass_kg / damping).min(LONGEST_LEAD_S) } else { 0.0 };
        Ok(Self { lead_s, ..Self::default() })
    }
}

/// Loops that lag by more than this are not worth leading: the command would be all lead.
const LONGEST_LEAD_S: f64 = 0.2;

/// A turn counts as coming nearer by what it moves the rim of a small robot, m.
const RIM_M: f64 = 0.09;

/// Share of the acceleration that is braked with: a reserve, because speed loops lag behind.
const BRAKING: f64 = 0.7;

/// What became of a set point, as far as the controller knows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Arrival {
    /// Not yet.
    Pending,
    /// Reached at a time (s), this far off (m).
    Reached {
        /// s.
        t: f64,
        /// Distance by the controller's pose, m.
        miss_m: f64,
    },
    /// Given up at a time (s), this far away (m): the robot no longer came nearer.
    Stuck {
        /// s.
        t: f64,
        /// Distance by the controller's pose, m.
        distance_m: f64,
    },
}

/// Follows set points along the straight lines between them.
///
/// Accelerations are limited and the speed before a corner is such that the robot swings out by
/// no more than [`FollowerOptions::corner_m`]; a wheel that would be too fast slows the whole
/// twist down. At a set point with `stop` the robot comes to rest, else it passes through; after
/// the last one it brakes. Errors across the line are corrected, so that a slow correction of the
/// pose by the camera draws the robot back to the path. A heading is turned to on the way, and at
/// the point as far as is left.
#[derive(Debug, Clone)]
pub struct Follower {
    set_points: Vec<SetPoint>,
    limits: Limits,
    options: FollowerOptions,
    geometry: Geometry,
    next: usize,
    from: [f64; 2],
    /// Speed at the corner of the next set point, m/s.
    corner: f64,
    /// Commanded velocity in the world, m/s, and rotation, rad/s.
    velocity: [f64; 2],
    omega: f64,
    t: f64,
    arrivals: Vec<Arrival>,
    nearest: f64,
    nearest_at: f64,
}

impl Follower {
    /// A follower at `start`, at rest.
    pub fn new(
        set_points: &[SetPoint],
        start: Pose,
        geometry: &Geometry,
        limits: Limits,
        options: FollowerOptions,
    ) -> Self {
        let mut follower = Self {
            set_points: set_points.to_vec(),
            limits,
            options,
            geometry: geometry.clone(),
            next: 0,
            from: [start.x, start.y],
            corner: f64::INFINITY,
            velocity: [0.0; 2],
            omega: 0.0,
            t: 0.0,
            arrivals: vec![Arrival::Pending; set_points.len()],
            nearest: f64::INFINITY,
            nearest_at: 0.0,
        };
        follower.corner = follower.corner_speed();
        follower
    }

    /// What became of each set point so far.
    pub fn arrivals(&self) -> &[Arrival] {
        &self.arrivals
    }

    /// The body twist for the coming `dt` seconds, from where the robot is believed to be; `None`
    /// once the robot rests after the last set point, or gave up.
    pub fn command(&mut self, pose: Pose, dt: f64) -> Option<Twist> {
        let mut wanted = self.wanted(pose);
        let at_rest = self.velocity == [0.0; 2] && self.omega == 0.0;
        if self.next >= self.set_points.len() {
            if at_rest {
                return None;
            }
            wanted = ([0.0; 2], 0.0);
        }
        Some(self.step_towards(wanted, pose, dt))
    }

    /// The body twist for the coming `dt` seconds of a robot that must not go on: it brakes and turns at a rate, rad/s. Its
    /// patience begins anew: afterwards it may know that it is farther away than it ever believed.
    pub fn hold(&mut self, pose: Pose, turn: f64, dt: f64) -> Twist {
        (self.nearest, self.nearest_at) = (f64::INFINITY, self.t + dt);
        self.step_towards(([0.0; 2], turn), pose, dt)
    }

    /// A tick towards a velocity in the world and a rate of turn, within the limits.
    fn step_towards(&mut self, (velocity, omega): ([f64; 2], f64), pose: Pose, dt: f64) -> Twist {
        let step = self.limited_step([velocity[0] - self.velocity[0], velocity[1] - self.velocity[1]], dt);
        self.velocity = [self.velocity[0] + step[0], self.velocity[1] + step[1]];
        let turn = self.limits.angular_acceleration * dt;
        self.omega += (omega - self.omega).clamp(-turn, turn);
        // The body turns during the tick; aim along its mean heading.
        let heading = Pose { theta: pose.theta + 0.5 * self.omega * dt, ..pose };
        let twist = heading.body_twist([self.velocity[0], self.velocity[1], self.omega]);
        let limited = self.limits.within_wheel_speed(twist, &self.geometry);
        if limited != twist {
            let [x, y, w] = heading.world_velocity(limited);
            (self.velocity, self.omega) = ([x, y], w);
        }
        self.t += dt;
        let lead = self.options.lead_s / dt;
        let [lead_x, lead_y] = heading.rotate_to_body(step.map(|v| v * lead));
        Twist::new(limited.vx + lead_x, limited.vy + lead_y, limited.omega)
    }

    /// A change of velocity within the acceleration limit. What goes across the leg comes first, so
    /// that a robot out of a corner is back on its line before it speeds up.
    fn limited_step(&self, change: [f64; 2], dt: f64) -> [f64; 2] {
        let allowed = self.limits.acceleration * dt;
        let u = self.set_points.get(self.next).map_or([0.0; 2], |p| [p.x - self.from[0], p.y - self.from[1]]);
        let length = length_of(u);
        if length == 0.0 || length_of(change) <= allowed {
            let share = (allowed / length_of(change).max(1e-12)).min(1.0);
            return [share * change[0], share * change[1]];
        }
        let u = [u[0] / length, u[1] / length];
        let (along, across) = (change[0] * u[0] + change[1] * u[1], change[1] * u[0] - change[0] * u[1]);
        let across = across.clamp(-allowed, allowed);
        let rest = (allowed * allowed - across * across).max(0.0).sqrt();
        let along = along.clamp(-rest, rest);
        [along * u[0] - across * u[1], along * u[1] + across * u[0]]
    }

    /// World velocity and rotation towards the next set point; moves on to it where one is reached.
    fn wanted(&mut self, pose: Pose) -> ([f64; 2], f64) {
        while let Some(target) = self.set_points.get(self.next).copied() {
            let leg = [target.x - self.from[0], target.y - self.from[1]];
            let length = length_of(leg);
            let to_go = [target.x - pose.x, target.y - pose.y];
            let distance = length_of(to_go);
            let along = if length > 0.0 { (to_go[0] * leg[0] + to_go[1] * leg[1]) / length } else { 0.0 };
            let to_turn = target.heading.filter(|_| target.stop).map(|heading| wrap_angle(heading - pose.theta));
            let off = to_turn.map_or(0.0, f64::abs);
            let slow = length_of(self.velocity) < 0.02 && (to_turn.is_none() || RIM_M * self.omega.abs() < 0.02);
            let arrived = if target.stop {
                distance <= self.options.tolerance_m && off <= self.options.tolerance_rad && slow
            } else {
                distance <= self.options.tolerance_m || along <= 0.0
            };
            if arrived {
                self.move_on(Arrival::Reached { t: self.t, miss_m: distance }, target);
                continue;
            }
            let left = distance + RIM_M * off;
            if left < self.nearest - 0.005 {
                (self.nearest, self.nearest_at) = (left, self.t);
            }
            if self.t - self.nearest_at > self.options.patience_s {
                self.arrivals[self.next] = Arrival::Stuck { t: self.t, distance_m: distance };
                self.next = self.set_points.len();
                break;
            }
            let omega = to_turn.map_or(target.omega, |angle| self.turning(target, angle));
            return (self.towards(target, to_go, leg, length, along), omega);
        }
        ([0.0; 2], 0.0)
    }

    /// Rate of the turn to a heading, so that it ends without overshoot.
    fn turning(&self, target: SetPoint, angle: f64) -> f64 {
        let braking = BRAKING * self.limits.angular_acceleration;
        let rate = (2.0 * braking * angle.abs()).sqrt().min(self.options.gain * angle.abs());
        rate.min(target.omega.abs()).copysign(angle)
    }

    fn move_on(&mut self, arrival: Arrival, target: SetPoint) {
        self.arrivals[self.next] = arrival;
        self.next += 1;
        self.from = [target.x, target.y];
        (self.nearest, self.nearest_at) = (f64::INFINITY, self.t);
        self.corner = self.corner_speed();
    }

    fn towards(&self, target: SetPoint, to_go: [f64; 2], leg: [f64; 2], length: f64, along: f64) -> [f64; 2] {
        let distance = length_of(to_go);
        let cruise = target.v.min(self.limits.speed);
        let end = if target.stop { 0.0 } else { self.corner.min(cruise) };
        let braking = BRAKING * self.limits.acceleration;
        let room = if target.stop { distance } else { along.max(0.0) };
        let mut speed = cruise.min((end * end + 2.0 * braking * room).sqrt());
        if target.stop {
            // The last centimetres without overshoot.
            speed = speed.min(self.options.gain * distance);
        }
        if length == 0.0 || distance < 2.0 * self.options.tolerance_m {
            let scale = speed / distance.max(1e-9);
            return [to_go[0] * scale, to_go[1] * scale];
        }
        let u = [leg[0] / length, leg[1] / length];
        // From the robot back to the line.
        let across = [to_go[0] - along * u[0], to_go[1] - along * u[1]];
        let off = length_of(across);
        let back = (self.options.gain * off).min(0.5 * speed + 0.05) / off.max(1e-9);
        // A stop that was passed is approached from the other side.
        let forward = if target.stop { along.clamp(-0.1, 0.1) * 10.0 * speed } else { speed };
        let wanted = [u[0] * forward + across[0] * back, u[1] * forward + across[1] * back];
        let scale = (cruise / length_of(wanted).max(1e-9)).min(1.0);
        [wanted[0] * scale, wanted[1] * scale]
    }

    /// Speed at which the turn into the next leg swings out by `corner_m`: a change of velocity of
    /// 2·v·sin(φ/2) at constant acceleration a leads past the corner by about v²·sin²(φ/2)/(2a).
    fn corner_speed(&self) -> f64 {
        let (Some(target), Some(next)) = (self.set_points.get(self.next), self.set_points.get(self.next + 1)) else {
            return f64::INFINITY;
        };
        let leg = [target.x - self.from[0], target.y - self.from[1]];
        let out = [next.x - target.x, next.y - target.y];
        let (cross, dot) = (leg[0] * out[1] - leg[1] * out[0], leg[0] * out[0] + leg[1] * out[1]);
        let half_turn = (0.5 * cross.atan2(dot)).sin().abs();
        (2.0 * self.limits.acceleration * self.options.corner_m).sqrt() / half_turn.max(1e-6)
    }
}
