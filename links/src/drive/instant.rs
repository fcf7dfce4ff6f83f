//! What the terms of the drive model see of one tick, and what they add to.

use runs::frames::Twist;

use crate::segment::Segment;

/// The state of the robot at one tick, as the terms of the drive model see it.
pub struct Instant<'a> {
    /// The piece of log.
    pub segment: &'a Segment,
    /// Index in the segment.
    pub tick: usize,
    /// Seconds since the start of the stretch.
    pub time_s: f64,
    /// Duty that acts, −1 to 1, one a wheel.
    pub duty: &'a [f64],
    /// Supply, V.
    pub supply: f64,
    /// Wheel speed, smoothed, rad/s.
    pub speed: &'a [f64],
    /// Direction of rotation, −1 to 1, smooth about 0.
    pub sign: &'a [f64],
    /// Torque of the winding at the wheel shaft, Nm.
    pub winding: &'a [f64],
    /// Torque of it by which the back-EMF brakes, Nm per rad/s of the wheel.
    pub braking: &'a [f64],
    /// Speed of the contact point in the direction in which the rollers roll, m/s.
    pub sideways: &'a [f64],
    /// Body twist.
    pub twist: Twist,
    /// Heading of the body x axis in the world, rad.
    pub heading: f64,
    /// Its cosine and sine.
    pub facing: [f64; 2],
    /// Place in the field, m.
    pub position: [f64; 2],
    /// What [`super::Prepare`] made, `[preparation][wheel][tick]`.
    pub prepared: &'a [Vec<Vec<f64>>],
    /// Metres that a contact slides per radian that its wheel turns, where friction turns round.
    pub(super) sliding_per_turning: f64,
}

impl Instant<'_> {
    /// Sideways speed of a contact over which its friction turns round, m/s.
    pub fn sliding(&self) -> f64 {
        self.segment.turning * self.sliding_per_turning
    }

    /// Cosine and sine of so many times the heading.
    pub fn facing_times(&self, times: f64) -> [f64; 2] {
        if !(0.0..8.0).contains(&times) || times.fract() != 0.0 {
            let (s, c) = (times * self.heading).sin_cos();
            return [c, s];
        }
        let [c, s] = self.facing;
        (0..times as u32).fold([1.0, 0.0], |[a, b], _| [a * c - b * s, a * s + b * c])
    }

    /// Body velocity in world axes, m/s.
    pub fn world_velocity(&self) -> [f64; 2] {
        let [c, s] = self.facing;
        [c * self.twist.vx - s * self.twist.vy, s * self.twist.vx + c * self.twist.vy]
    }
}

/// Torques and forces that terms add to.
pub struct Loads {
    /// At each wheel shaft, Nm, positive with the wheel's rotation.
    pub wheel: Vec<f64>,
    /// On what each shaft turns, Nm, likewise: of an axis on blocks the gear carries it, and loses its share of it.
    pub carried: Vec<f64>,
    /// On the body: to the right (N), forward (N), counter-clockwise (Nm).
    pub body: [f64; 3],
}

impl Loads {
    pub(super) fn none(wheels: usize) -> Self {
        Self { wheel: vec![0.0; wheels], carried: vec![0.0; wheels], body: [0.0; 3] }
    }

    /// Adds a force in world axes, N, at the chassis centre of a body that faces so.
    pub fn push_world(&mut self, facing: [f64; 2], force: [f64; 2]) {
        let [right, forward] = in_body(facing, force);
        self.body[0] += right;
        self.body[1] += forward;
    }
}

/// A force in world axes along those of a body that faces so.
pub(super) fn in_body([c, s]: [f64; 2], force: [f64; 2]) -> [f64; 2] {
    [c * force[0] + s * force[1], -s * force[0] + c * force[1]]
}
