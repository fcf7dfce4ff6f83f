use super::*;
use crate::camera::CameraModel;
use crate::effects::Applied;
use crate::manoeuvre::{Manoeuvre, simulate};
use crate::plant::Contact;
use crate::simulation::{VirtualRobot, calibration_drive};
use runs::DataSet;
use runs::frames::{Pose, Twist};
use std::path::Path;

/// Ticks between two readings of an encoder, a tenth of a second.
const READ_EVERY: usize = 100;

fn skewed(deg: [f64; 3]) -> Robot {
    let skew_rad = deg.map(f64::to_radians);
    Robot { layout: Layout::Rac { body_radius_m: 0.085, skew_rad }, ..Robot::racbot() }
}

fn virtual_robot(robot: &Robot, seed: u64) -> VirtualRobot {
    VirtualRobot::new(robot, Contact::Rolling, CameraModel::of(robot), Pose::default(), seed).unwrap()
}

/// 30 s of calibration driving by a controller that believes in no skew.
fn log(deg: [f64; 3], seed: u64) -> Run {
    let mut robot = virtual_robot(&skewed(deg), seed);
    calibration_drive(&mut robot, 0.8, 30.0, &Robot::racbot().geometry().unwrap());
    robot.into_log()
}

fn degrees(e: &SkewEstimate) -> Vec<f64> {
    e.skew_rad.iter().map(|s| s.to_degrees()).collect()
}

#[test]
fn the_measured_set_gives_its_true_skews() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/runs/wheel-skew");
    let set = DataSet::open(folder).unwrap();
    let e = estimate_skew(&set.robot, &set.runs).unwrap();
    let (truth, got) = ([4.0, -3.0, 2.0_f64], degrees(&e));
    for (i, j, half) in &e.differences {
        let off = (got[*i] - got[*j]) - (truth[*i] - truth[*j]);
        assert!(off.abs() < 0.1, "wheels {i} and {j}: {off} degrees off; {:?} {:?}", e.parts, e.residual);
        assert!(half.to_degrees() < 0.2 && off.abs() < half.to_degrees());
    }
    for (truth, ci) in truth.iter().zip(&e.ci95) {
        assert!(ci[0] < truth.to_radians() && truth.to_radians() < ci[1]);
    }
    assert!(e.identifiable && !e.common_identifiable);
    assert!(e.residual.before[2] > 2.0 * e.residual.after[2]);
    assert!((e.residual.reduced_chi2 - 1.0).abs() < 0.1, "{:?}", e.residual);
    // 0.5° and 1.5 mm, found without being told.
    assert!((e.residual.noise[2].to_degrees() / 0.5 - 1.0).abs() < 0.1);
    assert!((e.residual.noise[0] / 0.0015 - 1.0).abs() < 0.1);
    assert!(e.latency_s.value.abs() < 0.0005);
    assert_eq!(e.remarks.len(), 1, "{:?}", e.remarks);
    assert!(e.remarks[0].contains("marker plate"));
}

#[test]
fn differences_are_found_to_a_tenth_of_a_degree_in_thirty_seconds() {
    let truths = [[4.0, -3.0, 2.0], [-8.0, 8.0, 5.0], [0.0, 0.0, 0.0], [7.0, 6.0, -8.0], [1.0, -1.0, 0.5]];
    let mut errors = Vec::new();
    let mut covered = 0;
    for (k, truth) in truths.iter().enumerate() {
        for seed in 0..4 {
            let e = estimate_skew(&Robot::racbot(), &[log(*truth, 10 * k as u64 + seed)]).unwrap();
            let got = degrees(&e);
            for (i, j, half) in &e.differences {
                let off = ((got[*i] - got[*j]) - (truth[*i] - truth[*j])).abs();
                covered += usize::from(off < half.to_degrees());
                errors.push(off);
            }
        }
    }
    errors.sort_by(f64::total_cmp);
    let at95 = errors[errors.len() * 95 / 100];
    assert!(at95 < 0.1, "95 % of the differences are within {at95} degrees");
    assert!(covered * 100 >= errors.len() * 88, "{covered} of {} intervals hold the truth", errors.len());
}

/// A square without turns shows neither the lever nor a marker's place: what they would have to be there is no robot's, and the
/// skews are found all the same. They were given up at the first such size, and all said to be zero.
#[test]
fn sizes_that_a_manoeuvre_does_not_show_hide_no_skews() {
    for (truth, count) in [([5.0, 0.0, -2.0], 1), ([6.0, -4.0, 1.0], 1), ([6.0, -4.0, 1.0], 4), ([3.0, 1.0, -2.0], 4)] {
        let run = |k: u32| {
            let start = Pose { theta: 2.4 * f64::from(k), ..Pose::default() };
            let actual = Applied::of(&skewed(truth));
            simulate(Manoeuvre::Square, &actual, &Robot::racbot(), start, u64::from(k) + 1).unwrap()
        };
        let e = estimate_skew(&Robot::racbot(), &(0..count).map(run).collect::<Vec<_>>()).unwrap();
        let got = degrees(&e);
        for (i, j, half) in &e.differences {
            let off = (got[*i] - got[*j]) - (truth[*i] - truth[*j]);
            assert!(
                off.abs() < 1.5 * half.to_degrees() && half.to_degrees() < 0.5,
                "{truth:?}: {got:?}, {:?}",
                e.parts
            );
        }
        assert!(e.residual.reduced_chi2 < 1.3, "{truth:?}: {:?} {:?}", e.residual, e.remarks);
    }
}

#[test]
fn a_common_skew_is_a_turned_marker() {
    // No drive tells the two apart; one angle says it, three are not needed.
    let e = estimate_skew(&Robot::racbot(), &[log([2.0; 3], 3)]).unwrap();
    assert!(e.identifiable && !e.common_identifiable && e.common_half_width.to_degrees() > 1.0);
    let heading = e.sizes.marker_heading.expect("a turned plate").value.to_degrees();
    assert!((heading - 2.0).abs() < 0.15, "{heading}");
    assert!(e.remarks.iter().any(|r| r.contains("every wheel is turned by it clockwise")), "{:?}", e.remarks);
    let json = e.to_json();
    assert_eq!(json["common_identifiable"], false);
    assert_eq!(json["skew_rad"].as_array().unwrap().len(), 3);
    assert!(json["residual"]["after"][2].as_f64().unwrap() > 0.0);
}

#[test]
fn an_unknown_latency_does_not_pass_for_skew() {
    let robot = skewed([4.0, -3.0, 2.0]);
    let camera = CameraModel { latency_s: 0.05, ..CameraModel::of(&robot) };
    let mut v = VirtualRobot::new(&robot, Contact::Rolling, camera, Pose::default(), 8).unwrap();
    calibration_drive(&mut v, 0.8, 30.0, &Robot::racbot().geometry().unwrap());
    let run = v.into_log();
    let e = estimate_skew(&Robot::racbot(), std::slice::from_ref(&run)).unwrap();
    assert!((e.latency_s.value - 0.05).abs() < 0.001, "{:?}", e.latency_s);
    assert!((degrees(&e)[0] - 4.0).abs() < 0.15);
    assert!(
        e.remarks.iter().any(|r| r.contains("ms later") && r.contains("add it to camera_latency_s")),
        "{:?}",
        e.remarks
    );
    let slow = Robot { camera_latency_s: 0.1, ..Robot::racbot() };
    let e = estimate_skew(&slow, &[run]).unwrap();
    assert!(
        e.remarks.iter().any(|r| r.contains("50.") && r.contains("ms earlier") && r.contains("take it off")),
        "{:?}",
        e.remarks
    );
}

#[test]
fn outliers_do_not_matter() {
    let robot = skewed([4.0, -3.0, 2.0]);
    let camera = CameraModel { outlier_share: 0.05, drop_share: 0.1, ..CameraModel::of(&robot) };
    let mut v = VirtualRobot::new(&robot, Contact::Rolling, camera, Pose::default(), 9).unwrap();
    calibration_drive(&mut v, 0.8, 30.0, &Robot::racbot().geometry().unwrap());
    let e = estimate_skew(&Robot::racbot(), &[v.into_log()]).unwrap();
    for (got, truth) in degrees(&e).iter().zip([4.0, -3.0, 2.0]) {
        assert!((got - truth).abs() < 0.2, "{got}");
    }
    assert!(e.residual.outliers > 40, "{}", e.residual.outliers);
}

#[test]
fn what_logs_cannot_tell_is_said_in_words() {
    let nominal = Robot::racbot();
    let g = nominal.geometry().unwrap();
    let estimate = |run: Run| estimate_skew(&nominal, &[run]).unwrap();
    let remark = |e: &SkewEstimate| e.remarks.join("\n");

    let blind = Run { camera: Vec::new(), ..log([4.0, -3.0, 2.0], 1) };
    let e = estimate(blind);
    assert!(!e.identifiable && remark(&e).contains("no camera poses"), "{}", remark(&e));
    assert_eq!(e.skew_rad, [0.0; 3]);

    let deaf = Run { counts: Vec::new(), ..log([4.0, -3.0, 2.0], 1) };
    assert!(remark(&estimate(deaf)).contains("no encoder counts"));

    let mut still = virtual_robot(&skewed([4.0, -3.0, 2.0]), 1);
    still.drive(Twist::default(), 5.0, &g);
    let e = estimate(still.into_log());
    assert!(!e.identifiable && remark(&e).contains("stands still"), "{}", remark(&e));

    let mut turning = virtual_robot(&skewed([4.0, -3.0, 2.0]), 1);
    turning.drive(Twist::new(0.0, 0.0, 2.0), 10.0, &g);
    let e = estimate(turning.into_log());
    assert!(!e.identifiable && remark(&e).contains("beside turning"), "{}", remark(&e));
    assert!(remark(&e).contains("Driving straight"), "{}", remark(&e));

    // Sideways, the front wheel rolls along its own direction and says nothing about its skew.
    let mut sideways = virtual_robot(&nominal, 1);
    for _ in 0..3 {
        sideways.drive(Twist::new(0.6, 0.0, 0.0), 2.0, &g);
        sideways.drive(Twist::new(-0.6, 0.0, 0.0), 2.0, &g);
    }
    let e = estimate(sideways.into_log());
    assert!(!e.identifiable && remark(&e).contains("only drives along its sideways direction"), "{}", remark(&e));
    assert!(remark(&e).contains("along its forward direction would help most"), "{}", remark(&e));
}

#[test]
fn a_wrong_radius_is_called_a_radius() {
    // Wheels 7.5 % smaller than the file says.
    let truth = Robot { wheel_radius_m: 0.925 * Robot::racbot().wheel_radius_m, ..Robot::racbot() };
    let mut robot = virtual_robot(&truth, 5);
    calibration_drive(&mut robot, 0.8, 30.0, &Robot::racbot().geometry().unwrap());
    let e = estimate_skew(&Robot::racbot(), &[robot.into_log()]).unwrap();
    let radius = e.sizes.wheel_radius.expect("a radius explains it");
    assert!((radius.value + 0.075).abs() < 0.004 && !e.parts.contains(&Part::Skews), "{:?}", e.sizes);
    assert!(e.skew_rad.iter().all(|s| *s == 0.0), "{:?}", e.skew_rad);
    assert!(e.remarks.iter().any(|r| r.contains("a radius, not a skew")), "{:?}", e.remarks);
    assert!((e.apply(&Robot::racbot()).wheel_radius_m / truth.wheel_radius_m - 1.0).abs() < 0.004);
}

#[test]
fn few_windows_prove_neither_a_radius_nor_a_skew() {
    let said = |seconds: f64| {
        let truth = Robot { wheel_radius_m: 0.925 * Robot::racbot().wheel_radius_m, ..Robot::racbot() };
        let mut robot = virtual_robot(&truth, 5);
        calibration_drive(&mut robot, 0.8, seconds, &Robot::racbot().geometry().unwrap());
        let e = estimate_skew(&Robot::racbot(), &[robot.into_log()]).unwrap();
        (e.remarks.iter().any(|r| r.contains("is not proven")), e.remarks)
    };
    for (seconds, wanted) in [(5.0, true), (30.0, false)] {
        let (unproven, remarks) = said(seconds);
        assert_eq!(unproven, wanted, "{seconds} s: {remarks:?}");
    }
}

#[test]
fn one_small_wheel_is_one_small_wheel() {
    let mut robot = virtual_robot(&Robot::racbot(), 11);
    calibration_drive(&mut robot, 0.8, 30.0, &Robot::racbot().geometry().unwrap());
    let mut run = robot.into_log();
    // A wheel of 97 % of the radius turns further for the same way.
    run.counts[1].iter_mut().for_each(|c| *c = (*c as f64 / 0.97).round() as i64);
    let e = estimate_skew(&Robot::racbot(), &[run]).unwrap();
    assert_eq!(e.sizes.wheel_radii.len(), 3, "{:?} {:?}", e.parts, e.remarks);
    for (radius, truth) in e.sizes.wheel_radii.iter().zip([0.0, -0.03, 0.0]) {
        assert!(radius.ci95[0] - 5e-4 < truth && truth < radius.ci95[1] + 5e-4, "{:?}", e.sizes.wheel_radii);
    }
    let written = e.apply(&Robot::racbot());
    assert_eq!(written.effects[0].name, "wheel-radius");
}

#[test]
fn clocks_that_differ_from_run_to_run_are_no_latency() {
    let mut runs: Vec<Run> = (0..4).map(|seed| log([4.0, -3.0, 2.0], 20 + seed)).collect();
    for (run, late_s) in runs.iter_mut().zip([0.06, -0.05, 0.02, -0.04]) {
        let ticks = (late_s / 1e-3) as i64;
        run.camera.retain(|s| (0..run.t.len() as i64).contains(&(s.tick as i64 + ticks)));
        run.camera.iter_mut().for_each(|s| s.tick = (s.tick as i64 + ticks) as usize);
    }
    let e = estimate_skew(&Robot::racbot(), &runs).unwrap();
    let clocks: Vec<f64> = e.sizes.clocks_s.iter().map(|c| c.value).collect();
    assert_eq!(clocks.len(), 4, "{:?}", e.parts);
    for (got, truth) in clocks.iter().zip([0.06, -0.05, 0.02, -0.04]) {
        assert!((got - truth).abs() < 0.002, "{clocks:?}");
    }
    assert!(!e.latency_s.is_certain(), "{:?}", e.latency_s);
    assert_eq!(e.apply(&Robot::racbot()).camera_latency_s, Robot::racbot().camera_latency_s);
    assert!((degrees(&e)[0] - degrees(&e)[1] - 7.0).abs() < 0.1, "{:?} {:?}", e.fitted, e.residual);
}

#[test]
fn what_no_robot_does_is_refused() {
    // The encoders of two wheels crossed.
    let mut crossed = log([0.0; 3], 6);
    crossed.counts.swap(0, 1);
    let e = estimate_skew(&Robot::racbot(), &[crossed]).unwrap();
    assert!(e.remarks[0].starts_with("No estimate"), "{:?} {:?}", e.remarks, degrees(&e));
    assert!(degrees(&e).iter().all(|s| s.abs() < 45.0));
}

/// Motion capture scatters by hundredths of a millimetre, and wheels never roll as exactly: they are told nevertheless.
#[test]
fn a_camera_finer_than_wheels_roll_tells_skews() {
    let actual = skewed([4.0, -3.0, 2.0]);
    let camera = CameraModel { noise: [2e-5, 2e-5, 5e-5], ..CameraModel::of(&actual) };
    let mut robot = VirtualRobot::new(&actual, Contact::Rolling, camera, Pose::default(), 7).unwrap();
    calibration_drive(&mut robot, 0.8, 30.0, &Robot::racbot().geometry().unwrap());
    let mut run = robot.into_log();
    for (wheel, counts) in run.counts.iter_mut().enumerate() {
        let rolled: Vec<i64> = counts.windows(2).map(|c| c[1] - c[0]).collect();
        let mut sum = counts[0] as f64;
        for (k, step) in rolled.into_iter().enumerate() {
            let slips =
                0.05 * (run.t[k] * (9.0 + wheel as f64)).sin() + 0.05 * (run.t[k] * (2.3 + 0.4 * wheel as f64)).sin();
            sum += step as f64 * (1.0 + slips);
            counts[k + 1] = sum.round() as i64;
        }
    }
    let e = estimate_skew(&Robot::racbot(), &[run]).unwrap();
    assert!(
        !e.is_none() && e.remarks.iter().any(|r| r.contains("finer than wheels roll")),
        "{:?} {:?}",
        e.remarks,
        e.residual
    );
    let got = degrees(&e);
    for (i, j, half) in &e.differences {
        let off = (got[*i] - got[*j]) - ([4.0, -3.0, 2.0][*i] - [4.0, -3.0, 2.0][*j]);
        assert!(off.abs() < half.to_degrees() + 0.5, "{got:?} {half}");
    }
}

/// A marker farther out than the wheels of a tall robot, which has its axle at one end.
#[test]
fn a_marker_beyond_the_wheels_is_found() {
    let mut run = log([0.0; 3], 9);
    for Pose { x, y, theta } in run.camera.iter_mut().map(|sample| &mut sample.pose) {
        (*x, *y) = (*x + 0.13 * theta.cos(), *y + 0.13 * theta.sin());
    }
    let e = estimate_skew(&Robot::racbot(), &[run]).unwrap();
    let [x, y] = e.sizes.marker_m.expect("a place of the marker");
    assert!((x.value - 0.13).abs() < 0.002 && y.value.abs() < 0.002, "{x:?} {y:?} {:?}", e.residual);
}

#[test]
fn the_estimate_applied_is_the_robot_that_drove() {
    let truth = [4.0, -3.0, 2.0];
    let e = estimate_skew(&Robot::racbot(), &[log(truth, 2)]).unwrap();
    let again = estimate_skew(&e.apply(&Robot::racbot()), &[log(truth, 2)]).unwrap();
    for (a, b) in e.skew_rad.iter().zip(&again.skew_rad) {
        assert!((a - b).abs() < 1e-4, "{a} {b}");
    }
}

/// Wheels read ten times a second beside a camera with rows of its own: between two readings a wheel turns on, it does not
/// wait for the next. With counts held 12.7 mm were left, eight times the camera's noise.
#[test]
fn wheels_that_were_read_seldom_turn_between_readings() {
    let mut run = log([0.0; 3], 4);
    for (counts, gaps) in run.counts.iter_mut().zip(&mut run.count_gaps) {
        let mut last = counts[0];
        for (tick, count) in counts.iter_mut().enumerate() {
            if tick % READ_EVERY == 0 {
                last = *count;
            } else {
                *count = last;
                gaps.push(tick);
            }
        }
    }
    let larger = Robot { wheel_radius_m: Robot::racbot().wheel_radius_m / 1.05, ..Robot::racbot() };
    let e = estimate_skew(&larger, &[run]).unwrap();
    let radius = e.sizes.wheel_radius.expect("a radius").value;
    assert!((radius - 0.05).abs() < 0.003, "{radius}");
    assert!(e.latency_s.value.abs() < 0.005 && e.residual.reduced_chi2 < 1.2, "{:?} {:?}", e.latency_s, e.residual);
}

/// A camera of one frame a second, beside a robot that drives for minutes.
#[test]
fn few_frames_a_second_are_enough() {
    let run = |seed: u64| {
        let mut run = log([4.0, -3.0, 2.0], seed);
        let every = (1.0 / (run.t[run.camera[1].tick] - run.t[run.camera[0].tick])).round() as usize;
        run.camera = run.camera.into_iter().step_by(every).collect();
        run
    };
    let runs: Vec<Run> = (1..=6).map(run).collect();
    let e = estimate_skew(&Robot::racbot(), &runs).unwrap();
    let got = degrees(&e);
    for (i, j, half) in &e.differences {
        let off = (got[*i] - got[*j]) - ([4.0, -3.0, 2.0][*i] - [4.0, -3.0, 2.0][*j]);
        assert!(off.abs() < half.to_degrees() && half.to_degrees() < 2.0, "{got:?} {half} {:?}", e.remarks);
    }
}
