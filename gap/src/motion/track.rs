//! Chassis poses at the frames of the camera, by a model's wheels and clock.
//!
//! A linearisation asks for the tracks of a hundred models that differ in one number each. What they have in common with
//! the model they were made from is worked out once.

use std::borrow::Cow;
use std::ops::Range;

use runs::frames::{Twist, Walk};

use super::MotionModel;
use crate::segment::{Frame, Segment};

/// Turns of the wheels of a segment under one model, and where they take the body.
pub(super) struct Path<'a> {
    model: &'a MotionModel,
    segment: &'a Segment,
    /// Wheel angles with all changes.
    angles: Cow<'a, [Vec<f64>]>,
    /// What the wheels turn from each tick to the next, rad, `[tick][wheel]`, flat.
    turned: Cow<'a, [f64]>,
    /// Body displacement per wheel angle.
    columns: Vec<[f64; 3]>,
}

impl<'a> Path<'a> {
    /// Of a model on a segment; `None` where the wheels cannot drive the robot.
    pub(super) fn new(model: &'a MotionModel, segment: &'a Segment) -> Option<Self> {
        let columns = model.columns()?;
        let angles = model.angles(segment);
        let turned = Cow::Owned(turned(&angles));
        Some(Self { model, segment, angles, turned, columns })
    }

    /// Of another model on the same segment.
    pub(super) fn of<'b>(&'b self, model: &'b MotionModel) -> Option<Path<'b>> {
        let columns = model.columns()?;
        let (known, all) = (&self.model.origins, &model.origins);
        let is_more =
            known.len() == self.model.angles.len() && all.len() == model.angles.len() && all.starts_with(known);
        let (angles, turned) = match &model.angles[known.len().min(model.angles.len())..] {
            _ if !is_more => {
                let angles = model.angles(self.segment);
                let turned = Cow::Owned(turned(&angles));
                (angles, turned)
            }
            [] => (Cow::Borrowed(&*self.angles), Cow::Borrowed(&*self.turned)),
            more => {
                let mut angles = self.angles.to_vec();
                more.iter().for_each(|change| change(self.segment, &mut angles));
                let turned = Cow::Owned(turned(&angles));
                (Cow::Owned(angles), turned)
            }
        };
        Some(Path { model, segment: self.segment, angles, turned, columns })
    }

    /// Some camera frames of its segment.
    pub(super) fn frames(&self, range: &Range<usize>) -> &[Frame] {
        &self.segment.frames[range.clone()]
    }

    /// Whether its tracks are those of another path that borrowed from it.
    pub(super) fn is_as(&self, other: &Path) -> bool {
        let clock = |m: &MotionModel| (m.latency_s, m.clock_drift, offset(m, self.segment), m.speed_delay);
        matches!(other.turned, Cow::Borrowed(_))
            && self.columns == other.columns
            && clock(self.model) == clock(other.model)
    }

    /// Chassis poses at the frames of one window, relative to that at the window's first frame, added to `out`.
    /// The marker and the camera are not in it yet.
    pub(super) fn track(&self, frames: &[Frame], out: &mut Vec<Walk>) {
        // Loops of a known length over the wheels.
        match self.columns.len() {
            2 => self.walk(&self.fixed::<2>(), frames, out),
            3 => self.walk(&self.fixed::<3>(), frames, out),
            4 => self.walk(&self.fixed::<4>(), frames, out),
            n => {
                let moved = |k: usize| moved(&self.columns, &self.turned[k * n..(k + 1) * n]);
                self.walk(&moved, frames, out);
            }
        }
    }

    fn fixed<const N: usize>(&self) -> impl Fn(usize) -> Twist {
        let (turned, _) = self.turned.as_chunks::<N>();
        let mut columns = [[0.0; 3]; N];
        columns.iter_mut().zip(&self.columns).for_each(|(to, from)| *to = *from);
        move |k| moved(&columns, &turned[k])
    }

    /// The same by the body's displacement from a tick to the next.
    fn walk(&self, moved: &impl Fn(usize) -> Twist, frames: &[Frame], out: &mut Vec<Walk>) {
        let Some(first) = frames.first() else { return };
        let (model, segment) = (self.model, self.segment);
        let last_tick = segment.t.len() - 1;
        let offset = offset(model, segment);
        let age = |stamp: f64| model.latency_s + offset + model.clock_drift * (stamp - segment.stretch[0]);
        let early = if model.speed_delay == 0.0 { 0.0 } else { 0.1 };
        let origin = segment.tick_at(first.t - age(first.t) - early);
        let here = Walk::by(Twist::default());
        let (mut tick, mut walk) = (origin, here);
        let mut back = here;
        for (i, frame) in frames.iter().enumerate() {
            let mut exposed = frame.t - age(frame.t);
            if model.speed_delay != 0.0 {
                exposed -= model.speed_delay * segment.twist[segment.tick_at(exposed)].speed();
            }
            if exposed < segment.t[tick] {
                // Delays may differ from frame to frame: start over.
                (tick, walk) = (origin, here);
            }
            while tick < last_tick && segment.t[tick + 1] <= exposed {
                walk.step(moved(tick));
                tick += 1;
            }
            let mut at = walk;
            if tick < last_tick && exposed > segment.t[tick] {
                let share = (exposed - segment.t[tick]) / (segment.t[tick + 1] - segment.t[tick]);
                at.step(moved(tick).scaled(share));
            }
            if i == 0 {
                back = at.inverse();
            }
            out.push(back.then(&at));
        }
    }
}

/// Age of a frame beyond the latency in a segment's run, s.
fn offset(model: &MotionModel, segment: &Segment) -> f64 {
    model.clock_offset_s.get(segment.run).copied().unwrap_or(0.0)
}

#[inline]
fn moved(columns: &[[f64; 3]], turned: &[f64]) -> Twist {
    let mut sum = [0.0; 3];
    for (column, turned) in columns.iter().zip(turned) {
        for (s, c) in sum.iter_mut().zip(column) {
            *s += c * turned;
        }
    }
    Twist::new(sum[0], sum[1], sum[2])
}

/// Differences of the angles of all wheels, `[tick][wheel]`, flat.
fn turned(angles: &[Vec<f64>]) -> Vec<f64> {
    let (n, ticks) = (angles.len(), angles.first().map_or(0, Vec::len));
    let mut out = vec![0.0; n * ticks.saturating_sub(1)];
    for (i, angle) in angles.iter().enumerate() {
        for (slot, pair) in out[i..].iter_mut().step_by(n).zip(angle.windows(2)) {
            *slot = pair[1] - pair[0];
        }
    }
    out
}
