//! A step of rolling in which every wheel turns on: linear but for the turning frame, so that it may be long.
//!
//! While a wheel turns on (direction s) and its gear passes torque on (direction σ), friction is −s·(c + d + λ·|t|)
//! with the transmitted torque t = u − b·w − J·ẇ − s·c. With p = s·σ and η = 1 − p·λ the momentum balance is
//! (M + Aᵀ(I + η·J)A)·ν̇ = Aᵀ(η·(u − s·c) + load − s·d) + push − AᵀηbA·ν: an exponential for every pattern of p.
//! Half of the frame's turn goes before it and half after: of second order in the turn, exact in all else.

use std::array::from_fn;

use nalgebra::{Matrix3, Vector3};

use super::{Plant, turn};

/// Robots of more wheels go in the small steps of the general way.
const MOST_WHEELS: usize = 4;

/// What is fast in A·h is made slow by halving h; then this many terms of the series are exact to the last bits.
const SLOW: f64 = 0.1;
const TERMS: u32 = 9;

/// Patterns that are tried: that of the last step, that which it leads to, and once more for a gear near its reversal.
const ROUNDS: usize = 3;

/// What depends on the length of a step and on the pattern of p.
#[derive(Debug, Clone)]
struct Table {
    /// What is left of a twist after a step without torques.
    carried: Matrix3<f64>,
    /// Change of twist per force on the body.
    pushed: Matrix3<f64>,
    /// Wheel speed per twist, and change of twist per torque at a wheel.
    rows: [Vector3<f64>; MOST_WHEELS],
    response: [Vector3<f64>; MOST_WHEELS],
    /// η of every wheel: 1 less its gear's loss, or 1 more where its p is negative.
    shares: [f64; MOST_WHEELS],
    /// What of a turn of the platform's momentum the wheels let through.
    turning: Matrix3<f64>,
    per_h: f64,
}

/// Tables of one step length, by the bits of wheels whose p is negative.
#[derive(Debug, Clone, Default)]
pub(super) struct Tables {
    h: f64,
    of: [Option<Box<Table>>; 1 << MOST_WHEELS],
}

/// (e^(−A·h), ∫₀ʰ e^(−A·t) dt), or nothing where A is no matrix of numbers.
fn exponential(a: &Matrix3<f64>, h: f64) -> Option<(Matrix3<f64>, Matrix3<f64>)> {
    let norm = (a * h).amax();
    if !norm.is_finite() {
        return None;
    }
    let mut halvings = 0;
    while norm * 0.5_f64.powi(halvings) > SLOW {
        halvings += 1;
    }
    let short = h * 0.5_f64.powi(halvings);
    let step = a * -short;
    let (mut term, mut integral) = (Matrix3::identity(), Matrix3::identity());
    for k in 2..=TERMS {
        term *= step / f64::from(k);
        integral += term;
    }
    let mut carried = Matrix3::identity() + step * integral;
    integral *= short;
    for _ in 0..halvings {
        integral += carried * integral;
        carried *= carried;
    }
    Some((carried, integral))
}

impl Tables {
    fn of_step(h: f64) -> Box<Self> {
        Box::new(Self { h, ..Self::default() })
    }
}

impl Table {
    /// Of a plant whose wheels have these negative p, for steps of `h`.
    fn new(plant: &Plant, negative: usize, h: f64) -> Option<Self> {
        let rows: Vec<_> = plant.contacts.iter().map(|contact| contact.row / contact.lever).collect();
        let share = |i: usize, loss: f64| if negative >> i & 1 == 1 { 1.0 + loss } else { 1.0 - loss };
        let shares: Vec<_> = plant.axes.iter().enumerate().map(|(i, axis)| share(i, axis.gear_loss)).collect();
        let mass = plant.platform();
        let (mut inertia, mut damping) = (mass, Matrix3::zeros());
        for ((row, axis), share) in rows.iter().zip(&plant.axes).zip(&shares) {
            let square = row * row.transpose();
            inertia += square * (axis.load_inertia + share * axis.rotor_inertia);
            damping += square * (share * axis.damping);
        }
        let inverse = plant.geometry.invert_allowed(&inertia)?;
        let (carried, integral) = exponential(&(inverse * damping), h)?;
        let mut table = Self {
            // Wheels without rollers stop what goes sideways.
            carried: carried * inverse * inertia,
            pushed: integral * inverse,
            rows: [Vector3::zeros(); MOST_WHEELS],
            response: [Vector3::zeros(); MOST_WHEELS],
            shares: [0.0; MOST_WHEELS],
            turning: inverse * mass,
            per_h: 1.0 / h,
        };
        for (i, (row, share)) in rows.iter().zip(&shares).enumerate().take(MOST_WHEELS) {
            (table.rows[i], table.response[i], table.shares[i]) = (*row, table.pushed * row, *share);
        }
        Some(table)
    }
}

impl Plant {
    /// A step of rolling of `h` if every wheel turns on in it; if not, nothing has changed.
    pub(super) fn turn_on(&mut self, h: f64) -> bool {
        if self.wheels.iter().any(|wheel| wheel.speed == 0.0) {
            return false;
        }
        let mut tables = self.turning.take().filter(|tables| tables.h == h).unwrap_or_else(|| Tables::of_step(h));
        let done = match self.wheels.len() {
            3 => self.turn_on_wheels::<3>(&mut tables),
            4 => self.turn_on_wheels::<4>(&mut tables),
            _ => false,
        };
        self.turning = Some(tables);
        done
    }

    #[inline(always)]
    fn turn_on_wheels<const N: usize>(&mut self, tables: &mut Tables) -> bool {
        let h = tables.h;
        let (wheels, axes) = (&self.wheels[..N], &self.axes[..N]);
        let old: [f64; N] = from_fn(|i| wheels[i].speed);
        let torque: [f64; N] = from_fn(|i| wheels[i].drive - axes[i].coulomb.copysign(old[i]));
        let beside: [f64; N] = from_fn(|i| wheels[i].load - wheels[i].dry * 1.0_f64.copysign(old[i]));
        let mut transmitted: [f64; N] = from_fn(|i| wheels[i].transmitted);
        let pattern_of =
            |transmitted: &[f64; N]| (0..N).fold(0, |bits, i| bits | usize::from(old[i] * transmitted[i] < 0.0) << i);
        let mut pattern = pattern_of(&transmitted);
        let start = self.twist_vector();
        let start_turn = turn(&start, 0.5 * h);
        for _ in 0..ROUNDS {
            if tables.of[pattern].is_none() {
                tables.of[pattern] = Table::new(self, pattern, h).map(Box::new);
            }
            let Some(table) = &tables.of[pattern] else { return false };
            let mut twist = table.carried * (start + table.turning * start_turn);
            for i in 0..N {
                twist += table.response[i] * (table.shares[i] * torque[i] + beside[i]);
            }
            if self.deviations.is_some() {
                twist += table.pushed * self.push;
            }
            twist += table.turning * turn(&twist, 0.5 * h);
            let new: [f64; N] = from_fn(|i| table.rows[i].dot(&twist));
            for (i, axis) in axes.iter().enumerate() {
                let accelerating = axis.rotor_inertia * ((new[i] - old[i]) * table.per_h);
                transmitted[i] = torque[i] - 0.5 * axis.damping * (old[i] + new[i]) - accelerating;
            }
            let found = pattern_of(&transmitted);
            if found == pattern {
                let limits: [f64; N] = from_fn(|i| axes[i].friction_limit(transmitted[i]) + wheels[i].dry);
                if (0..N).any(|i| old[i] * new[i] <= 0.0 || limits[i] < 0.0) {
                    return false;
                }
                for (i, wheel) in self.wheels.iter_mut().enumerate() {
                    wheel.transmitted = transmitted[i];
                    wheel.friction = -limits[i].copysign(new[i]);
                    wheel.angle += 0.5 * h * (old[i] + new[i]);
                    wheel.speed = new[i];
                }
                self.move_body(twist, h);
                return true;
            }
            pattern = found;
        }
        false
    }
}
