//! Two effects at once, and one that looks like two.

use super::common::{RICH, cut_all, names, simulate, value, with};
use gap::{Analysis, Options, analyse};
use model::manoeuvre::Manoeuvre;
use runs::robot::Robot;

type Hidden<'a> = (&'a str, &'a [(&'a str, f64)]);

fn looked(effects: &[Hidden], drives: &[Manoeuvre], seed: u64) -> Analysis {
    let all = effects.iter().flat_map(|(name, parameters)| with(&Robot::racbot(), name, parameters).effects);
    let truth = Robot { effects: all.collect(), ..Robot::racbot() };
    let mut set = simulate(&truth, drives, seed);
    cut_all(&mut set, 9.0);
    analyse(&set, &Options::default()).unwrap()
}

fn listed(a: &Analysis, names: &[&str]) -> bool {
    a.alternatives.iter().any(|set| names.iter().all(|n| set.iter().any(|s| s == n)))
}

/// A straight line from the nominal inertia leads below nothing; the mass alone would take half of it on.
#[test]
fn an_effect_too_large_for_a_straight_line_is_found_beside_another() {
    let a = looked(&[("robot-mass", &[("scale", 0.2)]), ("yaw-inertia", &[("scale", -0.65)])], &RICH, 81);
    assert!(names(&a).contains(&"yaw-inertia"), "{}", a.terminal_summary());
    let yaw = a.effects.iter().find(|e| e.name == "yaw-inertia").unwrap().parameters[0].1;
    assert!((yaw / -0.65 - 1.0).abs() < 0.15, "{yaw}");
    assert!(names(&a).contains(&"robot-mass") || listed(&a, &["robot-mass"]), "{}", a.terminal_summary());
}

/// What the first effect leaves in the generic regression is no noise that may hide the second.
#[test]
fn a_large_effect_does_not_hide_a_small_one_in_the_floor() {
    let hidden: [Hidden; 2] =
        [("roller-friction", &[("force_n", 1.3)]), ("coulomb-friction", &[("torque_1_nm", 0.014)])];
    let a = looked(&hidden, &RICH, 82);
    let mut found = names(&a);
    found.sort_unstable();
    assert_eq!(found, ["coulomb-friction", "roller-friction"], "{}", a.terminal_summary());
    assert!((value(&a, "torque_1_nm") / 0.014 - 1.0).abs() < 0.3, "{}", a.terminal_summary());
}

/// A camera's scale is wheels and body too large by the same share: one name, and the two beside it.
#[test]
fn one_effect_is_named_in_place_of_two_that_look_like_it() {
    let a = looked(&[("camera-scale", &[("scale", 0.015)])], &RICH, 83);
    assert_eq!(names(&a), ["camera-scale"], "{}", a.terminal_summary());
    assert!(listed(&a, &["camera-scale", "wheel-radius-common", "body-radius"]), "{:?}", a.alternatives);
    let two: [Hidden; 2] = [("wheel-radius-common", &[("scale", 0.015)]), ("body-radius", &[("scale", 0.015)])];
    let b = looked(&two, &RICH, 83);
    assert_eq!(names(&b), ["camera-scale"], "{}", b.terminal_summary());
    assert!(listed(&b, &["camera-scale", "wheel-radius-common", "body-radius"]), "{:?}", b.alternatives);
    assert!(b.terminal_summary().contains("camera-scale, or wheel-radius-common with body-radius"));
}

/// Neither of the two shows anything alone, and of both only the turns remain, as of a body that is larger.
#[test]
fn two_that_cancel_but_for_one_sign_are_listed_beside_what_they_look_like() {
    let two: [Hidden; 2] = [("wheel-radius-common", &[("scale", 0.02)]), ("camera-scale", &[("scale", -0.0196)])];
    let a = looked(&two, &RICH, 85);
    assert_eq!(names(&a), ["body-radius"], "{}", a.terminal_summary());
    assert!(listed(&a, &["body-radius", "wheel-radius-common", "camera-scale"]), "{:?}", a.alternatives);
}

/// Lost counts at every speed are a larger wheel, however many counts must be lost before it matters.
#[test]
fn a_twin_is_listed_whatever_size_would_be_material_under_its_name() {
    let a = looked(&[("wheel-radius", &[("scale_1", 0.015)])], &RICH, 84);
    assert_eq!(names(&a), ["wheel-radius"], "{}", a.terminal_summary());
    assert!(listed(&a, &["wheel-radius", "encoder-loss"]), "{:?}", a.alternatives);
    let b = looked(&[("wheel-radius", &[("scale_1", -0.015)])], &RICH, 84);
    assert!(!listed(&b, &["encoder-loss"]), "no encoder gains counts: {:?}", b.alternatives);
}
