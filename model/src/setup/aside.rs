//! The robot's own odometry that goes beside its own heading, of a robot that cannot.

use runs::Log;
use runs::robot::Robot;

use super::samples::Wheels;
use super::{Mistake, short};

/// Angle between way and heading from which it is said, rad: odometry that is integrated from two wheels has none to its last digit,
/// one that a filter corrects up to 0.011 (eight recordings of five robots).
const ASIDE: f64 = 0.02;
/// Share of the squared way sideways that goes with the way ahead, at least: of those recordings it was 0.14 at most, what
/// corrections and rounding do follows no way.
const FOLLOWS: f64 = 0.8;
/// Fewest steps that tell anything.
const FEWEST: usize = 20;

/// Ways that lie beside the heading by one angle, ahead and backwards; the file says whether the robot can go there.
pub(super) fn mistakes(file: &Robot, robot: &Robot, logs: &[Log]) -> Option<Mistake> {
    if !runs::is_dead_reckoning(robot) || !file.geometry().is_ok_and(|geometry| geometry.is_differential()) {
        return None;
    }
    let geometry = robot.geometry().ok()?;
    let steps = logs.iter().filter_map(|log| Wheels::of(robot, log)).flat_map(|wheels| {
        let step = |pair: &[f64]| wheels.turned(pair[0], pair[1]).map(|turned| geometry.twist(&turned));
        wheels.t.windows(2).filter_map(step).collect::<Vec<_>>()
    });
    let (mut n, [mut ahead, mut beside, mut both]) = (0, [0.0; 3]);
    for twist in steps.filter(|twist| twist.vy != 0.0) {
        n += 1;
        ahead += twist.vy * twist.vy;
        beside += twist.vx * twist.vx;
        both += twist.vx * twist.vy;
    }
    let angle = (-both / ahead).atan();
    if n < FEWEST || angle.abs() < ASIDE || both * both < FOLLOWS * ahead * beside {
        return None;
    }
    let what = format!(
        "by odom_x and odom_y the robot goes {} rad beside its own heading, ahead and backwards, which its wheels cannot: \
         heading and place are not of one frame",
        short(angle)
    );
    let remedy = format!(
        "add {} to odom_theta (`offset` in a map), or log heading and place of the same odometry",
        short(angle)
    );
    Some(Mistake { nameable: true, ..Mistake::new("odometry-aside", "odom_theta", what, remedy) })
}
