//! The simulated robot: motors, wheels and body, in fixed steps.

mod bridge;
mod deviations;
mod encoder;
mod friction;
mod loads;
mod play;
mod rolling;
mod slipping;
mod turning;
mod weight;

use nalgebra::Vector3;

pub use deviations::{Deviations, HeadingDrag, WheelDeviation};
pub use weight::Weight;

use self::play::Play;
use crate::motor::Axis;
use runs::frames::{Pose, Twist, Walk, small_sin_cos};
use runs::geometry::{Geometry, GeometryError};
use runs::robot::{Robot, Support};

/// How the wheels hold the floor.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Contact {
    /// Rolling without slip: wheel speeds and body twist are tied by the inverse kinematics.
    #[default]
    Rolling,
    /// Friction-limited: the wheel speed is a state of its own; the contact point slips along the
    /// traction direction at `creep` × force until the force reaches its limit.
    Friction {
        /// Coefficient of friction between roller and floor.
        friction_coefficient: f64,
        /// Slip velocity per force below the limit; not nothing.
        creep: Creep,
    },
}

/// Slip velocity of a contact per force.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Creep {
    /// Whatever the wheel does, s/kg.
    pub s_per_kg: f64,
    /// Per speed at which it rolls: slip ratio per force, 1/N.
    pub per_n: f64,
}

impl Creep {
    /// Of a contact that yields with time alone.
    pub const fn at_rest(s_per_kg: f64) -> Self {
        Self { s_per_kg, per_n: 0.0 }
    }

    /// Whether there is any.
    pub fn is_any(self) -> bool {
        self.s_per_kg > 0.0 || self.per_n > 0.0
    }

    /// While the wheel rolls at this speed, s/kg.
    #[inline]
    pub fn at(self, rolled_m_s: f64) -> f64 {
        self.s_per_kg + self.per_n * (rolled_m_s.abs() + STANDS_M_S)
    }
}

/// Speed that is added to that of a rolling wheel, m/s: one that stands would creep by nothing, and its force be undefined.
const STANDS_M_S: f64 = 0.001;

/// Standard gravity, m/s².
pub const GRAVITY: f64 = 9.806_65;
/// Slip velocity per force of wheels that something knocked loose, s/kg: no more than 5 mm/s while they still hold.
const LOOSE_CREEP: Creep = Creep::at_rest(0.001);
/// Longest internal step, s. Halving it changes a second of driving by less than 0.1 mm.
const LONGEST_STEP_S: f64 = 0.000_25;
/// Longest step of wheels that turn on, s, while no force on them or on the body depends on where they are.
const LONGEST_TURN_S: f64 = 0.001;

/// The robot as a dynamic system.
///
/// The platform is a rigid body in the plane, its centre of mass at the chassis centre. The body
/// twist, body frame and pose are those of [`Twist`] and [`Pose`]; Coriolis terms act on the
/// platform's mass only, for the wheels' spin has no part in them. [`Deviations`] change all that.
///
/// While rolling wheels turn on, a step is exact in the motors, their damping and friction, and of second order in the
/// turn of the body frame. Where one stops, starts or slips, steps are small and implicit in the damping and the friction
/// (so that a wheel stands still instead of chattering about zero) and exact in the rotation of the body frame, half of
/// which goes before the push and half after. Neither creates energy.
#[derive(Debug, Clone)]
pub struct Plant {
    geometry: Geometry,
    axes: Vec<Axis>,
    /// The same before they warmed up.
    cold: Vec<Axis>,
    mass: f64,
    yaw_inertia: f64,
    contact: Contact,
    support: Support,
    counts_per_rad: f64,
    gear_ratio: f64,
    rotor_inertia: f64,
    /// Winding current per torque at the wheel shaft, A/Nm.
    current_per_torque: f64,
    /// `None` for the nominal model.
    deviations: Option<Box<Deviations>>,
    /// No force of the deviations changes within a tick.
    steady: bool,
    delayed: bridge::Delayed,
    /// By how much the supply has fallen since the start, V.
    fallen_v: f64,
    encoders: Vec<encoder::Encoder>,
    /// Force on the body beside that of the wheels: N, N, Nm.
    push: Vector3<f64>,
    twist: Twist,
    walk: Walk,
    wheels: Vec<WheelState>,
    before: Vec<f64>,
    after: Vec<f64>,
    contacts: Vec<slipping::ContactPoint>,
    weight: Weight,
    rolling: Option<Box<rolling::Tables>>,
    turning: Option<Box<turning::Tables>>,
    /// Friction coefficient of the floor while wheels that otherwise roll are knocked loose.
    loose: Option<f64>,
    /// Duties as they act in this tick.
    acting: Vec<f64>,
}

/// One wheel and its motor.
#[derive(Debug, Clone, Copy, Default)]
struct WheelState {
    /// rad/s.
    speed: f64,
    /// Speed at the end of the step in hand, rad/s.
    next_speed: f64,
    /// rad since the start.
    angle: f64,
    /// Torque through the gear in the last step, Nm.
    transmitted: f64,
    /// Friction torque in the last step, Nm.
    friction: f64,
    /// Torque of the winding at standstill for the present voltage, Nm.
    drive: f64,
    /// Torque at the wheel shaft beside winding and friction, Nm.
    load: f64,
    /// Friction beyond that of the nominal model, Nm.
    dry: f64,
    /// Mean square of the duty, as the winding's warmth follows it.
    heat: f64,
    /// By how much the rotor is ahead in the gear's play on blocks, rad at the wheel, and how fast the rotor is, rad/s.
    ahead: f64,
    rotor_speed: f64,
}

impl WheelState {
    /// Largest friction torque, Nm.
    fn friction_limit(&self, axis: &Axis) -> f64 {
        (axis.friction_limit(self.transmitted) + self.dry).max(0.0)
    }

    fn step_on_blocks(&mut self, axis: &Axis, h: f64) {
        let stiffness = axis.inertia() / h + axis.damping;
        let push = axis.inertia() / h * self.speed + self.drive + self.load;
        let old = self.speed;
        for _ in 0..friction::GEAR_ROUNDS {
            let limit = self.friction_limit(axis);
            self.speed = friction::soft(push, limit) / stiffness;
            self.friction = stiffness * self.speed - push;
            let winding = self.drive - axis.damping * self.speed;
            let acceleration = (self.speed - old) / h;
            self.transmitted = axis.transmitted(winding, acceleration, self.friction, limit);
        }
        self.angle += 0.5 * h * (old + self.speed);
    }
}

impl Plant {
    /// A robot at rest at the origin, rolling without slip (or on blocks, if it says so).
    ///
    /// # Errors
    /// [`GeometryError`] if the robot's wheels cannot drive it.
    pub fn new(robot: &Robot) -> Result<Self, GeometryError> {
        let geometry = robot.geometry()?;
        let n = geometry.wheel_count();
        Ok(Self {
            contacts: slipping::ContactPoint::of(&geometry),
            weight: Weight::new(geometry.wheels(), robot.mass_kg, [0.0; 2], 0.0),
            geometry,
            axes: vec![Axis::of(robot); n],
            cold: vec![Axis::of(robot); n],
            mass: robot.mass_kg,
            yaw_inertia: robot.yaw_inertia_kg_m2,
            contact: Contact::Rolling,
            support: robot.support,
            counts_per_rad: robot.counts_per_wheel_rad(),
            gear_ratio: robot.gear_ratio,
            rotor_inertia: robot.motor.rotor_inertia,
            current_per_torque: 1.0 / (robot.gear_ratio * robot.motor.torque_constant),
            deviations: None,
            steady: true,
            delayed: bridge::Delayed::new(),
            fallen_v: 0.0,
            encoders: vec![encoder::Encoder::default(); n],
            push: Vector3::zeros(),
            twist: Twist::default(),
            walk: Walk::from(Pose::default()),
            wheels: vec![WheelState::default(); n],
            before: vec![0.0; n],
            after: vec![0.0; n],
            rolling: None,
            turning: None,
            loose: None,
            acting: vec![0.0; n],
        })
    }

    /// The same robot on another floor. On blocks the contact does not matter.
    #[must_use]
    pub fn with_contact(mut self, contact: Contact) -> Self {
        self.contact = contact;
        self
    }

    /// The same robot as it really is.
    #[must_use]
    pub fn with_deviations(mut self, deviations: &Deviations) -> Self {
        self.deviations = (*deviations != Deviations::default()).then(|| Box::new(deviations.clone()));
        self.steady = deviations.are_steady();
        for (i, axis) in self.axes.iter_mut().enumerate() {
            *axis = axis.with_motor(deviations.wheel(i).torque_constant, deviations.wheel(i).resistance);
        }
        self.cold.clone_from(&self.axes);
        let Deviations { centre_of_mass_m, centre_height_m, .. } = *deviations;
        self.weight = Weight::new(self.geometry.wheels(), self.mass, centre_of_mass_m, centre_height_m);
        self.set_radii();
        self
    }

    /// The same robot at another place.
    #[must_use]
    pub fn at(mut self, pose: Pose) -> Self {
        self.stand(pose);
        self
    }

    /// Sets the robot down at another place; its wheels stay as they are.
    pub fn stand(&mut self, pose: Pose) {
        self.walk = Walk::from(pose);
    }

    /// The same robot in motion, its wheels rolling.
    #[must_use]
    pub fn moving(mut self, twist: Twist) -> Self {
        self.twist = if self.support == Support::Floor { twist } else { Twist::default() };
        self.loose = None;
        for (i, wheel) in self.wheels.iter_mut().enumerate() {
            let contact = &self.contacts[i];
            wheel.speed =
                contact.row.dot(&Vector3::new(self.twist.vx, self.twist.vy, self.twist.omega)) / contact.lever;
        }
        self
    }

    /// Something hit the body through its centre: place (m) and velocity (m/s) change at once by so much, in world axes.
    /// The wheels keep their speeds. Where they otherwise roll they slip from now on, as on a floor of this friction
    /// coefficient, until that holds every one of them again. On blocks nothing happens.
    pub fn strike(&mut self, moved: [f64; 2], changed: [f64; 2], friction_coefficient: f64) {
        if self.support == Support::Blocks {
            return;
        }
        let pose = self.pose();
        self.walk = Walk::from(Pose::new(pose.x + moved[0], pose.y + moved[1], pose.theta));
        if changed != [0.0; 2] {
            let [x, y] = pose.rotate_to_body(changed);
            let mass = self.platform();
            let change = Vector3::new(x, y, 0.0);
            // Wheels without rollers take what would be sideways.
            let change = self.geometry.invert_allowed(&mass).map_or(change, |inverse| inverse * mass * change);
            self.twist = Twist::new(self.twist.vx + change.x, self.twist.vy + change.y, self.twist.omega + change.z);
            self.loose = Some(friction_coefficient);
        }
    }

    /// One control tick of `dt` seconds with a constant duty in [−1, 1] a wheel (0, the motor
    /// shorted, where one is missing) and a constant supply (V).
    pub fn step(&mut self, duty: &[f64], supply_v: f64, dt: f64) {
        self.energise(duty, supply_v, dt);
        if self.deviations.as_ref().is_some_and(|d| d.is_changing()) {
            self.set_radii();
        }
        self.before.copy_from_slice(&self.after);
        self.walk = Walk::from(self.walk.pose());
        let rolls = self.support == Support::Floor && self.contact == Contact::Rolling;
        let (steps, h) = parts(dt, if self.steady { LONGEST_TURN_S } else { LONGEST_STEP_S });
        for _ in 0..steps {
            if rolls && self.loose.is_none() {
                self.load();
                if self.turn_on(h) {
                    continue;
                }
            }
            self.step_finely(h);
        }
        for i in 0..self.wheels.len() {
            self.after[i] = self.read_encoder(i, dt) * self.counts_per_rad;
        }
    }

    fn step_finely(&mut self, dt: f64) {
        let (steps, h) = parts(dt, LONGEST_STEP_S);
        for _ in 0..steps {
            self.load();
            match (self.support, self.contact, self.loose) {
                (Support::Blocks, ..) => self.step_on_blocks(h),
                (_, Contact::Rolling, None) => self.step_rolling(h),
                (_, Contact::Rolling, Some(friction_coefficient)) => {
                    if self.step_slipping(h, friction_coefficient, LOOSE_CREEP) {
                        self.loose = None;
                    }
                }
                (_, Contact::Friction { friction_coefficient, creep }, _) => {
                    self.step_slipping(h, friction_coefficient, creep);
                }
            }
        }
    }

    /// The kinematics it moves by.
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// Body twist.
    pub fn twist(&self) -> Twist {
        self.twist
    }

    /// Pose in the world, heading not wrapped.
    pub fn pose(&self) -> Pose {
        self.walk.pose()
    }

    /// Wheel speeds, rad/s.
    pub fn wheel_speeds(&self) -> impl Iterator<Item = f64> + '_ {
        self.wheels.iter().map(|w| w.speed)
    }

    /// Encoder positions at the motor shafts before the last step, in counts with fractions.
    pub fn encoder_before(&self) -> &[f64] {
        &self.before
    }

    /// Encoder positions at the motor shafts after the last step, in counts with fractions.
    pub fn encoder_after(&self) -> &[f64] {
        &self.after
    }

    /// What cumulative counters read after the last step.
    pub fn counts(&self) -> Vec<i64> {
        self.after.iter().map(|c| c.floor() as i64).collect()
    }

    /// Kinetic energy of platform, wheels and rotors, J.
    pub fn kinetic_energy(&self) -> f64 {
        let spin: f64 = self.wheels.iter().zip(&self.axes).map(|(w, a)| a.inertia() * w.speed * w.speed).sum();
        let t = self.twist_vector();
        0.5 * (t.dot(&(self.platform() * t)) + spin)
    }

    fn step_on_blocks(&mut self, h: f64) {
        for (i, (wheel, axis)) in self.wheels.iter_mut().zip(&self.axes).enumerate() {
            let play = self.deviations.as_deref().and_then(|d| Play::of(&d.wheel(i), axis, self.gear_ratio));
            match play {
                Some(play) => play.step(wheel, axis, h, |wheel| wheel.step_on_blocks(axis, h)),
                None => wheel.step_on_blocks(axis, h),
            }
        }
    }

    #[inline]
    fn move_body(&mut self, twist: Vector3<f64>, h: f64) {
        let old = self.twist;
        let half = 0.5 * h;
        let sum = [old.vx + twist.x, old.vy + twist.y, old.omega + twist.z].map(|v| v * half);
        self.walk.step(Twist::new(sum[0], sum[1], sum[2]));
        self.twist = Twist::new(twist.x, twist.y, twist.z);
    }

    fn twist_vector(&self) -> Vector3<f64> {
        Vector3::new(self.twist.vx, self.twist.vy, self.twist.omega)
    }

    /// Wheel radii as they are now; what was derived from them is made again.
    fn set_radii(&mut self) {
        let nominal = slipping::ContactPoint::of(&self.geometry);
        for (i, (contact, nominal)) in self.contacts.iter_mut().zip(nominal).enumerate() {
            contact.lever = nominal.lever * self.deviations.as_ref().map_or(1.0, |d| d.radius(i, self.wheels[i].angle));
        }
        (self.rolling, self.turning) = (None, None);
    }
}

/// How many equal steps of at most `longest` make up `dt`, and their length.
fn parts(dt: f64, longest: f64) -> (usize, f64) {
    // A time that is a multiple of the longest step up to rounding gets no extra step.
    let steps = (dt / longest - 1e-6).ceil().max(1.0);
    (steps as usize, dt / steps)
}

/// Change of a twist because the body frame turns on by ω·h: the Coriolis acceleration, exactly.
fn turn(twist: &Vector3<f64>, h: f64) -> Vector3<f64> {
    let (s, c) = small_sin_cos(twist.z * h);
    Vector3::new(c * twist.x + s * twist.y - twist.x, c * twist.y - s * twist.x - twist.y, 0.0)
}

#[cfg(test)]
mod tests;
