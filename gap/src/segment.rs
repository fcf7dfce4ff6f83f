//! A piece of a run without gaps, with everything the links need derived from it once.

use model::frames::{Pose, Twist, displacement, wrap_angle};
use model::geometry::Geometry;
use model::robot::Robot;
use model::run::Run;

use crate::drive::{SIGN_WIDTH, smooth_sign};

/// Time over which wheel speeds are smoothed (full width of a Hann window), s: at one count a
/// millisecond the quantum of a speed, 0.83 rad/s, becomes 0.04 rad/s.
const SMOOTHING_S: f64 = 0.03;
/// A pause longer than this many ticks starts a new segment.
const GAP_TICKS: f64 = 20.0;

/// One camera frame at the time it stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Regularised time, s.
    pub t: f64,
    /// What the camera reports.
    pub pose: Pose,
}

/// A piece of a run without gaps in time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Segment {
    /// Index of the run in the data set.
    pub run: usize,
    /// Ticks, s.
    pub t: Vec<f64>,
    /// Wheel angle by the encoders, rad, `[wheel][tick]`, 0 at the start; empty if not logged.
    pub angle: Vec<Vec<f64>>,
    /// Smoothed wheel speed at each tick, rad/s, `[wheel][tick]`.
    pub speed: Vec<Vec<f64>>,
    /// Direction of rotation, −1 to 1, smooth about 0, `[wheel][tick]`.
    pub sign: Vec<Vec<f64>>,
    /// Duty, `[wheel][tick]`, from its tick to the next; empty if not logged.
    pub duty: Vec<Vec<f64>>,
    /// Supply, V, at each tick.
    pub supply: Vec<f64>,
    /// Body twist by smoothed wheel speeds and nominal geometry, at each tick.
    pub twist: Vec<Twist>,
    /// Heading (world, or from the start of the segment without a camera) at each tick, rad.
    pub heading: Vec<f64>,
    /// Position in the field at each tick, m.
    pub position: Vec<[f64; 2]>,
    /// Camera frames worth using.
    pub frames: Vec<Frame>,
    /// Frozen camera frames that were left out.
    pub frozen: usize,
    /// Whether a camera fixes heading and position.
    pub has_world: bool,
}

/// Cuts runs into segments.
pub fn segments(robot: &Robot, geometry: &Geometry, runs: &[Run]) -> Vec<Segment> {
    let mut all = Vec::new();
    for (index, run) in runs.iter().enumerate() {
        let Some(tick) = run.tick_s() else { continue };
        let camera = regular_stamps(run, robot.camera_rate_hz, tick);
        let mut first = 0;
        for k in 1..=run.len() {
            if k < run.len() && run.t[k] - run.t[k - 1] <= GAP_TICKS * tick {
                continue;
            }
            if k - first >= 8 {
                all.push(segment(robot, geometry, run, index, first..k, &camera));
            }
            first = k;
        }
    }
    all
}

fn segment(
    robot: &Robot,
    geometry: &Geometry,
    run: &Run,
    index: usize,
    ticks: std::ops::Range<usize>,
    stamps: &[f64],
) -> Segment {
    let n = robot.wheel_count();
    let t: Vec<f64> = run.t[ticks.clone()].to_vec();
    let mut s = Segment { run: index, ..Segment::default() };
    if run.counts.len() == n {
        s.angle = (0..n)
            .map(|i| unwrapped(run, i, ticks.clone(), &t).iter().map(|c| c / robot.counts_per_wheel_rad()).collect())
            .collect();
        s.speed = s.angle.iter().map(|a| smooth_speed(&t, a)).collect();
        s.sign = s.speed.iter().map(|v| v.iter().map(|w| smooth_sign(*w, SIGN_WIDTH)).collect()).collect();
    }
    if run.duty.len() == n {
        s.duty = run.duty.iter().map(|d| held(&d[ticks.clone()], 0.0)).collect();
    }
    s.supply = match &run.supply_v {
        Some(v) => held(&v[ticks.clone()], robot.supply_v),
        None => vec![robot.supply_v; t.len()],
    };
    for (sample, stamp) in run.camera.iter().zip(stamps).filter(|(f, _)| ticks.contains(&f.tick)) {
        s.frames.push(Frame { t: *stamp, pose: sample.pose });
    }
    s.t = t;
    s.twist = (0..s.t.len())
        .map(|k| {
            let w: Vec<f64> = s.speed.iter().map(|w| w[k]).collect();
            if w.is_empty() { Twist::default() } else { geometry.twist(&w) }
        })
        .collect();
    s.drop_frozen();
    s.place(geometry, robot.camera_latency_s);
    s
}

impl Segment {
    /// Number of wheels with encoders.
    pub fn wheels(&self) -> usize {
        self.angle.len()
    }

    /// The tick whose interval to the next contains `t`, within the segment.
    pub fn tick_at(&self, t: f64) -> usize {
        self.t.partition_point(|x| *x <= t).saturating_sub(1).min(self.t.len().saturating_sub(2))
    }

    /// A frame that repeats the one before to the last digit while the wheels turned is no new
    /// measurement: the tracker lost the robot.
    fn drop_frozen(&mut self) {
        if self.angle.is_empty() {
            return;
        }
        let mut last_new: Option<Frame> = None;
        let frames = std::mem::take(&mut self.frames);
        let total = frames.len();
        for frame in frames {
            let repeated = last_new.is_some_and(|last| {
                let (a, b) = (self.tick_at(last.t), self.tick_at(frame.t));
                let moved = self.angle.iter().map(|w| (w[b] - w[a]).abs()).fold(0.0, f64::max);
                last.pose == frame.pose && moved > 0.05
            });
            if !repeated {
                self.frames.push(frame);
            }
            if last_new.is_none_or(|last| last.pose != frame.pose) {
                last_new = Some(frame);
            }
        }
        self.frozen = total - self.frames.len();
    }

    /// Heading and position at every tick: odometry, drawn to the camera where there is one.
    fn place(&mut self, geometry: &Geometry, latency: f64) {
        let n = self.t.len();
        let mut own = Vec::with_capacity(n);
        let mut pose = Pose::default();
        for k in 0..n {
            own.push(pose);
            if k + 1 < n && !self.angle.is_empty() {
                let turned: Vec<f64> = self.angle.iter().map(|a| a[k + 1] - a[k]).collect();
                pose = pose.compose(displacement(geometry.twist(&turned)));
            }
        }
        self.has_world = self.frames.len() >= 4;
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
        self.heading = self.t.iter().zip(&own).map(|(t, p)| p.theta + interpolate(&offsets, *t)).collect();
        let xs: Vec<(f64, f64)> = self.frames.iter().map(|f| (f.t, f.pose.x)).collect();
        let ys: Vec<(f64, f64)> = self.frames.iter().map(|f| (f.t, f.pose.y)).collect();
        let (xs, ys) = (running_mean(&xs, 1), running_mean(&ys, 1));
        self.position = self.t.iter().map(|t| [interpolate(&xs, *t), interpolate(&ys, *t)]).collect();
    }
}

/// Cumulative counts as differences from the first, ticks without a sample interpolated.
fn unwrapped(run: &Run, wheel: usize, ticks: std::ops::Range<usize>, t: &[f64]) -> Vec<f64> {
    let counts = &run.counts[wheel][ticks.clone()];
    let mut out: Vec<f64> = Vec::with_capacity(counts.len());
    let mut sum = 0.0;
    for k in 0..counts.len() {
        if k > 0 {
            sum += counts[k].wrapping_sub(counts[k - 1]) as f64;
        }
        out.push(sum);
    }
    let gaps = run.count_gaps.get(wheel).map_or(&[][..], Vec::as_slice);
    let lost: Vec<usize> = gaps.iter().copied().filter(|g| ticks.contains(g)).map(|g| g - ticks.start).collect();
    let mut i = 0;
    while i < lost.len() {
        let first = lost[i];
        let mut last = first;
        while i + 1 < lost.len() && lost[i + 1] == last + 1 {
            i += 1;
            last = lost[i];
        }
        i += 1;
        if first == 0 || last + 1 >= out.len() {
            continue;
        }
        let (a, b) = (out[first - 1], out[last + 1]);
        let (ta, tb) = (t[first - 1], t[last + 1]);
        for k in first..=last {
            out[k] = a + (b - a) * (t[k] - ta) / (tb - ta);
        }
    }
    out
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

/// Derivative at each tick from a Hann-weighted mean of the increments around it.
fn smooth_speed(t: &[f64], angle: &[f64]) -> Vec<f64> {
    let n = t.len();
    let tick = (t[n - 1] - t[0]) / (n - 1) as f64;
    let half = ((0.5 * SMOOTHING_S / tick).round() as usize).max(1);
    let weights: Vec<f64> = (0..2 * half)
        .map(|j| {
            let x = (j as f64 + 0.5) / (2 * half) as f64;
            (std::f64::consts::PI * x).sin().powi(2)
        })
        .collect();
    (0..n)
        .map(|k| {
            let (mut sum, mut time) = (0.0, 0.0);
            for (j, w) in weights.iter().enumerate() {
                // Increment from tick m to m + 1, centred on k.
                let Some(m) = (k + j).checked_sub(half) else { continue };
                if m + 1 < n {
                    sum += w * (angle[m + 1] - angle[m]);
                    time += w * (t[m + 1] - t[m]);
                }
            }
            if time > 0.0 { sum / time } else { 0.0 }
        })
        .collect()
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

fn interpolate(values: &[(f64, f64)], t: f64) -> f64 {
    let k = values.partition_point(|v| v.0 <= t);
    match (k.checked_sub(1).map(|i| values[i]), values.get(k)) {
        (Some(a), Some(b)) => a.1 + (b.1 - a.1) * (t - a.0) / (b.0 - a.0),
        (Some(a), None) => a.1,
        (None, Some(b)) => b.1,
        (None, None) => 0.0,
    }
}

/// Times of a run's camera frames: on a regular grid if the stamps are one, rounded to ticks.
fn regular_stamps(run: &Run, rate: f64, tick: f64) -> Vec<f64> {
    let raw: Vec<f64> = run.camera.iter().map(|f| run.t[f.tick]).collect();
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
