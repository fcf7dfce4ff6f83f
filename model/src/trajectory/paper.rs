//! The paper's motion controller and motion simulator (Fig. 5): kinematics only.

use super::SetPoint;
use runs::frames::{Pose, Twist};
use runs::geometry::Geometry;

/// The paper's open-loop motion controller: straight at the next set point from the current pose,
/// at the set point's speed and rotation.
///
/// A set point is reached within `tolerance` of it. In the last tick before it the speed is
/// lowered so that the point is met and not passed by up to a tick's travel.
#[derive(Debug, Clone)]
pub struct MotionController {
    set_points: Vec<SetPoint>,
    next: usize,
    tolerance: f64,
}

impl MotionController {
    /// A controller at the start of a trajectory; `tolerance` in m, greater than 0.
    pub fn new(set_points: &[SetPoint], tolerance: f64) -> Self {
        Self { set_points: set_points.to_vec(), next: 0, tolerance }
    }

    /// Number of set points reached so far.
    pub fn reached(&self) -> usize {
        self.next
    }

    /// The body twist for the coming `dt` seconds; `None` once all set points are reached.
    pub fn command(&mut self, pose: Pose, dt: f64) -> Option<Twist> {
        loop {
            let target = self.set_points.get(self.next)?;
            let (dx, dy) = (target.x - pose.x, target.y - pose.y);
            let distance = dx.hypot(dy);
            if distance <= self.tolerance {
                self.next += 1;
                continue;
            }
            let speed = target.v.min(distance / dt) / distance;
            // The body turns during the tick; aim along its mean heading.
            let heading = Pose { theta: pose.theta + 0.5 * target.omega * dt, ..pose };
            return Some(heading.body_twist([speed * dx, speed * dy, target.omega]));
        }
    }
}

/// One tick of [`simulate_motion`].
#[derive(Debug, Clone, PartialEq)]
pub struct MotionSample {
    /// s.
    pub t: f64,
    /// Where the controller believes the robot to be.
    pub believed: Pose,
    /// Where the robot really is.
    pub actual: Pose,
    /// Wheel speeds of the coming tick, rad/s.
    pub wheel_speeds: Vec<f64>,
}

/// The paper's simulation: the controller converts set points to wheel speeds with the geometry it
/// believes in (equation 4); the robot moves by what it really is (equation 5). Without visual
/// feedback the controller's pose is its own odometry.
///
/// Ends when the controller has reached all set points, or after `limit_s`.
pub fn simulate_motion(
    set_points: &[SetPoint],
    start: Pose,
    believed: &Geometry,
    actual: &Geometry,
    dt: f64,
    limit_s: f64,
) -> Vec<MotionSample> {
    let mut controller = MotionController::new(set_points, 1e-6);
    let (mut at, mut really_at) = (start, start);
    let mut samples = Vec::new();
    loop {
        let t = samples.len() as f64 * dt;
        let twist = if t < limit_s { controller.command(at, dt) } else { None };
        let wheel_speeds = believed.wheel_speeds(twist.unwrap_or_default());
        let (odometry, motion) = (believed.twist(&wheel_speeds), actual.twist(&wheel_speeds));
        samples.push(MotionSample { t, believed: at, actual: really_at, wheel_speeds });
        if twist.is_none() {
            return samples;
        }
        at = at.advance(odometry, dt);
        really_at = really_at.advance(motion, dt);
    }
}

#[cfg(test)]
mod tests {
    use super::super::{FIG_6, FIG_7_SKEW_DEG};
    use super::*;

    const DT: f64 = 0.001;

    fn drive(believed: [f64; 3], actual: [f64; 3]) -> Vec<MotionSample> {
        let geometry = |deg: [f64; 3]| Geometry::rac(0.0275, 0.085, deg.map(f64::to_radians)).unwrap();
        simulate_motion(&FIG_6, Pose::default(), &geometry(believed), &geometry(actual), DT, 60.0)
    }

    fn nearest(samples: &[MotionSample], x: f64, y: f64) -> f64 {
        samples.iter().map(|s| (s.actual.x - x).hypot(s.actual.y - y)).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn fig_6_ideal_geometry_meets_every_set_point_on_straight_lines() {
        let run = drive([0.0; 3], [0.0; 3]);
        let corners = [(0.0, 0.0), (3.0, 3.0), (3.0, 0.0), (6.0, 0.0), (6.0, 3.0)];
        for (x, y) in corners {
            assert!(nearest(&run, x, y) < 1e-5, "({x}, {y}) missed by {}", nearest(&run, x, y));
        }
        for s in &run {
            let off = corners.windows(2).map(|leg| off_line(s.actual, leg[0], leg[1])).fold(f64::INFINITY, f64::min);
            assert!(off < 1e-5, "{off} m off the path at {} s", s.t);
        }
        // Four legs at 1 m/s: √18 + 3 + 3 + 3 s, each leg ending within a tick.
        let last = run.last().unwrap();
        assert!((last.t - (18.0_f64.sqrt() + 9.0)).abs() < 5.0 * DT, "{}", last.t);
        let turned = 0.5 * 18.0_f64.sqrt() - 0.15 * 3.0;
        assert!((last.actual.theta - turned).abs() < 2e-3, "{}", last.actual.theta);
        assert_eq!(last.wheel_speeds, [0.0; 3]);
    }

    fn off_line(p: Pose, a: (f64, f64), b: (f64, f64)) -> f64 {
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let along = (((p.x - a.0) * dx + (p.y - a.1) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
        (p.x - a.0 - along * dx).hypot(p.y - a.1 - along * dy)
    }

    #[test]
    fn fig_7_unknown_skew_leads_astray_and_known_skew_does_not() {
        let red = drive([0.0; 3], FIG_7_SKEW_DEG);
        // The controller believes in its set points...
        let last = red.last().unwrap();
        assert!((last.believed.x - 6.0).abs() < 1e-5 && (last.believed.y - 3.0).abs() < 1e-5);
        // ...but the robot passes the corners by more than its own size and turns on the way.
        assert!(nearest(&red, 3.0, 3.0) > 0.2 && nearest(&red, 6.0, 3.0) > 0.2);
        assert!((last.actual.x - FIG_7_END.x).abs() < 1e-3, "{:?}", last.actual);
        assert!((last.actual.y - FIG_7_END.y).abs() < 1e-3, "{:?}", last.actual);
        assert!((last.actual.theta - FIG_7_END.theta).abs() < 1e-3, "{:?}", last.actual);
        let green = drive(FIG_7_SKEW_DEG, FIG_7_SKEW_DEG);
        assert!(green.last().unwrap().actual.distance(Pose::new(6.0, 3.0, 0.0)) < 1e-5);
    }

    /// Where the red curve ends, computed apart from this crate: the printed matrix (6), inverted
    /// by hand, in steps of 0.1 ms.
    const FIG_7_END: Pose = Pose::new(4.1946, 1.3636, 1.6587);

    #[test]
    fn a_robot_that_cannot_arrive_stops_at_the_time_limit() {
        let far = [SetPoint::pass(100.0, 0.0, 0.1, 0.0)];
        let g = Geometry::rac(0.0275, 0.085, [0.0; 3]).unwrap();
        let run = simulate_motion(&far, Pose::default(), &g, &g, 0.01, 2.0);
        assert!((run.last().unwrap().t - 2.0).abs() < 0.011);
    }
}
