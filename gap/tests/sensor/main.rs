//! The links to an inertial sensor: its effects named, twins of the wheels and the camera parted, and a log without a
//! sensor judged as if there were no such links.

#[allow(dead_code, reason = "shared with the bench of detection limits")]
mod felt;

use felt::{Hidden, blind, done, effects, estimate, names, numb, sensor, set, truth};
use gap::{Analysis, Verdict, undo};
use links::effect::Link;
use model::manoeuvre::Manoeuvre::{Chirp, Spin, StopAndGo};
use rand::{RngExt, SeedableRng};
use runs::DataSet;
use runs::robot::Robot;

fn holds(a: &Analysis, parameter: &str, truth: f64) {
    let (found, [low, high]) = estimate(a, parameter);
    assert!((low..=high).contains(&truth), "{parameter}: {found} ({low} to {high}), true {truth}");
}

fn link(a: &Analysis, link: Link) -> [f64; 2] {
    a.links.iter().find(|l| l.link == link).map_or([f64::NAN; 2], |l| [l.before, l.after])
}

#[test]
fn a_scale_is_named_written_read_again_and_undone() {
    let hidden = truth(&[("gyro-scale", &[("scale", -0.04)])], 3);
    let data = set(&hidden, &[Spin, Chirp], 3);
    let a = done(&data);
    assert_eq!((a.verdict, names(&a)), (Verdict::MissingEffect, vec!["gyro-scale"]), "{}", a.terminal_summary());
    holds(&a, "scale", sensor(&hidden).gyro_errors()[0][2]);
    let [before, after] = link(&a, Link::Gyroscope);
    assert!(before > 1.8 && after < 1.3, "{before} {after}");
    assert_eq!(a.effects[0].link, Link::Gyroscope);

    let folder = tempfile::tempdir().unwrap();
    a.write(folder.path()).unwrap();
    let robot = Robot::load(folder.path().join("robot.toml")).unwrap();
    let again = done(&DataSet { robot: robot.clone(), ..data });
    assert_eq!((again.verdict, names(&again)), (Verdict::Agrees, vec![]), "{}", again.terminal_summary());
    let [now, _] = link(&again, Link::Gyroscope);
    assert!((now - after).abs() < 1e-9, "{now} {after}");
    assert_eq!(undo(&robot, "gyro-scale").unwrap().effects, []);
    assert!(a.terminal_summary().contains("gyroscope") && a.html().contains("gyro"));
}

#[test]
fn a_bias_is_named() {
    let hidden = truth(&[("gyro-bias", &[("x_rad_s", 0.05), ("z_rad_s", -0.06)])], 4);
    let a = done(&set(&hidden, &[Spin, Chirp], 4));
    assert_eq!((a.verdict, names(&a)), (Verdict::MissingEffect, vec!["gyro-bias"]), "{}", a.terminal_summary());
    let bias = sensor(&hidden).gyro_errors()[1];
    holds(&a, "x_rad_s", bias[0]);
    holds(&a, "z_rad_s", bias[2]);
}

#[test]
fn late_readings_are_named() {
    let a = done(&set(&truth(&[("imu-latency", &[("latency_s", 0.012)])], 5), &[Spin, Chirp], 5));
    assert_eq!((a.verdict, names(&a)), (Verdict::MissingEffect, vec!["imu-latency"]), "{}", a.terminal_summary());
    holds(&a, "latency_s", 0.012);
}

/// Rows 20 ms apart without camera, duties and accelerometer, whose counts were read up to half a row early or late.
fn at_50_hz(mut data: DataSet, seed: u64) -> DataSet {
    const ROWS: usize = 20;
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
    data.robot.control_rate_hz /= ROWS as f64;
    for run in &mut data.runs {
        let rows: Vec<usize> = (ROWS..run.t.len() - ROWS).step_by(ROWS).collect();
        let read: Vec<usize> = rows.iter().map(|k| k - ROWS / 2 + rng.random_range(0..ROWS)).collect();
        let at = |column: &Vec<f64>, ticks: &[usize]| ticks.iter().map(|k| column[*k]).collect::<Vec<f64>>();
        for counts in &mut run.counts {
            *counts = read.iter().map(|k| counts[*k]).collect();
        }
        run.gyro = run.gyro.as_ref().map(|axes| [0, 1, 2].map(|i| at(&axes[i], &rows)));
        run.t = at(&run.t, &rows);
        (run.command, run.supply_v, run.acceleration, run.imu_temp) = (None, None, None, None);
        for columns in [&mut run.reference, &mut run.duty, &mut run.measured] {
            columns.clear();
        }
    }
    data
}

#[test]
fn readings_older_than_a_rate_lasts_are_named_with_their_age() {
    for (seed, latency) in [(21, 0.07), (22, 0.09)] {
        let hidden = truth(&[("imu-latency", &[("latency_s", latency)])], seed);
        let a = done(&at_50_hz(blind(set(&hidden, &[StopAndGo, Chirp], seed)), seed));
        assert_eq!((a.verdict, names(&a)), (Verdict::MissingEffect, vec!["imu-latency"]), "{}", a.terminal_summary());
        holds(&a, "latency_s", latency);
    }
}

#[test]
fn a_turned_sensor_elsewhere_is_named_with_angles_and_place() {
    let mount = [("x_rad", 0.06), ("y_rad", -0.05), ("z_rad", -0.06), ("x_m", 0.02), ("y_m", -0.015)];
    let hidden = truth(&[("imu-mount", &mount)], 7);
    let a = done(&set(&hidden, &[Spin, Chirp], 7));
    assert_eq!((a.verdict, names(&a)), (Verdict::MissingEffect, vec!["imu-mount"]), "{}", a.terminal_summary());
    let sensor = sensor(&hidden);
    let [_, _, turned] = sensor.gyro_errors();
    holds(&a, "x_rad", turned[0]);
    holds(&a, "y_rad", turned[1]);
    holds(&a, "z_rad", sensor.accelerometer_turn()[2]);
    holds(&a, "x_m", 0.02);
    holds(&a, "y_m", -0.015);
    let [before, after] = link(&a, Link::Accelerometer);
    assert!(before > 4.0 && after < 1.3, "{before} {after}");
}

#[test]
fn old_counts_are_told_from_old_frames() {
    let data = set(&truth(&[("encoder-lag", &[("latency_s", 0.02)])], 8), &[Spin, Chirp], 8);
    let without = done(&numb(data.clone()));
    assert_eq!(without.verdict, Verdict::Ambiguous, "{}", without.terminal_summary());
    assert!(
        without.alternatives.iter().any(|s| s.contains(&"camera-latency".to_owned())),
        "{:?}",
        without.alternatives
    );
    let with = done(&data);
    assert_eq!(
        (with.verdict, names(&with)),
        (Verdict::MissingEffect, vec!["encoder-lag"]),
        "{}",
        with.terminal_summary()
    );
    assert_eq!(with.alternatives, Vec::<Vec<String>>::new());
    holds(&with, "latency_s", 0.02);
}

#[test]
fn without_a_camera_the_gyroscope_tells_the_body_radius() {
    let data = blind(set(&truth(&[("body-radius", &[("scale", 0.04)])], 9), &[Spin, Chirp], 9));
    let with = done(&data);
    // Larger wheels turn it less, too; that they also drive it further, no camera tells.
    assert_eq!(with.verdict, Verdict::Ambiguous, "{}", with.terminal_summary());
    assert_eq!(names(&with)[0], "body-radius", "{}", with.terminal_summary());
    assert!(with.alternatives.iter().any(|s| s.contains(&"wheel-radius-common".to_owned())), "{:?}", with.alternatives);
    let without = done(&numb(data));
    assert_eq!(names(&without), Vec::<&str>::new(), "{}", without.terminal_summary());
}

#[test]
fn a_tilted_floor_is_felt() {
    let hidden = truth(&[("floor-tilt", &[("x_rad", 0.02), ("y_rad", -0.014)])], 14);
    let data = set(&hidden, &[Spin, Chirp], 14);
    let told = |a: &Analysis| {
        assert_eq!((a.verdict, names(a)), (Verdict::MissingEffect, vec!["floor-tilt"]), "{}", a.terminal_summary());
        holds(a, "x_rad", 0.02);
        holds(a, "y_rad", -0.014);
        let [before, after] = link(a, Link::Accelerometer);
        assert!(before > 1.5 && after < 1.3, "{before} {after}");
    };
    told(&done(&data));
    // Wheels and camera say nothing of it, the motors' duties do; the sensor does without either.
    let mut without_duties = data;
    without_duties.runs.iter_mut().for_each(|run| run.duty.clear());
    assert_eq!(names(&done(&numb(without_duties.clone()))), Vec::<&str>::new());
    told(&done(&without_duties));
}

/// Where wheels slip they tell nothing of what the motors move; the sensor does.
#[test]
fn on_a_slippery_floor_the_sensor_tells_the_mass() {
    const SLIP: Hidden = ("wheel-slip", &[("friction_coefficient", 0.3)]);
    const HEAVY: Hidden = ("robot-mass", &[("scale", 0.2)]);
    let drives = [Spin, Chirp, StopAndGo];
    let limit = |a: &Analysis| {
        assert_eq!(names(a), ["wheel-slip"], "{}", a.terminal_summary());
        a.limits.iter().find(|l| l.name == "robot-mass").map_or(f64::INFINITY, |l| l.limit)
    };
    let light = set(&truth(&[SLIP], 15), &drives, 15);
    let [with, without] = [limit(&done(&light)), limit(&done(&numb(light)))];
    assert!(with < 0.12 && with < 0.6 * without, "{with} {without}");
    // Readings of a known age tell it, too.
    for late in [&[][..], &[("imu-latency", &[("latency_s", 0.03)][..])]] {
        let mut data = set(&truth(&[&[SLIP, HEAVY], late].concat(), 16), &drives, 16);
        data.robot.effects = effects(late);
        let heavy = done(&data);
        assert!(names(&heavy).contains(&"robot-mass"), "{}", heavy.terminal_summary());
        holds(&heavy, "scale", 0.2);
    }
}

#[test]
fn parts_within_their_tolerances_are_not_named() {
    for part in [11, 12] {
        let a = done(&set(&truth(&[], part), &[Spin, Chirp], part));
        assert_eq!((a.verdict, names(&a)), (Verdict::Agrees, vec![]), "{part}: {}", a.terminal_summary());
        assert!(a.limits.iter().any(|l| l.name == "gyro-scale") && a.tried.contains(&"imu-mount".to_owned()));
    }
}

#[test]
fn a_slow_sensor_with_holes_a_narrow_range_and_a_walking_bias_names_what_is_there_alone() {
    let spoil = |mut data: DataSet| {
        for run in &mut data.runs {
            let n = run.t.len();
            for axis in run.gyro.iter_mut().flatten() {
                // A narrow range, a bias that walks, and a bus that is silent for 0.2 s of every 2 s.
                for (k, (x, t)) in axis.iter_mut().zip(&run.t).enumerate() {
                    let walked = 2e-3 * t / run.t[n - 1];
                    *x = if k % 2000 < 200 { f64::NAN } else { (*x + walked).clamp(-4.0, 4.0) };
                }
            }
            for axis in run.gyro.iter_mut().chain(&mut run.acceleration).flatten() {
                for k in 0..n {
                    // Read at 125 Hz, held between.
                    axis[k] = axis[k - k % 8];
                }
            }
        }
        data
    };
    let clean = done(&spoil(set(&truth(&[], 13), &[Spin, Chirp], 13)));
    assert_eq!(names(&clean), Vec::<&str>::new(), "{}", clean.terminal_summary());
    let hidden = truth(&[("gyro-scale", &[("scale", 0.06)])], 13);
    let a = done(&spoil(set(&hidden, &[Spin, Chirp], 13)));
    assert_eq!(names(&a), ["gyro-scale"], "{}", a.terminal_summary());
    holds(&a, "scale", sensor(&hidden).gyro_errors()[0][2]);
}

#[test]
fn a_log_without_a_sensor_is_judged_as_if_there_were_no_such_link() {
    let data = numb(set(&truth(&[("wheel-skew", &[("skew_1_rad", 0.06)])], 1), &[Spin, Chirp], 1));
    let of = |robot: Robot| {
        let a = done(&DataSet { robot, ..data.clone() });
        (a.to_json().to_string(), a.terminal_summary())
    };
    let (json, text) = of(felt::robot());
    let (plain, plainly) = of(Robot::racbot());
    assert!(json == plain && text == plainly);
    assert!(!json.contains("gyro") && !json.contains("imu") && !text.contains("gyro"), "{text}");
}
