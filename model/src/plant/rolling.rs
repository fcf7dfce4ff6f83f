//! A step of rolling without slip.

use nalgebra::{Matrix3, Vector3};

use super::{Plant, friction, turn};
use crate::motor::Axis;
use runs::geometry::Geometry;

/// What depends on the step length only.
///
/// With A the inverse kinematics, I and B the axes' inertias and dampings and M the platform's mass
/// matrix, the momentum balance over a step h is (M + AᵀIA + h·AᵀBA)·ν⁺ = momentum + h·Aᵀ·torque.
#[derive(Debug, Clone)]
pub(super) struct Tables {
    h: f64,
    rows: Vec<Vector3<f64>>,
    /// AᵀIA.
    spin: Matrix3<f64>,
    /// (M + AᵀIA + h·AᵀBA)⁻¹.
    inverse: Matrix3<f64>,
    /// (M + AᵀIA)⁻¹·M, both inverses among the twists that the wheels allow: what of a turn of the platform's momentum the wheels let through.
    turning: Matrix3<f64>,
    /// inverse · rowᵢ: change of twist per impulse at a wheel.
    response: Vec<Vector3<f64>>,
    /// rowᵢ · inverse · rowⱼ, row by row: change of wheel speed i per impulse at wheel j.
    coupling: Vec<f64>,
}

impl Tables {
    fn new(geometry: &Geometry, rows: Vec<Vector3<f64>>, axes: &[Axis], mass: Matrix3<f64>, h: f64) -> Self {
        let weighted = |of: &dyn Fn(&Axis) -> f64| -> Matrix3<f64> {
            rows.iter().zip(axes).map(|(r, a)| r * r.transpose() * of(a)).sum()
        };
        let spin = weighted(&Axis::inertia);
        let inertia = mass + spin;
        // Masses are positive, so both matrices are positive definite.
        let turning = geometry.invert_allowed(&inertia).unwrap_or_else(Matrix3::zeros) * mass;
        let damped = inertia + weighted(&|a| h * a.damping);
        let inverse = geometry.invert_allowed(&damped).unwrap_or_else(Matrix3::zeros);
        let response: Vec<Vector3<f64>> = rows.iter().map(|r| inverse * r).collect();
        let coupling = rows.iter().flat_map(|a| response.iter().map(move |b| a.dot(b))).collect();
        Self { h, rows, spin, inverse, turning, response, coupling }
    }
}

/// Sweeps over the wheels until friction torques and wheel speeds agree: 1 or 2 while all wheels
/// turn; the bound only cuts short what a reversal of several wheels in one step needs.
const SWEEPS: usize = 30;

impl Plant {
    pub(super) fn step_rolling(&mut self, h: f64) {
        let mass = self.platform();
        let tables = match self.rolling.take() {
            Some(tables) if tables.h == h => tables,
            _ => {
                let rows = self.contacts.iter().map(|c| c.row / c.lever).collect();
                Tables::new(&self.geometry, rows, &self.axes, mass, h)
            }
        };
        let start = self.twist_vector();
        let start = start + tables.turning * turn(&start, 0.5 * h);
        let mut momentum = mass * start + tables.spin * start + self.push * h;
        for (row, wheel) in tables.rows.iter().zip(&self.wheels) {
            momentum += row * (h * (wheel.drive + wheel.load));
        }
        let free = tables.inverse * momentum;
        for _ in 0..friction::GEAR_ROUNDS {
            self.balance_friction(&tables, &free);
        }
        let mut twist = free;
        for (response, wheel) in tables.response.iter().zip(&self.wheels) {
            twist += response * (h * wheel.friction);
        }
        twist += tables.turning * turn(&twist, 0.5 * h);
        for (row, wheel) in tables.rows.iter().zip(&mut self.wheels) {
            let speed = row.dot(&twist);
            wheel.angle += 0.5 * h * (wheel.speed + speed);
            wheel.speed = speed;
        }
        self.move_body(twist, h);
        self.rolling = Some(tables);
    }

    /// Projected Gauss-Seidel on the friction torques: each either stops its wheel or is at its
    /// limit against the rotation. Starts from the last step's torques.
    fn balance_friction(&mut self, tables: &Tables, free: &Vector3<f64>) {
        let (n, h) = (self.wheels.len(), tables.h);
        for _ in 0..SWEEPS {
            let mut change = 0.0_f64;
            for i in 0..n {
                let limit = self.wheels[i].friction_limit(&self.axes[i]);
                let coupling = &tables.coupling[i * n..(i + 1) * n];
                let pushed: f64 = coupling.iter().zip(&self.wheels).map(|(g, w)| g * w.friction).sum();
                let speed = tables.rows[i].dot(free) + h * pushed;
                let old = self.wheels[i].friction;
                let torque = (old - speed / (h * coupling[i])).clamp(-limit, limit);
                self.wheels[i].friction = torque;
                change = change.max((torque - old).abs());
            }
            if change <= 1e-12 {
                break;
            }
        }
        for i in 0..n {
            let coupling = &tables.coupling[i * n..(i + 1) * n];
            let pushed: f64 = coupling.iter().zip(&self.wheels).map(|(g, w)| g * w.friction).sum();
            let speed = tables.rows[i].dot(free) + h * pushed;
            let wheel = &mut self.wheels[i];
            let axis = &self.axes[i];
            let limit = wheel.friction_limit(axis);
            let winding = wheel.drive - axis.damping * speed;
            wheel.transmitted = axis.transmitted(winding, (speed - wheel.speed) / h, wheel.friction, limit);
        }
    }
}
