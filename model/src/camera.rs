//! The overhead camera as a simulated sensor.

use std::collections::VecDeque;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use runs::frames::{Pose, wrap_angle};
use runs::robot::Robot;

/// What a camera does to a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraModel {
    /// Frames a second.
    pub rate_hz: f64,
    /// From exposure to delivery, s.
    pub latency_s: f64,
    /// Time constant of a low-pass of first order on what is seen, s; the noise is that after it.
    pub filter_s: f64,
    /// Whether that low-pass steps once a frame, as a program's does.
    pub filters_frames: bool,
    /// Standard deviations of x, y (m) and heading (rad).
    pub noise: [f64; 3],
    /// Share of frames that never arrive.
    pub drop_share: f64,
    /// Share of frames with a wrong robot in them.
    pub outlier_share: f64,
    /// Standard deviation of x and y of such a frame about the truth, m; its heading is random.
    pub outlier_m: f64,
    /// Marker plate on the chassis: where it sits (m, m, body frame) and how far it is turned (rad).
    pub marker: Pose,
    /// Metres of the camera per metre, less 1.
    pub scale: f64,
    /// Radial distortion about the field's origin, 1/m².
    pub k1_per_m2: f64,
}

impl CameraModel {
    /// 1.5 mm and 0.5° as the example data sets have, no dropped frames, no outliers.
    pub fn of(robot: &Robot) -> Self {
        Self {
            rate_hz: robot.camera_rate_hz,
            latency_s: robot.camera_latency_s,
            filter_s: 0.0,
            filters_frames: false,
            noise: robot.camera_noise.unwrap_or([0.0015, 0.0015, 0.5_f64.to_radians()]),
            drop_share: 0.0,
            outlier_share: 0.0,
            outlier_m: 0.5,
            marker: Pose::default(),
            scale: 0.0,
            k1_per_m2: 0.0,
        }
    }

    /// What a camera without noise reports of a chassis pose.
    pub fn image(&self, chassis: Pose) -> Pose {
        let plate = chassis.compose(self.marker);
        let s = (1.0 + self.scale) * (1.0 + self.k1_per_m2 * (plate.x * plate.x + plate.y * plate.y));
        Pose::new(s * plate.x, s * plate.y, plate.theta)
    }
}

/// A seeded camera that watches one robot.
#[derive(Debug, Clone)]
pub struct Camera {
    model: CameraModel,
    rng: ChaCha8Rng,
    frames: u64,
    start: Option<f64>,
    /// Times and poses back to the oldest that may still be needed.
    past: VecDeque<(f64, Pose)>,
    /// Time and pose of the last frame, filtered.
    shown: Option<(f64, Pose)>,
}

impl Camera {
    /// A camera whose every run with the same seed and poses gives the same frames.
    pub fn new(model: CameraModel, seed: u64) -> Self {
        Self { model, rng: ChaCha8Rng::seed_from_u64(seed), frames: 0, start: None, past: VecDeque::new(), shown: None }
    }

    /// The robot is at `pose` at time `t` (s, increasing): what arrives from the camera at this
    /// tick, if anything. Before the first tick the robot counts as standing still.
    pub fn observe(&mut self, t: f64, pose: Pose) -> Option<Pose> {
        let passed = if self.model.filters_frames { pose } else { self.filtered(self.past.back(), t, pose) };
        self.past.push_back((t, passed));
        let start = *self.start.get_or_insert(t);
        if self.model.rate_hz <= 0.0 || t < start + self.frames as f64 / self.model.rate_hz - 1e-9 {
            return None;
        }
        self.frames += 1;
        let mut past = self.pose_at(t - self.model.latency_s);
        if self.model.filters_frames {
            past = self.filtered(self.shown.as_ref(), t, past);
            self.shown = Some((t, past));
        }
        let seen = self.model.image(past);
        // The same draws for every frame, so that dropping one does not change the others.
        let mut gauss = || -> f64 { StandardNormal.sample(&mut self.rng) };
        let (noise, wrong) = ([gauss(), gauss(), gauss()], [gauss(), gauss()]);
        let [drop, outlier, turn] = [(); 3].map(|()| self.rng.random::<f64>());
        if drop < self.model.drop_share {
            return None;
        }
        let is_outlier = outlier < self.model.outlier_share;
        let [sx, sy, st] = self.model.noise;
        let (sx, sy) = if is_outlier { (self.model.outlier_m, self.model.outlier_m) } else { (sx, sy) };
        let (nx, ny) = if is_outlier { (wrong[0], wrong[1]) } else { (noise[0], noise[1]) };
        let dtheta = if is_outlier { turn * std::f64::consts::TAU } else { st * noise[2] };
        Some(Pose::new(seen.x + sx * nx, seen.y + sy * ny, wrap_angle(seen.theta + dtheta)))
    }

    /// What a low-pass makes of a pose some time after what it made of the one before.
    fn filtered(&self, last: Option<&(f64, Pose)>, t: f64, pose: Pose) -> Pose {
        let Some((then, last)) = last.filter(|_| self.model.filter_s > 0.0) else { return pose };
        let kept = (-(t - then) / self.model.filter_s).exp();
        let turn = wrap_angle(last.theta - pose.theta);
        Pose::new(pose.x + kept * (last.x - pose.x), pose.y + kept * (last.y - pose.y), pose.theta + kept * turn)
    }

    fn pose_at(&mut self, t: f64) -> Pose {
        while self.past.len() > 2 && self.past[1].0 <= t {
            self.past.pop_front();
        }
        let (t0, p0) = self.past[0];
        match self.past.get(1) {
            Some((t1, p1)) if t > t0 => {
                let share = ((t - t0) / (t1 - t0)).min(1.0);
                let part = |a: f64, b: f64| a + share * (b - a);
                Pose::new(part(p0.x, p1.x), part(p0.y, p1.y), part(p0.theta, p1.theta))
            }
            _ => p0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn watch(model: CameraModel, seed: u64, seconds: f64) -> Vec<(f64, Pose, Pose)> {
        let mut camera = Camera::new(model, seed);
        let mut frames = Vec::new();
        for k in 0..(seconds * 1000.0) as usize {
            let t = k as f64 * 0.001;
            let truth = Pose::new(t, -2.0 * t, 3.0 * t);
            if let Some(seen) = camera.observe(t, truth) {
                frames.push((t, truth, seen));
            }
        }
        frames
    }

    fn clean() -> CameraModel {
        CameraModel { noise: [0.0; 3], ..CameraModel::of(&Robot::racbot()) }
    }

    #[test]
    fn rate_latency_and_wrapping() {
        let frames = watch(CameraModel { latency_s: 0.0705, ..clean() }, 1, 10.0);
        assert_eq!(frames.len(), 600);
        for (t, _, seen) in &frames[10..] {
            assert!((seen.x - (t - 0.0705)).abs() < 1e-9, "{t}: {seen:?}");
            assert!((wrap_angle(seen.theta - 3.0 * (t - 0.0705))).abs() < 1e-9);
            assert!(seen.theta.abs() <= std::f64::consts::PI);
        }
    }

    #[test]
    fn a_filter_lags_by_its_time_constant() {
        let frames = watch(CameraModel { filter_s: 0.08, ..clean() }, 1, 4.0);
        let (t, _, seen) = frames[200];
        // Half a tick is the step of the filter.
        assert!((seen.x - (t - 0.08)).abs() < 6e-4 && (seen.y + 2.0 * (t - 0.08)).abs() < 1.2e-3, "{t}: {seen:?}");
        assert!(wrap_angle(seen.theta - 3.0 * (t - 0.08)).abs() < 2e-3, "{t}: {seen:?}");
        // Once a frame of 60 a second: x is as late as the recursion has it.
        let frames = watch(CameraModel { filter_s: 0.08, filters_frames: true, ..clean() }, 1, 4.0);
        let (late, kept) = (frames[200].0 - frames[200].2.x, (-1.0 / 60.0 / 0.08_f64).exp());
        assert!((late - kept / (1.0 - kept) / 60.0).abs() < 1e-3, "{late}");
    }

    #[test]
    fn noise_has_the_stated_size_and_the_seed_decides() {
        let model = CameraModel::of(&Robot::racbot());
        let frames = watch(model, 7, 100.0);
        assert_eq!(frames, watch(model, 7, 100.0));
        assert_ne!(frames, watch(model, 8, 100.0));
        let n = frames.len() as f64;
        let rms =
            |f: &dyn Fn(&Pose, &Pose) -> f64| (frames.iter().map(|(_, a, b)| f(a, b).powi(2)).sum::<f64>() / n).sqrt();
        // 6000 frames: the RMS is known to 1 %.
        assert!((rms(&|a, b| a.x - b.x) / 0.0015 - 1.0).abs() < 0.04);
        assert!((rms(&|a, b| wrap_angle(a.theta - b.theta)) / 0.5_f64.to_radians() - 1.0).abs() < 0.04);
    }

    #[test]
    fn dropped_frames_and_outliers_come_at_their_rate_and_leave_the_others_alone() {
        let all = watch(clean(), 3, 100.0);
        let some = watch(CameraModel { drop_share: 0.25, outlier_share: 0.1, ..clean() }, 3, 100.0);
        let share = some.len() as f64 / all.len() as f64;
        assert!((share - 0.75).abs() < 0.02, "{share}");
        let wrong = some.iter().filter(|(_, a, b)| a.distance(*b) > 1e-9).count();
        assert!((wrong as f64 / some.len() as f64 - 0.1).abs() < 0.02, "{wrong}");
    }
}
