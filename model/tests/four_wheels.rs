//! A four-wheel robot drives, localises itself and is calibrated by the same code.

use std::path::Path;

use model::calibration::estimate_skew;
use model::camera::CameraModel;
use model::localisation::Localiser;
use model::plant::{Contact, Creep};
use model::simulation::{VirtualRobot, calibration_drive, follow};
use model::trajectory::{FIG_6, Follower, FollowerOptions, Limits};
use runs::frames::Pose;
use runs::robot::{Layout, Robot};

fn robot() -> Robot {
    Robot::load(Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/robot-four-wheels.toml")).unwrap()
}

#[test]
fn it_follows_fig_6_on_odometry() {
    let robot = robot();
    let g = robot.geometry().unwrap();
    let camera = CameraModel::of(&robot);
    let mut v = VirtualRobot::new(&robot, Contact::Rolling, camera, Pose::default(), 1).unwrap();
    let limits = Limits { acceleration: 3.0, ..Limits::of(&robot).unwrap() };
    let mut follower = Follower::new(&FIG_6, Pose::default(), &g, limits, FollowerOptions::of(&robot).unwrap());
    let mut localiser = Localiser::odometry(&robot, &g, Pose::default());
    let followed = follow(&mut v, &FIG_6, &mut follower, &mut localiser, &g, 60.0, 0.05);
    let r = followed.report;
    assert!(r.time_s.is_some_and(|t| t < 17.0) && r.path_error_max_m < 0.1, "{r:#?}");
}

#[test]
fn its_four_skews_are_found() {
    let nominal = robot();
    let truth = [3.0, -4.0, 1.5, -2.0_f64];
    let mut actual = nominal.clone();
    if let Layout::Wheels(wheels) = &mut actual.layout {
        for (wheel, deg) in wheels.iter_mut().zip(truth) {
            wheel.drive_rad -= deg.to_radians();
        }
    }
    // Four wheels of unequal skew cannot roll without slip; a little creep lets them.
    let contact = Contact::Friction { friction_coefficient: 0.8, creep: Creep::at_rest(0.001) };
    let mut v = VirtualRobot::new(&actual, contact, CameraModel::of(&actual), Pose::default(), 2).unwrap();
    calibration_drive(&mut v, 0.8, 30.0, &nominal.geometry().unwrap());
    let e = estimate_skew(&nominal, &[v.into_log()]).unwrap();
    let got: Vec<f64> = e.skew_rad.iter().map(|s| s.to_degrees()).collect();
    println!("{got:.2?} {:?}", e.residual);
    assert!(e.identifiable, "{:?}", e.remarks);
    for i in 0..4 {
        for j in i + 1..4 {
            let off = (got[i] - got[j]) - (truth[i] - truth[j]);
            assert!(off.abs() < 0.5, "wheels {i} and {j} are {off} degrees off: {got:?}");
        }
    }
    let calibrated = e.apply(&nominal);
    assert!(calibrated.geometry().is_ok() && calibrated != nominal);
}
