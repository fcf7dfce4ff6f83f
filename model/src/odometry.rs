//! Odometry: encoder counts to pose, with covariance.

use nalgebra::Matrix3;

use runs::frames::{Pose, Twist, displacement};
use runs::geometry::Geometry;

/// Variance of a wheel's angle per angle turned, rad²/rad: slip and roller contact make the
/// distance rolled a random walk. 1e-4 is 1 cm after 13 m on wheels of 27.5 mm.
///
/// The encoders' quantisation is not part of it: it is bounded and does not add up.
pub const DEFAULT_WHEEL_VARIANCE: f64 = 1e-4;

/// A displacement over one tick and what is not known about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Increment {
    /// Displacement in the body frame: twist × tick (m, m, rad).
    pub moved: Twist,
    /// Covariance of the displacement, body frame.
    pub covariance: Matrix3<f64>,
}

/// Turns encoder counts into [`Increment`]s.
#[derive(Debug, Clone)]
pub struct Odometer {
    /// Body displacement per count, one column a wheel (m, m, rad).
    per_count: Vec<[f64; 3]>,
    rad_per_count: f64,
    wheel_variance: f64,
    counts: Vec<i64>,
}

impl Odometer {
    /// For wheels with this kinematics and encoder; counts start at 0.
    pub fn new(geometry: &Geometry, counts_per_wheel_rad: f64, wheel_variance: f64) -> Self {
        let direct = geometry.direct();
        let per_count =
            direct.column_iter().map(|c| [c[0], c[1], c[2]].map(|v| v / counts_per_wheel_rad)).collect::<Vec<_>>();
        let counts = vec![0; per_count.len()];
        Self { per_count, rad_per_count: 1.0 / counts_per_wheel_rad, wheel_variance, counts }
    }

    /// Takes these counts as where the robot stands, without moving it.
    pub fn reset(&mut self, counts: &[i64]) {
        for (own, count) in self.counts.iter_mut().zip(counts) {
            *own = *count;
        }
    }

    /// The displacement since the last call; counters may wrap.
    pub fn increment(&mut self, counts: &[i64]) -> Increment {
        let mut moved = [0.0; 3];
        let mut covariance = Matrix3::zeros();
        for ((own, count), column) in self.counts.iter_mut().zip(counts).zip(&self.per_count) {
            let difference = count.wrapping_sub(*own) as f64;
            *own = *count;
            if difference == 0.0 {
                continue;
            }
            // Variance of this wheel's turn, in counts².
            let variance = self.wheel_variance * difference.abs() / self.rad_per_count;
            for i in 0..3 {
                moved[i] += column[i] * difference;
                for j in 0..=i {
                    covariance[(i, j)] += column[i] * column[j] * variance;
                }
            }
        }
        covariance.fill_upper_triangle_with_lower_triangle();
        Increment { moved: Twist::new(moved[0], moved[1], moved[2]), covariance }
    }
}

/// Of the errors of x, y and heading, in world axes: m², m rad, rad².
pub type Covariance = Matrix3<f64>;

/// A pose and its covariance.
///
/// The covariance is that of the pose's error (x, y, θ) in world axes, m² and rad².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Best estimate.
    pub pose: Pose,
    /// Covariance of its error.
    pub covariance: Covariance,
}

impl Estimate {
    /// A pose with independent standard deviations of x, y (m) and heading (rad).
    pub fn new(pose: Pose, sd: [f64; 3]) -> Self {
        Self { pose, covariance: Matrix3::from_diagonal(&nalgebra::Vector3::from(sd.map(|s| s * s))) }
    }

    /// The estimate after an increment: exact integration of a constant twist, and first-order
    /// propagation of the covariance.
    #[must_use]
    pub fn moved(self, increment: &Increment) -> Self {
        let pose = self.pose.compose(displacement(increment.moved));
        let (dx, dy) = (pose.x - self.pose.x, pose.y - self.pose.y);
        let mut p = self.covariance;
        // F P Fᵀ with F = 1 but for F(x, θ) = −dy and F(y, θ) = dx.
        let (xt, yt, tt) = (p[(0, 2)], p[(1, 2)], p[(2, 2)]);
        p[(0, 0)] += dy * (dy * tt - 2.0 * xt);
        p[(1, 1)] += dx * (dx * tt + 2.0 * yt);
        p[(0, 1)] += dx * xt - dy * yt - dx * dy * tt;
        p[(0, 2)] = xt - dy * tt;
        p[(1, 2)] = yt + dx * tt;
        // The increment's covariance turned into the world, along the mean heading of the tick.
        let (s, c) = (self.pose.theta + 0.5 * increment.moved.omega).sin_cos();
        let q = &increment.covariance;
        let (xx, xy, yy) = (q[(0, 0)], q[(0, 1)], q[(1, 1)]);
        p[(0, 0)] += c * c * xx - 2.0 * s * c * xy + s * s * yy;
        p[(1, 1)] += s * s * xx + 2.0 * s * c * xy + c * c * yy;
        p[(0, 1)] += s * c * (xx - yy) + (c * c - s * s) * xy;
        p[(0, 2)] += c * q[(0, 2)] - s * q[(1, 2)];
        p[(1, 2)] += s * q[(0, 2)] + c * q[(1, 2)];
        p[(2, 2)] += q[(2, 2)];
        p.fill_lower_triangle_with_upper_triangle();
        Self { pose, covariance: p }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    fn geometry() -> Geometry {
        Geometry::rac(0.0275, 0.085, [0.0; 3]).unwrap()
    }

    const COUNTS_PER_RAD: f64 = 1209.0;

    #[test]
    fn a_circle_closes_where_euler_steps_do_not() {
        let g = geometry();
        let mut odometer = Odometer::new(&g, COUNTS_PER_RAD, 0.0);
        let mut estimate = Estimate::new(Pose::default(), [0.0; 3]);
        let (mut euler, mut old) = (Pose::default(), [0; 3]);
        // Forward on a circle of 1 m radius, in 40 coarse ticks.
        for k in 1..=40 {
            let angle = f64::from(k) * std::f64::consts::TAU / 40.0;
            let counts: Vec<i64> = g
                .wheel_speeds(Twist::new(0.0, angle, angle))
                .iter()
                .map(|w| (w * COUNTS_PER_RAD).round() as i64)
                .collect();
            let turned: Vec<f64> = counts.iter().zip(old).map(|(c, o)| (*c - o) as f64 / COUNTS_PER_RAD).collect();
            old.copy_from_slice(&counts);
            let [x, y, omega] = euler.world_velocity(g.twist(&turned));
            euler = Pose::new(euler.x + x, euler.y + y, euler.theta + omega);
            if k == 20 {
                assert!(euler.distance(Pose::new(-2.0, 0.0, 0.0)) > 0.1, "half way: {euler:?}");
                assert!(estimate.pose.advance(g.twist(&turned), 1.0).distance(Pose::new(-2.0, 0.0, 0.0)) < 2e-4);
            }
            estimate = estimate.moved(&odometer.increment(&counts));
        }
        assert!(estimate.pose.distance(Pose::default()) < 2e-4, "{:?}", estimate.pose);
        assert!((estimate.pose.theta - std::f64::consts::TAU).abs() < 1e-3);
    }

    #[test]
    fn covariance_is_the_spread_of_many_noisy_drives() {
        let g = geometry();
        let variance = 1e-3;
        let twist = Twist::new(0.3e-2, 0.8e-2, 0.9e-2);
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let (n, ticks) = (4000, 120);
        let mut ends = Vec::new();
        for _ in 0..n {
            let mut pose = Pose::default();
            for _ in 0..ticks {
                let turned: Vec<f64> = g
                    .wheel_speeds(twist)
                    .iter()
                    .map(|w| {
                        let z: f64 = StandardNormal.sample(&mut rng);
                        w + z * (variance * w.abs()).sqrt()
                    })
                    .collect();
                pose = pose.advance(g.twist(&turned), 1.0);
            }
            ends.push(pose);
        }
        let mut estimate = Estimate::new(Pose::default(), [0.0; 3]);
        // Counts fine enough that rounding does not matter.
        let fine = 1e9;
        let mut odometer = Odometer::new(&g, fine, variance);
        for k in 1..=ticks {
            let counts: Vec<i64> = g.wheel_speeds(twist).iter().map(|w| (w * f64::from(k) * fine) as i64).collect();
            estimate = estimate.moved(&odometer.increment(&counts));
        }
        let p = estimate.pose;
        let errors: Vec<[f64; 3]> = ends.iter().map(|e| [e.x - p.x, e.y - p.y, e.theta - p.theta]).collect();
        for i in 0..3 {
            for j in 0..3 {
                let sample = errors.iter().map(|e| e[i] * e[j]).sum::<f64>() / f64::from(n);
                let scale = (estimate.covariance[(i, i)] * estimate.covariance[(j, j)]).sqrt();
                let off = (sample - estimate.covariance[(i, j)]) / scale;
                // 4000 drives: a correlation is known to 1.6 %.
                assert!(off.abs() < 0.07, "({i}, {j}): off by {off}");
            }
        }
    }

    #[test]
    fn wrapping_counters_do_not_jump() {
        let mut odometer = Odometer::new(&geometry(), COUNTS_PER_RAD, 0.0);
        odometer.reset(&[i64::MAX; 3]);
        let moved = odometer.increment(&[i64::MIN; 3]).moved;
        assert!((moved.omega + 0.0275 / 0.085 / COUNTS_PER_RAD).abs() < 1e-12, "{moved:?}");
    }
}
