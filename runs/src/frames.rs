//! Frames, twists and poses.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::Matrix3;

/// Velocity of the platform in its own **body frame**.
///
/// Conventions (those of the paper's equation (1)): x to the right, y forward (wheel 1 is at the
/// front), ω counter-clockwise seen from above; origin at the chassis centre.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Twist {
    /// To the right, m/s.
    pub vx: f64,
    /// Forward, m/s.
    pub vy: f64,
    /// Counter-clockwise, rad/s.
    pub omega: f64,
}

impl Twist {
    /// A twist from right, forward (m/s) and counter-clockwise (rad/s).
    pub const fn new(vx: f64, vy: f64, omega: f64) -> Self {
        Self { vx, vy, omega }
    }

    /// Speed of the chassis centre, m/s, not negative.
    pub fn speed(self) -> f64 {
        self.vx.hypot(self.vy)
    }

    /// All three components times a factor.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self::new(self.vx * factor, self.vy * factor, self.omega * factor)
    }
}

/// Position and heading of the body frame in the **world frame**, which is the camera's field frame.
///
/// θ is the angle from the field's x axis to the robot's body **x** axis, counter-clockwise, in
/// radians. The league's orientation points forward (body y): [`Pose::league_theta`].
/// θ is not wrapped by the arithmetic here, so that headings can be subtracted; wrap with
/// [`wrap_angle`] where one is shown or logged.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pose {
    /// Field x, m.
    pub x: f64,
    /// Field y, m.
    pub y: f64,
    /// Heading of the body x axis, rad.
    pub theta: f64,
}

impl Pose {
    /// A pose from field x, y (m) and heading of the body x axis (rad).
    pub const fn new(x: f64, y: f64, theta: f64) -> Self {
        Self { x, y, theta }
    }

    /// A body-frame vector in world axes.
    pub fn rotate_to_world(self, vector: [f64; 2]) -> [f64; 2] {
        let (s, c) = self.theta.sin_cos();
        [c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]]
    }

    /// A world-frame vector in body axes.
    pub fn rotate_to_body(self, vector: [f64; 2]) -> [f64; 2] {
        let (s, c) = self.theta.sin_cos();
        [c * vector[0] + s * vector[1], -s * vector[0] + c * vector[1]]
    }

    /// Body twist to world velocity (ẋ, ẏ, θ̇).
    pub fn world_velocity(self, twist: Twist) -> [f64; 3] {
        let [x, y] = self.rotate_to_world([twist.vx, twist.vy]);
        [x, y, twist.omega]
    }

    /// World velocity (ẋ, ẏ, θ̇) to body twist.
    pub fn body_twist(self, velocity: [f64; 3]) -> Twist {
        let [vx, vy] = self.rotate_to_body([velocity[0], velocity[1]]);
        Twist::new(vx, vy, velocity[2])
    }

    /// `self ∘ local`: the world pose of something whose pose in this body frame is `local`.
    #[must_use]
    pub fn compose(self, local: Self) -> Self {
        let [x, y] = self.rotate_to_world([local.x, local.y]);
        Self::new(self.x + x, self.y + y, self.theta + local.theta)
    }

    /// The pose of the world in this frame, so that `p.inverse().compose(p)` is the identity.
    #[must_use]
    pub fn inverse(self) -> Self {
        let [x, y] = self.rotate_to_body([-self.x, -self.y]);
        Self::new(x, y, -self.theta)
    }

    /// The pose of `other` seen from this one: `self.compose(self.relative(other)) == other`.
    #[must_use]
    pub fn relative(self, other: Self) -> Self {
        let [x, y] = self.rotate_to_body([other.x - self.x, other.y - self.y]);
        Self::new(x, y, other.theta - self.theta)
    }

    /// The pose after moving with a constant body twist for `dt` seconds: the SE(2) exponential,
    /// exact for any rotation (Euler integration is not).
    #[must_use]
    pub fn advance(self, twist: Twist, dt: f64) -> Self {
        self.compose(displacement(twist.scaled(dt)))
    }

    /// Distance between the two positions, m.
    pub fn distance(self, other: Self) -> f64 {
        (other.x - self.x).hypot(other.y - self.y)
    }

    /// The league's orientation: angle from the field's x axis to the robot's **forward**
    /// direction, θ + π/2, wrapped.
    pub fn league_theta(self) -> f64 {
        wrap_angle(self.theta + FRAC_PI_2)
    }

    /// A pose from the league's position and orientation.
    pub fn from_league(x: f64, y: f64, orientation: f64) -> Self {
        Self::new(x, y, wrap_angle(orientation - FRAC_PI_2))
    }
}

/// SE(2) exponential of a body displacement (m, m, rad): the pose reached, in the start frame.
pub fn displacement(d: Twist) -> Pose {
    let (a, b) = chord(d.omega);
    Pose::new(a * d.vx - b * d.vy, b * d.vx + a * d.vy, d.omega)
}

/// sin ω/ω and (1 − cos ω)/ω: a chord along and across the direction in which its arc of 1 begins.
#[inline]
fn chord(w: f64) -> (f64, f64) {
    if w.abs() > SMALL_RAD {
        let (s, c) = w.sin_cos();
        return (s / w, (1.0 - c) / w);
    }
    small_chord(w)
}

/// Length of the chord of an arc of 1 along and across the direction in which the arc begins, for a turn of at most
/// [`SMALL_RAD`]: sin w/w and (1 − cos w)/w.
#[inline(always)]
pub fn small_chord(w: f64) -> (f64, f64) {
    // Series, because the second quotient cancels; the next terms are below 1e-17.
    let w2 = w * w;
    let a = 1.0 - w2 * (1.0 / 6.0 - w2 * (1.0 / 120.0 - w2 * (1.0 / 5_040.0 - w2 * (1.0 / 362_880.0))));
    let b = 0.5 - w2 * (1.0 / 24.0 - w2 * (1.0 / 720.0 - w2 * (1.0 / 40_320.0 - w2 * (1.0 / 3_628_800.0))));
    (a, w * b)
}

/// Sine and cosine of an angle that is mostly as small as the turn of a robot in a control tick: there by their series.
#[inline]
pub fn small_sin_cos(angle: f64) -> (f64, f64) {
    if angle.abs() > SMALL_RAD {
        return angle.sin_cos();
    }
    let (a, b) = chord(angle);
    (angle * a, 1.0 - angle * b)
}

/// Angles up to which five terms of a series are exact to the last bit or two, rad.
pub const SMALL_RAD: f64 = 0.05;

/// The body displacement that leads to a pose in the start frame: the SE(2) logarithm, inverse of [`displacement`] for
/// turns of less than half a circle.
pub fn displacement_to(pose: Pose) -> Twist {
    let half = 0.5 * pose.theta;
    // θ/2 · cot(θ/2), by its series where the quotient loses digits.
    let a = if half.abs() < 1e-4 { 1.0 - half * half / 3.0 } else { half / half.tan() };
    Twist::new(a * pose.x + half * pose.y, a * pose.y - half * pose.x, pose.theta)
}

/// A pose on its way, for many small displacements one after the other: the cosine and sine of the
/// heading turn with it, so that no step needs a trigonometric function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walk {
    pose: Pose,
    cos: f64,
    sin: f64,
}

impl Walk {
    /// A walk that begins at `pose`.
    #[inline]
    pub fn from(pose: Pose) -> Self {
        let (sin, cos) = pose.theta.sin_cos();
        Self { pose, cos, sin }
    }

    /// From a pose whose heading has this cosine and sine.
    #[inline]
    pub fn turned(pose: Pose, cos: f64, sin: f64) -> Self {
        Self { pose, cos, sin }
    }

    /// From the origin by one displacement: as [`displacement`].
    #[inline]
    pub fn by(d: Twist) -> Self {
        if d.omega.abs() > SMALL_RAD {
            return Self::from(displacement(d));
        }
        let (a, b) = small_chord(d.omega);
        let pose = Pose::new(a * d.vx - b * d.vy, b * d.vx + a * d.vy, d.omega);
        Self { pose, cos: 1.0 - d.omega * b, sin: d.omega * a }
    }

    /// Where it is, heading not wrapped.
    #[inline]
    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// On from here by what leads somewhere from the origin: as [`Pose::compose`].
    #[inline]
    #[must_use]
    pub fn then(&self, local: &Self) -> Self {
        let (p, q) = (self.pose, local.pose);
        Self {
            pose: Pose::new(
                p.x + (self.cos * q.x - self.sin * q.y),
                p.y + (self.sin * q.x + self.cos * q.y),
                p.theta + q.theta,
            ),
            cos: self.cos * local.cos - self.sin * local.sin,
            sin: self.sin * local.cos + self.cos * local.sin,
        }
    }

    /// The way back: as [`Pose::inverse`].
    #[inline]
    #[must_use]
    pub fn inverse(&self) -> Self {
        let (p, cos, sin) = (self.pose, self.cos, -self.sin);
        Self { pose: Pose::new(-(cos * p.x - sin * p.y), -(sin * p.x + cos * p.y), -p.theta), cos, sin }
    }

    /// The same as `pose.compose(displacement(d))`, to 1e-12 after many thousand.
    #[inline]
    pub fn step(&mut self, d: Twist) {
        *self = self.then(&Self::by(d));
    }
}

/// Standard deviation of a place in the direction where it is largest, m, by the covariance of x, y (m²) and heading.
pub fn place_sd(covariance: &Matrix3<f64>) -> f64 {
    let [xx, xy, yy] = [(0, 0), (0, 1), (1, 1)].map(|i| covariance[i]);
    (0.5 * (xx + yy) + (0.5 * (xx - yy)).hypot(xy)).sqrt()
}

/// The angle in [−π, π) equal to `angle` up to whole turns.
pub fn wrap_angle(angle: f64) -> f64 {
    if (-PI..PI).contains(&angle) {
        return angle;
    }
    let wrapped = (angle + PI).rem_euclid(TAU) - PI;
    // rem_euclid may round up to the modulus itself.
    if wrapped >= PI { -PI } else { wrapped }
}

/// A velocity command as the SSL's team software sends it (`MoveLocalVelocity`).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LeagueCommand {
    /// Forward, m/s.
    pub forward: f64,
    /// To the left, m/s.
    pub left: f64,
    /// Counter-clockwise, rad/s.
    pub angular: f64,
}

impl From<LeagueCommand> for Twist {
    fn from(c: LeagueCommand) -> Self {
        Self::new(-c.left, c.forward, c.angular)
    }
}

impl From<Twist> for LeagueCommand {
    fn from(t: Twist) -> Self {
        Self { forward: t.vy, left: -t.vx, angular: t.omega }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_walk_ends_where_its_displacements_lead() {
        for step in [1e-6, 0.004, 0.03, 0.4] {
            let (mut walk, mut pose) = (Walk::from(Pose::new(1.0, -2.0, 0.7)), Pose::new(1.0, -2.0, 0.7));
            for k in 0..2000 {
                let d = Twist::new(0.001, 0.002 * f64::from(k % 7), step * f64::from(k % 5 - 1));
                walk.step(d);
                pose = pose.compose(displacement(d));
            }
            assert!(walk.pose().distance(pose) < 1e-9 && (walk.pose().theta - pose.theta).abs() < 1e-9);
            let back = walk.inverse().then(&walk);
            assert!(close(back.pose(), Pose::default()) && (back.cos - 1.0).abs() < 1e-9 && back.sin.abs() < 1e-9);
            assert!(walk.inverse().pose().distance(pose.inverse()) < 1e-8);
        }
    }

    fn close(a: Pose, b: Pose) -> bool {
        (a.x - b.x).abs() < 1e-12 && (a.y - b.y).abs() < 1e-12 && (a.theta - b.theta).abs() < 1e-12
    }

    #[test]
    fn the_logarithm_undoes_the_exponential() {
        for d in [Twist::new(0.3, -0.2, 1.1), Twist::new(0.1, 0.4, -2.5), Twist::new(1.0, 2.0, 1e-6), Twist::default()]
        {
            let back = displacement_to(displacement(d));
            let off = (back.vx - d.vx).abs() + (back.vy - d.vy).abs() + (back.omega - d.omega).abs();
            assert!(off < 1e-12, "{d:?} {back:?}");
        }
    }

    #[test]
    fn a_quarter_circle_ends_where_geometry_says() {
        // Forward at 1 m/s on a circle of 1 m to the left.
        let p = Pose::default().advance(Twist::new(0.0, 1.0, 1.0), FRAC_PI_2);
        assert!(close(p, Pose::new(-1.0, 1.0, FRAC_PI_2)), "{p:?}");
    }

    #[test]
    fn exponential_equals_many_small_steps_and_is_smooth_at_zero_rotation() {
        let twist = Twist::new(0.7, -0.4, 2.3);
        let whole = Pose::new(1.0, 2.0, 0.3).advance(twist, 1.5);
        let mut p = Pose::new(1.0, 2.0, 0.3);
        for _ in 0..1000 {
            p = p.advance(twist, 1.5e-3);
        }
        assert!((p.x - whole.x).abs() < 1e-11 && (p.y - whole.y).abs() < 1e-11);
        let below = displacement(Twist::new(1.0, 1.0, SMALL_RAD - 1e-10));
        let above = displacement(Twist::new(1.0, 1.0, SMALL_RAD + 1e-10));
        assert!((below.x - above.x).abs() < 1e-9 && (below.y - above.y).abs() < 1e-9);
    }

    #[test]
    fn compose_inverse_and_relative_agree() {
        let (a, b) = (Pose::new(0.3, -1.2, 2.5), Pose::new(-0.7, 0.4, -4.0));
        assert!(close(a.inverse().compose(a), Pose::default()));
        assert!(close(a.compose(a.relative(b)), b));
        let t = Twist::new(0.1, 0.2, 0.3);
        let back = a.body_twist(a.world_velocity(t));
        assert!((back.vx - t.vx).abs() < 1e-15 && (back.vy - t.vy).abs() < 1e-15);
    }

    #[test]
    fn league_forward_is_body_y_and_left_is_minus_x() {
        let t: Twist = LeagueCommand { forward: 1.0, left: 2.0, angular: 3.0 }.into();
        assert_eq!(t, Twist::new(-2.0, 1.0, 3.0));
        // A robot whose forward direction points along field x drives along field x.
        let v = Pose::from_league(0.0, 0.0, 0.0).world_velocity(Twist::new(0.0, 1.0, 0.0));
        assert!((v[0] - 1.0).abs() < 1e-15 && v[1].abs() < 1e-15);
        assert!((Pose::from_league(0.0, 0.0, 1.0).league_theta() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn wrapped_angles_stay_in_range() {
        for k in -7..8 {
            for a in [-PI, -3.0, -1e-17, 0.0, 1e-9, 3.0] {
                let w = wrap_angle(a + f64::from(k) * TAU);
                assert!((-PI..PI).contains(&w));
                assert!((w - a).abs() < 1e-14 || (w - a).abs() > TAU - 1e-14);
            }
        }
    }
}
