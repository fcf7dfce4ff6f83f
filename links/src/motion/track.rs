//! Chassis poses at the frames of the camera, by a model's wheels and clock.
//!
//! A linearisation asks for the tracks of a hundred models that differ in one number each. What they have in common with
//! the model they were made from is worked out once.

use std::borrow::Cow;

use runs::frames::{Pose, SMALL_RAD, Twist, Walk, displacement, small_chord};

use super::{AngleChange, CameraFilter, MotionModel, lag};
use crate::segment::{Frame, Segment};

/// Turns of the wheels of a segment under one model, and where they take the body.
pub(crate) struct Path<'a> {
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
    pub(crate) fn new(model: &'a MotionModel, segment: &'a Segment) -> Option<Self> {
        let columns = model.columns()?;
        let angles = model.angles(segment);
        let turned = Cow::Owned(turned(&angles));
        Some(Self { model, segment, angles, turned, columns })
    }

    /// Of another model on the same segment.
    pub(crate) fn of<'b>(&'b self, model: &'b MotionModel) -> Option<Path<'b>> {
        let columns = model.columns()?;
        let (angles, turned) = match self.further(model) {
            None => {
                let angles = model.angles(self.segment);
                let turned = Cow::Owned(turned(&angles));
                (angles, turned)
            }
            Some([]) => (Cow::Borrowed(&*self.angles), Cow::Borrowed(&*self.turned)),
            Some(more) => {
                let mut angles = self.angles.to_vec();
                more.iter().for_each(|change| change(self.segment, &mut angles));
                let turned = Cow::Owned(turned(&angles));
                (Cow::Owned(angles), turned)
            }
        };
        Some(Path { model, segment: self.segment, angles, turned, columns })
    }

    /// What another model changes of the angles after all that this one's does; `None` if that is not all.
    fn further<'b>(&self, model: &'b MotionModel) -> Option<&'b [AngleChange]> {
        let (known, all) = (&self.model.origins, &model.origins);
        let is_more = self.model.floor == model.floor
            && known.len() == self.model.angles.len()
            && all.len() == model.angles.len()
            && all.starts_with(known);
        is_more.then(|| &model.angles[known.len()..])
    }

    /// How another model's track differs from this one's.
    pub(super) fn differs(&self, model: &MotionModel) -> Differs {
        let Some(columns) = model.columns() else { return Differs::Alone };
        if clock(model, self.segment) != clock(self.model, self.segment) || columns.len() != self.columns.len() {
            return Differs::Alone;
        }
        match self.further(model) {
            Some([]) if columns == self.columns => Differs::Nowhere,
            Some([]) => Differs::InColumns,
            _ => Differs::InTurns,
        }
    }

    /// Body displacement per wheel angle.
    pub(crate) fn columns(&self) -> &[[f64; 3]] {
        &self.columns
    }

    /// What the wheels turn from each tick to the next, rad, `[tick][wheel]`, flat.
    pub(crate) fn turned(&self) -> &[f64] {
        &self.turned
    }

    /// Wheel angles, rad, `[wheel][tick]`.
    pub(crate) fn angles(&self) -> &[Vec<f64>] {
        &self.angles
    }

    /// When what a frame of a stamp shows was so, by the camera's clock.
    fn exposure(&self) -> impl Fn(f64) -> f64 {
        let segment = self.segment;
        let Clock { latency, drift, offset, delay, .. } = clock(self.model, segment);
        move |stamp| {
            let exposed = stamp - (latency + offset + drift * (stamp - segment.stretch[0]));
            if delay == 0.0 { exposed } else { exposed - delay * segment.twist[segment.tick_at(exposed)].speed() }
        }
    }

    /// Whether the camera shows poses that were filtered.
    fn is_filtered(&self) -> bool {
        self.model.camera_filter.time_s > 0.0
    }

    /// Chassis poses at the frames of one window, relative to that at the window's first frame, added to `out`.
    /// The marker and the camera are not in it yet.
    pub(super) fn track(&self, frames: &[Frame], out: &mut Vec<Walk>) {
        let mut keep = |p: Walk| out.push(p);
        if self.is_filtered() {
            let n = self.columns.len();
            let moved = |k: usize| moved(&self.columns, &self.turned[k * n..(k + 1) * n]);
            return lag::walk(self.segment, &moved, &self.exposure(), self.model.camera_filter, frames, &mut keep);
        }
        // Loops of a known length over the wheels.
        match self.columns.len() {
            2 => self.walk(&self.moved_by::<2>(), frames, &mut keep),
            3 => self.walk(&self.moved_by::<3>(), frames, &mut keep),
            4 => self.walk(&self.moved_by::<4>(), frames, &mut keep),
            n => {
                let moved = |k: usize| moved(&self.columns, &self.turned[k * n..(k + 1) * n]);
                self.walk(&moved, frames, &mut keep);
            }
        }
    }

    fn moved_by<const N: usize>(&self) -> impl Fn(usize) -> Twist {
        let (turned, _) = self.turned.as_chunks::<N>();
        let mut columns = [[0.0; 3]; N];
        columns.iter_mut().zip(&self.columns).for_each(|(to, from)| *to = *from);
        move |k| moved(&columns, &turned[k])
    }

    /// The tracks along some windows, one after the other.
    pub(super) fn alone(&self, windows: &[&[Frame]]) -> Vec<Walk> {
        let mut out = Vec::with_capacity(windows.iter().map(|w| w.len()).sum());
        windows.iter().for_each(|frames| self.track(frames, &mut out));
        out
    }

    /// The same of paths of one clock and as many wheels, one for each.
    pub(super) fn beside(paths: &[Path], windows: &[&[Frame]]) -> Vec<Vec<Walk>> {
        let room = windows.iter().map(|w| w.len()).sum();
        let mut out: Vec<Vec<Walk>> = paths.iter().map(|_| Vec::with_capacity(room)).collect();
        for (paths, out) in paths.chunks(LANES).zip(out.chunks_mut(LANES)) {
            let first = &paths[0];
            if first.is_filtered() || !(2..=4).contains(&first.columns.len()) {
                paths.iter().zip(out).for_each(|(path, out)| *out = path.alone(windows));
                continue;
            }
            let mut keep = |p: Lanes| out.iter_mut().enumerate().for_each(|(lane, out)| out.push(p.lane(lane)));
            match first.columns.len() {
                2 => windows.iter().for_each(|w| first.walk(&Self::moved_by_each::<2>(paths), w, &mut keep)),
                3 => windows.iter().for_each(|w| first.walk(&Self::moved_by_each::<3>(paths), w, &mut keep)),
                _ => windows.iter().for_each(|w| first.walk(&Self::moved_by_each::<4>(paths), w, &mut keep)),
            }
        }
        out
    }

    fn moved_by_each<'p, const N: usize>(paths: &'p [Path<'p>]) -> impl Fn(usize) -> [[f64; LANES]; 3] + use<'p, N> {
        let all: [&[[f64; N]]; LANES] =
            std::array::from_fn(|lane| paths[lane.min(paths.len() - 1)].turned.as_chunks::<N>().0);
        let shared = all.iter().all(|turned| std::ptr::eq(*turned, all[0]));
        let mut columns = [[[0.0; LANES]; 3]; N];
        for (i, column) in columns.iter_mut().enumerate() {
            for (axis, lanes) in column.iter_mut().enumerate() {
                lanes.iter_mut().zip(paths).for_each(|(to, path)| *to = path.columns[i][axis]);
            }
        }
        move |k| {
            let mut sum = [[0.0; LANES]; 3];
            let mut each = [[0.0; LANES]; N];
            for (i, each) in each.iter_mut().enumerate() {
                if shared {
                    each.fill(all[0][k][i]);
                } else {
                    each.iter_mut().zip(&all).for_each(|(each, turned)| *each = turned[k][i]);
                }
            }
            for (column, turned) in columns.iter().zip(&each) {
                for (sum, column) in sum.iter_mut().zip(column) {
                    for lane in 0..LANES {
                        sum[lane] += column[lane] * turned[lane];
                    }
                }
            }
            sum
        }
    }

    /// The same by the body's displacement from a tick to the next.
    #[inline(always)]
    fn walk<P: Place>(&self, moved: &impl Fn(usize) -> P::Move, frames: &[Frame], keep: &mut impl FnMut(P)) {
        let Some(first) = frames.first() else { return };
        let segment = self.segment;
        let last_tick = segment.t.len() - 1;
        let exposure = self.exposure();
        let early = if self.model.speed_delay == 0.0 { 0.0 } else { 0.1 };
        let origin = segment.tick_at(exposure(first.t) - early);
        let (mut tick, mut walk) = (origin, P::origin());
        let mut back = P::origin();
        for (i, frame) in frames.iter().enumerate() {
            let exposed = exposure(frame.t);
            if exposed < segment.t[tick] {
                // Delays may differ from frame to frame: start over.
                (tick, walk) = (origin, P::origin());
            }
            while tick < last_tick && segment.t[tick + 1] <= exposed {
                walk = walk.then(&P::by(&moved(tick), 1.0));
                tick += 1;
            }
            let mut at = walk;
            if tick < last_tick && exposed > segment.t[tick] {
                let share = (exposed - segment.t[tick]) / (segment.t[tick + 1] - segment.t[tick]);
                at = at.then(&P::by(&moved(tick), share));
            }
            if i == 0 {
                back = at.inverse();
            }
            keep(back.then(&at));
        }
    }
}

/// How a model's track differs from that of the one it was made from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Differs {
    /// Not at all: only the marker or the camera does.
    Nowhere,
    /// By where its wheels take the body.
    InColumns,
    /// By what its wheels turn, too.
    InTurns,
    /// By its clock or its wheels, so that it is walked alone.
    Alone,
}

/// What a model says of when the camera saw what it shows in a run.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Clock {
    /// Age of every frame, s.
    latency: f64,
    /// Seconds ahead per second.
    drift: f64,
    /// Age of the frames of this run beside that, s.
    offset: f64,
    /// Age per speed of the robot, s²/m.
    delay: f64,
    /// What smooths its poses after that.
    filter: CameraFilter,
}

fn clock(m: &MotionModel, segment: &Segment) -> Clock {
    Clock {
        latency: m.latency_s,
        drift: m.clock_drift,
        offset: m.clock_offset_s.get(segment.run).copied().unwrap_or(0.0),
        delay: m.speed_delay,
        filter: m.camera_filter,
    }
}

/// Models whose tracks are walked side by side.
pub(super) const LANES: usize = 8;

/// A pose, or those of several models side by side.
trait Place: Copy {
    /// A displacement of the body.
    type Move;
    fn origin() -> Self;
    /// From the origin by a share of a displacement.
    fn by(d: &Self::Move, share: f64) -> Self;
    fn then(&self, local: &Self) -> Self;
    fn inverse(&self) -> Self;
}

impl Place for Walk {
    type Move = Twist;

    #[inline]
    fn origin() -> Self {
        Self::by(Twist::default())
    }

    #[inline]
    fn by(d: &Twist, share: f64) -> Self {
        Self::by(d.scaled(share))
    }

    #[inline]
    fn then(&self, local: &Self) -> Self {
        self.then(local)
    }

    #[inline]
    fn inverse(&self) -> Self {
        self.inverse()
    }
}

/// As [`Walk`], of several models.
#[derive(Clone, Copy)]
struct Lanes {
    x: [f64; LANES],
    y: [f64; LANES],
    theta: [f64; LANES],
    cos: [f64; LANES],
    sin: [f64; LANES],
}

impl Lanes {
    fn lane(&self, lane: usize) -> Walk {
        let pose = Pose::new(self.x[lane], self.y[lane], self.theta[lane]);
        Walk::turned(pose, self.cos[lane], self.sin[lane])
    }
}

impl Place for Lanes {
    type Move = [[f64; LANES]; 3];

    #[inline(always)]
    fn origin() -> Self {
        let zero = [0.0; LANES];
        Self { x: zero, y: zero, theta: zero, cos: [1.0; LANES], sin: zero }
    }

    #[inline(always)]
    fn by([vx, vy, omega]: &Self::Move, share: f64) -> Self {
        let mut out = Self::origin();
        let mut most = 0.0_f64;
        for l in 0..LANES {
            let (vx, vy, w) = (vx[l] * share, vy[l] * share, omega[l] * share);
            let (a, b) = small_chord(w);
            out.x[l] = a * vx - b * vy;
            out.y[l] = b * vx + a * vy;
            out.theta[l] = w;
            out.cos[l] = 1.0 - w * b;
            out.sin[l] = w * a;
        }
        for w in out.theta {
            most = if w.abs() > most { w.abs() } else { most };
        }
        if most > SMALL_RAD {
            for l in 0..LANES {
                let d = Twist::new(vx[l], vy[l], omega[l]).scaled(share);
                let walk = Walk::from(displacement(d));
                let p = walk.pose();
                (out.x[l], out.y[l], out.theta[l]) = (p.x, p.y, p.theta);
                (out.sin[l], out.cos[l]) = p.theta.sin_cos();
            }
        }
        out
    }

    #[inline(always)]
    fn then(&self, local: &Self) -> Self {
        let mut out = *self;
        for l in 0..LANES {
            out.x[l] += self.cos[l] * local.x[l] - self.sin[l] * local.y[l];
            out.y[l] += self.sin[l] * local.x[l] + self.cos[l] * local.y[l];
            out.theta[l] += local.theta[l];
            out.cos[l] = self.cos[l] * local.cos[l] - self.sin[l] * local.sin[l];
            out.sin[l] = self.sin[l] * local.cos[l] + self.cos[l] * local.sin[l];
        }
        out
    }

    #[inline(always)]
    fn inverse(&self) -> Self {
        let mut out = *self;
        for l in 0..LANES {
            out.x[l] = -(self.cos[l] * self.x[l] + self.sin[l] * self.y[l]);
            out.y[l] = self.sin[l] * self.x[l] - self.cos[l] * self.y[l];
            out.theta[l] = -self.theta[l];
            out.sin[l] = -self.sin[l];
        }
        out
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::values::Values;

    #[test]
    fn models_side_by_side_go_where_each_goes_alone() {
        let robot = runs::robot::Robot::racbot();
        let ticks = 200;
        let t: Vec<f64> = (0..ticks).map(|k| 0.01 * k as f64).collect();
        // Turns of every size, those beyond the series' reach among them.
        let angle = |i: usize| t.iter().map(|t| 40.0 * (3.0 * t + i as f64).sin() * t).collect();
        let twist = vec![Twist::new(0.3, 0.1, 0.0); ticks];
        let frames: Vec<Frame> = (3..150).map(|k| Frame { t: 0.0131 * k as f64, pose: Pose::default() }).collect();
        let segment = Segment { angle: (0..3).map(angle).collect(), twist, t, ..Segment::default() };
        let base = MotionModel { latency_s: 0.013, ..MotionModel::new(&robot) };
        let path = Path::new(&base, &segment).unwrap();
        let models: Vec<MotionModel> = (0..11)
            .map(|k| {
                let mut model = MotionModel { latency_s: 0.013, ..MotionModel::new(&robot) };
                model.distance_scale[k % 3] = 1.0 + 0.01 * k as f64;
                if k > 8 {
                    // Wheels that turn otherwise.
                    model.angles.push(Box::new(move |_, angles| angles[k % 3].iter_mut().for_each(|a| *a *= 1.1)));
                    model.angles_are_of("turned", &Values::default());
                }
                model
            })
            .collect();
        let paths: Vec<Path> = models.iter().map(|m| path.of(m).unwrap()).collect();
        let differs = |k: usize| path.differs(&models[k]);
        assert_eq!(
            [0, 1, 9, 10].map(differs),
            [Differs::Nowhere, Differs::InColumns, Differs::InTurns, Differs::InTurns]
        );
        let together = Path::beside(&paths, &[&frames[..70], &frames[70..]]);
        for (model, together) in models.iter().zip(together) {
            let alone = Path::new(model, &segment).unwrap();
            let track = alone.alone(&[&frames[..70], &frames[70..]]);
            assert_eq!(track.len(), together.len());
            for (a, b) in track.iter().zip(&together) {
                assert!(a.pose().distance(b.pose()) < 1e-12 && (a.pose().theta - b.pose().theta).abs() < 1e-12);
            }
        }
        // The clock is not the columns.
        let late = MotionModel { latency_s: 0.02, ..MotionModel::new(&robot) };
        assert_eq!(path.differs(&late), Differs::Alone);
    }
}
