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
    per_h: f64,
    rows: Vec<Vector3<f64>>,
    /// (M + AᵀIA + h·AᵀBA)⁻¹·(M + AᵀIA): what is left of a twist after a step without torques.
    carried: Matrix3<f64>,
    /// (M + AᵀIA + h·AᵀBA)⁻¹·h: change of twist per force on the body.
    pushed: Matrix3<f64>,
    /// (M + AᵀIA)⁻¹·M, both inverses among the twists that the wheels allow: what of a turn of the platform's momentum the wheels let through.
    turning: Matrix3<f64>,
    /// inverse · rowᵢ: change of twist per impulse at a wheel.
    response: Vec<Vector3<f64>>,
    /// rowᵢ · inverse · rowⱼ, row by row: change of wheel speed i per impulse at wheel j; then the same per torque.
    coupling: Vec<f64>,
    per_torque: Vec<f64>,
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
        let coupling: Vec<f64> = rows.iter().flat_map(|a| response.iter().map(move |b| a.dot(b))).collect();
        let per_torque = coupling.iter().map(|g| h * g).collect();
        Self {
            h,
            per_h: 1.0 / h,
            rows,
            carried: inverse * inertia,
            pushed: inverse * h,
            turning,
            response,
            coupling,
            per_torque,
        }
    }
}

/// Sweeps over the wheels until friction torques and wheel speeds agree: 1 or 2 while all wheels
/// turn; the bound only cuts short what a reversal of several wheels in one step needs.
const SWEEPS: usize = 30;

/// Robots of more wheels take the general way.
const MOST_WHEELS: usize = 8;

impl Plant {
    pub(super) fn step_rolling(&mut self, h: f64) {
        let tables = match self.rolling.take() {
            Some(tables) if tables.h == h => tables,
            _ => {
                let rows = self.contacts.iter().map(|c| c.row / c.lever).collect();
                Box::new(Tables::new(&self.geometry, rows, &self.axes, self.platform(), h))
            }
        };
        // The loops over three and four wheels, which most robots have, are unrolled.
        match self.wheels.len() {
            3 => self.roll(&tables, 3),
            4 => self.roll(&tables, 4),
            n => self.roll(&tables, n),
        }
        self.rolling = Some(tables);
    }

    #[inline(always)]
    fn roll(&mut self, tables: &Tables, n: usize) {
        let (h, rows, response) = (tables.h, &tables.rows[..n], &tables.response[..n]);
        let start = self.twist_vector();
        let start = start + tables.turning * turn(&start, 0.5 * h);
        let mut free = tables.carried * start;
        if self.deviations.is_some() {
            free += tables.pushed * self.push;
        }
        for (response, wheel) in response.iter().zip(&self.wheels[..n]) {
            free += response * (h * (wheel.drive + wheel.load));
        }
        for _ in 0..friction::GEAR_ROUNDS {
            if !self.turn_all(tables, &free, n) {
                self.balance_friction(tables, &free);
            }
        }
        let mut twist = free;
        for (response, wheel) in response.iter().zip(&self.wheels[..n]) {
            twist += response * (h * wheel.friction);
        }
        twist += tables.turning * turn(&twist, 0.5 * h);
        for (row, wheel) in rows.iter().zip(&mut self.wheels[..n]) {
            let speed = row.dot(&twist);
            wheel.angle += 0.5 * h * (wheel.speed + speed);
            wheel.speed = speed;
        }
        self.move_body(twist, h);
    }

    /// The usual case of [`Self::balance_friction`]: every wheel turns on, so every torque is at its limit against the
    /// rotation of the last step. Answers whether that balances; if not, nothing has changed.
    #[inline(always)]
    fn turn_all(&mut self, tables: &Tables, free: &Vector3<f64>, n: usize) -> bool {
        if n > MOST_WHEELS {
            return false;
        }
        let (wheels, axes, rows) = (&mut self.wheels[..n], &self.axes[..n], &tables.rows[..n]);
        let per_torque = &tables.per_torque[..n * n];
        let (mut torques, mut speeds) = ([0.0; MOST_WHEELS], [0.0; MOST_WHEELS]);
        for (torque, (wheel, axis)) in torques.iter_mut().zip(wheels.iter().zip(axes)) {
            *torque = wheel.friction_limit(axis).copysign(wheel.friction);
        }
        let mut balanced = true;
        for i in 0..n {
            speeds[i] = rows[i].dot(free);
            for j in 0..n {
                speeds[i] += per_torque[i * n + j] * torques[j];
            }
            balanced &= speeds[i] * torques[i] < 0.0;
        }
        if balanced {
            for i in 0..n {
                let (wheel, axis) = (&mut wheels[i], &axes[i]);
                wheel.friction = torques[i];
                let winding = wheel.drive - axis.damping * speeds[i];
                let acceleration = (speeds[i] - wheel.speed) * tables.per_h;
                wheel.transmitted = axis.transmitted_in_motion(winding, acceleration, torques[i]);
            }
        }
        balanced
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
