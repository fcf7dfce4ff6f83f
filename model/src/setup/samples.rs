//! What wheels, camera and commands say of the same stretches of time.

use estimation::statistics::median;
use runs::frames::{Pose, wrap_angle};
use runs::robot::Robot;
use runs::{Columns, Log, is_from_speeds};

/// Share of the time that an axis turns each way, from which a sign must show.
pub(super) const BOTH_WAYS: f64 = 0.1;
/// Share of an axis's largest duty from which a firmware's limit holds it, where it cannot follow.
pub(super) const HELD: f64 = 0.99;
/// Time over which a wheel that follows its set point does not change its speed by as much as that: one that lags by 0.1 s
/// is then no tenth off.
pub(super) const SETTLED_S: f64 = 1.0;
/// Samples from which anything is said.
pub(super) const FEWEST: usize = 50;
/// Ticks of a log that are looked at.
pub(super) const MOST_TICKS: usize = 200_000;
/// Stretches of a log that are compared.
const MOST: usize = 1500;
/// Usual length of a stretch, s: long against the camera's noise, short against a turn. A log of few frames has longer ones.
pub(super) const STRETCH_S: f64 = 0.15;
/// Turn in a stretch at most, rad: from half a turn on a heading does not say which way it was.
const TURN: f64 = 0.8 * std::f64::consts::PI;
/// Share of the stretches in which the robot may turn further.
const FASTER_YET: f64 = 0.01;
/// Lags at which camera and wheels are compared, s: clocks set by hand differ by a fifth of a second.
const LAGS_S: (f64, f64) = (0.3, 0.02);

/// Standard deviations up to which noise makes a change of speed: of 15 000 stretches of three wheels none has more by chance.
/// Speeds of 264 steps a turn at 100 Hz, some of them 30 times too large, seemed to gain 22 m/s² at the rim in ten drives.
const BY_NOISE: f64 = 5.0;
/// Median of the size of a standard normal number.
const MEDIAN_OF_NORMAL: f64 = 0.674_5;

/// A log's wheel angles, rad by robot.toml, at increasing times.
pub(super) struct Wheels {
    pub(super) t: Vec<f64>,
    pub(super) angle: Vec<Vec<f64>>,
}

impl Wheels {
    /// Of a log with counts.
    pub(super) fn of(robot: &Robot, log: &Log) -> Option<Self> {
        let part = log.part(0..log.len().min(MOST_TICKS), Columns { counts: true, ..Columns::NONE });
        if part.counts.len() != robot.wheel_count() || part.len() < 16 {
            return None;
        }
        // Ticks at which every wheel was read; counters that wrap do not jump.
        let sampled: Vec<usize> =
            (0..part.len()).filter(|k| part.count_gaps.iter().all(|gaps| gaps.binary_search(k).is_err())).collect();
        let sampled = if sampled.len() < 16 { (0..part.len()).collect() } else { sampled };
        let angle = part.counts.iter().map(|counts| {
            let first = counts.first().copied().unwrap_or(0);
            sampled.iter().map(|k| counts[*k].wrapping_sub(first) as f64 / robot.counts_per_wheel_rad()).collect()
        });
        Some(Self { angle: angle.collect(), t: sampled.iter().map(|k| part.t[*k]).collect() })
    }

    /// Angles at a time between first and last.
    pub(super) fn at(&self, t: f64) -> Vec<f64> {
        let k = self.t.partition_point(|x| *x <= t).clamp(1, self.t.len() - 1);
        let share = ((t - self.t[k - 1]) / (self.t[k] - self.t[k - 1])).clamp(0.0, 1.0);
        self.angle.iter().map(|a| a[k - 1] + share * (a[k] - a[k - 1])).collect()
    }

    fn covers(&self, from: f64, to: f64) -> bool {
        self.t.first().is_some_and(|t| *t <= from) && self.t.last().is_some_and(|t| *t >= to)
    }

    /// Standard deviation that noise of logged speeds gives the turn of a wheel from one row to the next, rad, of the wheel that
    /// has most: by the middle of how much two neighbouring turns differ. Nothing for counts, whose errors do not add up.
    fn scatter(&self, robot: &Robot) -> f64 {
        let of = |angle: &Vec<f64>| {
            let bends = angle.windows(3).map(|a| (a[2] - 2.0 * a[1] + a[0]).abs());
            median(&mut bends.collect::<Vec<f64>>()) / (MEDIAN_OF_NORMAL * std::f64::consts::SQRT_2)
        };
        if is_from_speeds(robot) { self.angle.iter().map(of).fold(0.0, f64::max) } else { 0.0 }
    }

    /// The most by which the turn of each wheel differs from one row to the next in a stretch of time: a speed that was logged
    /// wrong once makes no more than that.
    fn bends(&self, from: f64, to: f64) -> Vec<f64> {
        let first = self.t.partition_point(|t| *t <= from).saturating_sub(1);
        let last = (self.t.partition_point(|t| *t < to) + 1).min(self.t.len());
        let most = |angle: &Vec<f64>| {
            angle[first..last].windows(3).map(|a| (a[2] - 2.0 * a[1] + a[0]).abs()).fold(0.0, f64::max)
        };
        self.angle.iter().map(most).collect()
    }

    /// How far the robot turned at most in so many seconds but for a hundredth of them, rad by robot.toml; 0 where its wheels
    /// drive no robot.
    fn turns_in(&self, robot: &Robot, every_s: f64) -> f64 {
        let Ok(geometry) = robot.geometry() else { return 0.0 };
        let [Some(first), Some(last)] = [self.t.first(), self.t.last()] else { return 0.0 };
        let steps = ((last - first) / every_s).floor().min(MOST_TICKS as f64) as usize;
        let at = |k: usize| first + k as f64 * every_s;
        let turned = (0..steps).filter_map(|k| self.turned(at(k), at(k + 1)));
        let mut turns: Vec<f64> = turned.map(|turned| geometry.twist(&turned).omega.abs()).collect();
        turns.sort_by(f64::total_cmp);
        turns.get((turns.len() as f64 * (1.0 - FASTER_YET)) as usize).copied().unwrap_or(0.0)
    }

    /// How far each wheel turned in a stretch of time.
    pub(super) fn turned(&self, from: f64, to: f64) -> Option<Vec<f64>> {
        self.covers(from, to).then(|| self.at(to).iter().zip(self.at(from)).map(|(b, a)| b - a).collect())
    }
}

/// Two poses of the camera and the turn of the wheels between them.
#[derive(Debug, Clone)]
pub(super) struct Sample {
    /// When it ends, s in its log.
    pub(super) t: f64,
    pub(super) from: Pose,
    pub(super) to: Pose,
    pub(super) turned: Vec<f64>,
    /// Greatest acceleration of a wheel, rad/s² by robot.toml; none where noise of the speeds may have made it.
    pub(super) acceleration: f64,
}

/// Stretches of a log between camera frames, so many seconds long, or as long as the robot takes for less than half a turn, at
/// the lag of the camera at which the wheels tell its speed best.
pub(super) fn of_camera(robot: &Robot, log: &Log, stretch_s: f64) -> Vec<Sample> {
    let Some(wheels) = Wheels::of(robot, log) else { return Vec::new() };
    let frames = log.camera();
    let stretch_s = stretch_s * (TURN / wheels.turns_in(robot, stretch_s).max(TURN));
    let mut pairs = Vec::new();
    let mut j = 0;
    for i in 0..frames.len() {
        j = j.max(i + 1);
        while j < frames.len() && frames[j].t - frames[i].t < stretch_s {
            j += 1;
        }
        // A camera that lost the robot in between, or stood still, tells nothing.
        if j < frames.len() && frames[j].t - frames[i].t < 3.0 * stretch_s.max(frames[i + 1].t - frames[i].t) {
            pairs.push((i, j));
        }
    }
    let every = pairs.len().div_ceil(MOST).max(1);
    let pairs: Vec<(usize, usize)> = pairs.into_iter().step_by(every).collect();
    let between = |of: &dyn Fn(&Pose, &Pose) -> f64| -> Vec<f64> {
        pairs.iter().map(|(i, j)| of(&frames[*i].pose, &frames[*j].pose)).collect()
    };
    let ways = between(&|a, b| a.distance(*b));
    let turns = between(&|a, b| wrap_angle(b.theta - a.theta).abs());
    let steps = (LAGS_S.0 / LAGS_S.1).round() as i32;
    // The wheels' mean turn follows the way, or the turn, whatever their order, signs and sizes.
    let fit = |lag: f64| -> f64 {
        let turned = pairs.iter().map(|(i, j)| {
            let turned = wheels.turned(frames[*i].t - lag, frames[*j].t - lag)?;
            Some(turned.iter().map(|a| a * a).sum::<f64>().sqrt())
        });
        let turned: Vec<Option<f64>> = turned.collect();
        let follows = |seen: &[f64]| {
            correlation(seen.iter().copied().zip(&turned).filter_map(|(seen, turned)| Some((seen, (*turned)?))))
        };
        follows(&ways).max(follows(&turns))
    };
    let best = (-steps..=steps).map(|k| f64::from(k) * LAGS_S.1).map(|lag| (fit(lag), lag));
    let lag = best.max_by(|a, b| a.0.total_cmp(&b.0)).map_or(0.0, |b| b.1);
    let scatter = wheels.scatter(robot);
    let row_s = median(&mut wheels.t.windows(2).map(|t| t[1] - t[0]).collect::<Vec<f64>>());
    let sample = |(i, j): &(usize, usize)| {
        let [from, to] = [i, j].map(|k| frames[*k].t - lag);
        let turned = wheels.turned(from, to)?;
        let first = wheels.turned(from, 0.5 * (from + to))?;
        let bends = if scatter > 0.0 { wheels.bends(from, to) } else { vec![0.0; turned.len()] };
        let changes =
            turned.iter().zip(&first).zip(&bends).map(|((all, first), bend)| (all - 2.0 * first).abs() - bend);
        let change = changes.fold(0.0, f64::max);
        // Turns of each row add up in both halves.
        let noise = scatter * ((to - from) / row_s).sqrt();
        let change = if change > BY_NOISE * noise { change } else { 0.0 };
        let acceleration = change / (0.5 * (to - from)).powi(2);
        Some(Sample { t: to, from: frames[*i].pose, to: frames[*j].pose, turned, acceleration })
    };
    pairs.iter().filter_map(sample).collect()
}

/// Pearson's correlation; 0 for what does not change.
pub(super) fn correlation(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let mut s = [0.0_f64; 6];
    for (x, y) in pairs {
        for (slot, v) in s.iter_mut().zip([1.0, x, y, x * x, y * y, x * y]) {
            *slot += v;
        }
    }
    let [n, x, y, xx, yy, xy] = s;
    let spread = (n * xx - x * x).max(0.0) * (n * yy - y * y).max(0.0);
    if spread > 0.0 { (n * xy - x * y) / spread.sqrt() } else { 0.0 }
}
