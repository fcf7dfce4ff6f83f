//! A piece of a run without gaps, with everything the links need derived from it once.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use estimation::sums::dot;
use runs::frames::{Pose, Twist, displacement, wrap_angle};
use runs::geometry::Geometry;
use runs::robot::Robot;
use runs::{Columns, Log, Run, Seen};

use crate::inertial::Felt;
use crate::memo::Memo;
use crate::thresholds::{self, TEST_FUNCTION_S};

/// Time over which wheel speeds are smoothed (full width of a Hann window), s: at one count a
/// millisecond the quantum of a speed, 0.83 rad/s, becomes 0.04 rad/s.
pub(crate) const SMOOTHING_S: f64 = 0.03;
/// Where an axis turns by fewer counts than this in that time, it is longer, up to the length of a test function: a servo
/// whose potentiometer has 102 steps a turn makes one count in 60 ms, and by one in 30 ms it never turned at all.
const SMOOTHED_COUNTS: f64 = 2.0;
/// One camera frame at the time it stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Regularised time, s.
    pub t: f64,
    /// What the camera reports.
    pub pose: Pose,
}

/// A piece of a run without gaps in time.
#[derive(Debug, Clone, Default)]
pub struct Segment {
    /// Index of the run in the data set.
    pub run: usize,
    /// Ticks, s.
    pub t: Vec<f64>,
    /// Wheel angle by the encoders, rad, `[wheel][tick]`, 0 at the start; empty if not logged.
    pub angle: Vec<Vec<f64>>,
    /// What the log's own counters read where the angles are 0, rad, one a wheel.
    pub zero: Vec<f64>,
    /// Smoothed wheel speed at each tick, rad/s, `[wheel][tick]`.
    pub speed: Vec<Vec<f64>>,
    /// Direction of rotation, −1 to 1, smooth about 0, `[wheel][tick]`.
    pub sign: Vec<Vec<f64>>,
    /// Speed over which friction turns round, rad/s at the wheel: what is known of a direction.
    pub turning: f64,
    /// Duty, `[wheel][tick]`, from its tick to the next; empty if not logged.
    pub duty: Vec<Vec<f64>>,
    /// Share of the time from each tick to the next that rows are missing of, `[wheel][tick]`; empty if none are.
    pub unlogged: Vec<Vec<f64>>,
    /// Set point of each wheel's speed, rad/s, `[wheel][tick]`; empty if not logged.
    pub reference: Vec<Vec<f64>>,
    /// Supply, V, at each tick, and whether it was logged.
    pub supply: Vec<f64>,
    /// See `supply`.
    pub supply_logged: bool,
    /// When the run's first stretch begins, s.
    pub begins_s: f64,
    /// Body twist by smoothed wheel speeds and nominal geometry, at each tick.
    pub twist: Vec<Twist>,
    /// Heading (world, or from the start of the segment without a camera) at each tick, rad.
    pub heading: Vec<f64>,
    /// Cosine and sine of the heading.
    pub facing: Vec<[f64; 2]>,
    /// Position in the field at each tick, m.
    pub position: Vec<[f64; 2]>,
    /// Camera frames worth using.
    pub frames: Vec<Frame>,
    /// Frozen camera frames that were left out.
    pub frozen: usize,
    /// What an inertial sensor felt, if the log has one beside its encoders.
    pub felt: Option<Felt>,
    /// Whether a camera fixes heading and position.
    pub has_world: bool,
    /// The ticks that are looked at; those before and after belong to its neighbours in the log and are here for what
    /// reaches over.
    pub own: std::ops::Range<usize>,
    /// Times from which and before which its own ticks, windows and test functions begin, s; infinite at the ends of a
    /// stretch.
    pub span: [f64; 2],
    /// First and last time of the stretch without gaps that it is cut from, s.
    pub stretch: [f64; 2],
    /// The stretch before its first tick: length in s and mean squared duty of each wheel, second by second.
    pub before: Vec<(f64, Vec<f64>)>,
    /// What its wheels did from each tick to the next, worked out when it is first asked for.
    pub rows: OnceLock<Rows>,
    /// What its wheels lose on the floors that were asked about.
    pub lost: Memo,
    /// What it is with fewer ticks.
    pub thinned: Thinned,
}

/// A segment with fewer ticks, the one asked for last, and of how many one is left. A copy begins without.
#[derive(Debug, Default)]
pub struct Thinned(Mutex<Option<(usize, Arc<Segment>)>>);

impl Clone for Thinned {
    fn clone(&self) -> Self {
        Self::default()
    }
}

/// What the wheels did from each tick to the next, `[wheel][tick]`, whatever the model.
#[derive(Debug, Clone, Default)]
pub struct Rows {
    /// Speed by the angles at both ends, rad/s.
    pub(crate) rate: Vec<Vec<f64>>,
    /// Mean of the smoothed speeds, rad/s, and of the directions at both ends.
    pub(crate) speed: Vec<Vec<f64>>,
    pub(crate) sign: Vec<Vec<f64>>,
    /// Sine and cosine of [`Segment::shaft_angle`], made where they are looked at: only axes on blocks have loads by their angle.
    turned: OnceLock<Vec<Vec<[f64; 2]>>>,
}

impl Rows {
    fn of(s: &Segment) -> Self {
        let per_s: Vec<f64> = s.t.windows(2).map(|t| 1.0 / (t[1] - t[0])).collect();
        let rate = |angle: &Vec<f64>| angle.windows(2).zip(&per_s).map(|(a, per_s)| (a[1] - a[0]) * per_s).collect();
        let mean = |values: &Vec<f64>| values.windows(2).map(|v| 0.5 * (v[0] + v[1])).collect();
        Self {
            rate: s.angle.iter().map(rate).collect(),
            speed: s.speed.iter().map(mean).collect(),
            sign: s.sign.iter().map(mean).collect(),
            turned: OnceLock::new(),
        }
    }
}

/// What the rows of a log say of what drives the wheels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Driven {
    /// What is set there, and held until the next row.
    Held,
    /// What was measured there; it goes straight to the next row.
    Straight,
    /// What was measured there, and had been since the row before: a controller reads its sensors and then sets what is next.
    UntilThen,
}

/// Where a segment lies in its log, and what only the log before it tells.
pub(crate) struct Place<'a> {
    /// Index of the run.
    pub(crate) run: usize,
    /// Its ticks, counted from the first one of the segment.
    pub(crate) own: std::ops::Range<usize>,
    /// When its run begins, s.
    pub(crate) begins_s: f64,
    /// First and last time of the stretch without gaps, s.
    pub(crate) stretch: [f64; 2],
    /// Whether it is cut from the stretch at its start and its end.
    pub(crate) cut: [bool; 2],
    /// Counts from the start of the stretch to the first tick of the segment.
    pub(crate) counts: &'a [i64],
    /// Pose by odometry there, from the start of the stretch.
    pub(crate) pose: Pose,
    /// Camera frames of the whole stretch, and those that this segment looks at, with regularised stamps.
    pub(crate) stretch_frames: usize,
    pub(crate) frames: Vec<Frame>,
    /// Mean squared duty of every second of the stretch before it: length in s, wheels.
    pub(crate) before: &'a [(f64, Vec<f64>)],
    /// Speed of the wheels of the data set while they turned, rad/s.
    pub(crate) speed: f64,
    /// What the rows say of what drives the wheels.
    pub(crate) driven: Driven,
    /// Half rows by which logged speeds are older than momentary ones.
    pub(crate) half_rows: usize,
}

/// Speed of the wheels while they turned, rad/s: how long they stood makes no difference. Of a long log some parts are
/// looked at.
pub(crate) fn usual_speed(robot: &Robot, logs: &[Log]) -> f64 {
    let per_count = 1.0 / robot.counts_per_wheel_rad();
    let speed = mean_speed(per_count, logs, SMOOTHING_S);
    // Of none or one count in a step the mean is that of one.
    let coarse = speed * SMOOTHING_S < SMOOTHED_COUNTS * per_count;
    if coarse { mean_speed(per_count, logs, TEST_FUNCTION_S) } else { speed }
}

/// The same by what turned in steps of so many seconds.
fn mean_speed(per_count: f64, logs: &[Log], step_s: f64) -> f64 {
    /// Ticks of a part, and parts of a log at most.
    const PART: usize = 1 << 12;
    const PARTS: usize = 24;
    let (mut square, mut sum) = (0.0, 0.0);
    for log in logs {
        let every = log.len().div_ceil(PART).div_ceil(PARTS).max(1) * PART;
        let step = log.tick_s().map_or(1, |t| (step_s / t).round().max(2.0) as usize);
        for first in (0..log.len()).step_by(every) {
            let columns = Columns { counts: true, ..Columns::NONE };
            let part = log.part(first..(first + PART).min(log.len()), columns);
            for counts in &part.counts {
                for k in (step..counts.len().min(part.t.len())).step_by(step) {
                    let turned = counts[k].wrapping_sub(counts[k - step]) as f64 * per_count;
                    let lasted = part.t[k] - part.t[k - step];
                    square += turned * turned / lasted;
                    sum += turned.abs();
                }
            }
        }
    }
    if sum > 0.0 { square / sum } else { 0.0 }
}

/// Speed about 0 within which the direction of a wheel is not known, rad/s: a share of the `speed` of the log, and some
/// counts within the smoothing.
pub(crate) fn turns_round(count_rad: f64, tick_s: f64, speed: f64) -> f64 {
    let quantum = count_rad / smoothing_s(count_rad, speed).max(2.0 * tick_s);
    (thresholds::TURNS_ROUND * speed).max(thresholds::TURNS_ROUND_COUNTS * quantum)
}

/// Time over which the speeds of wheels that turn at `speed` are smoothed, s.
fn smoothing_s(count_rad: f64, speed: f64) -> f64 {
    let counts_s = SMOOTHED_COUNTS * count_rad / speed.max(f64::MIN_POSITIVE);
    counts_s.clamp(SMOOTHING_S, TEST_FUNCTION_S)
}

fn mean_tick(t: &[f64]) -> f64 {
    (t[t.len() - 1] - t[0]) / (t.len() - 1) as f64
}

/// Derives a segment from the ticks of `part`.
pub(crate) fn segment(robot: &Robot, geometry: &Geometry, part: &Run, place: Place) -> Segment {
    let n = robot.wheel_count();
    let t = part.t.clone();
    let mut s = Segment {
        run: place.run,
        stretch: place.stretch,
        begins_s: place.begins_s,
        supply_logged: part.supply_v.is_some(),
        span: [
            if place.cut[0] { t[place.own.start] } else { f64::NEG_INFINITY },
            if place.cut[1] { t[place.own.end] } else { f64::INFINITY },
        ],
        own: place.own,
        frames: place.frames,
        before: place.before.to_vec(),
        ..Segment::default()
    };
    if part.counts.len() == n {
        let whole: Vec<i64> = if place.counts.len() == n { place.counts.to_vec() } else { vec![0; n] };
        s.angle = (0..n)
            .map(|i| {
                let counts = part.cumulative(i);
                counts.iter().map(|c| (whole[i] as f64 + c) / robot.counts_per_wheel_rad()).collect()
            })
            .collect();
        s.zero = (0..n).map(|i| zero(part, i, &s.angle[i], robot.counts_per_wheel_rad())).collect();
        let count_rad = 1.0 / robot.counts_per_wheel_rad();
        s.speed = smooth_speeds(&t, &s.angle, smoothing_s(count_rad, place.speed));
        s.turning = turns_round(count_rad, mean_tick(&t), place.speed);
        s.sign = s.speed.iter().map(|v| v.iter().map(|w| smooth_sign(*w, s.turning)).collect()).collect();
    }
    // Duties of motors that nobody described predict nothing.
    if part.duty.len() == n && runs::drive_lacks(robot).is_empty() {
        let measured = place.driven != Driven::Held;
        s.duty = part.duty.iter().map(|d| if measured { straight(d, &t) } else { held(d, 0.0) }).collect();
        let lost: Vec<Vec<Lost>> = (0..n)
            .map(|i| lost_rows(&part.duty[i], &t, part.count_gaps.get(i).map_or(&[][..], Vec::as_slice)))
            .collect();
        if place.driven == Driven::UntilThen {
            s.duty.iter_mut().for_each(|d| d.copy_within(1.., 0));
        } else if measured || between_rows(robot, &t) {
            s.duty.iter_mut().for_each(|d| mean_of_neighbours(d));
        } else {
            s.duty.iter_mut().zip(&lost).for_each(|(duty, lost)| lost.iter().for_each(|rows| rows.cross(duty, &t)));
        }
        if lost.iter().any(|rows| !rows.is_empty()) {
            s.unlogged = lost.iter().map(|rows| Lost::shares(rows, t.len())).collect();
        }
        s.duty.iter_mut().for_each(|d| later(d, place.half_rows));
    }
    if part.reference.len() == n && !s.duty.is_empty() {
        s.reference = part.reference.iter().map(|r| held(r, 0.0)).collect();
    }
    s.supply = match &part.supply_v {
        Some(v) => held(v, robot.supply_v),
        None => vec![robot.supply_v; t.len()],
    };
    s.t = t;
    let mut w = vec![0.0; s.speed.len()];
    s.twist = (0..s.t.len())
        .map(|k| {
            w.iter_mut().zip(&s.speed).for_each(|(w, speed)| *w = speed[k]);
            if w.is_empty() { Twist::default() } else { geometry.twist(&w) }
        })
        .collect();
    if !s.angle.is_empty() && (part.gyro.is_some() || part.acceleration.is_some()) {
        let mut turned = vec![0.0; n];
        let turn = |k: usize| {
            turned.iter_mut().zip(&s.angle).for_each(|(turned, a)| *turned = a[k + 1] - a[k]);
            geometry.twist(&turned).omega
        };
        let turn: Vec<f64> = (0..s.t.len() - 1).map(turn).collect();
        s.felt = Felt::of(part, &turn);
    }
    s.drop_frozen(part.source.positions_only);
    let frames = if place.cut == [false; 2] { s.frames.len() } else { place.stretch_frames };
    s.has_world = frames >= 4 && !s.frames.is_empty();
    s.place(geometry, robot.camera_latency_s, place.pose);
    s.facing = s.heading.iter().map(|heading| [heading.cos(), heading.sin()]).collect();
    s
}

impl Segment {
    /// From each tick to the next.
    pub(crate) fn rows(&self) -> &Rows {
        self.rows.get_or_init(|| Rows::of(self))
    }

    /// Mean time from tick to tick, s.
    pub(crate) fn tick_s(&self) -> f64 {
        mean_tick(&self.t)
    }

    /// Number of wheels with encoders.
    pub fn wheels(&self) -> usize {
        self.angle.len()
    }

    /// Angle of a wheel by the log's own counter, the same in all runs of an encoder that keeps its zero: the mean from a
    /// tick to the next, rad.
    pub fn shaft_angle(&self, wheel: usize, tick: usize) -> f64 {
        let Some(angle) = self.angle.get(wheel) else { return 0.0 };
        let at = |k: usize| angle[k.min(angle.len() - 1)];
        self.zero.get(wheel).unwrap_or(&0.0) + 0.5 * (at(tick) + at(tick + 1))
    }

    /// Its sine and cosine.
    pub fn shaft_sin_cos(&self, wheel: usize, tick: usize) -> [f64; 2] {
        let of = |wheel| (0..self.t.len()).map(|k| self.shaft_angle(wheel, k).sin_cos().into()).collect();
        let turned = self.rows().turned.get_or_init(|| (0..self.wheels()).map(of).collect());
        turned.get(wheel).map_or([0.0, 1.0], |ticks| ticks[tick])
    }

    /// The tick whose interval to the next contains `t`, within the segment.
    pub fn tick_at(&self, t: f64) -> usize {
        self.t.partition_point(|x| *x <= t).saturating_sub(1).min(self.t.len().saturating_sub(2))
    }

    /// The same with no more ticks than `part` of the time between two camera frames takes, the first and the last among
    /// them: angles and what is smooth are what they are at those ticks. `None` if that leaves half of them or more.
    pub(crate) fn coarser(&self, part: f64) -> Option<Arc<Self>> {
        let last = self.t.len().checked_sub(1)?;
        let mut apart: Vec<f64> = self.frames.windows(2).map(|f| f[1].t - f[0].t).collect();
        let tick = (self.t[last] - self.t[0]) / last.max(1) as f64;
        let every = (part * estimation::statistics::median(&mut apart) / tick + 1e-6).floor();
        if !(every >= 2.0 && every < last as f64) {
            return None;
        }
        let every = every as usize;
        let mut known = self.thinned.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((of, thinned)) = &*known
            && *of == every
        {
            return Some(thinned.clone());
        }
        let thinned = Arc::new(self.thinned(every));
        *known = Some((every, thinned.clone()));
        Some(thinned)
    }

    fn thinned(&self, every: usize) -> Self {
        let last = self.t.len() - 1;
        let ticks: Vec<usize> = (0..last).step_by(every).chain([last]).collect();
        let each = |rows: &[Vec<f64>]| rows.iter().map(|row| ticks.iter().map(|k| row[*k]).collect()).collect();
        Self {
            t: ticks.iter().map(|k| self.t[*k]).collect(),
            angle: each(&self.angle),
            zero: self.zero.clone(),
            speed: each(&self.speed),
            sign: each(&self.sign),
            duty: each(&self.duty),
            unlogged: each(&self.unlogged),
            reference: each(&self.reference),
            supply: ticks.iter().map(|k| self.supply[*k]).collect(),
            twist: ticks.iter().map(|k| self.twist[*k]).collect(),
            heading: ticks.iter().map(|k| self.heading[*k]).collect(),
            facing: ticks.iter().map(|k| self.facing[*k]).collect(),
            position: ticks.iter().map(|k| self.position[*k]).collect(),
            frames: self.frames.clone(),
            own: 0..ticks.len(),
            before: self.before.clone(),
            // The sensor's links cut the segments as they are.
            felt: None,
            rows: OnceLock::new(),
            lost: Memo::default(),
            thinned: Thinned::default(),
            ..*self
        }
    }

    /// A frame that repeats the one before to the last digit while the wheels turned is no new
    /// measurement: the tracker lost the robot.
    fn drop_frozen(&mut self, positions_only: bool) {
        if self.angle.is_empty() {
            return;
        }
        let same = |a: Pose, b: Pose| a.x == b.x && a.y == b.y && (positions_only || a.theta == b.theta);
        let mut last_new: Option<Frame> = None;
        let frames = std::mem::take(&mut self.frames);
        for frame in frames {
            let repeated = last_new.is_some_and(|last| {
                let (a, b) = (self.tick_at(last.t), self.tick_at(frame.t));
                let moved = self.angle.iter().map(|w| (w[b] - w[a]).abs()).fold(0.0, f64::max);
                same(last.pose, frame.pose) && moved > 0.05
            });
            if !repeated {
                self.frames.push(frame);
            } else if (self.span[0]..self.span[1]).contains(&frame.t) {
                self.frozen += 1;
            }
            if last_new.is_none_or(|last| !same(last.pose, frame.pose)) {
                last_new = Some(frame);
            }
        }
    }

    /// Whether a tick is in the second half of its stretch.
    pub fn is_late(&self, tick: usize) -> bool {
        if self.span == [f64::NEG_INFINITY, f64::INFINITY] {
            return tick > self.t.len() / 2;
        }
        2.0 * self.t[tick] > self.stretch[0] + self.stretch[1]
    }

    /// The camera frames that are looked at; see [`Segment::own`].
    pub fn own_frames(&self) -> &[Frame] {
        let at = |t: f64| self.frames.partition_point(|f| f.t < t);
        &self.frames[at(self.span[0])..at(self.span[1])]
    }

    /// Heading and position at every tick: odometry, drawn to the camera where there is one.
    fn place(&mut self, geometry: &Geometry, latency: f64, from: Pose) {
        let n = self.t.len();
        let mut own = Vec::with_capacity(n);
        let mut pose = from;
        let mut turned = vec![0.0; self.angle.len()];
        for k in 0..n {
            own.push(pose);
            if k + 1 < n && !self.angle.is_empty() {
                turned.iter_mut().zip(&self.angle).for_each(|(turned, a)| *turned = a[k + 1] - a[k]);
                pose = pose.compose(displacement(geometry.twist(&turned)));
            }
        }
        if !self.has_world {
            self.heading = own.iter().map(|p| p.theta).collect();
            self.position = own.iter().map(|p| [p.x, p.y]).collect();
            return;
        }
        // Camera minus odometry drifts slowly; a running mean over about half a second follows it.
        let mut turn = 0.0;
        let offsets: Vec<(f64, f64)> = self
            .frames
            .iter()
            .map(|f| {
                turn += wrap_angle(f.pose.theta - own[self.tick_at(f.t - latency)].theta - turn);
                (f.t, turn)
            })
            .collect();
        let offsets = running_mean(&offsets, 15);
        self.heading = interpolated(&offsets, &self.t).zip(&own).map(|(turn, p)| p.theta + turn).collect();
        let xs: Vec<(f64, f64)> = self.frames.iter().map(|f| (f.t, f.pose.x)).collect();
        let ys: Vec<(f64, f64)> = self.frames.iter().map(|f| (f.t, f.pose.y)).collect();
        let (xs, ys) = (running_mean(&xs, 1), running_mean(&ys, 1));
        self.position = interpolated(&xs, &self.t).zip(interpolated(&ys, &self.t)).map(|(x, y)| [x, y]).collect();
    }
}

/// What the log's own counter reads where the angles of a wheel are 0, rad.
fn zero(run: &Run, wheel: usize, angle: &[f64], counts_per_rad: f64) -> f64 {
    let lost = run.count_gaps.get(wheel).map_or(&[][..], Vec::as_slice);
    let known = (0..angle.len()).find(|k| !lost.contains(k)).unwrap_or(0);
    run.counts[wheel][known] as f64 / counts_per_rad - angle[known]
}

/// Direction of a speed, −1 to 1, smooth over about `width` on either side of 0.
pub fn smooth_sign(speed: f64, width: f64) -> f64 {
    // tanh, by one exponential: a library's is exact beside 0, too, where nothing is told from 0, and takes twice as long.
    1.0 - 2.0 / (1.0 + (2.0 * speed / width).exp())
}

/// Whether the loop set further duties between the rows of a log.
fn between_rows(robot: &Robot, t: &[f64]) -> bool {
    mean_tick(t) * robot.control_rate_hz > thresholds::ROWS_APART
}

/// In place of a signal at each tick its mean until the next, if it goes there straight.
fn mean_of_neighbours(values: &mut [f64]) {
    for k in 1..values.len() {
        values[k - 1] = 0.5 * (values[k - 1] + values[k]);
    }
}

/// Rows that a log lacks between two that it has.
#[derive(Debug, Clone, Copy)]
struct Lost {
    /// The ticks of those.
    ends: [usize; 2],
    /// Rows from the one to the other, one of which would follow the other.
    steps: f64,
}

/// Where rows were lost: none came, and no count either, and the next one keeps the beat. A duty that is logged when it changes
/// alone is held, and so is one of a loop that was late.
fn lost_rows(duty: &[f64], t: &[f64], count_gaps: &[usize]) -> Vec<Lost> {
    let rows: Vec<usize> = (0..t.len()).filter(|k| duty[*k].is_finite()).collect();
    let mut apart: Vec<f64> = rows.windows(2).map(|ends| t[ends[1]] - t[ends[0]]).collect();
    if apart.is_empty() {
        return Vec::new();
    }
    let row = estimation::statistics::median(&mut apart);
    let between = |ends: &[usize]| {
        let (a, b) = (ends[0], ends[1]);
        let steps = ((t[b] - t[a]) / row).round();
        let counted = (a + 1..b).any(|k| count_gaps.binary_search(&k).is_err());
        (steps >= 2.0 && !counted).then_some(Lost { ends: [a, b], steps })
    };
    let lost: Vec<Lost> = rows.windows(2).filter_map(between).collect();
    let off = |l: &Lost| ((t[l.ends[1]] - t[l.ends[0]]) / row - l.steps).abs();
    let mut off: Vec<f64> = lost.iter().map(off).collect();
    if !off.is_empty() && estimation::statistics::median(&mut off) <= thresholds::BEAT { lost } else { Vec::new() }
}

impl Lost {
    /// What was set in them lies on a line from row to row as likely as on either side of it, while the duty before, held, is
    /// late.
    fn cross(&self, duty: &mut [f64], t: &[f64]) {
        let [a, b] = self.ends;
        let (first, height, lasted) = (duty[a], duty[b] - duty[a], t[b] - t[a]);
        // Of steps of one height and one length, the first of which has none.
        let sum = |until: f64| {
            let place = (until - t[a]) / lasted * self.steps;
            let whole = (place + 1e-9).floor();
            height / self.steps * whole * (place - 0.5 * (whole + 1.0)) / self.steps * lasted
        };
        for k in a..b {
            duty[k] = first + (sum(t[k + 1]) - sum(t[k])) / (t[k + 1] - t[k]);
        }
    }

    /// Share of the time from each tick to the next in which no row says what was set.
    fn shares(rows: &[Self], ticks: usize) -> Vec<f64> {
        let mut shares = vec![0.0; ticks];
        for lost in rows {
            shares[lost.ends[0]..lost.ends[1]].fill(1.0 - 1.0 / lost.steps);
        }
        shares
    }
}

/// A signal that is held from tick to tick, later by half ticks: of half a one its mean from half a tick before to half a
/// tick after.
fn later(values: &mut [f64], half_rows: usize) {
    for k in (1..values.len()).rev() {
        let [now, before] = [0, 1].map(|row| values[k.saturating_sub(half_rows / 2 + row)]);
        values[k] = if half_rows.is_multiple_of(2) { now } else { 0.5 * (before + now) };
    }
}

/// Values with gaps filled by the value before.
fn held(values: &[f64], first: f64) -> Vec<f64> {
    let mut last = values.iter().copied().find(|v| v.is_finite()).unwrap_or(first);
    values
        .iter()
        .map(|v| {
            if v.is_finite() {
                last = *v;
            }
            last
        })
        .collect()
}

/// Values with gaps filled by lines from sample to sample; before the first and after the last by these.
fn straight(values: &[f64], t: &[f64]) -> Vec<f64> {
    let mut out = held(values, 0.0);
    let samples: Vec<usize> = (0..values.len()).filter(|k| values[*k].is_finite()).collect();
    for ends in samples.windows(2) {
        let (a, b) = (ends[0], ends[1]);
        for k in a + 1..b {
            out[k] = values[a] + (values[b] - values[a]) * (t[k] - t[a]) / (t[b] - t[a]);
        }
    }
    out
}

/// Derivatives at each tick from a Hann-weighted mean of the increments within so many seconds around it, one row for each
/// of `angles`.
pub(crate) fn smooth_speeds(t: &[f64], angles: &[Vec<f64>], smoothing_s: f64) -> Vec<Vec<f64>> {
    let n = t.len();
    let tick = (t[n - 1] - t[0]) / (n - 1) as f64;
    let half = ((0.5 * smoothing_s / tick).round() as usize).max(1);
    let weights: Vec<f64> = (0..2 * half)
        .map(|j| {
            let x = (j as f64 + 0.5) / (2 * half) as f64;
            (std::f64::consts::PI * x).sin().powi(2)
        })
        .collect();
    let increments = |values: &[f64]| values.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<f64>>();
    // Increments from tick m to m + 1, centred on k.
    let mean = |k: usize, increments: &[f64]| {
        let m = k.saturating_sub(half)..(k + half).min(n - 1);
        dot(&weights[m.start + half - k..], &increments[m])
    };
    let passed = increments(t);
    let times: Vec<f64> = (0..n).map(|k| mean(k, &passed)).collect();
    let speeds = |angle: &Vec<f64>| {
        let turned = increments(angle);
        times.iter().enumerate().map(|(k, time)| if *time > 0.0 { mean(k, &turned) / time } else { 0.0 }).collect()
    };
    angles.iter().map(speeds).collect()
}

fn running_mean(values: &[(f64, f64)], half: usize) -> Vec<(f64, f64)> {
    (0..values.len())
        .map(|i| {
            let h = half.min(i).min(values.len() - 1 - i);
            let part = &values[i - h..=i + h];
            (values[i].0, part.iter().map(|v| v.1).sum::<f64>() / part.len() as f64)
        })
        .collect()
}

/// Values at increasing times.
fn interpolated<'a>(values: &'a [(f64, f64)], times: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    let mut k = 0;
    times.iter().map(move |t| {
        while k < values.len() && values[k].0 <= *t {
            k += 1;
        }
        match (k.checked_sub(1).map(|i| values[i]), values.get(k)) {
            (Some(a), Some(b)) => a.1 + (b.1 - a.1) * (t - a.0) / (b.0 - a.0),
            (Some(a), None) => a.1,
            (None, Some(b)) => b.1,
            (None, None) => 0.0,
        }
    })
}

/// Times of a run's camera frames: on a regular grid if the stamps are one, rounded to ticks.
pub(crate) fn regular_stamps(seen: &[Seen], rate: f64, tick: f64) -> Vec<f64> {
    let raw: Vec<f64> = seen.iter().map(|f| f.t).collect();
    if raw.len() < 8 {
        return raw;
    }
    // Frame numbers by the nominal rate, then a line through the stamps.
    let numbers: Vec<f64> = raw
        .windows(2)
        .scan(0.0, |n, w| {
            *n += ((w[1] - w[0]) * rate).round().max(1.0);
            Some(*n)
        })
        .collect();
    let numbers: Vec<f64> = std::iter::once(0.0).chain(numbers).collect();
    let m = raw.len() as f64;
    let (mean_n, mean_t) = (numbers.iter().sum::<f64>() / m, raw.iter().sum::<f64>() / m);
    let sxx: f64 = numbers.iter().map(|n| (n - mean_n).powi(2)).sum();
    let sxy: f64 = numbers.iter().zip(&raw).map(|(n, t)| (n - mean_n) * (t - mean_t)).sum();
    let line: Vec<f64> = numbers.iter().map(|n| mean_t + sxy / sxx * (n - mean_n)).collect();
    let worst = line.iter().zip(&raw).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    if worst <= 1.01 * tick { line } else { raw }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_duty_goes_on_where_rows_are_lost() {
        let nan = f64::NAN;
        let t = [0.0, 1.0, 2.0, 3.0, 5.0, 6.0, 9.0, 9.5, 11.0, 12.0, 13.0, 14.0];
        // 3 to 5 lacks a row, 6 to 9 two, and 9 to 12, within which a camera has two of its own.
        let duty = [0.0, 1.0, 1.0, 1.0, 3.0, 0.0, 6.0, nan, nan, 9.0, 9.0, 9.0];
        let across = |gaps: &[usize]| {
            let (mut out, lost) = (held(&duty, 0.0), lost_rows(&duty, &t, gaps));
            lost.iter().for_each(|rows| rows.cross(&mut out, &t));
            (out, Lost::shares(&lost, t.len()))
        };
        let (out, shares) = across(&[7, 8]);
        let wanted = [0.0, 1.0, 1.0, 1.5, 3.0, 2.0, 6.0, 6.0 + 1.0 / 1.5, 8.0, 9.0, 9.0, 9.0];
        assert!(out.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-6), "{out:?}");
        let two_of_three = 1.0 - 1.0 / 3.0;
        assert_eq!(shares[3..10], [0.5, 0.0, two_of_three, two_of_three, two_of_three, two_of_three, 0.0]);
        assert_eq!(across(&[]).0[6..9], [6.0; 3], "rows that count are not lost");
        let late = [0.0, 1.0, 2.0, 3.0, 4.6, 5.6, 8.1, 9.1, 10.1];
        assert!(lost_rows(&duty[..7].repeat(2)[..9], &late, &[]).is_empty(), "a loop that was late lost none");
    }

    #[test]
    fn slow_axes_with_coarse_encoders_turn() {
        // A count in 60 ms of a potentiometer with 102 steps a turn, and one in a millisecond of a motor's encoder.
        let step = std::f64::consts::TAU / 102.4;
        assert!(turns_round(step, 0.002, 1.0) < 0.6, "{}", turns_round(step, 0.002, 1.0));
        assert_eq!((smoothing_s(step, 0.01), smoothing_s(1e-3, 17.0)), (TEST_FUNCTION_S, SMOOTHING_S));
        let t: Vec<f64> = (0..1000).map(|k| 0.002 * f64::from(k)).collect();
        let angles = vec![t.iter().map(|t| (t / step).floor() * step).collect()];
        let speeds = &smooth_speeds(&t, &angles, smoothing_s(step, 1.0))[0];
        assert!(speeds[100..900].iter().all(|w| (0.4..1.6).contains(w)), "{speeds:?}");
    }
}
