//! Torques and forces at every tick.

use std::mem::take;
use std::sync::OnceLock;

use runs::frames::Twist;
use runs::robot::Support;

use super::instant::{Instant, Loads};
use super::signals::Signals;
use super::{DriveModel, LoadTerm};
use crate::segment::Segment;

/// Torques of the wheels and forces on the body at the ticks of a segment but the last, `[wheels + 3][tick]`.
pub type Forces = Vec<Vec<f64>>;

/// Torques and forces of a model at every tick of a segment without its loads that add up, and what those look at; each is
/// worked out when it is asked for.
pub(super) struct Base<'a> {
    model: &'a DriveModel,
    segment: &'a Segment,
    forces: OnceLock<Forces>,
    signals: OnceLock<Signals<'a>>,
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
    /// Nothing is worked out before it is asked for.
    pub(super) fn new(model: &'a DriveModel, segment: &'a Segment) -> Self {
        Self { model, segment, forces: OnceLock::new(), signals: OnceLock::new() }
    }

    /// As of [`DriveModel::forces`].
    pub(super) fn forces(&self) -> &Forces {
        self.forces.get_or_init(|| {
            let inside = self.model.proportional.iter().filter(|load| !self.model.adds_up(load));
            let loads: Vec<&LoadTerm> = self.model.loads.iter().chain(inside.flat_map(|load| &load.own)).collect();
            self.model.evaluate(self.segment, Axes::Body, &loads)
        })
    }

    /// What a load that adds up adds to torques and forces; nothing where that is 0 throughout.
    pub(super) fn of_load(&self, load: &[LoadTerm]) -> Vec<Option<Vec<f64>>> {
        let (s, n) = (self.segment, self.model.wheels.len());
        let mut out: Vec<Option<Vec<f64>>> = vec![None; n + 3];
        if !self.model.is_measured_by(s) {
            return out;
        }
        let signals = self.signals.get_or_init(|| {
            let mut signals = self.model.signals(s, &self.model.prepared(s), true, true);
            signals.lay();
            signals
        });
        let ticks = signals.ticks();
        self.model.each_instant(s, signals, &[], |k, now, loads| {
            for term in load {
                term(now, loads);
            }
            for (wheel, carried) in loads.wheel.iter_mut().zip(&mut loads.carried) {
                *wheel += take(carried);
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
    /// nothing at small duties or takes some volts off, which near rest does the same.
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
                supply: self.supply_at(s, 0),
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
            self.all_loads().into_iter().for_each(|term| term(&now, &mut loads));
            loads.wheel
        };
        let (forwards, backwards) = (turning(1.0), turning(-1.0));
        let loads = forwards.iter().zip(&backwards).map(|(a, b)| 0.5 * (b - a).max(0.0));
        let constants = self.constants();
        let idle = (0..n).map(|i| constants[i].gain * (self.supply_at(s, 0) * self.idle_duty(i) + self.bridge_drop_v));
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

    /// Wheel torques and body forces at the ticks of a segment. Inertias have no part in them on the floor; nor may terms have.
    pub fn forces(&self, s: &Segment) -> Forces {
        self.evaluate(s, Axes::Body, &self.all_loads())
    }

    /// The same without gravity and what turning axes add: what an accelerometer feels.
    pub(super) fn felt_forces(&self, s: &Segment) -> Forces {
        self.evaluate(s, Axes::Inertial, &self.all_loads())
    }

    /// Its loads with the proportional ones.
    fn all_loads(&self) -> Vec<&LoadTerm> {
        self.loads.iter().chain(self.proportional.iter().flat_map(|p| &p.own)).collect()
    }

    /// Whether a segment has all that moves its wheels.
    fn is_measured_by(&self, s: &Segment) -> bool {
        let n = self.wheels.len();
        s.duty.len() == n && s.angle.len() == n && s.t.len() > 1
    }

    /// The signals that torques and forces come from, laid out if the supply is worked out; twists and what they make only
    /// where they are looked at.
    fn signals<'a>(&self, s: &'a Segment, prepared: &[Vec<Vec<f64>>], all: bool, turns: bool) -> Signals<'a> {
        let axes = self.constants();
        // Only terms and maps look at more than duties and counts.
        let mut signals = Signals::of(self, s, &axes, all || !self.supply_maps.is_empty(), turns);
        if !self.supply_maps.is_empty() {
            signals.lay();
            signals.supply = self.mapped_supply(s, &signals, prepared).into();
        }
        signals.wind(s, &axes);
        signals
    }

    /// Torques and forces with these loads.
    fn evaluate(&self, s: &Segment, axes_of: Axes, load: &[&LoadTerm]) -> Forces {
        let n = self.wheels.len();
        let ticks = s.t.len().saturating_sub(1);
        let mut out = vec![vec![0.0; ticks]; n + 3];
        if !self.is_measured_by(s) {
            return out;
        }
        let axes = self.constants();
        let prepared = self.prepared(s);
        let turns = axes_of == Axes::Body && self.support == Support::Floor;
        let mut signals = self.signals(s, &prepared, !load.is_empty(), turns);
        if turns {
            self.inertial(s, &signals, &mut out[n..]);
        }
        let mut carried = vec![Vec::new(); n];
        if !load.is_empty() {
            signals.lay();
            carried = vec![vec![0.0; ticks]; n];
            self.each_instant(s, &signals, &prepared, |k, now, loads| {
                for (slot, row) in loads.body.iter_mut().zip(&out[n..]) {
                    *slot = row[k];
                }
                for term in load {
                    term(now, loads);
                }
                for (row, x) in out.iter_mut().zip(loads.wheel.iter_mut().chain(&mut loads.body)) {
                    row[k] = take(x);
                }
                for (row, x) in carried.iter_mut().zip(&mut loads.carried) {
                    row[k] = take(x);
                }
            });
        }
        for (i, axis) in axes.iter().enumerate() {
            let given = out[i].iter_mut().zip(&signals.winding[i]).zip(&*signals.sign[i]);
            let of_motor =
                |winding, sign, carried| winding + carried - sign * (axis.coulomb + axis.lost(winding, sign, carried));
            if carried[i].is_empty() {
                given.for_each(|((out, winding), sign)| *out += of_motor(*winding, *sign, 0.0));
            } else {
                let given = given.zip(&carried[i]);
                given.for_each(|(((out, winding), sign), carried)| *out += of_motor(*winding, *sign, *carried));
            }
        }
        out
    }
}
