//! The way in: `check`, `init`, `convert`, and data sets as their owners have them.

use super::{data, racbot};
use std::fs;
use std::path::Path;
use tempfile::tempdir;

/// A copy of a data set with its robot.toml changed.
fn set(folder: &Path, of: &str, change: impl Fn(String) -> String) {
    let from = data(of);
    for entry in fs::read_dir(&from).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, folder.join(path.file_name().unwrap())).unwrap();
    }
    let robot = folder.join("robot.toml");
    let text = change(fs::read_to_string(&robot).unwrap());
    fs::write(robot, text).unwrap();
}

#[test]
fn check_passes_good_sets_and_names_mistakes_with_what_to_write() {
    let folder = tempdir().unwrap();
    for name in ["runs/wheel-skew", "real/differential-squares"] {
        let outcome = racbot(folder.path(), &["check", data(name).to_str().unwrap()]).done().fits_80_columns();
        assert!(outcome.stdout.contains("no set-up mistake"), "{}", outcome.stdout);
    }
    set(folder.path(), "runs/wheel-skew", |text| text.replace("wheel_radius_m = 0.0275", "wheel_radius_m = 0.055"));
    let outcome = racbot(folder.path(), &["check", "."]);
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    assert!(outcome.stdout.contains("wheel_radius_m: ") && outcome.stdout.contains("diameter"), "{}", outcome.stdout);
    assert!(outcome.stdout.contains("write wheel_radius_m = 0.0275"), "{}", outcome.stdout);
    assert!(outcome.stderr.contains("1 set-up mistake"), "{}", outcome.stderr);
    let json = racbot(folder.path(), &["--json", "check", "."]).json();
    assert_eq!(json["mistakes"][0]["kind"], "wheel-diameter");
    for command in ["gap", "calibrate"] {
        racbot(folder.path(), &[command, "."]).refused(1, &["set up wrong", "diameter", "--despite-mistakes"]);
    }
}

#[test]
fn init_writes_a_robot_that_reads_and_asks_once_for_what_a_log_needs() {
    let folder = tempdir().unwrap();
    let run = |arguments: &[&str]| racbot(folder.path(), &[&["init"], arguments].concat());
    run(&["four.toml", "--wheels", "60,135,225,300", "--x", "forward", "--radius-mm", "27", "--body-radius-mm", "80"])
        .done();
    let text = fs::read_to_string(folder.path().join("four.toml")).unwrap();
    let robot = runs::robot::Robot::parse_partial(&text, Path::new("four.toml")).unwrap();
    let wheels = robot.layout.wheels();
    // The first wheel is in front, to the left.
    assert!(wheels[0].x_m < -0.06 && wheels[0].y_m > 0.03, "{:?}", wheels[0]);
    assert!((robot.wheel_radius_m - 0.027).abs() < 1e-12 && robot.geometry().is_ok());
    run(&["four.toml", "--wheels", "0,90"]).refused(1, &["four.toml", "exists already", "--force"]);
    let log = data("runs/wheel-skew");
    let missing = run(&["--wheels", "90,210,330", "--body-radius-mm", "85", "--log", log.to_str().unwrap()]);
    missing.refused(
        2,
        &["--radius-mm", "--gear", "--counts-per-motor-rev", "--mass-kg", "--supply-v", "--torque-constant"],
    );
    let camera = data("real/differential-squares");
    run(&["two.toml", "--track-mm", "200", "--log", camera.to_str().unwrap()])
        .refused(2, &["--radius-mm", "--counts-per-motor-rev"]);
    let two = ["two.toml", "--track-mm", "200", "--radius-mm", "42", "--counts-per-wheel-rev", "2796.8"];
    run(&[&two[..], &["--log", camera.to_str().unwrap()]].concat()).done();
    let check = racbot(folder.path(), &["check", camera.to_str().unwrap(), "--robot", "two.toml"]).done();
    assert!(check.stdout.contains("no set-up mistake"), "{}", check.stdout);
}

/// The file is not there yet: what is wrong came by an option. What is right comes as it was said, however small.
#[test]
fn numbers_of_init_are_judged_by_their_options_and_kept() {
    let folder = tempdir().unwrap();
    let wheels = ["init", "r.toml", "--wheels", "60,135,225,300", "--radius-mm", "27", "--body-radius-mm", "80"];
    let with = |more: &[&str]| racbot(folder.path(), &[&wheels, more].concat());
    for (flag, value, said) in [
        ("--counts-per-motor-rev", "0", "0 is not positive"),
        ("--counts-per-wheel-rev", "-5", "-5 is not positive"),
        ("--mass-kg", "nan", "NaN is not a finite number"),
        ("--rate-hz", "-1e3", "-1000 is not positive"),
        ("--supply-v", "inf", "inf is not a finite number"),
        ("--gear", "-3", "lengths and ratios are positive numbers"),
    ] {
        let answer = with(&[flag, value]);
        assert_eq!(answer.code, Some(2), "{flag}: {}", answer.stderr);
        assert!(!answer.stderr.contains("r.toml"), "{}", answer.stderr);
        let said = if flag == "--gear" { said.to_owned() } else { format!("{flag}: {said}") };
        assert!(answer.stderr.contains(&said), "{}", answer.stderr);
    }
    racbot(folder.path(), &["init", "--wheels", "60,60,60", "--radius-mm", "27", "--body-radius-mm", "80"])
        .refused(2, &["--wheels: singular geometry"]);
    assert!(!folder.path().join("r.toml").exists());
    let small = ["--rotor-inertia", "3.1e-9", "--torque-constant", "0.00123456789", "--resistance-ohm", "9.4"];
    with(&small).done();
    let text = fs::read_to_string(folder.path().join("r.toml")).unwrap();
    let robot = runs::robot::Robot::parse_partial(&text, Path::new("r.toml")).unwrap();
    assert_eq!((robot.motor.rotor_inertia, robot.motor.torque_constant), (3.1e-9, 0.00123456789));
    assert_eq!((robot.wheel_radius_m, robot.motor.friction_torque), (0.027, 0.0));
}

/// Gains belong to a firmware that nobody asked for: a robot drives in the simulation without them, and over no card.
#[test]
fn a_robot_of_init_simulates_at_once() {
    let folder = tempdir().unwrap();
    let run = |arguments: &[&str]| racbot(folder.path(), arguments);
    let parts = ["--radius-mm", "27", "--body-radius-mm", "80", "--gear", "3.6", "--counts-per-motor-rev", "4096"];
    let motor = ["--resistance-ohm", "0.3", "--torque-constant", "0.03", "--rotor-inertia", "1e-5", "--supply-v", "24"];
    let rest = ["--mass-kg", "2.5", "--rate-hz", "1000"];
    run(&[&["init", "r.toml", "--wheels", "60,135,225,300"], &parts[..], &motor, &rest].concat()).done();
    let answer = run(&["simulate", "--robot", "r.toml", "--out", "sim"]).done();
    assert!(answer.stdout.contains("has no gains in [pi]: simulated with kp ="), "{}", answer.stdout);
    assert!(!answer.stdout.contains("missed"), "{}", answer.stdout);
    let beside = runs::robot::Robot::load(folder.path().join("sim/robot.toml")).unwrap();
    assert!(beside.pi.kp > 0.0 && beside.pi.ki > 0.0);
    let points = data("set-points/square.toml");
    run(&["drive", "--card", "virtual", "--robot", "r.toml", "--setpoints", points.to_str().unwrap()])
        .refused(1, &["r.toml", "has no gains in [pi]", "write, say, kp ="]);
    let served = run(&[
        "serve",
        "--robot",
        "r.toml",
        "--blue",
        "2",
        "--yellow",
        "2",
        "--ports",
        "0,0,0",
        "--vision",
        "none",
        "--seconds",
        "0.3",
    ]);
    assert_eq!(served.code, Some(0), "{}", served.stderr);
    assert_eq!(
        served.stderr.matches("r.toml has no gains in [pi]: simulated with kp =").count(),
        1,
        "{}",
        served.stderr
    );
    run(&["serve", "--card", "virtual", "--robot", "r.toml", "--seconds", "0.1"])
        .refused(1, &["r.toml", "has no gains in [pi]", "write, say, kp ="]);
    // What a log tells of the ticks is written; of rows that are in another unit of time nothing is.
    let bare = ["--mass-kg", "2.5", "--log"];
    run(&[&["init", "by_log.toml", "--wheels", "60,135,225,300"], &parts[..], &motor, &bare, &["sim/run.csv"]].concat()).done();
    let read = |name: &str| runs::robot::Robot::load_partial(folder.path().join(name)).unwrap();
    assert_eq!(read("by_log.toml").control_rate_hz, 1000.0);
    let again = run(&["simulate", "--robot", "by_log.toml", "--out", "again"]).done();
    assert!(again.stdout.contains("simulated with kp ="), "{}", again.stdout);
    let rows: Vec<String> = (0..50).map(|k| format!("{},0.{}", 5 * k, k % 10)).collect();
    fs::write(folder.path().join("ms.csv"), format!("t,duty_1\n{}\n", rows.join("\n"))).unwrap();
    run(&[&["init", "ms.toml", "--wheels", "60,135,225,300"], &parts[..], &motor, &bare, &["ms.csv"]].concat()).done();
    assert_eq!(read("ms.toml").lacks(&["control_rate_hz"]), ["control_rate_hz"]);
}

#[test]
fn a_servo_on_a_bench_is_a_robot_of_one_axis() {
    let folder = tempdir().unwrap();
    // A motor of 1.2 ohm and 0.05 Nm/A at 24 V with 0.004 Nm of friction, 8192 counts a turn, no gear.
    let (mut speed, mut angle, mut rows) = (0.0_f64, 0.0_f64, String::new());
    for k in 0..6_000 {
        let t = f64::from(k) * 1e-3;
        let duty = ((0.5 * (4.0 * t).sin() + 0.3 * (11.0 * t).sin()) * 1e3).round() / 1e3;
        let counts = (angle / std::f64::consts::TAU * 8192.0).floor();
        rows += &format!("{},{counts},{:.1},24\n", 1_000 * k, 100.0 * duty);
        for _ in 0..10 {
            let current = (24.0 * duty - 0.05 * speed) / 1.2;
            speed += 1e-4 * (0.05 * current - 0.004 * (speed / 0.05).tanh()) / 2e-5;
            angle += 1e-4 * speed;
        }
    }
    fs::write(folder.path().join("servo.csv"), "time_us,pos_counts,pwm_percent,vbus\n".to_owned() + &rows).unwrap();
    racbot(folder.path(), &["convert", "--draft", "servo.csv", "map.toml"]).done();
    racbot(folder.path(), &["convert", "map.toml", "servo.csv", "set/run_1.csv"]).done();
    let init = ["init", "set/robot.toml", "--axis", "--log", "set", "--gear", "1", "--counts-per-motor-rev", "8192"];
    racbot(folder.path(), &init)
        .refused(2, &["--supply-v", "--resistance-ohm", "--torque-constant", "--rotor-inertia"]);
    let motor = ["--supply-v", "24", "--resistance-ohm", "1.2", "--torque-constant", "0.05", "--rotor-inertia", "2e-5"];
    racbot(folder.path(), &[&init[..], &motor].concat()).done();
    racbot(folder.path(), &["check", "set"]).done();
    let gap = racbot(folder.path(), &["gap", "set", "--out", "out"]).done();
    assert!(gap.stdout.contains("coulomb-friction"), "{}", gap.stdout);
}

/// An arm's log: each of its joints is a data set, and one log against a file of one axis says how to come to that.
#[test]
fn a_log_of_an_arm_becomes_a_data_set_of_each_axis() {
    let folder = tempdir().unwrap();
    let joints = [2.0, 3.0, 5.0];
    let mut rows = "t,enc_1,enc_2,enc_3,current_1,current_2,current_3\n".to_owned();
    for k in 0..800 {
        let t = 0.01 * f64::from(k);
        let of = |f: fn(f64) -> f64, scale: f64| joints.map(|w| format!("{:.4}", scale * f(w * t)));
        let counts = joints.map(|w| format!("{:.0}", 5000.0 * (w * t).sin()));
        rows += &format!("{t:.2},{},{}\n", counts.join(","), of(f64::cos, 1.0).join(","));
    }
    fs::write(folder.path().join("arm.csv"), rows).unwrap();
    let init =
        ["init", "arm/robot.toml", "--axis", "--log", "arm.csv", "--gear", "1", "--counts-per-motor-rev", "4096"];
    let motor = ["--torque-constant", "1", "--rotor-inertia", "0.01"];
    let said = racbot(folder.path(), &[&init[..], &motor].concat()).done();
    assert!(said.stdout.contains("the 3 axes of the logs, each a data set of its own"), "{}", said.stdout);
    for axis in 1..=3 {
        let set = format!("arm/axis_{axis}");
        let run = runs::Run::read(folder.path().join(&set).join("arm.csv")).unwrap();
        let whole = runs::Run::read(folder.path().join("arm.csv")).unwrap();
        assert_eq!((run.wheel_count(), &run.counts[0]), (1, &whole.counts[axis - 1]));
        assert_eq!(run.current[0], whole.current[axis - 1]);
        racbot(folder.path(), &["check", &set]).done();
    }
    racbot(folder.path(), &[&init[..], &motor].concat()).refused(1, &["exists already"]);
    fs::create_dir(folder.path().join("whole")).unwrap();
    fs::copy(folder.path().join("arm.csv"), folder.path().join("whole/arm.csv")).unwrap();
    racbot(folder.path(), &["check", "whole", "--robot", "arm/axis_1/robot.toml"])
        .refused(1, &["speaks of 3 wheels", "racbot init --axis --log"]);
}

#[test]
fn a_log_with_x_forward_millimetres_and_degrees_is_converted_and_calibrates_as_the_original() {
    let folder = tempdir().unwrap();
    let original = runs::Run::read(data("runs/wheel-skew/run_01.csv")).unwrap();
    let mut text = "time_ms;motor a;motor b;motor c;px;py;heading\n".to_owned();
    let mut camera = original.camera.iter().peekable();
    for k in 0..original.len() {
        let [a, b, c] = [0, 1, 2].map(|i| original.counts[i][k]);
        let pose = camera.next_if(|s| s.tick == k).map_or(";;".to_owned(), |s| {
            let heading = (s.pose.theta + std::f64::consts::FRAC_PI_2).to_degrees();
            format!("{:.2};{:.2};{heading:.3}", 1e3 * s.pose.x, 1e3 * s.pose.y).replace('.', ",")
        });
        text += &format!("{};{a};{b};{c};{pose}\n", (1e3 * original.t[k]).round());
    }
    fs::write(folder.path().join("theirs.csv"), text).unwrap();
    fs::create_dir(folder.path().join("set")).unwrap();
    let map = "[time]\ncolumn = \"time_ms\"\nunit = \"ms\"\n[frame]\nx = \"forward\"\n[columns]\nenc_1 = \"motor a\"\n\
               enc_2 = \"motor b\"\nenc_3 = \"motor c\"\ncam_x = { from = \"px\", unit = \"mm\" }\n\
               cam_y = { from = \"py\", unit = \"mm\" }\ncam_theta = { from = \"heading\", unit = \"deg\" }\n";
    fs::write(folder.path().join("map.toml"), map).unwrap();
    let list = racbot(folder.path(), &["convert", "--list", "theirs.csv"]).done();
    assert!(list.stdout.contains("time_ms  the time, its unit 0.001 s"), "{}", list.stdout);
    racbot(folder.path(), &["convert", "map.toml", "theirs.csv", "set/run.csv"]).done();
    racbot(folder.path(), &["convert", "map.toml", "theirs.csv", "set/run.csv"]).refused(1, &["exists already"]);
    racbot(folder.path(), &["convert", "map.toml", "theirs.csv", "set/run.txt"])
        .refused(1, &["neither *.csv nor *.mcap"]);
    fs::write(folder.path().join("bad.toml"), map.replace("motor a", "motor x")).unwrap();
    racbot(folder.path(), &["convert", "bad.toml", "theirs.csv", "set/b.csv"])
        .refused(1, &["motor x", "did you mean motor"]);
    fs::write(folder.path().join("bad.toml"), map.replace("enc_1", "ecn_1")).unwrap();
    racbot(folder.path(), &["convert", "bad.toml", "theirs.csv", "set/b.csv"]).refused(1, &["columns.ecn_1", "enc_1?"]);
    let run = runs::Run::read(folder.path().join("set/run.csv")).unwrap();
    assert_eq!((run.counts.clone(), run.camera.len()), (original.counts.clone(), original.camera.len()));
    for (a, b) in run.camera.iter().zip(&original.camera) {
        assert!(a.pose.distance(b.pose) < 2e-5 && runs::frames::wrap_angle(a.pose.theta - b.pose.theta).abs() < 2e-5);
    }
}

#[test]
fn two_wheels_and_dead_reckoning_are_compared_with_the_camera() {
    let folder = tempdir().unwrap();
    let squares = data("real/differential-squares");
    let outcome = racbot(folder.path(), &["--json", "gap", squares.to_str().unwrap()]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(outcome.json()["gap"].to_string().contains("motion"), "{}", outcome.json()["gap"]);
    let found = racbot(folder.path(), &["calibrate", squares.to_str().unwrap()]).done().fits_80_columns();
    assert!(!found.stdout.contains("95 % from"), "two wheels show no skew: {}", found.stdout);
    // The same drive as the robot's own odometry, with nothing said of the wheels.
    let set = runs::DataSet::open(&squares).unwrap();
    let geometry = set.robot.geometry().unwrap();
    fs::create_dir(folder.path().join("odom")).unwrap();
    for run in &set.runs {
        let mut pose = runs::frames::Pose::default();
        let mut text = "t,odom_x,odom_y,odom_theta,cam_x,cam_y,cam_theta\n".to_owned();
        let mut camera = run.camera.iter().peekable();
        for k in 0..run.len() {
            if k > 0 {
                let turned: Vec<f64> =
                    run.counts.iter().map(|c| (c[k] - c[k - 1]) as f64 / set.robot.counts_per_wheel_rad()).collect();
                pose = pose.compose(runs::frames::displacement(geometry.twist(&turned)));
            }
            let seen = camera
                .next_if(|s| s.tick == k)
                .map_or(",,".to_owned(), |s| format!("{},{},{}", s.pose.x, s.pose.y, s.pose.theta));
            text += &format!("{},{},{},{},{seen}\n", run.t[k], pose.x, pose.y, pose.theta);
        }
        fs::write(folder.path().join("odom").join(format!("{}.csv", run.name)), text).unwrap();
    }
    fs::write(folder.path().join("odom/robot.toml"), "camera_rate_hz = 20\n").unwrap();
    racbot(folder.path(), &["check", "odom"]).done();
    let outcome = racbot(folder.path(), &["--json", "gap", "odom"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let json = outcome.json();
    let named: Vec<&str> = json["effects"].as_array().unwrap().iter().map(|e| e["name"].as_str().unwrap()).collect();
    assert!(named.iter().all(|n| !n.starts_with("wheel-") || *n == "wheel-radius-common"), "{named:?}");
    racbot(folder.path(), &["calibrate", "odom"]).refused(1, &["odometry and no wheels"]);
}

/// The camera saw a robot on one spot: what its noise makes of that is no mistake.
#[test]
fn a_robot_that_only_turned_is_set_up_right() {
    let folder = tempdir().unwrap();
    let spin = ["simulate", "--skew-deg", "5,0,-2", "--manoeuvre", "spin", "--times", "3", "--out", "spin"];
    racbot(folder.path(), &spin).done();
    let check = racbot(folder.path(), &["check", "spin"]).done();
    assert!(check.stdout.contains("no set-up mistake"), "{}", check.stdout);
    racbot(folder.path(), &["calibrate", "spin"]).done();
    // Turns alone tell a diameter and clockwise headings.
    let robot = folder.path().join("spin/robot.toml");
    let text = fs::read_to_string(&robot).unwrap();
    let wide = text.replace("wheel_radius_m = 0.0275", "wheel_radius_m = 0.055");
    assert_ne!(wide, text);
    fs::write(&robot, wide).unwrap();
    let check = racbot(folder.path(), &["check", "spin"]);
    assert!(check.code == Some(1) && check.stdout.contains("looks\n  like a diameter"), "{}", check.stdout);
}

#[test]
fn a_strangers_log_becomes_a_run_by_a_drafted_map() {
    let folder = tempdir().unwrap();
    let rows: String = (0..400)
        .map(|k| {
            let t = f64::from(k) * 0.02;
            let camera =
                if k % 2 == 0 { format!("{:.1};{:.1};{:.2}", 1e3 * t, 50.0 * t, 10.0 * t) } else { ";;".to_owned() };
            format!("{};{};{};{camera}\n", 5_000 + 20 * k, 40 * k, -38 * k).replace('.', ",")
        })
        .collect();
    fs::create_dir(folder.path().join("set")).unwrap();
    let text = "Zeit [ms];Motor 1 (ticks);Motor 2 (ticks);vision x;vision y;vision phi [deg]\n".to_owned() + &rows;
    fs::write(folder.path().join("set/theirs.csv"), &text).unwrap();
    // Beside a robot.toml as it is, the error says how to go on.
    racbot(folder.path(), &["init", "set/robot.toml", "--track-mm", "200", "--radius-mm", "40"]).done();
    racbot(folder.path(), &["check", "set"])
        .refused(1, &["theirs.csv:1:1: t: no such column", "racbot convert --draft"]);
    let list = racbot(folder.path(), &["convert", "--list", "set/theirs.csv"]).done();
    assert!(list.stdout.contains("Zeit [ms]  the time, its unit 0.001 s"), "{}", list.stdout);
    racbot(folder.path(), &["convert", "--draft", "set/theirs.csv", "map.toml"]).done().fits_80_columns();
    racbot(folder.path(), &["convert", "--draft", "set/theirs.csv", "map.toml"]).refused(1, &["exists already"]);
    racbot(folder.path(), &["convert", "map.toml", "set/theirs.csv", "run.csv"]).done();
    let run = runs::Run::read(folder.path().join("run.csv")).unwrap();
    assert_eq!((run.counts[1][399], run.camera.len()), (-38 * 399, 200));
    assert!((run.t[399] - 399.0 * 0.02).abs() < 1e-9 && (run.camera[199].pose.x - 398.0 * 0.02).abs() < 1e-3);
    let plain = racbot(folder.path(), &["convert", "set/theirs.csv", "out.csv"]);
    plain.refused(2, &["give a map", "racbot convert --draft"]);
    // A file without any time is listed nevertheless, by its rows.
    fs::write(folder.path().join("bare.csv"), "a,b\n1,2\n3,4\n").unwrap();
    let list = racbot(folder.path(), &["convert", "--list", "bare.csv"]).done();
    assert!(list.stdout.contains("a  2 samples, 1.000000 to 3.000000"), "{}", list.stdout);
}

/// Where nothing could be found out, nothing is to be typed into a firmware.
#[test]
fn a_calibration_without_an_estimate_prints_no_arrays() {
    let folder = tempdir().unwrap();
    let from = data("runs/wheel-skew");
    fs::copy(from.join("robot.toml"), folder.path().join("robot.toml")).unwrap();
    for mut run in runs::DataSet::open(&from).unwrap().runs {
        run.camera.clear();
        run.save(folder.path().join(format!("{}.csv", run.name)), runs::output::Existing::Refuse).unwrap();
    }
    let outcome = racbot(folder.path(), &["calibrate", "."]).done().fits_80_columns();
    assert!(outcome.stdout.starts_with("The logs have no camera poses"), "{}", outcome.stdout);
    for absent in ["static const float", "95 % from", "residual"] {
        assert!(!outcome.stdout.contains(absent), "{absent}: {}", outcome.stdout);
    }
}

#[test]
fn what_is_passed_over_is_said_in_every_answer_and_replacing_files_passes_over_nothing() {
    let folder = tempdir().unwrap();
    set(folder.path(), "runs/wheel-skew", |text| text.replace("wheel_radius_m = 0.0275", "wheel_radius_m = 0.055"));
    racbot(folder.path(), &["gap", ".", "--force"]).refused(1, &["set up wrong", "--despite-mistakes"]);
    let outcome = racbot(folder.path(), &["gap", ".", "--despite-mistakes", "--out", "g"]).done().fits_80_columns();
    assert!(outcome.stdout.contains("can be trusted"), "{}", outcome.stdout);
    let report = fs::read_to_string(folder.path().join("g/report.html")).unwrap();
    assert!(report.contains("Set up wrong: wheel_radius_m"), "no mistake in the report");
    let json: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.path().join("g/gap.json")).unwrap()).unwrap();
    assert!(json["set_up_mistakes"][0].as_str().is_some_and(|said| said.contains("diameter")), "{json}");
    let good = data("runs/wheel-skew");
    let outcome = racbot(folder.path(), &["gap", good.to_str().unwrap(), "--out", "good"]).done();
    assert!(!outcome.stdout.contains("Gone on with"), "{}", outcome.stdout);
}
