//! Cameras that see where the robot is but not where it points: GPS, ultra-wideband, a single marker.

use crate::Run;
use crate::frames::{Pose, displacement, wrap_angle};
use crate::geometry::Geometry;
use crate::robot::Robot;

/// Spread of the way by the wheels, in distances of the outermost wheel from the centre, that tells a direction.
const SPREAD: f64 = 2.0;
/// Frames on either side at first.
const NEAR: usize = 4;

/// Puts headings to positions: those by which the way of the wheels lies along that of the camera. They point, and are no
/// measurement of a turn.
pub(super) struct Headings {
    robot: Option<(Geometry, f64)>,
    said: bool,
}

/// Sums over the frames up to one: camera, wheels, their product with the one's conjugate, and the wheels' square.
#[derive(Clone, Copy, Default)]
struct Sums {
    n: f64,
    camera: [f64; 2],
    wheels: [f64; 2],
    product: [f64; 2],
    square: f64,
}

impl Headings {
    /// For the robot as its logs show it.
    pub(super) fn of(as_logged: &Robot) -> Self {
        let known = as_logged.geometry().ok().map(|geometry| (geometry, as_logged.counts_per_wheel_rad()));
        Self { robot: known.filter(|(_, counts)| counts.is_finite() && *counts > 0.0), said: false }
    }

    /// Whether a run has positions alone.
    pub(super) fn are_missing(run: &Run) -> bool {
        run.camera.iter().any(|sample| sample.pose.theta.is_nan())
    }

    /// Fills in the headings of a part; positions without wheels go.
    pub(super) fn apply(&self, run: &mut Run) {
        if !Self::are_missing(run) {
            return;
        }
        let Some((geometry, per_rad)) = &self.robot else { return run.camera.clear() };
        if run.counts.len() != geometry.wheel_count() {
            return run.camera.clear();
        }
        let own = by_wheels(geometry, *per_rad, run);
        let mut sums = vec![Sums::default()];
        for (sample, own) in run.camera.iter().zip(&own) {
            let last = sums[sums.len() - 1];
            sums.push(last.with([sample.pose.x, sample.pose.y], [own.x, own.y]));
        }
        let wheels = geometry.wheels().iter();
        let enough = SPREAD * wheels.map(|w| w.x_m.hypot(w.y_m)).fold(0.0, f64::max);
        let n = own.len();
        for (i, sample) in run.camera.iter_mut().enumerate() {
            let mut near = NEAR;
            let turn = loop {
                let (from, to) = (i.saturating_sub(near), (i + near + 1).min(n));
                let (turn, spread) = sums[to].since(&sums[from]);
                if spread >= enough || to - from == n {
                    break turn;
                }
                near *= 2;
            };
            sample.pose.theta = wrap_angle(own[i].theta + turn);
        }
    }

    /// What was done, said once.
    pub(super) fn note(&mut self) -> Option<String> {
        let new = !std::mem::replace(&mut self.said, true);
        let what = "the camera's positions have no headings: ways are compared, and turns as far as they bend them; where \
                    the robot points is taken from its wheels";
        new.then(|| what.to_owned())
    }
}

impl Sums {
    fn with(mut self, camera: [f64; 2], wheels: [f64; 2]) -> Self {
        let ([cx, cy], [ox, oy]) = (camera, wheels);
        self.n += 1.0;
        for (sum, x) in self.camera.iter_mut().chain(&mut self.wheels).zip([cx, cy, ox, oy]) {
            *sum += x;
        }
        self.product[0] += cx * ox + cy * oy;
        self.product[1] += cy * ox - cx * oy;
        self.square += ox * ox + oy * oy;
        self
    }

    /// Over the frames after an earlier one: the turn from the wheels' way to the camera's, rad, and the RMS distance of
    /// the wheels' way from its middle, m.
    fn since(&self, before: &Self) -> (f64, f64) {
        let n = self.n - before.n;
        let of = |now: [f64; 2], then: [f64; 2]| [now[0] - then[0], now[1] - then[1]];
        let ([cx, cy], [ox, oy]) = (of(self.camera, before.camera), of(self.wheels, before.wheels));
        let [re, im] = of(self.product, before.product);
        let (re, im) = (re - (cx * ox + cy * oy) / n, im - (cy * ox - cx * oy) / n);
        let square = self.square - before.square - (ox * ox + oy * oy) / n;
        (im.atan2(re), (square / n).max(0.0).sqrt())
    }
}

/// Poses by the wheels at the camera's frames, from the first tick.
fn by_wheels(geometry: &Geometry, counts_per_rad: f64, run: &Run) -> Vec<Pose> {
    let mut pose = Pose::default();
    let mut turned = vec![0.0; run.counts.len()];
    let mut last = 0;
    let mut out = Vec::with_capacity(run.camera.len());
    for sample in &run.camera {
        for tick in last..sample.tick {
            for (turned, counts) in turned.iter_mut().zip(&run.counts) {
                *turned = counts[tick + 1].wrapping_sub(counts[tick]) as f64 / counts_per_rad;
            }
            pose = pose.compose(displacement(geometry.twist(&turned)));
        }
        last = sample.tick;
        out.push(pose);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CameraSample;
    use crate::frames::Twist;

    #[test]
    fn positions_point_where_the_robot_drives() {
        let robot = Robot::racbot();
        let (geometry, per_rad) = (robot.geometry().unwrap(), robot.counts_per_wheel_rad());
        let mut pose = Pose::new(0.4, -0.3, 2.0);
        let mut angle = vec![0.0; geometry.wheel_count()];
        let mut run = Run { counts: vec![Vec::new(); angle.len()], has_camera: true, ..Run::default() };
        let mut headings = Vec::new();
        for tick in 0..4000 {
            let t = 1e-3 * f64::from(tick);
            run.t.push(t);
            run.counts
                .iter_mut()
                .zip(&angle)
                .for_each(|(counts, a): (_, &f64)| counts.push((a * per_rad).round() as i64));
            if tick % 100 == 0 {
                run.camera.push(CameraSample { tick: tick as usize, pose: Pose::new(pose.x, pose.y, f64::NAN) });
                headings.push(pose.theta);
            }
            let step = Twist::new(0.3, 0.4 * (2.0 * t).sin(), 0.8).scaled(1e-3);
            angle.iter_mut().zip(geometry.wheel_speeds(step)).for_each(|(a, w)| *a += w);
            pose = pose.compose(displacement(step));
        }
        Headings::of(&robot).apply(&mut run);
        for (sample, heading) in run.camera.iter().zip(headings) {
            assert!(wrap_angle(sample.pose.theta - heading).abs() < 0.02, "{sample:?} {heading}");
        }
        // Without wheels nothing points.
        run.camera.iter_mut().for_each(|sample| sample.pose.theta = f64::NAN);
        run.counts.clear();
        Headings::of(&robot).apply(&mut run);
        assert!(run.camera.is_empty());
    }
}
