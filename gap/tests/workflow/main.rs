//! The workflow from logs to a named effect and back.

mod benches;
mod catalogue;
mod cogging;
mod common;
mod counts;
mod currents;
mod differing;
mod drive;
mod drive_train;
mod experiment;
mod filtered;
mod flywheel;
mod gear_motor;
mod gravity;
mod heavy;
mod joint;
mod late_duties;
mod lost_rows;
mod margins;
mod odometry;
mod pairs;
mod partial;
mod play;
mod replayed;
mod scale;
mod single_steps;
mod slipping;
mod slow_rows;
mod smoothed;
mod stale;
mod thumb_motor;
mod uneven;
mod ways;
mod windings;

use common::{RICH, cut_all, example, names, simulate, value, with};
use gap::{Options, Verdict, analyse, undo};
use runs::DataSet;
use runs::robot::Robot;

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
    // What the written file closes, with nothing adjusted beside it: all of the motion, and of the drive all but what
    // rolling costs, which is in every robot and too small to be named.
    let motion = a.links.iter().find(|l| l.link == links::effect::Link::Motion).unwrap();
    assert!((motion.before - motion.after) / (motion.before - 1.0) > 0.95, "{} {}", motion.before, motion.after);
    assert!(json["gap"]["closed"].as_f64().unwrap() > 0.6, "{}", json["gap"]);
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
    let text = "name = \"my-rub\"\ntorque = \"-c * sign_w\"\n[parameters]\nc = { scale = 1e-3, low = 0.0, high = 0.1, material = 4e-3 }\n";
    let effect = gap::user::UserEffect::parse(text).unwrap();
    let options = Options { effects: vec![std::sync::Arc::new(effect)], ..Options::default() };
    let mut set = simulate(&with(&Robot::racbot(), "coulomb-friction", &[("torque_nm", 0.012)]), &RICH, 30);
    cut_all(&mut set, 6.0);
    let a = analyse(&set, &options).unwrap();
    assert_eq!(names(&a), ["coulomb-friction"]);
    assert!(a.alternatives.iter().any(|s| s.contains(&"my-rub".to_owned())), "{:?}", a.alternatives);
    let bad = gap::user::UserEffect::parse(&text.replace("sign_w", "tanh(ww)")).unwrap_err().to_string();
    assert!(bad.contains("`ww` is no signal") && bad.contains("         ^"), "{bad}");
}

#[test]
fn a_robot_that_is_carried_away_is_unexplained() {
    let mut set = simulate(&Robot::racbot(), &RICH, 2);
    // Somebody takes it by the hand: the camera sees half a metre that no wheel turned.
    let run = &mut set.runs[1];
    for sample in &mut run.camera {
        sample.pose.x += 0.25 * (1.0 - (0.9 * run.t[sample.tick]).cos());
    }
    let a = analyse(&set, &Options::default()).unwrap();
    assert_eq!(a.verdict, Verdict::Unexplained, "{}", a.terminal_summary());
    assert!(a.unexplained.iter().any(|u| u.link == links::effect::Link::Motion), "{:?}", a.unexplained);
}
