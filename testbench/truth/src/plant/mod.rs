//! The physics: chassis, wheels on a soft contact, gears, motors, battery.
//!
//! Integration is leapfrog at 0.05 ms or finer: angles, places and deflections live half a step before the speeds; every
//! step moves them over a whole step and then kicks the speeds with the forces at the middle. Dry friction is an impulse
//! (it stops what it can stop), winding currents follow their exact exponential.
//!
//! Chassis: `m·v' = ΣR(θ)·F + F_ext`, `I·ω' = Σ p×F + M_ext`. Shaft: `J·Ω' = n·k·i − F·r·cos γ − b·Ω − friction`.
//! Winding: `L·i' = u·V − R·i − k·n·Ω`. Battery: `V = V₀ − R_b·Σ u·i`.

mod bristle;
mod load;
mod shaft;

use std::f64::consts::TAU;

use crate::disturbance::Hit;
use crate::machine::Machine;
use bristle::Bristle;
use load::LoadShare;
use shaft::{Shaft, Torques};

/// Standard gravity, m/s².
pub const GRAVITY: f64 = 9.81;
/// Speed at which ground noise reaches its full strength, m/s: a carpet does not shake a robot that stands.
const NOISE_SPEED: f64 = 0.05;
/// Part by which the smoothed ground force moves in one step (load transfer through the suspension, about 1 ms).
const LOAD_SMOOTHING: f64 = 0.05;

/// Coloured ground noise at one moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shake {
    /// Force on the chassis, body frame, N.
    pub force_n: [f64; 2],
    /// Moment about the vertical axis, counter-clockwise, Nm.
    pub moment_nm: f64,
    /// Torque at every wheel shaft, Nm.
    pub shaft_nm: Vec<f64>,
}

/// One wheel's moving parts and fixed numbers.
#[derive(Clone, Debug)]
struct Corner {
    shaft: Shaft,
    current: f64,
    heat: f64,
    grip: Bristle,
    side: Bristle,
    push: [f64; 2],
    free: [f64; 2],
    place: [f64; 2],
    cos_roller: f64,
    resting_load: f64,
}

/// The robot in motion.
#[derive(Clone, Debug)]
pub struct Plant<'a> {
    machine: &'a Machine,
    step: f64,
    time: f64,
    centre: [f64; 2],
    heading: f64,
    velocity: [f64; 2],
    spin: f64,
    corners: Vec<Corner>,
    loads: LoadShare,
    ground_force: [f64; 2],
    grain: Bristle,
    battery_v: f64,
    current_gain: f64,
    hits: Vec<Hit>,
}

impl<'a> Plant<'a> {
    /// A robot at rest at `start` (x, y of the chassis centre, θ; m, rad), moved in steps of `step_s`.
    #[must_use]
    pub fn new(machine: &'a Machine, start: [f64; 3], step_s: f64, hits: &[Hit]) -> Self {
        let com = machine.centre_of_mass_m;
        let places: Vec<[f64; 2]> =
            machine.wheels.iter().map(|w| [w.mount.x_m - com[0], w.mount.y_m - com[1]]).collect();
        let loads = LoadShare::new(&places, machine.mass_kg * GRAVITY, machine.centre_height_m);
        let power = &machine.power;
        let corners = machine
            .wheels
            .iter()
            .zip(&places)
            .enumerate()
            .map(|(i, (wheel, &place))| {
                let push = wheel.mount.grip();
                let ratio = power.gear_ratio;
                Corner {
                    shaft: Shaft::new(
                        wheel.inertia_kg_m2,
                        ratio * ratio * power.rotor_inertia,
                        wheel.play_rad / ratio,
                        power.gear_efficiency,
                    ),
                    current: 0.0,
                    heat: 0.0,
                    grip: Bristle::new(machine.ground.stiffness_n_m, machine.ground.damping_ns_m),
                    side: Bristle::new(0.1 * machine.ground.stiffness_n_m, machine.ground.damping_ns_m),
                    push,
                    free: [-push[1], push[0]],
                    place,
                    cos_roller: wheel.mount.roller_rad.cos(),
                    resting_load: loads.of(i, [0.0; 2]),
                }
            })
            .collect();
        let (sin, cos) = start[2].sin_cos();
        Self {
            machine,
            step: step_s,
            time: 0.0,
            centre: [start[0] + cos * com[0] - sin * com[1], start[1] + sin * com[0] + cos * com[1]],
            heading: start[2],
            velocity: [0.0; 2],
            spin: 0.0,
            corners,
            loads,
            ground_force: [0.0; 2],
            grain: Bristle::new(2.0e3, 10.0),
            battery_v: power.open_v,
            current_gain: 1.0 - (-step_s * power.resistance_ohm / power.inductance_h).exp(),
            hits: hits.to_vec(),
        }
    }

    /// One step with these duties (per physical wheel, −1 … 1) and this ground noise.
    pub fn advance(&mut self, duty: &[f64], shake: &Shake) {
        let step = self.step;
        self.time += step;
        self.centre[0] += step * self.velocity[0];
        self.centre[1] += step * self.velocity[1];
        self.heading += step * self.spin;
        let (sin, cos) = self.heading.sin_cos();
        let along = [cos * self.velocity[0] + sin * self.velocity[1], -sin * self.velocity[0] + cos * self.velocity[1]];
        let gate = ((along[0].hypot(along[1]) + 0.1 * self.spin.abs()) / NOISE_SPEED).min(1.0);
        let (mut force, mut moment, mut amps) = ([0.0; 2], 0.0, 0.0);
        for i in 0..self.corners.len() {
            let noise = gate * shake.shaft_nm.get(i).copied().unwrap_or(0.0);
            let (push, turn, drawn) = self.turn_wheel(i, duty.get(i).copied().unwrap_or(0.0), along, noise);
            force[0] += push[0];
            force[1] += push[1];
            moment += turn;
            amps += drawn;
        }
        self.battery_v = self.machine.power.open_v - self.machine.power.battery_ohm * amps;
        if self.machine.blocks {
            return;
        }
        for (smooth, now) in self.ground_force.iter_mut().zip(force) {
            *smooth += LOAD_SMOOTHING * (now - *smooth);
        }
        force[0] += gate * shake.force_n[0];
        force[1] += gate * shake.force_n[1];
        moment += gate * shake.moment_nm;
        let (outside, twist) = self.outside_forces();
        let world = [cos * force[0] - sin * force[1] + outside[0], sin * force[0] + cos * force[1] + outside[1]];
        self.velocity[0] += step / self.machine.mass_kg * world[0];
        self.velocity[1] += step / self.machine.mass_kg * world[1];
        self.spin += step / self.machine.yaw_inertia_kg_m2 * (moment + twist);
    }

    /// Motor, gear and contact of wheel `i`: force on the chassis (body frame, N), its moment about the centre of mass
    /// (Nm) and the battery current (A).
    fn turn_wheel(&mut self, i: usize, duty: f64, along: [f64; 2], noise: f64) -> ([f64; 2], f64, f64) {
        let (machine, step) = (self.machine, self.step);
        let (power, ground, wheel) = (&machine.power, &machine.ground, &machine.wheels[i]);
        let corner = &mut self.corners[i];
        corner.shaft.drift(step);
        let speed = corner.shaft.speed;

        let bridge = bridge(duty, power.dead_band, power.curvature);
        let resistance = power.resistance_ohm * (1.0 + power.heating_per_j * corner.heat);
        let back_emf = power.torque_constant * power.gear_ratio * corner.shaft.rotor_speed;
        let settled = (bridge * self.battery_v - back_emf) / resistance;
        corner.current += self.current_gain * (settled - corner.current);
        corner.heat += step * (resistance * corner.current * corner.current - corner.heat / power.cooling_s.max(1e-3));

        let mut push = [0.0; 2];
        let mut moment = 0.0;
        let mut torque = noise - wheel.viscous_nms * speed;
        if !machine.blocks {
            let [px, py] = corner.place;
            let point = [along[0] - self.spin * py, along[1] + self.spin * px];
            let ripple = wheel.ripple_count * corner.shaft.angle + wheel.ripple_phase_rad;
            let radius = wheel.radius_m * (1.0 + wheel.ripple_amplitude * ripple.cos());
            let slip = radius * speed * corner.cos_roller - dot(point, corner.push);
            let load = self.loads.of(i, self.ground_force);
            let friction = limit_ratio(ground, corner.grip.sliding);
            let creep = ground.creep_s_per_kg + ground.slip_ratio_per_n * (radius * speed).abs();
            let drive = corner.grip.advance(step, slip, creep, friction * load);
            let drag_limit = wheel.roller_drag_n * load / corner.resting_load.max(1e-9);
            let drag = corner.side.advance(step, dot(point, corner.free), 0.0, drag_limit);
            push = [drive * corner.push[0] - drag * corner.free[0], drive * corner.push[1] - drag * corner.free[1]];
            moment = px * push[1] - py * push[0];
            torque -= drive * radius * corner.cos_roller;
        }

        let mut held = 0.0;
        if wheel.stribeck_nm != 0.0 {
            held += wheel.stribeck_nm * (-(speed / wheel.stribeck_speed_rad_s).powi(2)).exp();
        }
        let [peak, harmonic, phase] = wheel.heading_drag;
        if peak != 0.0 {
            held += 0.5 * peak * (1.0 + (harmonic * self.heading - phase).cos());
        }
        for disturbance in &machine.disturbances {
            held += disturbance.dry_torque(i, self.time, self.heading);
            torque += disturbance.shaft_torque(i, self.time);
        }
        corner.shaft.kick(
            step,
            &Torques {
                motor: power.gear_ratio * power.torque_constant * corner.current,
                wheel: torque,
                motor_dry: power.gear_ratio * power.motor_friction_nm,
                wheel_dry: [held + wheel.dry_nm[0], held + wheel.dry_nm[1]],
            },
        );
        (push, moment, bridge * corner.current)
    }

    /// Forces (world frame, N) and moment (Nm) that are neither wheels nor noise.
    fn outside_forces(&mut self) -> ([f64; 2], f64) {
        let (machine, time) = (self.machine, self.time);
        let weight = machine.mass_kg * GRAVITY;
        let mut force = [weight * machine.ground.tilt_rad[0], weight * machine.ground.tilt_rad[1]];
        let mut moment = 0.0;
        if machine.ground.grain_n > 0.0 {
            let (sin, cos) = machine.ground.grain_azimuth_rad.sin_cos();
            let drag = self.grain.advance(self.step, dot(self.velocity, [cos, sin]), 0.0, machine.ground.grain_n);
            force[0] -= drag * cos;
            force[1] -= drag * sin;
        }
        for disturbance in &machine.disturbances {
            let [x, y] = disturbance.force(self.centre, self.velocity);
            force[0] += x;
            force[1] += y;
        }
        for hit in self.hits.iter().filter(|hit| (hit.start_s..hit.end_s).contains(&time)) {
            force[0] += hit.force_n[0];
            force[1] += hit.force_n[1];
            moment += hit.moment_nm;
        }
        (force, moment)
    }

    /// Chassis centre and heading now: x, y (m, world), θ (rad, not wrapped).
    #[must_use]
    pub fn pose(&self) -> [f64; 3] {
        let half = 0.5 * self.step;
        let heading = self.heading + half * self.spin;
        let (sin, cos) = heading.sin_cos();
        let [cx, cy] = self.machine.centre_of_mass_m;
        [
            self.centre[0] + half * self.velocity[0] - cos * cx + sin * cy,
            self.centre[1] + half * self.velocity[1] - sin * cx - cos * cy,
            heading,
        ]
    }

    /// Velocity of the centre of mass (world, m/s) and yaw rate (rad/s).
    #[must_use]
    pub fn twist(&self) -> [f64; 3] {
        [self.velocity[0], self.velocity[1], self.spin]
    }

    /// Sets the motion: velocity of the centre of mass (world, m/s), yaw rate, all wheels rolling with it.
    pub fn set_twist(&mut self, [vx, vy, spin]: [f64; 3]) {
        self.velocity = [vx, vy];
        self.spin = spin;
        let (sin, cos) = self.heading.sin_cos();
        let along = [cos * vx + sin * vy, -sin * vx + cos * vy];
        for (corner, wheel) in self.corners.iter_mut().zip(&self.machine.wheels) {
            let [px, py] = corner.place;
            let rim = dot([along[0] - spin * py, along[1] + spin * px], corner.push) / corner.cos_roller;
            corner.shaft.speed = rim / wheel.radius_m;
            corner.shaft.rotor_speed = corner.shaft.speed;
        }
    }

    /// Angle of the motor shaft of wheel `i` now, over the gear ratio, rad.
    #[must_use]
    pub fn rotor_angle(&self, i: usize) -> f64 {
        let shaft = &self.corners[i].shaft;
        shaft.rotor_angle + 0.5 * self.step * shaft.rotor_speed
    }

    /// Speed of the motor shaft of wheel `i` over the gear ratio, rad/s.
    #[must_use]
    pub fn rotor_speed(&self, i: usize) -> f64 {
        self.corners[i].shaft.rotor_speed
    }

    /// Voltage at the battery's terminals, V.
    #[must_use]
    pub fn battery_v(&self) -> f64 {
        self.battery_v
    }

    /// Heat in the winding of wheel `i` beyond the cold state, J.
    #[must_use]
    pub fn winding_heat_j(&self, i: usize) -> f64 {
        self.corners[i].heat
    }

    /// Kinetic and elastic energy, J.
    #[must_use]
    pub fn energy_j(&self) -> f64 {
        let [vx, vy] = self.velocity;
        let chassis =
            0.5 * (self.machine.mass_kg * (vx * vx + vy * vy) + self.machine.yaw_inertia_kg_m2 * self.spin * self.spin);
        let wheels: f64 = self.corners.iter().map(|c| c.shaft.energy() + c.grip.energy() + c.side.energy()).sum();
        chassis + wheels + self.grain.energy()
    }
}

/// Static and sliding friction over load at this sliding speed (Stribeck's law).
fn limit_ratio(ground: &crate::machine::Ground, sliding: f64) -> f64 {
    if sliding == 0.0 {
        return ground.friction_static;
    }
    let fade = (-(sliding / ground.friction_speed_m_s).powi(2)).exp();
    ground.friction_sliding + (ground.friction_static - ground.friction_sliding) * fade
}

/// Part of the battery voltage at the motor for a duty.
fn bridge(duty: f64, dead_band: f64, curvature: f64) -> f64 {
    let size = (duty.abs() - dead_band).max(0.0);
    (size * (1.0 + curvature * (size - 1.0))).copysign(duty)
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Angle in counts of an encoder on the motor shaft: `counts·(1 + scale)·gear·angle/2π`.
#[must_use]
pub(crate) fn counts_of(angle_rad: f64, gear_ratio: f64, counts_per_rev: f64) -> f64 {
    angle_rad * gear_ratio * counts_per_rev / TAU
}
