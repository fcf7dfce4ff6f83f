//! Set points with a heading, driven by a robot with mass.

use model::camera::CameraModel;
use model::localisation::Localiser;
use model::plant::Contact;
use model::simulation::{VirtualRobot, follow};
use model::trajectory::{Follower, FollowerOptions, Limits, SetPoint};
use runs::frames::{Pose, wrap_angle};
use runs::robot::Robot;
use std::f64::consts::PI;

#[test]
fn a_heading_is_turned_to_the_short_way_without_overshoot() {
    let robot = Robot::racbot();
    let geometry = robot.geometry().unwrap();
    // Start, place, heading, and the way round, rad.
    let table = [
        (Pose::new(0.0, 0.0, 0.5), [0.0, 0.0], 0.5 + 1.2, 1.2),
        (Pose::new(1.0, 2.0, 3.0), [1.0, 2.0], -3.0, 2.0 * PI - 6.0),
        (Pose::new(0.0, 0.0, 0.0), [0.0, 0.0], -2.9, -2.9),
        (Pose::new(0.0, 0.0, 0.2), [0.8, 0.3], -0.4, -0.6),
        (Pose::new(0.0, 0.0, 0.2), [0.8, 0.3], 0.2, 0.0),
    ];
    for (start, [x, y], heading, way) in table {
        let points = [SetPoint::facing(x, y, 0.8, 2.0, heading)];
        let mut driven = VirtualRobot::new(&robot, Contact::Rolling, CameraModel::of(&robot), start, 1).unwrap();
        let (limits, options) = (Limits::of(&robot).unwrap(), FollowerOptions::of(&robot).unwrap());
        let mut follower = Follower::new(&points, start, &geometry, limits, options);
        let mut localiser = Localiser::odometry(&robot, &geometry, start);
        let followed = follow(&mut driven, &points, &mut follower, &mut localiser, &geometry, 10.0, 0.02);
        assert!(followed.report.time_s.is_some(), "{heading}: {:#?}", followed.report);
        let end = followed.track.last().unwrap().1;
        assert!((end.x - x).hypot(end.y - y) < 0.02 && wrap_angle(end.theta - heading).abs() < 0.03, "{end:?}");
        let turned = |pose: &Pose| wrap_angle(pose.theta - start.theta) * if way < 0.0 { -1.0 } else { 1.0 };
        let farthest = followed.track.iter().map(|(_, pose)| turned(pose)).fold(0.0, f64::max);
        assert!(farthest < way.abs() + 0.03, "{heading}: {farthest} of {way}");
    }
}
