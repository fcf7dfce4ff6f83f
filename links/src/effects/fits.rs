//! Which effects a robot can have at all.

use runs::robot::{Robot, Support};

/// What a differential drive has no wheels for: they have no rollers, and a wheel that is turned scrubs; both turned alike
/// are a turned marker plate.
const NOT_ON_ONE_AXLE: [&str; 5] = ["wheel-skew", "wheel-angle", "roller-friction", "roller-ripple", "sideways-creep"];
/// What is said of single wheels or their contact, which dead reckoning does not show. A common radius (the scale of the
/// way and of the turn), a body radius (the scale of the turn alone) and the scale of what moves sideways remain.
const NOT_BY_DEAD_RECKONING: [&str; 11] = [
    "wheel-skew",
    "wheel-radius",
    "wheel-angle",
    "encoder-scale",
    "encoder-loss",
    "encoder-lag",
    "wheel-creep",
    "wheel-slip",
    "wheel-order",
    "roller-ripple",
    "roller-friction",
];
/// What dead reckoning has, and counts of wheels have not: there the wheels have names of their own for it.
const ONLY_BY_DEAD_RECKONING: [&str; 2] = ["odometry-curl", "odometry-drift"];

/// What acts on the body, at the contact with the floor, or follows the way, none of which there is while the wheels are off
/// the floor.
const NOT_ON_BLOCKS: [&str; 14] = [
    "wheel-creep",
    "wheel-slip",
    "robot-mass",
    "yaw-inertia",
    "centre-of-mass",
    "floor-tilt",
    "body-drag",
    "turning-resistance",
    "carpet-grain",
    "roller-friction",
    "heading-drag",
    "probe-heading-friction",
    "probe-position-force",
    "probe-position-drag",
];

/// What hangs on an axis alone; the weight of a robot hangs on none of its wheels, and none of them turns a fan. Once a
/// turn a wheel on the floor has ripples of its own.
const ONLY_ON_BLOCKS: [&str; 5] =
    ["encoder-eccentricity", "gravity-load", "hanging-load", "joint-spring", "quadratic-drag"];

/// Whether a robot can have an effect.
pub fn fits(name: &str, robot: &Robot) -> bool {
    // Counts are what they are; what a firmware makes of them is in the speeds that it logs.
    if name == "speed-filter" && !runs::is_from_speeds(robot) {
        return false;
    }
    let elsewhere: &[&str] = if robot.support == Support::Blocks { &NOT_ON_BLOCKS } else { &ONLY_ON_BLOCKS };
    if elsewhere.contains(&name) {
        return false;
    }
    // On blocks it does what an inertia and frictions that are all as much larger do; where the file has no friction that
    // is the inertia alone.
    if name == "winding-resistance" && robot.support == Support::Blocks && robot.motor.friction_torque <= 0.0 {
        return false;
    }
    if runs::is_dead_reckoning(robot) {
        return !NOT_BY_DEAD_RECKONING.contains(&name);
    }
    if ONLY_BY_DEAD_RECKONING.contains(&name) {
        return false;
    }
    let differential = robot.geometry().is_ok_and(|g| g.is_differential());
    !(differential && NOT_ON_ONE_AXLE.contains(&name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_wheels_have_no_rollers_and_dead_reckoning_no_wheels() {
        let robot = Robot::racbot();
        let source = runs::Source { counts: runs::CountSource::Odometry, ..Default::default() };
        let reckoned = runs::as_logged(&robot, source, None);
        let mut axle = robot.layout.wheels()[..2].to_vec();
        for (wheel, x) in axle.iter_mut().zip([0.1, -0.1]) {
            (wheel.x_m, wheel.y_m, wheel.drive_rad) = (x, 0.0, std::f64::consts::FRAC_PI_2);
        }
        let two = Robot { layout: runs::robot::Layout::Wheels(axle), ..robot.clone() };
        let blocks = Robot { support: Support::Blocks, ..robot.clone() };
        assert!(NOT_ON_BLOCKS.iter().all(|name| fits(name, &robot) && !fits(name, &blocks)));
        assert!(ONLY_ON_BLOCKS.iter().all(|name| fits(name, &blocks) && !fits(name, &robot)));
        assert!(fits("coulomb-friction", &blocks) && fits("winding-resistance", &blocks));
        let mut smooth = blocks.clone();
        smooth.motor.friction_torque = 0.0;
        assert!(!fits("winding-resistance", &smooth));
        for (name, on) in [
            ("wheel-skew", [true, false, false]),
            ("wheel-radius", [true, true, false]),
            ("body-radius", [true, true, true]),
            ("camera-latency", [true, true, true]),
            ("sideways-creep", [true, false, true]),
            ("odometry-curl", [false, false, true]),
            ("odometry-drift", [false, false, true]),
            ("wheel-order", [true, true, false]),
        ] {
            assert_eq!([&robot, &two, &reckoned].map(|r| fits(name, r)), on, "{name}");
            assert!(crate::effects::find(name).is_some(), "{name}");
        }
    }
}
