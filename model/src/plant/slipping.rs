//! A step on a floor that gives way.

use nalgebra::{Matrix3, Vector3};

use super::{Creep, Plant, WheelState, friction, turn};
use crate::motor::Axis;
use runs::geometry::{Geometry, Wheel};

/// Newton steps; piecewise linear and convex, so that 2 or 3 are the rule.
const NEWTON_STEPS: usize = 40;

/// Where a wheel holds the floor.
#[derive(Debug, Clone, Copy)]
pub(super) struct ContactPoint {
    /// Coefficients of the twist in the contact point's speed along the traction direction.
    pub(super) row: Vector3<f64>,
    /// Traction speed per wheel speed, r·cos(roller), m.
    pub(super) lever: f64,
}

impl ContactPoint {
    pub(super) fn of(geometry: &Geometry) -> Vec<Self> {
        let point = |wheel: &Wheel| Self {
            row: Vector3::from(wheel.traction_row()),
            lever: geometry.wheel_radius_m() * wheel.roller_rad.cos(),
        };
        geometry.wheels().iter().map(point).collect()
    }
}

/// What all wheels share over one step of length `h`.
struct Floor {
    h: f64,
    creep: Creep,
    /// Of every wheel, m.
    radius: f64,
}

/// Force on the body (N), its slope against the contact's speed, and the wheel's new speed.
struct Traction {
    force: f64,
    slope: f64,
    speed: f64,
}

impl Floor {
    /// The answer to a body twist of a wheel that holds no more than `grip` N.
    fn traction(
        &self,
        axis: &Axis,
        wheel: &WheelState,
        contact: &ContactPoint,
        twist: &Vector3<f64>,
        grip: f64,
    ) -> Traction {
        let (u, lever) = (contact.row.dot(twist), contact.lever);
        let limit = wheel.friction_limit(axis);
        let inertia = axis.inertia() / self.h;
        let creep = self.creep.at(self.radius * wheel.speed);
        let push = inertia * wheel.speed + wheel.drive + wheel.load;
        let (k, stiffness) = (lever / creep, inertia + axis.damping);
        let held = stiffness + lever * k;
        let speed = friction::soft(push + k * u, limit) / held;
        let force = (lever * speed - u) / creep;
        if force.abs() <= grip {
            let follows = if speed == 0.0 { 0.0 } else { lever * k / held };
            return Traction { force, slope: (follows - 1.0) / creep, speed };
        }
        let force = grip.copysign(force);
        let speed = friction::soft(push - lever * force, limit) / stiffness;
        Traction { force, slope: 0.0, speed }
    }
}

impl Plant {
    /// Whether the floor held every wheel.
    pub(super) fn step_slipping(&mut self, h: f64, friction_coefficient: f64, creep: Creep) -> bool {
        let mass = self.platform() / h;
        let start = self.twist_vector();
        let start = start + turn(&start, 0.5 * h);
        let axes = std::mem::take(&mut self.axes);
        let floor = Floor { h, creep, radius: self.geometry.wheel_radius_m() };
        let grip = |wheel: usize| friction_coefficient * self.weight.on(wheel);
        // Wheels without rollers hold sideways whatever they slip along.
        let within = |slope: &Matrix3<f64>| self.geometry.invert_allowed(slope);
        let mut twist = within(&mass).map_or(start, |inverse| inverse * mass * start);
        let mut held = true;
        for _ in 0..friction::GEAR_ROUNDS {
            for step in 0..NEWTON_STEPS {
                let mut residual = mass * (twist - start) - self.push;
                let mut slope: Matrix3<f64> = mass;
                for (i, ((wheel, contact), axis)) in self.wheels.iter().zip(&self.contacts).zip(&axes).enumerate() {
                    let t = floor.traction(axis, wheel, contact, &twist, grip(i));
                    residual -= contact.row * t.force;
                    slope -= contact.row * contact.row.transpose() * t.slope;
                }
                let Some(change) = within(&slope).map(|s| s * residual) else { break };
                // Full steps can cycle between two kinks; half steps then cannot.
                twist -= if step < 10 { change } else { change * 0.5 };
                if change.amax() < 1e-13 {
                    break;
                }
            }
            held = true;
            for (i, ((wheel, contact), axis)) in self.wheels.iter_mut().zip(&self.contacts).zip(&axes).enumerate() {
                let t = floor.traction(axis, wheel, contact, &twist, grip(i));
                let limit = wheel.friction_limit(axis);
                let acceleration = (t.speed - wheel.speed) / h;
                let winding = wheel.drive - axis.damping * t.speed;
                wheel.friction = axis.inertia() * acceleration - winding - wheel.load + contact.lever * t.force;
                wheel.transmitted = axis.transmitted(winding, acceleration, wheel.friction, limit);
                wheel.next_speed = t.speed;
                held &= t.force.abs() < grip(i);
            }
        }
        self.axes = axes;
        self.weight.shift([(twist.x - start.x) / h, (twist.y - start.y) / h], h);
        for wheel in &mut self.wheels {
            wheel.angle += 0.5 * h * (wheel.speed + wheel.next_speed);
            wheel.speed = wheel.next_speed;
        }
        twist += turn(&twist, 0.5 * h);
        if self.geometry.is_differential() {
            twist = self.geometry.invert_allowed(&mass).map_or(twist, |inverse| inverse * mass * twist);
        }
        self.move_body(twist, h);
        held
    }
}
