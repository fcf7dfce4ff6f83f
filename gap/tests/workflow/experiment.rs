//! The loop: an ambiguity, the drive that is proposed, and its end.

use super::common::{names, run, simulate, with};
use gap::{Options, analyse};
use model::manoeuvre::Manoeuvre;
use runs::robot::Robot;

/// Hides an effect in drives that cannot show what it is, follows the proposal, and returns its name.
fn settled(name: &str, parameters: &[(&str, f64)], poor: &[Manoeuvre], twin: &str) -> String {
    let truth = with(&Robot::racbot(), name, parameters);
    let mut set = simulate(&truth, poor, 7);
    let a = analyse(&set, &Options::default()).unwrap();
    let pair = |s: &Vec<String>| s.len() == 2 && s.iter().any(|n| n == name) && s.iter().any(|n| n == twin);
    assert!(a.alternatives.iter().any(pair), "{}", a.terminal_summary());
    let next = a.next_experiment.clone().expect("a proposal");
    assert_eq!(next.kind, "manoeuvre", "{next:?}");
    assert!(next.sigmas.unwrap() >= 5.0 && next.seconds < 120.0, "{next:?}");
    let manoeuvre = Manoeuvre::from_name(&next.what).unwrap();
    assert!(manoeuvre != Manoeuvre::Square);
    for k in 0..next.times {
        set.runs.push(run(&truth, manoeuvre, 900 + k as u64));
    }
    let a = analyse(&set, &Options::default()).unwrap();
    assert_eq!(names(&a), [name], "after {}: {}", next.what, a.terminal_summary());
    assert!(!a.alternatives.iter().any(pair), "after {}: {}", next.what, a.terminal_summary());
    next.what
}

#[test]
fn a_scale_is_settled_by_a_drive_that_turns() {
    settled("camera-scale", &[("scale", 0.03)], &[Manoeuvre::Square; 3], "wheel-radius-common");
}

#[test]
fn a_body_radius_is_settled_by_a_drive_that_does_not() {
    settled("body-radius", &[("scale", 0.05)], &[Manoeuvre::Spin; 2], "wheel-radius-common");
}

#[test]
fn an_inertia_is_settled_by_a_drive_that_does_not() {
    settled("yaw-inertia", &[("scale", 0.8)], &[Manoeuvre::Spin; 2], "rotor-inertia");
}

#[test]
fn what_no_drive_separates_is_to_be_measured() {
    let truth = with(&Robot::racbot(), "wheel-radius", &[("scale_2", 0.03)]);
    let set = simulate(&truth, &[Manoeuvre::Spin, Manoeuvre::Square], 8);
    let a = analyse(&set, &Options::default()).unwrap();
    let twins = a.alternatives.first().expect("a set");
    let next = a.next_experiment.as_ref().expect("a proposal");
    assert!(twins.iter().any(|n| n == "encoder-scale"), "{twins:?}");
    assert_eq!((next.kind, next.seconds), ("measurement", 120.0), "{next:?}");
}
