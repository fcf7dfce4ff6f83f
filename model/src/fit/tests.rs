use super::*;
use crate::calibration::{KinematicModel, KinematicParameter as P};
use crate::camera::CameraModel;
use crate::plant::Contact;
use crate::simulation::{VirtualRobot, calibration_drive};
use runs::robot::Robot;

fn log(robot: &Robot, camera: CameraModel, seed: u64) -> Run {
    let mut v = VirtualRobot::new(robot, Contact::Rolling, camera, Pose::new(0.4, -0.2, 2.0), seed).unwrap();
    calibration_drive(&mut v, 0.8, 20.0, &Robot::racbot().geometry().unwrap());
    v.into_log()
}

fn fit_one(parameters: Vec<P>, run: Run) -> Fit {
    let model = KinematicModel::new(&Robot::racbot(), parameters);
    let n = model.names().len();
    fit(&model, &[run], &vec![0.0; n], &FitOptions::default()).unwrap()
}

fn camera() -> CameraModel {
    CameraModel::of(&Robot::racbot())
}

#[test]
fn every_kind_of_parameter_is_found_where_it_is() {
    let nominal = Robot::racbot();
    let mut larger = nominal.clone();
    larger.wheel_radius_m *= 1.01;
    let mut wider = nominal.clone();
    wider.layout = runs::robot::Layout::Rac { body_radius_m: 0.085 * 1.02, skew_rad: [0.0; 3] };
    let late = CameraModel { latency_s: 0.03, ..camera() };
    let table = [
        (P::WheelRadiusCommon, 0.01, log(&larger, camera(), 1)),
        (P::BodyRadius, 0.02, log(&wider, camera(), 2)),
        (P::CameraLatency, 0.03, log(&nominal, late, 3)),
    ];
    for (parameter, truth, run) in table {
        let f = fit_one(vec![parameter], run);
        let [low, high] = f.ci95(0);
        assert!(low < truth && truth < high, "{parameter:?}: {} in {low}..{high}", f.parameters[0]);
        assert!(high - low < 0.4 * truth && f.unknown.is_empty(), "{parameter:?}: {low}..{high}");
        assert!((f.residuals.reduced_chi2 - 1.0).abs() < 0.1);
    }
}

/// A camera that scales, shifts and turns what it sees: applied to a clean log.
fn seen_by(mut run: Run, change: impl Fn(Pose) -> Pose) -> Run {
    for sample in &mut run.camera {
        sample.pose = change(sample.pose);
    }
    run
}

#[test]
fn the_cameras_own_faults_are_found() {
    let clean = log(&Robot::racbot(), camera(), 4);
    let scaled = seen_by(clean.clone(), |p| Pose::new(1.015 * p.x, 1.015 * p.y, p.theta));
    let f = fit_one(vec![P::CameraScale], scaled);
    assert!((f.parameters[0] - 0.015).abs() < 0.001, "{}", f.parameters[0]);
    let offset = seen_by(clean.clone(), |p| p.compose(Pose::new(0.004, -0.006, 0.0)));
    let f = fit_one(vec![P::MarkerX, P::MarkerY], offset);
    assert!((f.parameters[0] - 0.004).abs() < 0.0008 && (f.parameters[1] + 0.006).abs() < 0.0008, "{:?}", f.parameters);
    let turned = seen_by(clean, |p| p.compose(Pose::new(0.0, 0.0, 0.03)));
    let f = fit_one(vec![P::MarkerHeading], turned);
    assert!((f.parameters[0] - 0.03).abs() < 0.002, "{}", f.parameters[0]);
}

#[test]
fn a_direction_that_changes_nothing_is_named_and_left_alone() {
    let f = fit_one((0..3).map(P::Skew).chain([P::MarkerHeading]).collect(), log(&Robot::racbot(), camera(), 5));
    assert_eq!(f.unknown.len(), 1);
    let d = &f.unknown[0].direction;
    // All skews clockwise and the marker counter-clockwise, or the other way round.
    for skew in &d[..3] {
        assert!((skew.abs() - 0.5).abs() < 0.02 && (skew + d[3]).abs() < 0.05, "{d:?}");
    }
    // Sums along the null direction are unknown, differences are not.
    assert!(f.half_width(&[1.0, 0.0, 0.0, 0.0]).to_degrees() > 10.0);
    assert!(f.half_width(&[1.0, -1.0, 0.0, 0.0]).to_degrees() < 0.3);
}

#[test]
fn without_frames_there_is_nothing_to_fit() {
    let model = KinematicModel::new(&Robot::racbot(), vec![P::BodyRadius]);
    let none = fit(&model, &[Run::default()], &[0.0], &FitOptions::default());
    assert_eq!(none.unwrap_err(), FitError::NoWindows);
    let run = log(&Robot::racbot(), camera(), 6);
    let lost = fit(&model, &[run], &[f64::NAN], &FitOptions::default());
    assert_eq!(lost.unwrap_err(), FitError::NotFinite);
}

#[test]
fn held_out_residuals_tell_a_right_model_from_a_wrong_one() {
    let model = KinematicModel::new(&Robot::racbot(), vec![P::BodyRadius]);
    let run = [log(&Robot::racbot(), camera(), 7)];
    let at = |value: f64| residuals(&model, &run, &[value], &FitOptions::default()).unwrap().reduced_chi2;
    assert!((at(0.0) - 1.0).abs() < 0.1 && at(0.1) > 1.5, "{} {}", at(0.0), at(0.1));
}
