//! Axes that stand still or turn against their drive are told, by name; good ones and loads are not.

use std::path::Path;

use model::setup::{Mistake, mistakes};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::robot::Robot;
use runs::{DataSet, DutySource, Logs, Run, Source};

fn set(name: &str) -> DataSet {
    let mut set = DataSet::open(Path::new(env!("CARGO_MANIFEST_DIR")).join("../data").join(name)).unwrap();
    for run in &mut set.runs {
        // As a bench without a camera logs it.
        run.has_camera = false;
        run.camera.clear();
    }
    set
}

fn told(set: &DataSet) -> Vec<String> {
    let set = DataSet { folder: "set".into(), robot: set.robot.clone(), runs: set.runs.clone() };
    mistakes(&Logs::from(&set)).iter().map(Mistake::sentence).collect()
}

#[test]
fn an_encoder_that_stands_still_is_told() {
    let mut set = set("runs/wheel-skew");
    for run in &mut set.runs {
        run.duty.clear();
        // Edges of noise on a cable that leads nowhere.
        run.counts[1] = (0..run.len()).map(|k| i64::from(k % 97 == 0)).collect();
    }
    let said = told(&set);
    assert!(said.iter().any(|s| s.starts_with("enc_2: it stands still: set points ask for ")), "{said:?}");
    let mut dead = set.clone();
    dead.runs.iter_mut().for_each(|run| run.counts[1].fill(0));
    let not_one = told(&dead);
    assert!(not_one.iter().any(|s| s.contains("enc_2: it stands still") && s.contains("it counts 0")), "{not_one:?}");
    assert!(!said.iter().any(|s| s.starts_with("enc_1: it stands") || s.starts_with("enc_3: it stands")), "{said:?}");
}

#[test]
fn a_drive_the_other_way_round_is_told() {
    let mut set = set("real/robojackets-excitation");
    assert_eq!(told(&set), Vec::<String>::new());
    set.runs.iter_mut().flat_map(|run| &mut run.duty[2]).for_each(|d| *d = -*d);
    let said = told(&set);
    let expected = "duty_3: the axis turns the other way than it drives, both ways; change its sign, or that of enc_3";
    assert!(said.iter().any(|s| s.starts_with(expected)), "{said:?}");
    assert!(said.iter().filter(|s| s.contains("turns the other way")).count() == 1, "{said:?}");
}

/// A motor that was plugged in the other way for a part of its logs.
#[test]
fn a_drive_that_is_the_other_way_round_in_some_logs_is_told_with_their_names() {
    let mut set = set("real/robojackets-excitation");
    let name = set.runs[0].name.clone();
    set.runs[0].duty[0].iter_mut().for_each(|d| *d = -*d);
    let said = told(&set);
    let expected = format!("duty_1: the axis turns the other way than it drives, both ways, in 1 of 2 logs ({name})");
    assert!(said.iter().any(|s| s.starts_with(&expected)), "{said:?}");
}

/// A weight on a winch turns it backwards against its motor, one way; a spring drives it back half of the time.
#[test]
fn loads_that_pull_are_no_reversed_drives() {
    let text = "encoder_counts_per_wheel_rev = 65536\ngear_ratio = 1\nsupport = \"blocks\"\nwheel_radius_m = 1\nwheel_inertia_kg_m2 = 0\n\
                [motor]\ntorque_constant = 1\nrotor_inertia = 0.02\nfriction_torque = 0\n[[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n";
    let robot = Robot::parse_partial(text, Path::new("robot.toml")).unwrap();
    for (weight, spring) in [(0.5, 0.0), (0.0, 4.0), (0.0, 0.2)] {
        let mut run = Run { name: "run_1".to_owned(), ..Run::default() };
        let (mut angle, mut speed, mut currents, mut counts) = (0.0_f64, 0.0_f64, Vec::new(), Vec::new());
        for k in 0..6000 {
            let t = 0.005 * f64::from(k);
            let wanted = 8.0 * (0.9 * t).sin();
            let current = (0.4 * (wanted - speed) + weight).clamp(-2.0, 2.0);
            run.t.push(t);
            currents.push(current);
            counts.push((angle / std::f64::consts::TAU * 65536.0).floor() as i64);
            for _ in 0..20 {
                speed += 0.00025 * (current - weight - spring * angle - 0.01 * speed) / 0.02;
                angle += 0.00025 * speed;
            }
        }
        run.source = Source { duties: DutySource::Currents, ..Source::default() };
        (run.duty, run.counts, run.count_gaps) = (vec![currents], vec![counts], vec![Vec::new()]);
        let set = DataSet { folder: "set".into(), robot: robot.clone(), runs: vec![run] };
        let said = told(&set);
        assert!(!said.iter().any(|s| s.contains("the other way")), "{weight} {spring}: {said:?}");
    }
}

/// A motor in a loop whose set point changes every ten seconds; its header was shifted by one, so that the set point stands as
/// the speed and the speed as the duty. A coarse encoder behind a duty that changes in every row is no such thing.
#[test]
fn a_set_point_in_the_column_of_the_speed_is_told() {
    let text = "gear_ratio = 30\nsupply_v = 12\nsupport = \"blocks\"\nwheel_radius_m = 1\nwheel_inertia_kg_m2 = 0\n\
                encoder_counts_per_wheel_rev = 360\n[motor]\nresistance_ohm = 4\ntorque_constant = 0.01\nrotor_inertia = 1e-6\n\
                friction_torque = 0\n[[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n";
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let (mut t, mut asked, mut duty, mut speed) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut w, mut integral) = (0.0_f64, 0.0_f64);
    for k in 0..1200 {
        let set_point = [24.0, 20.0, 27.0, 22.0, 25.0, 21.0][k / 200];
        // A count of a coarse encoder within a row is 2 rad/s.
        let seen = ((w + random.random_range(-0.5..0.5)) / 2.0).round() * 2.0;
        integral += 0.004 * (set_point - seen);
        let u = (0.01 * (set_point - seen) + integral).clamp(-1.0, 1.0);
        t.push(0.05 * k as f64);
        asked.push(set_point);
        duty.push(u);
        speed.push(seen);
        w += (38.0 * u - w) * 0.3;
    }
    let told = |speed: &[f64], duty: &[f64]| {
        let folder = tempfile::tempdir().unwrap();
        let row = |k: usize| format!("{},{},{}\n", t[k], speed[k], duty[k]);
        let rows: String = (0..t.len()).map(row).collect();
        std::fs::write(folder.path().join("robot.toml"), text).unwrap();
        std::fs::write(folder.path().join("run_1.csv"), format!("t,speed_1,duty_1\n{rows}")).unwrap();
        let logs = Logs::open(folder.path()).unwrap();
        mistakes(&logs).iter().map(Mistake::sentence).collect::<Vec<_>>()
    };
    assert!(!told(&speed, &duty).iter().any(|said| said.contains("set point")), "{:?}", told(&speed, &duty));
    let shifted: Vec<f64> = speed.iter().map(|w| w / 40.0).collect();
    let said = told(&asked, &shifted);
    assert!(said.len() == 1 && said[0].starts_with("speed_1: it changes in 5 of 1200 rows and duty_1 in "), "{said:?}");
}

/// One log of a robot that somebody held up: the whole set was that of another robot.
#[test]
fn a_log_of_a_robot_that_was_lifted_is_told_by_its_name() {
    let mut set = DataSet::open(Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/runs/wheel-skew")).unwrap();
    assert_eq!(told(&set), Vec::<String>::new());
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let name = set.runs[1].name.clone();
    let first = set.runs[1].camera[0].pose;
    for sample in &mut set.runs[1].camera {
        let mut off = |most: f64| rng.random_range(-most..most);
        let (x, y, theta) = (first.x + off(0.003), first.y + off(0.003), first.theta + off(0.01));
        (sample.pose.x, sample.pose.y, sample.pose.theta) = (x, y, theta);
    }
    let said = told(&set);
    assert!(said.len() == 1 && said[0].starts_with(&format!("cam_x: in {name} (1 of ")), "{said:?}");
    // A set of such logs alone says so by itself.
    set.runs = vec![set.runs[1].clone()];
    assert!(!told(&set).iter().any(|s| s.contains("sees the robot stand")), "{:?}", told(&set));
}

/// Rows that come when something happens keep the beat of the loop, soon or late; those of a loop that is slower than its file says
/// have one distance, or nearly.
#[test]
fn rows_by_events_are_no_slower_loop() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/runs/wheel-skew");
    let said = |after: &mut dyn FnMut() -> usize| {
        let mut set = DataSet::open(&folder).unwrap();
        for run in &mut set.runs {
            let mut rows = vec![0, 1];
            while let Some(row) = Some(rows[rows.len() - 1] + after()).filter(|row| *row < run.len()) {
                rows.push(row);
            }
            let kept = |column: &mut Vec<f64>| *column = rows.iter().map(|row| column[*row]).collect();
            [&mut run.reference, &mut run.duty].into_iter().flatten().chain([&mut run.t]).for_each(kept);
            run.counts.iter_mut().for_each(|c| *c = rows.iter().map(|row| c[*row]).collect());
            run.count_gaps.iter_mut().for_each(Vec::clear);
            run.measured.clear();
            run.camera.clear();
            (run.command, run.supply_v, run.has_camera) = (None, None, false);
        }
        told(&set).iter().any(|s| s.contains("control_rate_hz = "))
    };
    let mut rng = ChaCha8Rng::seed_from_u64(20);
    assert!(!said(&mut || if rng.random::<f64>() < 0.3 { 1 } else { rng.random_range(2..12) }), "by events");
    assert!(!said(&mut || rng.random_range(2..40)), "never at the next tick");
    assert!(said(&mut || 4 * rng.random_range(1..5)), "a quarter of the rate by events");
    assert!(said(&mut || 4), "a loop of a quarter of the rate");
    assert!(said(&mut || rng.random_range(3..6)), "one that is late and early");
}
