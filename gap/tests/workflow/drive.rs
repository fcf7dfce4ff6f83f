//! The drive link by itself.

use super::common::{simulate, with};
use gap::drive::{DriveLink, DriveModel};
use gap::pieces::{PIECE, segments};
use gap::statistics::rms;
use model::manoeuvre::Manoeuvre;
use runs::Logs;
use runs::robot::Robot;

/// Unexplained torque of all wheels, Nm RMS, where the model knows the skews in rad.
fn unexplained(skew_rad: [f64; 3]) -> f64 {
    let names = ["skew_1_rad", "skew_2_rad", "skew_3_rad"];
    let parameters: Vec<(&str, f64)> = names.into_iter().zip(skew_rad).collect();
    let set = simulate(&with(&Robot::racbot(), "wheel-skew", &parameters), &[Manoeuvre::Chirp], 7);
    let set = Logs::from(&set);
    let pieces = segments(&set.robot, &set.robot.geometry().unwrap(), &set.logs, PIECE);
    let mut model = DriveModel::new(&set.robot);
    model.wheels.iter_mut().zip(skew_rad).for_each(|(wheel, skew)| wheel.drive_rad -= skew);
    let residuals = DriveLink::new(&pieces, &model).unwrap().residuals(&model).unwrap();
    let counted = residuals.torque.iter().flatten().zip(residuals.weights.iter().flatten());
    rms(counted.filter(|(_, weight)| **weight > 0.0).map(|(torque, _)| *torque))
}

#[test]
fn skews_that_are_known_leave_nothing_in_the_drive() {
    let (straight, skewed) = (unexplained([0.0; 3]), unexplained([0.14, -0.1, 0.07]));
    assert!(skewed < 1.3 * straight, "{skewed} Nm with skews that the model knows, {straight} without any");
}
