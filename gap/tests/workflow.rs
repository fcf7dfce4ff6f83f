//! The workflow from logs to a named effect and back.

use std::path::{Path, PathBuf};

use gap::{Analysis, Options, Verdict, analyse, undo};
use model::effects::Applied;
use model::frames::{Pose, Twist};
use model::manoeuvre::Manoeuvre;
use model::plant::Contact;
use model::robot::{Effect, EffectParameter, Robot};
use model::run::{DataSet, Run};
use model::simulation::VirtualRobot;

/// The example set whose hidden skews are +4, −3 and +2 degrees.
fn example() -> DataSet {
    DataSet::open(Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/runs/wheel-skew")).unwrap()
}

fn with(name: &str, parameters: &[(&str, f64)]) -> Robot {
    let parameters = parameters
        .iter()
        .map(|(n, v)| ((*n).to_owned(), EffectParameter { value: *v, ..EffectParameter::default() }))
        .collect();
    let effect = Effect { name: name.to_owned(), parameters, ..Effect::default() };
    Robot { effects: vec![effect], ..Robot::racbot() }
}

/// Logs of the true robot, described by the nominal one. Contacts creep a little, as all do.
fn simulate(truth: &Robot, manoeuvres: &[Manoeuvre], seed: u64) -> DataSet {
    let applied = Applied::of(truth);
    assert!(applied.unsupported.is_empty(), "{:?}", applied.unsupported);
    let believed = Robot::racbot().geometry().unwrap();
    let runs = manoeuvres
        .iter()
        .enumerate()
        .map(|(k, manoeuvre)| {
            let start = Pose::new(0.3, -0.2, 0.4 + k as f64);
            let contact = match applied.contact {
                Contact::Rolling => Contact::Friction { friction_coefficient: 0.9, creep_s_per_kg: 3e-4 },
                other => other,
            };
            let mut robot =
                VirtualRobot::new(&applied.robot, contact, applied.camera, start, 100 * seed + k as u64).unwrap();
            manoeuvre.drive(&mut robot, &believed);
            let mut run = robot.into_log();
            run.name = format!("run_{}", k + 1);
            applied.finish(&mut run);
            run
        })
        .collect();
    DataSet { folder: PathBuf::from("simulated"), robot: Robot::racbot(), runs }
}

const RICH: [Manoeuvre; 3] = [Manoeuvre::Star, Manoeuvre::Spin, Manoeuvre::Chirp];

fn names(a: &Analysis) -> Vec<&str> {
    a.effects.iter().map(|e| e.name.as_str()).collect()
}

fn value(a: &Analysis, parameter: &str) -> f64 {
    let all = a.effects.iter().flat_map(|e| &e.parameters);
    all.filter(|p| p.0 == parameter).map(|p| p.1).next().unwrap_or(f64::NAN)
}

#[test]
fn the_skew_set_is_named_added_and_then_agrees() {
    let set = example();
    let a = analyse(&set, &Options::default()).unwrap();
    assert_eq!((a.verdict, names(&a)), (Verdict::MissingEffect, vec!["wheel-skew"]));
    assert_eq!(a.effects[0].wheels, [1, 2, 3]);
    for (i, truth) in [4.0_f64, -3.0, 2.0].iter().enumerate() {
        let found = value(&a, &format!("skew_{}_rad", i + 1)).to_degrees();
        assert!((found - truth).abs() < 0.3, "wheel {}: {found}", i + 1);
    }
    let json = a.to_json();
    for key in ["verdict", "located", "effects", "alternatives", "unexplained", "next_experiment", "gap"] {
        assert!(json.get(key).is_some(), "{key}");
    }
    assert!(json["gap"]["closed"].as_f64().unwrap() > 0.8);
    assert!(a.terminal_summary().lines().all(|l| l.chars().count() <= 80), "{}", a.terminal_summary());
    let html = a.html();
    assert!(html.contains("<svg") && !html.contains("<script") && !html.contains("NaN"));

    let folder = tempfile::tempdir().unwrap();
    a.write(folder.path()).unwrap();
    let robot = Robot::load(folder.path().join("robot.toml")).unwrap();
    let again = analyse(&DataSet { robot: robot.clone(), ..set }, &Options::default()).unwrap();
    assert_eq!((again.verdict, names(&again)), (Verdict::Agrees, vec![]), "{}", again.terminal_summary());
    let nominal = undo(&robot, "wheel-skew").unwrap();
    assert!(nominal.effects.is_empty() && undo(&nominal, "wheel-skew").is_none());
}

#[test]
fn a_clean_simulation_agrees() {
    let a = analyse(&simulate(&Robot::racbot(), &RICH, 1), &Options::default()).unwrap();
    assert_eq!((a.verdict, names(&a)), (Verdict::Agrees, vec![]), "{}", a.terminal_summary());
    assert!(a.limits.iter().any(|l| l.name == "robot-mass") && a.to_json()["gap"]["closed"].is_null());
}

/// Effect, its parameters, the one that is checked and its relative tolerance.
type Case = (&'static str, &'static [(&'static str, f64)], &'static str, f64);

#[test]
fn effects_simulated_in_are_found() {
    let table: [Case; 6] = [
        ("body-radius", &[("scale", 0.03)], "scale", 0.15),
        ("camera-latency", &[("latency_s", 0.03)], "latency_s", 0.1),
        ("marker-offset", &[("x_m", 0.01), ("y_m", -0.006)], "x_m", 0.15),
        ("coulomb-friction", &[("torque_nm", 0.012)], "torque_nm", 0.2),
        ("torque-constant", &[("scale", -0.15)], "scale", 0.25),
        ("robot-mass", &[("scale", 0.2)], "scale", 0.25),
    ];
    for (seed, (name, parameters, parameter, tolerance)) in table.into_iter().enumerate() {
        let a = analyse(&simulate(&with(name, parameters), &RICH, 10 + seed as u64), &Options::default()).unwrap();
        assert_eq!(names(&a), [name], "{name}\n{}", a.terminal_summary());
        let truth = parameters.iter().find(|p| p.0 == parameter).unwrap().1;
        let found = value(&a, parameter);
        assert!((found / truth - 1.0).abs() < tolerance, "{name}: {found} instead of {truth}");
    }
}

#[test]
fn partial_logs_narrow_what_is_compared() {
    let set = example();
    let cut = |change: &dyn Fn(&mut Run)| {
        let mut set = set.clone();
        set.runs.iter_mut().for_each(change);
        analyse(&set, &Options::default())
    };
    let no_duty = cut(&|r| r.duty.clear()).unwrap();
    assert_eq!(names(&no_duty), ["wheel-skew"]);
    let no_camera = cut(&|r| {
        r.camera.clear();
        r.has_camera = false;
    })
    .unwrap();
    assert!(no_camera.effects.iter().all(|e| e.name != "wheel-skew"));
    assert!(
        cut(&|r| {
            r.command = None;
            r.reference.clear();
        })
        .is_ok()
    );
    assert!(
        cut(&|r| {
            *r = Run { t: r.t.clone(), ..Run::default() };
        })
        .is_err()
    );
    let mut one = set.clone();
    one.runs.truncate(1);
    assert!(analyse(&one, &Options::default()).is_ok());
}

#[test]
fn a_command_that_comes_late_is_proved() {
    let mut set = example();
    for run in &mut set.runs {
        for signal in run.command.as_mut().unwrap() {
            signal.rotate_left(20);
            let n = signal.len();
            signal[n - 20..].fill(0.0);
        }
    }
    let a = analyse(&set, &Options::default()).unwrap();
    assert!((value(&a, "latency_s") - 0.02).abs() < 1e-9, "{}", a.terminal_summary());
}

#[test]
fn a_users_effect_stands_beside_the_built_in_ones() {
    let text = "name = \"my-rub\"\ntorque = \"-c * tanh(w / 0.4)\"\n[parameters]\nc = { scale = 1e-3, low = 0.0, high = 0.1, material = 4e-3 }\n";
    let effect = gap::user::UserEffect::parse(text).unwrap();
    let options = Options { effects: vec![std::sync::Arc::new(effect)], ..Options::default() };
    let a = analyse(&simulate(&with("coulomb-friction", &[("torque_nm", 0.012)]), &RICH, 30), &options).unwrap();
    assert_eq!(names(&a), ["coulomb-friction"]);
    assert!(a.alternatives.iter().any(|s| s.contains(&"my-rub".to_owned())), "{:?}", a.alternatives);
    let bad = gap::user::UserEffect::parse(&text.replace("tanh(w", "tanh(ww")).unwrap_err().to_string();
    assert!(bad.contains("`ww` is no signal") && bad.contains("         ^"), "{bad}");
}

#[test]
fn wheels_on_blocks_are_compared_axis_by_axis() {
    let mut nominal = Robot::racbot();
    nominal.support = model::robot::Support::Blocks;
    nominal.wheel_inertia_kg_m2 = 2e-5;
    let mut truth = nominal.clone();
    truth.motor.friction_torque += 0.012 / truth.gear_ratio;
    let g = nominal.geometry().unwrap();
    let runs = (0..3)
        .map(|k| {
            let camera = model::camera::CameraModel::of(&truth);
            let mut r = VirtualRobot::new(&truth, Contact::Rolling, camera, Pose::default(), k).unwrap();
            for j in 0..5 {
                let a = f64::from(j) + k as f64;
                r.drive(Twist::new(a.cos(), a.sin(), 2.0 * (2.0 * a).sin()), 1.0, &g);
            }
            r.into_log()
        })
        .collect();
    let set = DataSet { folder: PathBuf::from("blocks"), robot: nominal, runs };
    let a = analyse(&set, &Options::default()).unwrap();
    assert_eq!(names(&a), ["coulomb-friction"], "{}", a.terminal_summary());
}
