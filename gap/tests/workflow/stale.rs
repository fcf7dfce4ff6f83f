//! Files with effects that are not, or no longer, the robot's.

use gap::{Analysis, Options, Verdict, analyse};
use model::manoeuvre::Manoeuvre::{Chirp, FullDuty, StopAndGo};
use runs::robot::Robot;

use super::common::{RICH, names, simulate, value, with};

/// What is said of logs of one robot by the file of another.
fn by(file: &Robot, truth: &Robot, drive: bool, seed: u64) -> Analysis {
    let mut set =
        if drive { simulate(truth, &[StopAndGo, FullDuty, Chirp], seed) } else { simulate(truth, &RICH, seed) };
    if !drive {
        set.runs.iter_mut().for_each(|run| run.duty.clear());
    }
    set.robot = file.clone();
    analyse(&set, &Options::default()).unwrap()
}

fn written(a: &Analysis) -> Vec<&str> {
    a.robot.effects.iter().map(|e| e.name.as_str()).collect()
}

/// Beside friction that is not there a bridge gave more than its duties; beside a radius, counts were others.
#[test]
fn an_effect_of_the_file_that_is_not_in_the_logs_goes() {
    let robot = Robot::racbot();
    for (seed, drive, name, value) in [
        (31, false, "wheel-radius-common", ("scale", 0.03)),
        (32, false, "camera-latency", ("latency_s", 0.05)),
        (33, true, "coulomb-friction", ("torque_nm", 0.05)),
        (34, true, "robot-mass", ("scale", 0.5)),
    ] {
        let a = by(&with(&robot, name, &[value]), &robot, drive, seed);
        assert_eq!((a.verdict, names(&a).len()), (Verdict::Unexplained, 0), "{}", a.terminal_summary());
        let told = format!("{name}, which the file has, is not in these logs: ");
        assert!(a.unexplained.iter().any(|u| u.structure.starts_with(&told)), "{}", a.terminal_summary());
        assert!(written(&a).is_empty() && !a.robot_text.contains(name), "{}", a.robot_text);
        assert!(a.links.iter().all(|l| l.after <= l.before), "{}", a.terminal_summary());
    }
}

#[test]
fn an_effect_of_the_file_that_has_another_size_is_named_with_its_own() {
    let robot = Robot::racbot();
    let of = |scale: f64| with(&robot, "wheel-radius-common", &[("scale", scale)]);
    let a = by(&of(-0.03), &of(0.02), false, 35);
    assert_eq!(names(&a), ["wheel-radius-common"], "{}", a.terminal_summary());
    assert!((value(&a, "scale") - 0.02).abs() < 2e-3, "{}", a.terminal_summary());
    assert!(a.remarks.iter().any(|r| r.contains("it was looked for anew")), "{:?}", a.remarks);
    assert_eq!(written(&a), ["wheel-radius-common"]);
}

/// By what undoes a part of it counts were others beside a radius that is half too large, and nothing beside friction.
#[test]
fn a_size_of_the_file_that_is_half_too_large_is_named_with_its_own() {
    let robot = Robot::racbot();
    for (seed, drive, name, parameter, [filed, truth]) in [
        (38, false, "wheel-radius-common", "scale", [0.03, 0.02]),
        (39, true, "coulomb-friction", "torque_nm", [0.08, 0.05]),
        (40, true, "robot-mass", "scale", [0.6, 0.4]),
    ] {
        let of = |size: f64| with(&robot, name, &[(parameter, size)]);
        let a = by(&of(filed), &of(truth), drive, seed);
        assert_eq!((names(&a), written(&a)), (vec![name], vec![name]), "{}", a.terminal_summary());
        assert!((value(&a, parameter) / truth - 1.0).abs() < 0.1, "{}", a.terminal_summary());
        assert!(a.links.iter().all(|l| l.after <= l.before), "{}", a.terminal_summary());
        let said = format!("{name} as the file has it does not fit these logs");
        assert!(a.remarks.iter().any(|r| r.starts_with(&said)), "{:?}", a.remarks);
    }
}

/// Of the right size it stays beside what is missing.
#[test]
fn an_effect_of_the_file_stays_beside_what_is_missing() {
    let robot = Robot::racbot();
    for (seed, drive, filed, missing) in [
        (41, false, ("wheel-radius-common", "scale", 0.02), ("camera-latency", "latency_s", 0.04)),
        (42, true, ("coulomb-friction", "torque_nm", 0.05), ("robot-mass", "scale", 0.4)),
    ] {
        let [file, other] = [filed, missing].map(|(name, parameter, value)| with(&robot, name, &[(parameter, value)]));
        let effects = [file.effects.clone(), other.effects].concat();
        let truth = Robot { effects, ..robot.clone() };
        let a = by(&file, &truth, drive, seed);
        assert_eq!(names(&a), [missing.0], "{}", a.terminal_summary());
        assert_eq!(written(&a), [filed.0, missing.0], "{}", a.terminal_summary());
    }
}

#[test]
fn an_effect_of_the_file_that_is_there_stays() {
    let robot = Robot::racbot();
    for (seed, drive, name, value) in
        [(36, false, "wheel-radius-common", ("scale", 0.03)), (37, true, "coulomb-friction", ("torque_nm", 0.05))]
    {
        let truth = with(&robot, name, &[value]);
        let a = by(&truth, &truth, drive, seed);
        assert_eq!((a.verdict, written(&a)), (Verdict::Agrees, vec![name]), "{}", a.terminal_summary());
    }
}
