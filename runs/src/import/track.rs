//! What a log and poses say of the motion, as velocities over time.

use super::time::usual_step;
use crate::Run;
use crate::frames::{Pose, displacement_to, wrap_angle};

/// A velocity is that over so many steps: noise of millimetres is then some cm/s.
pub(super) const OVER: usize = 4;
/// Samples farther apart than so many usual steps have a hole between them.
const HOLE: f64 = 5.0;

/// Samples over time whose differences are what was done in between.
pub(super) struct Track<const N: usize> {
    t: Vec<f64>,
    x: Vec<[f64; N]>,
    hole_s: f64,
}

impl<const N: usize> Track<N> {
    pub(super) fn new(samples: impl Iterator<Item = (f64, [f64; N])>) -> Self {
        let mut samples: Vec<(f64, [f64; N])> = samples.filter(|(_, x)| x.iter().all(|x| x.is_finite())).collect();
        samples.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (t, x): (Vec<f64>, Vec<[f64; N]>) = samples.into_iter().unzip();
        let mut track = Self { t, x, hole_s: 0.0 };
        track.hole_s = HOLE * track.step_s();
        track
    }

    /// The usual step, s.
    pub(super) fn step_s(&self) -> f64 {
        usual_step(&self.t).unwrap_or(0.0)
    }

    pub(super) fn length_s(&self) -> f64 {
        self.t.last().zip(self.t.first()).map_or(0.0, |(last, first)| last - first)
    }

    /// Between its samples; nothing in holes and beyond the ends.
    pub(super) fn at(&self, t: f64, step_s: f64) -> Option<[f64; N]> {
        let after = self.t.partition_point(|own| *own <= t).min(self.t.len().checked_sub(1)?).max(1);
        let [from, to] = [self.t.get(after - 1)?, self.t.get(after)?];
        if !(*from..=*to).contains(&t) || to - from > self.hole_s.max(2.0 * step_s) {
            return None;
        }
        let part = if to > from { (t - from) / (to - from) } else { 0.0 };
        Some(std::array::from_fn(|i| self.x[after - 1][i] + part * (self.x[after][i] - self.x[after - 1][i])))
    }
}

/// A pose in the frame of an earlier one, as the velocity that leads there.
pub(super) fn velocity(from: [f64; 3], to: [f64; 3], over_s: f64) -> [f64; 3] {
    let [from, to] = [from, to].map(|p| Pose::new(p[0], p[1], p[2]));
    let way = from.relative(to);
    let twist = displacement_to(Pose { theta: wrap_angle(way.theta), ..way }).scaled(over_s.recip());
    [twist.vx, twist.vy, twist.omega]
}

/// Poses as a track: headings go on over a turn.
pub(super) fn of_poses(poses: impl Iterator<Item = (f64, Pose)>) -> Track<3> {
    let mut track = Track::new(poses.map(|(t, p)| (t, [p.x, p.y, p.theta])));
    for i in 1..track.x.len() {
        let before = track.x[i - 1][2];
        track.x[i][2] = before + wrap_angle(track.x[i][2] - before);
    }
    track
}

/// What the log says of the motion.
pub(super) enum Motion {
    /// Ways, each with its own track: of wheels, or of what somebody wanted.
    Ways(Vec<Track<1>>),
    Poses(Track<3>),
}

impl Motion {
    /// Of a run whose first tick is at `begin`; from there on.
    pub(super) fn of(run: &Run, begin: f64) -> Option<Self> {
        let since: Vec<f64> = run.t.iter().map(|t| t - begin).collect();
        let way = |rates: &Vec<f64>| {
            let (mut way, mut last) = (0.0, None);
            Track::new(since.iter().zip(rates).filter(|(_, rate)| rate.is_finite()).map(|(t, rate)| {
                let (from, before) = last.replace((*t, *rate)).unwrap_or((*t, *rate));
                way += 0.5 * (rate + before) * (t - from);
                (*t, [way])
            }))
        };
        if !run.counts.is_empty() {
            let wheels = run.counts.iter().zip(&run.count_gaps).map(|(counts, gaps)| {
                let mut gaps = gaps.iter().peekable();
                let known = (0..run.len()).filter(|tick| gaps.next_if(|gap| *gap == tick).is_none());
                Track::new(known.map(|tick| (since[tick], [counts[tick] as f64])))
            });
            return Some(Self::Ways(wheels.collect()));
        }
        let by_wheel = [&run.speed, &run.measured].into_iter().find(|wheels| !wheels.is_empty());
        if let Some(wheels) = by_wheel {
            return Some(Self::Ways(wheels.iter().map(way).collect()));
        }
        if let Some([x, y, theta]) = &run.odometry {
            let poses = since.iter().zip(x).zip(y).zip(theta);
            return Some(Self::Poses(of_poses(poses.map(|(((t, x), y), theta)| (*t, Pose::new(*x, *y, *theta))))));
        }
        if !run.reference.is_empty() {
            return Some(Self::Ways(run.reference.iter().map(way).collect()));
        }
        let wanted = run.command.as_ref().map(|command| command.iter().map(way).collect());
        wanted.or_else(|| run.gyro.as_ref().map(|gyro| vec![way(&gyro[2])])).map(Self::Ways)
    }

    /// Usual step and length, s.
    pub(super) fn extent(&self) -> [f64; 2] {
        match self {
            Self::Ways(ways) => {
                ways.iter().fold([0.0, 0.0], |[step, length], w| [w.step_s().max(step), w.length_s().max(length)])
            }
            Self::Poses(track) => [track.step_s(), track.length_s()],
        }
    }

    /// Velocities on a grid from 0 on, each divided by its spread; those that do not change are left out.
    pub(super) fn velocities(&self, steps: usize, step_s: f64) -> Vec<Option<Vec<f64>>> {
        let ends = |k: usize| [k as f64 * step_s, (k + OVER) as f64 * step_s];
        let over_s = OVER as f64 * step_s;
        let mut rows: Vec<Option<Vec<f64>>> = (0..steps)
            .map(|k| {
                let [from, to] = ends(k);
                match self {
                    Self::Ways(ways) => {
                        ways.iter().map(|w| Some((w.at(to, step_s)?[0] - w.at(from, step_s)?[0]) / over_s)).collect()
                    }
                    Self::Poses(track) => {
                        Some(velocity(track.at(from, step_s)?, track.at(to, step_s)?, over_s).to_vec())
                    }
                }
            })
            .collect();
        let known: Vec<&Vec<f64>> = rows.iter().flatten().collect();
        let spreads: Vec<f64> =
            (0..known.first().map_or(0, |row| row.len())).map(|i| spread(known.iter().map(|row| row[i]))).collect();
        for row in rows.iter_mut().flatten() {
            *row =
                row.iter().zip(&spreads).filter(|(_, spread)| **spread > 0.0).map(|(x, spread)| x / spread).collect();
        }
        rows
    }
}

/// Standard deviation.
pub(super) fn spread(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let n = values.clone().count().max(1) as f64;
    let mean = values.clone().sum::<f64>() / n;
    (values.map(|x| (x - mean).powi(2)).sum::<f64>() / n).sqrt()
}
