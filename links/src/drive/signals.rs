//! What the terms of the drive model look at, column by column: each is a loop over ticks that a processor runs several at a
//! time.

use std::borrow::Cow;

use model::plant::GRAVITY;
use runs::frames::Twist;
use runs::robot::Support;

use super::DriveModel;
use super::instant::{Instant, Loads, in_body};
use crate::segment::Segment;
use crate::thresholds::NOISY_AT_LIMIT;

/// What is the same at every tick of an axis, at its output shaft.
pub(super) struct Axis {
    /// Nm per volt.
    pub(super) gain: f64,
    /// Nm per rad/s.
    damping: f64,
    /// Torque that the motor has at most, Nm; infinite where nothing limits its current.
    most: f64,
    /// Torque that the bridge takes off, Nm.
    dropped: f64,
    /// Friction of the motor, Nm.
    pub(super) coulomb: f64,
    /// Share of the transmitted torque that is lost.
    loss: f64,
    /// Share of the winding's torque that passes through the gear: off the floor, what turns the rotor does not.
    pub(super) passed: f64,
}

impl Axis {
    /// Duty that keeps a speed, rad/s.
    fn holds(&self, speed: f64, sign: f64, supply: f64) -> f64 {
        let volts = (self.damping * speed + self.coulomb * sign) / self.gain;
        if supply > 0.0 { volts / supply } else { 0.0 }
    }

    /// Torque that the gear loses, Nm, by size.
    pub(super) fn lost(&self, winding: f64, sign: f64, carried: f64) -> f64 {
        self.loss * (self.passed * (winding - self.coulomb * sign) - (1.0 - self.passed) * carried).abs()
    }
}

/// Signals that each wheel has, in [`Signals::lay`].
const BY_WHEEL: usize = 5;

/// Ticks that are laid out at a time: what is written stays at hand from the first signal to the last.
const TOGETHER: usize = 64;

/// A signal of each wheel; the segment's own where a model leaves it as it is.
type ByWheel<'a> = Vec<Cow<'a, [f64]>>;

/// Signals of a model at the ticks of a segment but the last; means from each to the next.
#[derive(Default)]
pub(super) struct Signals<'a> {
    /// Duty that acts, −1 to 1, `[wheel][tick]`, as the others of the wheels.
    pub(super) duty: ByWheel<'a>,
    /// Speed, rad/s.
    pub(super) speed: ByWheel<'a>,
    /// Direction of rotation, −1 to 1.
    pub(super) sign: ByWheel<'a>,
    /// Torque of the winding at the wheel shaft, Nm.
    pub(super) winding: Vec<Vec<f64>>,
    /// Speed of the contact in the direction in which its rollers roll, m/s.
    pub(super) sideways: Vec<Vec<f64>>,
    /// To the right, forward, counter-clockwise: m/s, m/s, rad/s.
    pub(super) twist: [Vec<f64>; 3],
    /// V.
    pub(super) supply: Cow<'a, [f64]>,
    /// The wheels' duties, speeds, directions, windings and sideways speeds once more, tick by tick, as terms look at them.
    rows: Vec<f64>,
}

impl<'a> Signals<'a> {
    /// Of a model, but for its windings; twists and what they make only where they are looked at.
    pub(super) fn of(model: &DriveModel, s: &'a Segment, axes: &[Axis], all: bool, twist: bool) -> Self {
        let n = model.wheels.len();
        let rows = s.rows();
        let mut out = Self { supply: model.supplies(s), ..Self::default() };
        out.duty = (0..n).map(|i| model.acting_duty(s, i, &axes[i])).collect();
        out.sign = rows.sign.iter().map(|sign| Cow::Borrowed(sign.as_slice())).collect();
        if all || twist {
            out.twist = model.twists(s);
        }
        if all {
            out.speed = rows.speed.iter().zip(&model.axes).map(|(w, axis)| scaled(w, axis.encoder_scale)).collect();
            out.sideways = model.rolls_free(&out.twist);
        }
        out
    }

    /// Lays the wheels' signals side by side, tick by tick, for [`DriveModel::each_instant`]; again only what is new since.
    pub(super) fn lay(&mut self) {
        let (n, ticks) = (self.duty.len(), self.ticks());
        let mut rows = std::mem::take(&mut self.rows);
        let mut columns: Vec<(usize, &[f64])> = Vec::with_capacity(BY_WHEEL * n);
        if rows.is_empty() {
            rows = vec![0.0; BY_WHEEL * n * ticks];
            for (kind, signals) in [&self.duty, &self.speed, &self.sign].into_iter().enumerate() {
                columns.extend(signals.iter().enumerate().map(|(i, x)| (kind * n + i, &**x)));
            }
            columns.extend(self.sideways.iter().enumerate().map(|(i, x)| (4 * n + i, x.as_slice())));
        }
        // Windings are not there yet where the supply is worked out.
        columns.extend(self.winding.iter().enumerate().map(|(i, x)| (3 * n + i, x.as_slice())));
        for (block, rows) in rows.chunks_mut(TOGETHER * BY_WHEEL * n).enumerate() {
            for (place, column) in &columns {
                for (row, value) in rows.chunks_exact_mut(BY_WHEEL * n).zip(&column[block * TOGETHER..]) {
                    row[*place] = *value;
                }
            }
        }
        self.rows = rows;
    }

    /// Ticks but the last.
    pub(super) fn ticks(&self) -> usize {
        self.supply.len()
    }

    /// Torques of the windings by duties and supply. Raw increments of the angles where the equation is linear: nothing is
    /// lost by smoothing.
    pub(super) fn wind(&mut self, s: &Segment, axes: &[Axis]) {
        let of = |((duty, rate), axis): ((&Cow<[f64]>, &Vec<f64>), &Axis)| -> Vec<f64> {
            let (gain, damping) = (axis.gain, axis.damping);
            let driven = duty.iter().zip(&*self.supply).zip(rate);
            driven.map(|((duty, supply), rate)| gain * duty * supply - damping * rate).collect()
        };
        let rows = s.rows();
        self.winding = self.duty.iter().zip(&rows.rate).zip(axes).map(of).collect();
        for (i, axis) in axes.iter().enumerate().filter(|(_, axis)| axis.most.is_finite() || axis.dropped > 0.0) {
            self.limit(i, axis, [&rows.rate[i], &rows.speed[i]]);
        }
    }

    /// Takes off what a bridge drops and what a limit of the current does not let through, by the raw increments of the angles,
    /// or, where that would cut off their noise, by the smoothed speeds.
    fn limit(&mut self, wheel: usize, axis: &Axis, [rate, speed]: [&[f64]; 2]) {
        let apart = rate.iter().zip(speed).map(|(a, b)| axis.damping * (a - b));
        let edge = if axis.dropped > 0.0 { axis.dropped.min(axis.most) } else { axis.most };
        let noisy = estimation::statistics::rms(apart) > NOISY_AT_LIMIT * edge;
        let driven = self.duty[wheel].iter().zip(&*self.supply).zip(if noisy { speed } else { rate });
        for (winding, ((duty, supply), speed)) in self.winding[wheel].iter_mut().zip(driven) {
            let asked = axis.gain * duty * supply - axis.damping * speed;
            *winding -= asked - passed(asked, axis.dropped, axis.most);
        }
    }
}

/// What a bridge that drops and a limit pass of a current or a torque that is asked for.
fn passed(asked: f64, dropped: f64, most: f64) -> f64 {
    (asked - asked.clamp(-dropped, dropped)).clamp(-most, most)
}

impl DriveModel {
    pub(super) fn constants(&self) -> Vec<Axis> {
        let g = self.gear_ratio;
        let of = |a: &super::AxisModel| {
            let gain = g * a.torque_constant / a.resistance;
            let rotor = g * g * a.rotor_inertia;
            Axis {
                gain,
                damping: a.braking(g) * a.encoder_scale,
                most: g * a.torque_constant * self.current_limit_a,
                dropped: gain * self.bridge_drop_v,
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

    /// Supply at a tick, V: as logged, or what the model has in its place.
    pub(super) fn supply_at(&self, s: &Segment, tick: usize) -> f64 {
        if s.supply_logged {
            return s.supply[tick];
        }
        let fallen = self.supply_fall_v_per_s * (s.t[tick] - s.begins_s);
        (self.supply_scale * s.supply[tick] - fallen).max(0.0)
    }

    /// The same at every tick of a segment but the last.
    fn supplies<'a>(&self, s: &'a Segment) -> Cow<'a, [f64]> {
        let ticks = s.t.len() - 1;
        if s.supply_logged || (self.supply_scale == 1.0 && self.supply_fall_v_per_s == 0.0) {
            return Cow::Borrowed(&s.supply[..ticks]);
        }
        (0..ticks).map(|k| self.supply_at(s, k)).collect()
    }

    /// Duty of a wheel that acts at the ticks of a segment.
    fn acting_duty<'a>(&self, s: &'a Segment, wheel: usize, axis: &Axis) -> Cow<'a, [f64]> {
        let logged = &s.duty[wheel];
        let ticks = s.t.len() - 1;
        let dt = |k: usize| s.t[k + 1] - s.t[k];
        let mut duty: Cow<[f64]> = if self.duty_delay_s == 0.0 {
            Cow::Borrowed(&logged[..ticks])
        } else {
            delayed(&s.t, &logged[..ticks], self.duty_delay_s).into()
        };
        for map in &self.duty_maps {
            duty.to_mut().iter_mut().for_each(|u| *u = map(wheel, *u));
        }
        // Of wheels that are read through a low-pass all is late as they are: what drives them, too.
        if self.reading_filter_s > 0.0 && ticks > 0 {
            let mut passed = LowPass { at: axis.holds(s.speed[wheel][0], s.sign[wheel][0], self.supply_at(s, 0)) };
            for (k, u) in duty.to_mut().iter_mut().enumerate() {
                *u = passed.over_row(*u, dt(k) / self.reading_filter_s);
            }
        }
        duty
    }

    /// Body twists by the wheels as they are: skews and radii that were found turn the Coriolis force, too.
    fn twists(&self, s: &Segment) -> [Vec<f64>; 3] {
        let Some(per_speed) = self.twist_per_wheel_speed() else {
            let mean = |of: fn(&Twist) -> f64| s.twist.windows(2).map(|t| 0.5 * (of(&t[0]) + of(&t[1]))).collect();
            return [mean(|t| t.vx), mean(|t| t.vy), mean(|t| t.omega)];
        };
        let mut out = [0; 3].map(|_| vec![0.0; s.t.len() - 1]);
        for (j, out) in out.iter_mut().enumerate() {
            for (i, (speed, axis)) in s.rows().speed.iter().zip(&self.axes).enumerate() {
                let per_speed = per_speed[(j, i)] * axis.encoder_scale;
                out.iter_mut().zip(speed).for_each(|(sum, w)| *sum += per_speed * w);
            }
        }
        out
    }

    /// Speeds of the contacts across their traction, m/s, `[wheel][tick]`.
    fn rolls_free(&self, [vx, vy, omega]: &[Vec<f64>; 3]) -> Vec<Vec<f64>> {
        let of = |wheel: &runs::geometry::Wheel| {
            let free = wheel.free_row();
            let twists = vx.iter().zip(vy).zip(omega);
            twists.map(|((vx, vy), omega)| free[0] * vx + free[1] * vy + free[2] * omega).collect()
        };
        self.wheels.iter().map(of).collect()
    }

    /// Supplies that the model's maps make, V.
    pub(super) fn mapped_supply(&self, s: &Segment, signals: &Signals, prepared: &[Vec<Vec<f64>>]) -> Vec<f64> {
        let g = self.gear_ratio;
        let mut currents = vec![0.0; self.wheels.len()];
        let mut out = Vec::with_capacity(signals.ticks());
        self.each_instant(s, signals, prepared, |_, now, _| {
            let mut mapped = |from: f64| {
                for (i, (current, axis)) in currents.iter_mut().zip(&self.axes).enumerate() {
                    let asked = axis.asks_a(now.duty[i] * from, g, now.speed[i]);
                    let dropped = self.bridge_drop_v / axis.resistance;
                    *current = passed(asked, dropped, self.current_limit_a);
                }
                self.supply_maps.iter().fold(now.supply, |v, map| map(now, v, &currents))
            };
            // The supply sets the currents and they the supply: the fixed point, by a secant.
            let first = mapped(now.supply);
            let second = mapped(first);
            let slope = if first == now.supply { 0.0 } else { (second - first) / (first - now.supply) };
            out.push(if slope < 0.95 { first + (second - first) / (1.0 - slope) } else { second });
        });
        out
    }

    /// Forces of axes that turn with the body, and of a floor that slopes, added to forces on the body, `[3][tick]`.
    pub(super) fn inertial(&self, s: &Segment, signals: &Signals, body: &mut [Vec<f64>]) {
        let ([cx, cy], mass) = (self.centre_of_mass, self.mass);
        let [vx, vy, omega] = &signals.twist;
        let [right, forward, turning] = body else { return };
        for (k, ((vx, vy), omega)) in vx.iter().zip(vy).zip(omega).enumerate() {
            let (px, py) = (mass * (vx - omega * cy), mass * (vy + omega * cx));
            right[k] += omega * py;
            forward[k] += -omega * px;
            turning[k] += -mass * omega * (cx * vx + cy * vy);
        }
        if self.slope_rad != [0.0; 2] {
            let pull = self.slope_rad.map(|slope| mass * GRAVITY * slope);
            for (k, facing) in s.facing.iter().enumerate().take(right.len()) {
                let [x, y] = in_body(*facing, pull);
                right[k] += x;
                forward[k] += y;
            }
        }
    }

    /// Calls for every tick with what terms see of it, and loads as the call before left them, of 0 at first; the signals are
    /// laid out.
    pub(super) fn each_instant(
        &self,
        s: &Segment,
        signals: &Signals,
        prepared: &[Vec<Vec<f64>>],
        mut of: impl FnMut(usize, &Instant, &mut Loads),
    ) {
        let n = self.wheels.len();
        let mut loads = Loads::none(n);
        let braking = self.braking();
        let sliding_per_turning = self.sliding_per_turning();
        let [vx, vy, omega] = &signals.twist;
        for (k, row) in signals.rows.chunks_exact(BY_WHEEL * n).enumerate() {
            let [duty, speed, sign, winding, sideways] = [0, 1, 2, 3, 4].map(|kind| &row[kind * n..(kind + 1) * n]);
            let now = Instant {
                segment: s,
                tick: k,
                time_s: s.t[k] - s.stretch[0],
                duty,
                supply: signals.supply[k],
                speed,
                sign,
                winding,
                braking: &braking,
                sideways,
                twist: Twist::new(vx[k], vy[k], omega[k]),
                heading: s.heading[k],
                facing: s.facing[k],
                position: s.position[k],
                prepared,
                sliding_per_turning,
            };
            of(k, &now, &mut loads);
        }
    }
}

fn scaled(values: &[f64], factor: f64) -> Cow<'_, [f64]> {
    if factor == 1.0 { Cow::Borrowed(values) } else { values.iter().map(|x| factor * x).collect() }
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

/// Means over the rows from `t` on of a signal held from row to row, so many seconds ago; 0 before its start. Rows of a
/// camera between those of the wheels make them uneven.
fn delayed(t: &[f64], held: &[f64], seconds: f64) -> Vec<f64> {
    let (mut row, mut passed) = (0, 0.0);
    // Of the signal from its start to a time, the times in order.
    let mut area = |at: f64| {
        if at <= t[0] {
            return 0.0;
        }
        while row + 1 < held.len() && t[row + 1] <= at {
            passed += held[row] * (t[row + 1] - t[row]);
            row += 1;
        }
        passed + held[row] * (at - t[row])
    };
    let mut before = t.first().map_or(0.0, |t| area(t - seconds));
    let rows = t.windows(2).map(|t| {
        let now = area(t[1] - seconds);
        let mean = (now - before) / (t[1] - t[0]);
        before = now;
        mean
    });
    rows.take(held.len()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a camera 2 ms after every row of the wheels, which the duty is held over.
    #[test]
    fn a_delay_is_a_time_where_rows_are_uneven() {
        let duties = [0.1, 0.4, -0.2, 0.3, 0.7, 0.5];
        let even: Vec<f64> = (0..=6).map(|k| 0.016 * f64::from(k)).collect();
        let mut uneven: Vec<f64> = even[..6].iter().flat_map(|t| [*t, t + 0.002]).collect();
        uneven.push(even[6]);
        let twice: Vec<f64> = duties.iter().flat_map(|u| [*u; 2]).collect();
        for seconds in [-0.004, 0.0, 0.005, 0.033] {
            let wanted = delayed(&even, &duties, seconds);
            let rows = delayed(&uneven, &twice, seconds);
            for (k, wanted) in wanted.iter().enumerate() {
                let mean = (0.002 * rows[2 * k] + 0.014 * rows[2 * k + 1]) / 0.016;
                assert!((mean - wanted).abs() < 1e-12, "{seconds} s, row {k}: {mean} {wanted}");
            }
        }
        // Of even rows a part of one row and of the next.
        let late = delayed(&even, &duties, 0.024);
        assert!(late[0] == 0.0 && (late[2] - 0.5 * (0.1 + 0.4)).abs() < 1e-12, "{late:?}");
    }
}
