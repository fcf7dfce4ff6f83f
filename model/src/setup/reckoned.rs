//! Poses that were computed from the counts beside them: the robot's own odometry in the columns of a camera, with which
//! everything agrees.

use nalgebra::{DMatrix, DVector};
use runs::frames::{Pose, wrap_angle};
use runs::robot::Robot;
use runs::{Log, Seen, is_dead_reckoning, is_from_speeds};

use super::Mistake;
use super::samples::Wheels;
use super::short;

/// Share of what rounding to whole counts leaves of a way below which poses have that rounding themselves. What does not know
/// the counts differs from them by all of it at least, whatever it is; a Roomba's poses by its own counts differed by 0.001.
const KNOWS: f64 = 0.5;
/// Fewest steps that tell anything: the RMS of as many is known to a twentieth.
const FEWEST: usize = 200;
/// Variance of the difference of two readings in whole counts, counts².
const ROUNDED: f64 = 1.0 / 6.0;
/// Rows by which poses may be older or younger than the counts that they were computed from.
const LAGS: [isize; 3] = [0, 1, -1];
/// Frames that are a row's own, s.
const SAME_S: f64 = 1e-6;

/// Of ways from pose to pose, RMS: what the counts leave, and what rounding to whole counts would.
struct Ways {
    left: f64,
    rounding: f64,
}

impl Ways {
    fn know_counts(&self) -> bool {
        self.left < KNOWS * self.rounding
    }
}

/// Poses of the camera that have the rounding of the counts.
pub(super) fn mistakes(robot: &Robot, logs: &[Log]) -> Option<Mistake> {
    if is_dead_reckoning(robot) || is_from_speeds(robot) {
        return None;
    }
    let known: Vec<Ways> = logs.iter().filter_map(|log| of(robot, log)).filter(Ways::know_counts).collect();
    let most = known.iter().max_by(|a, b| a.left.total_cmp(&b.left))?;
    let logs =
        if known.len() == logs.len() { String::new() } else { format!(" in {} of {} logs", known.len(), logs.len()) };
    let what = format!(
        "the poses{logs} go from row to row as the counts say to {} mm, where whole counts tell a way to {} mm: they were \
         computed from these counts, and agree with any wheels",
        short(1e3 * most.left),
        short(1e3 * most.rounding)
    );
    let remedy = "log poses of a camera, of motion capture or on a map; the robot's own odometry is odom_x, odom_y and \
                  odom_theta beside those, in place of its counts";
    Some(Mistake::new("poses-reckoned", "cam_x", what, remedy.to_owned()))
}

/// The ways of a log by the reading of its headings and the age of its poses that leave least.
fn of(robot: &Robot, log: &Log) -> Option<Ways> {
    let geometry = robot.geometry().ok()?;
    let ways_alone = log.layout().source.positions_only;
    if ways_alone && !geometry.is_differential() {
        return None; // which way it went by its frame is not known
    }
    let wheels = Wheels::of(robot, log)?;
    let row = |frame: &Seen| {
        let k = wheels.t.partition_point(|t| *t < frame.t - SAME_S);
        (k < wheels.t.len() && wheels.t[k] < frame.t + SAME_S).then_some((k, frame.pose))
    };
    let frames: Vec<(usize, Pose)> = log.camera().iter().filter_map(row).collect();
    let rim = geometry.wheels().iter().map(|w| w.x_m.hypot(w.y_m)).fold(0.0, f64::max);
    let steps_by = |lag: isize, clockwise: f64| {
        let step = |pair: &[(usize, Pose)]| {
            let at = |k: usize| k.checked_add_signed(-lag).filter(|k| *k < wheels.t.len());
            let [(i, from), (j, to)] = [pair[0], pair[1]];
            let (i, j) = (at(i)?, at(j)?);
            let turned: Vec<f64> = wheels.angle.iter().map(|angle| angle[j] - angle[i]).collect();
            let counts: Vec<f64> = turned.iter().map(|angle| angle * robot.counts_per_wheel_rad()).collect();
            let [dx, dy] = [to.x - from.x, to.y - from.y];
            let way = if ways_alone {
                let twist = geometry.twist(&turned);
                // Ahead, or back: of a turn on the spot nobody knows.
                (twist.vy.abs() > 2.0 * rim * twist.omega.abs()).then(|| [twist.vy.signum() * dx.hypot(dy), 0.0])?
            } else {
                let heading = clockwise * (from.theta + 0.5 * wrap_angle(to.theta - from.theta));
                let (sin, cos) = heading.sin_cos();
                [cos * dx + sin * dy, cos * dy - sin * dx]
            };
            counts.iter().any(|n| n.abs() > ROUNDED).then_some((counts, way))
        };
        frames.windows(2).filter_map(step).collect::<Vec<(Vec<f64>, [f64; 2])>>()
    };
    let readings = LAGS.into_iter().flat_map(|lag| [1.0, -1.0].map(|clockwise| (lag, clockwise)));
    let found = readings.filter_map(|(lag, clockwise)| ways(&steps_by(lag, clockwise)));
    found.min_by(|a, b| a.left.total_cmp(&b.left))
}

/// Ways in the body's frame as a linear function of the counts of all wheels: no file is needed for that, nor any geometry.
fn ways(steps: &[(Vec<f64>, [f64; 2])]) -> Option<Ways> {
    if steps.len() < FEWEST {
        return None;
    }
    let n = steps.len();
    let counts = DMatrix::from_fn(n, steps[0].0.len(), |i, w| steps[i].0[w]);
    let svd = counts.clone().svd(true, true);
    // Wheels that never turn apart have one column.
    let tiny = 1e-6 * svd.singular_values.max();
    let (mut left, mut rounding) = (0.0, 0.0);
    for axis in 0..2 {
        let way = DVector::from_fn(n, |i, _| steps[i].1[axis]);
        let per_count = svd.solve(&way, tiny).ok()?;
        left += (way - &counts * &per_count).norm_squared() / n as f64;
        rounding += ROUNDED * per_count.norm_squared();
    }
    Some(Ways { left: left.sqrt(), rounding: rounding.sqrt() })
}
