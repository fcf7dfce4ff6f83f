//! Torques and forces at every tick.

use std::borrow::Cow;
use std::mem::take;

use runs::frames::Twist;
use runs::robot::Support;

use super::instant::{Instant, Loads};
use super::signals::Signals;
use super::{Ahead, DriveModel};
use crate::segment::Segment;

/// Torques of the wheels and forces on the body at the ticks of a segment but the last, `[wheels + 3][tick]`.
pub type Forces = Vec<Vec<f64>>;

/// Torques and forces of a model at every tick of a segment, with all that further loads look at.
pub(super) struct Base<'a> {
    model: &'a DriveModel,
    segment: &'a Segment,
    /// As of [`DriveModel::forces`].
    pub(super) forces: Forces,
    signals: Signals<'a>,
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

impl<'a> Base<'a> {
    /// Of a model at a segment; what loads look at is worked out if loads are to be added.
    pub(super) fn new(model: &'a DriveModel, segment: &'a Segment, more: bool) -> Self {
        let prepared = model.prepared(segment);
        let (forces, signals) = model.evaluate(segment, &prepared, more, Axes::Body);
        Self { model, segment, forces, signals, prepared }
    }

    /// What a model that only adds loads to this one adds to its torques and forces; nothing where that is 0 throughout.
    pub(super) fn loads_of(&self, other: &DriveModel) -> Vec<Option<Vec<f64>>> {
        let (s, n) = (self.segment, self.model.wheels.len());
        let more = &other.loads[self.model.loads.len()..];
        if more.is_empty() || self.signals.ticks() == 0 {
            return vec![None; n + 3];
        }
        let new = &other.prepare[self.prepared.len()..];
        let prepared = if new.is_empty() {
            Cow::Borrowed(&self.prepared)
        } else {
            Cow::Owned(self.prepared.iter().cloned().chain(new.iter().map(|p| p(other, s))).collect())
        };
        let mut out: Vec<Option<Vec<f64>>> = vec![None; n + 3];
        let axes = self.model.constants();
        let ticks = self.signals.ticks();
        self.model.each_instant(s, &self.signals, &prepared, |k, now, loads| {
            for term in more {
                term(now, loads);
            }
            for (i, axis) in axes.iter().enumerate() {
                let more = take(&mut loads.carried[i]);
                if more != 0.0 {
                    let before = self.signals.carried[i].get(k).copied().unwrap_or(0.0);
                    let lost = |carried| axis.lost(now.winding[i], now.sign[i], carried);
                    loads.wheel[i] += more - now.sign[i] * (lost(before + more) - lost(before));
                }
            }
            for (row, x) in out.iter_mut().zip(loads.wheel.iter_mut().chain(&mut loads.body)) {
                let x = take(x);
                if x != 0.0 {
                    row.get_or_insert_with(|| vec![0.0; ticks])[k] = x;
                }
            }
        });
        out
    }

    /// What the offsets are that a model which only adds to this one adds, `[offset][wheel][tick]`.
    pub(super) fn offsets_of(&self, other: &DriveModel) -> Vec<(Ahead, Vec<Vec<f64>>)> {
        other.offsets[self.model.offsets.len()..].iter().map(|(what, o)| (*what, o(other, self.segment))).collect()
    }
}

impl DriveModel {
    pub(super) fn sliding_per_turning(&self) -> f64 {
        crate::thresholds::SLIDES * self.wheel_radius_m
    }

    /// Torque by which the back-EMF brakes each wheel, Nm per rad/s.
    pub(super) fn braking(&self) -> Vec<f64> {
        self.axes.iter().map(|a| a.braking(self.gear_ratio)).collect()
    }

    /// Largest torque with which each wheel may stick, Nm, at the start of a segment: of friction, and of a bridge that does
    /// nothing at small duties, which near rest does the same.
    pub(super) fn standing_friction(&self, s: &Segment) -> Vec<f64> {
        let n = self.wheels.len();
        let prepared = self.prepared(s);
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
                facing: s.facing[0],
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

    /// What the terms with memory prepare.
    fn prepared(&self, s: &Segment) -> Vec<Vec<Vec<f64>>> {
        self.prepare.iter().map(|p| p(self, s)).collect()
    }

    /// Wheel torques and body forces at the ticks of a segment. Inertias have no part in them on the floor, as
    /// [`crate::effect::Effect::is_inertia`] says; nor may terms have.
    pub fn forces(&self, s: &Segment) -> Forces {
        self.evaluate(s, &self.prepared(s), false, Axes::Body).0
    }

    /// The same without gravity and what turning axes add: what an accelerometer feels.
    pub(super) fn felt_forces(&self, s: &Segment) -> Forces {
        self.evaluate(s, &self.prepared(s), false, Axes::Inertial).0
    }

    /// Torques and forces, and the signals that they come from: all of them if further loads ask for `more`.
    fn evaluate<'a>(
        &self,
        s: &'a Segment,
        prepared: &[Vec<Vec<f64>>],
        more: bool,
        axes_of: Axes,
    ) -> (Forces, Signals<'a>) {
        let n = self.wheels.len();
        let ticks = s.t.len().saturating_sub(1);
        if s.duty.len() != n || s.angle.len() != n || ticks == 0 {
            return (vec![vec![0.0; ticks]; n + 3], Signals::default());
        }
        let axes = self.constants();
        // Only terms and maps look at more than duties and counts.
        let all = more || !self.loads.is_empty() || !self.supply_maps.is_empty();
        let turns = axes_of == Axes::Body && self.support == Support::Floor;
        let mut signals = Signals::of(self, s, &axes, all, turns);
        if !self.supply_maps.is_empty() {
            signals.lay();
            signals.supply = self.mapped_supply(s, &signals, prepared).into();
        }
        signals.wind(s, &axes);
        if more || !self.loads.is_empty() {
            signals.lay();
        }
        let mut out = vec![vec![0.0; ticks]; n + 3];
        if turns {
            self.inertial(s, &signals, &mut out[n..]);
        }
        if self.loads.is_empty() {
            signals.carried = vec![Vec::new(); n];
        } else {
            let mut carried = vec![vec![0.0; ticks]; n];
            self.each_instant(s, &signals, prepared, |k, now, loads| {
                for (slot, row) in loads.body.iter_mut().zip(&out[n..]) {
                    *slot = row[k];
                }
                for term in &self.loads {
                    term(now, loads);
                }
                for (row, x) in out.iter_mut().zip(loads.wheel.iter_mut().chain(&mut loads.body)) {
                    row[k] = take(x);
                }
                for (row, x) in carried.iter_mut().zip(&mut loads.carried) {
                    row[k] = take(x);
                }
            });
            signals.carried = carried;
        }
        for (i, axis) in axes.iter().enumerate() {
            let given = out[i].iter_mut().zip(&signals.winding[i]).zip(&*signals.sign[i]);
            let of_motor =
                |winding, sign, carried| winding + carried - sign * (axis.coulomb + axis.lost(winding, sign, carried));
            if signals.carried[i].is_empty() {
                given.for_each(|((out, winding), sign)| *out += of_motor(*winding, *sign, 0.0));
            } else {
                let carried = given.zip(&signals.carried[i]);
                carried.for_each(|(((out, winding), sign), carried)| *out += of_motor(*winding, *sign, *carried));
            }
        }
        (out, signals)
    }
}
