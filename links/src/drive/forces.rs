//! Torques and forces at every tick.

use std::borrow::Cow;

use model::plant::GRAVITY;
use runs::frames::Twist;
use runs::robot::Support;

use super::{Ahead, DriveModel};
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

    /// Body velocity in world axes, m/s.
    pub fn world_velocity(&self) -> [f64; 2] {
        let (s, c) = self.heading.sin_cos();
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
    fn none(wheels: usize) -> Self {
        Self { wheel: vec![0.0; wheels], carried: vec![0.0; wheels], body: [0.0; 3] }
    }

    fn clear(&mut self) {
        self.wheel.fill(0.0);
        self.carried.fill(0.0);
        self.body = [0.0; 3];
    }

    /// Adds a force in world axes, N, at the chassis centre.
    pub fn push_world(&mut self, heading: f64, force: [f64; 2]) {
        let (s, c) = heading.sin_cos();
        self.body[0] += c * force[0] + s * force[1];
        self.body[1] += -s * force[0] + c * force[1];
    }
}

/// What is the same at every tick of an axis, at its output shaft.
struct Axis {
    /// Nm per volt.
    gain: f64,
    /// Nm per rad/s.
    damping: f64,
    /// Friction of the motor, Nm.
    coulomb: f64,
    /// Share of the transmitted torque that is lost.
    loss: f64,
    /// Share of the winding's torque that passes through the gear: off the floor, what turns the rotor does not.
    passed: f64,
}

impl Axis {
    /// Duty that keeps a speed, rad/s.
    fn holds(&self, speed: f64, sign: f64, supply: f64) -> f64 {
        let volts = (self.damping * speed + self.coulomb * sign) / self.gain;
        if supply > 0.0 { volts / supply } else { 0.0 }
    }

    /// Torque that the gear loses, Nm, by size.
    fn lost(&self, winding: f64, sign: f64, carried: f64) -> f64 {
        self.loss * (self.passed * (winding - self.coulomb * sign) - (1.0 - self.passed) * carried).abs()
    }
}

/// Torques and forces of a model at every tick of a segment, with all that further loads look at.
pub(super) struct Base<'a> {
    model: &'a DriveModel,
    segment: &'a Segment,
    /// As of [`DriveModel::forces`].
    pub(super) forces: Vec<f64>,
    /// `[tick][SIGNALS wheels + 4]`, flat, without the last tick: duty, speed, sign, winding, sideways speed and carried
    /// torque of the wheels, twist, supply.
    signals: Vec<f64>,
    prepared: Vec<Vec<Vec<f64>>>,
}

/// In which axes the body's motion is told.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Axes {
    /// Its own: they turn with it, and gravity pulls.
    Body,
    /// Those of an accelerometer, which feels forces alone.
    Inertial,
}

/// Signals of a wheel.
const SIGNALS: usize = 6;

impl<'a> Base<'a> {
    /// Of a model at a segment; without its signals, unless loads are to be added.
    pub(super) fn new(model: &'a DriveModel, segment: &'a Segment, with_signals: bool) -> Self {
        let prepared: Vec<Vec<Vec<f64>>> = model.prepare.iter().map(|p| p(model, segment)).collect();
        let room = if with_signals { segment.t.len() * (SIGNALS * model.wheels.len() + 4) } else { 0 };
        let mut signals = Vec::with_capacity(room);
        let forces = model.evaluate(segment, &prepared, with_signals.then_some(&mut signals), Axes::Body);
        Self { model, segment, forces, signals, prepared }
    }

    /// What a model that only adds loads to this one adds to its torques and forces, `[wheels + 3][tick]`; nothing where
    /// that is 0 throughout. `None` for a model that changes more.
    pub(super) fn loads_of(&self, other: &DriveModel) -> Option<Vec<Option<Vec<f64>>>> {
        let s = self.segment;
        let n = self.model.wheels.len();
        if !other.only_loads_more(self.model) {
            return None;
        }
        let more = &other.loads[self.model.loads.len()..];
        if more.is_empty() {
            return Some(vec![None; n + 3]);
        }
        if self.signals.is_empty() {
            return None;
        }
        let new = &other.prepare[self.prepared.len()..];
        let prepared = if new.is_empty() {
            Cow::Borrowed(&self.prepared)
        } else {
            Cow::Owned(self.prepared.iter().cloned().chain(new.iter().map(|p| p(other, s))).collect())
        };
        let mut out = vec![vec![0.0; s.t.len()]; n + 3];
        let mut loads = Loads::none(n);
        let axes = self.model.constants();
        let braking = self.model.braking();
        let sliding_per_turning = self.model.sliding_per_turning();
        for (k, signals) in self.signals.chunks_exact(SIGNALS * n + 4).enumerate() {
            let (by_wheel, whole) = signals.split_at(SIGNALS * n);
            let wheel = |index: usize| &by_wheel[index * n..(index + 1) * n];
            let now = Instant {
                segment: s,
                tick: k,
                time_s: s.t[k] - s.stretch[0],
                duty: wheel(0),
                supply: whole[3],
                speed: wheel(1),
                sign: wheel(2),
                winding: wheel(3),
                braking: &braking,
                sideways: wheel(4),
                twist: Twist::new(whole[0], whole[1], whole[2]),
                heading: s.heading[k],
                position: s.position[k],
                prepared: &prepared,
                sliding_per_turning,
            };
            loads.clear();
            for term in more {
                term(&now, &mut loads);
            }
            for (i, axis) in axes.iter().enumerate() {
                let (before, more) = (wheel(5)[i], loads.carried[i]);
                if more != 0.0 {
                    let lost = |carried| axis.lost(now.winding[i], now.sign[i], carried);
                    loads.wheel[i] += more - now.sign[i] * (lost(before + more) - lost(before));
                }
            }
            for (row, x) in out.iter_mut().zip(loads.wheel.iter().chain(&loads.body)) {
                row[k] = *x;
            }
        }
        Some(out.into_iter().map(|row| row.iter().any(|x| *x != 0.0).then_some(row)).collect())
    }

    /// What the offsets are that a model which only adds to this one adds, `[offset][wheel][tick]`.
    pub(super) fn offsets_of(&self, other: &DriveModel) -> Vec<(Ahead, Vec<Vec<f64>>)> {
        other.offsets[self.model.offsets.len()..].iter().map(|(what, o)| (*what, o(other, self.segment))).collect()
    }
}

impl DriveModel {
    fn sliding_per_turning(&self) -> f64 {
        crate::thresholds::SLIDES * self.wheel_radius_m
    }

    /// Torque by which the back-EMF brakes each wheel, Nm per rad/s.
    fn braking(&self) -> Vec<f64> {
        self.axes.iter().map(|a| a.braking(self.gear_ratio)).collect()
    }

    fn constants(&self) -> Vec<Axis> {
        let g = self.gear_ratio;
        let of = |a: &super::AxisModel| {
            let gain = g * a.torque_constant / a.resistance;
            let rotor = g * g * a.rotor_inertia;
            Axis {
                gain,
                damping: a.braking(g) * a.encoder_scale,
                coulomb: g * a.friction,
                loss: a.gear_loss,
                passed: match self.support {
                    Support::Blocks => a.load_inertia / (a.load_inertia + rotor).max(1e-300),
                    Support::Floor => 1.0,
                },
            }
        };
        self.axes.iter().map(of).collect()
    }

    /// Largest torque with which each wheel may stick, Nm, at the start of a segment: of friction, and of a bridge that does
    /// nothing at small duties, which near rest does the same.
    pub(super) fn standing_friction(&self, s: &Segment) -> Vec<f64> {
        let n = self.wheels.len();
        let prepared: Vec<Vec<Vec<f64>>> = self.prepare.iter().map(|p| p(self, s)).collect();
        let still = vec![0.0; n];
        let braking = self.braking();
        let turning = |sense: f64| {
            let now = Instant {
                segment: s,
                tick: 0,
                time_s: 0.0,
                duty: &still,
                supply: s.supply[0],
                speed: &still,
                sign: &vec![sense; n],
                winding: &still,
                braking: &braking,
                sideways: &still,
                twist: Twist::default(),
                heading: s.heading[0],
                position: s.position[0],
                prepared: &prepared,
                sliding_per_turning: self.sliding_per_turning(),
            };
            let mut loads = Loads::none(n);
            self.loads.iter().for_each(|term| term(&now, &mut loads));
            loads.wheel
        };
        let (forwards, backwards) = (turning(1.0), turning(-1.0));
        let loads = forwards.iter().zip(&backwards).map(|(a, b)| 0.5 * (b - a).max(0.0));
        let constants = self.constants();
        let idle = (0..n).map(|i| constants[i].gain * s.supply[0] * self.idle_duty(i));
        let friction = loads.zip(&self.axes).map(|(load, axis)| load + self.gear_ratio * axis.friction);
        friction.zip(idle).map(|(friction, idle)| friction + idle).collect()
    }

    /// Largest duty at which a wheel's bridge does nothing.
    fn idle_duty(&self, wheel: usize) -> f64 {
        /// Halvings of the whole range of duties.
        const STEPS: i32 = 12;
        let (mut idle, mut acts) = (0.0, 1.0);
        for _ in 0..STEPS {
            let duty = 0.5 * (idle + acts);
            let passed = self.duty_maps.iter().fold(duty, |u, map| map(wheel, u));
            if passed < 0.01 * duty { idle = duty } else { acts = duty }
        }
        idle
    }

    /// Wheel torques and body forces at every tick of a segment, `[tick][wheels + 3]`, flat.
    pub fn forces(&self, s: &Segment) -> Vec<f64> {
        let prepared: Vec<Vec<Vec<f64>>> = self.prepare.iter().map(|p| p(self, s)).collect();
        self.evaluate(s, &prepared, None, Axes::Body)
    }

    /// The same without gravity and what turning axes add: what an accelerometer feels.
    pub(super) fn felt_forces(&self, s: &Segment) -> Vec<f64> {
        let prepared: Vec<Vec<Vec<f64>>> = self.prepare.iter().map(|p| p(self, s)).collect();
        self.evaluate(s, &prepared, None, Axes::Inertial)
    }

    /// The same; writes down what loads look at, if that is asked for.
    fn evaluate(
        &self,
        s: &Segment,
        prepared: &[Vec<Vec<f64>>],
        mut signals: Option<&mut Vec<f64>>,
        axes_of: Axes,
    ) -> Vec<f64> {
        let n = self.wheels.len();
        let width = n + 3;
        let ticks = s.t.len();
        let mut out = vec![0.0; ticks * width];
        if s.duty.len() != n || s.angle.len() != n {
            return out;
        }
        let free: Vec<[f64; 3]> = self
            .wheels
            .iter()
            .map(|w| {
                // Perpendicular to the traction direction.
                let [ax, ay] = w.traction();
                [-ay, ax, w.x_m * ax + w.y_m * ay]
            })
            .collect();
        let g = self.gear_ratio;
        let (mut duty, mut speed, mut sign) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        let (mut winding, mut sideways, mut currents) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        let mut passed: Vec<Option<LowPass>> = vec![None; n];
        let mut loads = Loads::none(n);
        let start = s.stretch[0];
        let from_wheels: Option<Vec<[f64; 3]>> = self.twist_per_wheel_speed().map(|m| {
            let of_wheel = |(i, a): (usize, &super::AxisModel)| [0, 1, 2].map(|j| m[(j, i)] * a.encoder_scale);
            self.axes.iter().enumerate().map(of_wheel).collect()
        });
        let sliding_per_turning = self.sliding_per_turning();
        // Only terms and maps look at more than duties and counts.
        let bare = self.loads.is_empty() && self.supply_maps.is_empty() && signals.is_none();
        let axes = self.constants();
        let braking = self.braking();
        for k in 0..ticks - 1 {
            let dt = s.t[k + 1] - s.t[k];
            let per_dt = 1.0 / dt;
            // By the wheels as they are: skews and radii that were found turn the Coriolis force, too.
            let twist = match &from_wheels {
                Some(columns) => {
                    let mut sum = [0.0; 3];
                    for (column, speed) in columns.iter().zip(&s.speed) {
                        for (sum, c) in sum.iter_mut().zip(column) {
                            *sum += c * over_row(speed, k);
                        }
                    }
                    Twist::new(sum[0], sum[1], sum[2])
                }
                None => {
                    let (at, next) = (s.twist[k], s.twist[k + 1]);
                    let mean = |a: f64, b: f64| 0.5 * (a + b);
                    Twist::new(mean(at.vx, next.vx), mean(at.vy, next.vy), mean(at.omega, next.omega))
                }
            };
            for i in 0..n {
                let mut u = if self.duty_delay_s == 0.0 {
                    s.duty[i][k]
                } else {
                    delayed(&s.duty[i], k, self.duty_delay_s / dt)
                };
                for map in &self.duty_maps {
                    u = map(i, u);
                }
                // Of wheels that are read through a low-pass all is late as they are: what drives them, too.
                if self.reading_filter_s > 0.0 {
                    let began = || LowPass { at: axes[i].holds(s.speed[i][k], s.sign[i][k], s.supply[k]) };
                    u = passed[i].get_or_insert_with(began).over_row(u, dt / self.reading_filter_s);
                }
                duty[i] = u;
                sign[i] = over_row(&s.sign[i], k);
                if bare {
                    continue;
                }
                speed[i] = self.axes[i].encoder_scale * over_row(&s.speed[i], k);
                sideways[i] = free[i][0] * twist.vx + free[i][1] * twist.vy + free[i][2] * twist.omega;
            }
            let mut supply = s.supply[k];
            if !self.supply_maps.is_empty() {
                let mut mapped = |from: f64| {
                    for i in 0..n {
                        let axis = &self.axes[i];
                        currents[i] = (duty[i] * from - axis.back_emf * g * speed[i]) / axis.resistance;
                    }
                    let now = Instant {
                        segment: s,
                        tick: k,
                        time_s: s.t[k] - start,
                        duty: &duty,
                        supply: s.supply[k],
                        speed: &speed,
                        sign: &sign,
                        winding: &winding,
                        braking: &braking,
                        sideways: &sideways,
                        twist,
                        heading: s.heading[k],
                        position: s.position[k],
                        prepared,
                        sliding_per_turning,
                    };
                    self.supply_maps.iter().fold(s.supply[k], |v, map| map(&now, v, &currents))
                };
                // The supply sets the currents and they the supply: the fixed point, by a secant.
                let first = mapped(supply);
                let second = mapped(first);
                let slope = if first == supply { 0.0 } else { (second - first) / (first - supply) };
                supply = if slope < 0.95 { first + (second - first) / (1.0 - slope) } else { second };
            }
            for i in 0..n {
                // Raw increments where the equation is linear: nothing is lost by smoothing.
                let raw = (s.angle[i][k + 1] - s.angle[i][k]) * per_dt;
                winding[i] = axes[i].gain * duty[i] * supply - axes[i].damping * raw;
            }
            loads.clear();
            if self.support == Support::Floor && axes_of == Axes::Body {
                let [cx, cy] = self.centre_of_mass;
                let (px, py) = (self.mass * (twist.vx - twist.omega * cy), self.mass * (twist.vy + twist.omega * cx));
                loads.body =
                    [twist.omega * py, -twist.omega * px, -self.mass * twist.omega * (cx * twist.vx + cy * twist.vy)];
                if self.slope_rad != [0.0; 2] {
                    loads.push_world(s.heading[k], self.slope_rad.map(|slope| self.mass * GRAVITY * slope));
                }
            }
            if !self.loads.is_empty() {
                let now = Instant {
                    segment: s,
                    tick: k,
                    time_s: s.t[k] - start,
                    duty: &duty,
                    supply,
                    speed: &speed,
                    sign: &sign,
                    winding: &winding,
                    braking: &braking,
                    sideways: &sideways,
                    twist,
                    heading: s.heading[k],
                    position: s.position[k],
                    prepared,
                    sliding_per_turning,
                };
                for term in &self.loads {
                    term(&now, &mut loads);
                }
            }
            for (i, axis) in axes.iter().enumerate() {
                let lost = axis.lost(winding[i], sign[i], loads.carried[i]);
                loads.wheel[i] += winding[i] + loads.carried[i] - sign[i] * (axis.coulomb + lost);
            }
            let row = &mut out[k * width..(k + 1) * width];
            row[..n].copy_from_slice(&loads.wheel);
            row[n..].copy_from_slice(&loads.body);
            if let Some(signals) = &mut signals {
                for part in [&duty, &speed, &sign, &winding, &sideways, &loads.carried] {
                    signals.extend_from_slice(part);
                }
                signals.extend([twist.vx, twist.vy, twist.omega, supply]);
            }
        }
        out
    }
}

/// Mean from a tick to the next of a signal that is known at the ticks: a load acts for as long as the duty of its row.
fn over_row(values: &[f64], k: usize) -> f64 {
    0.5 * (values[k] + values[k + 1])
}

/// A low-pass of first order.
#[derive(Debug, Clone, Copy)]
struct LowPass {
    at: f64,
}

impl LowPass {
    /// Mean of what comes out while `held` goes in for `rows` time constants.
    fn over_row(&mut self, held: f64, rows: f64) -> f64 {
        let begins = self.at - held;
        let kept = (-rows).exp();
        self.at = held + begins * kept;
        held + begins * (1.0 - kept) / rows
    }
}

/// A held signal `ticks` ago, 0 before its start.
fn delayed(values: &[f64], k: usize, ticks: f64) -> f64 {
    let at = |m: i64| if m < 0 { 0.0 } else { values[(m as usize).min(values.len() - 1)] };
    let whole = ticks.floor();
    let share = ticks - whole;
    let m = k as i64 - whole as i64;
    (1.0 - share) * at(m) + share * at(m - 1)
}
