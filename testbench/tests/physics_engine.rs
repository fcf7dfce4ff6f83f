//! `gap` on logs of a rigid-body engine that is not ours (MuJoCo, `testbench/engine`): fixed seeds, whose truth only this test reads.

use std::path::Path;
use std::process::Command;

use gap::{Analysis, Options, Verdict, analyse};
use runs::DataSet;
use serde_json::Value;

/// Has the engine make a set in which `hidden` is, and the workflow look at it.
fn look(hidden: &str, seed: u64) -> (Analysis, Value) {
    look_at(hidden, seed, &[])
}

/// The same with more said to the engine.
fn look_at(hidden: &str, seed: u64, more: &[&str]) -> (Analysis, Value) {
    let scratch = tempfile::tempdir().unwrap();
    let (set, truth) = (scratch.path().join("set"), scratch.path().join("sealed/truth.json"));
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("engine/make.py");
    let output = Command::new("python3")
        .arg("-B")
        .arg(&script)
        .args(["--hide", hidden, "--seed", &seed.to_string(), "--out"])
        .arg(&set)
        .arg("--truth")
        .arg(&truth)
        .args(more)
        .output()
        .unwrap_or_else(|error| panic!("python3: {error}"));
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{complaint}\n./test.sh installs mujoco into target/python");
    let analysis = analyse(&DataSet::open(&set).unwrap(), &Options::default()).unwrap();
    let truth: Value = serde_json::from_str(&std::fs::read_to_string(&truth).unwrap()).unwrap();
    (analysis, truth["hidden"][0].clone())
}

/// Nothing is named where nothing is hidden.
fn agrees(seed: u64, more: &[&str]) {
    let (analysis, _) = look_at("", seed, more);
    assert_eq!(analysis.verdict, Verdict::Agrees, "{}", analysis.terminal_summary());
    assert!(analysis.effects.is_empty(), "{}", analysis.terminal_summary());
}

/// Nothing but what is hidden is named, and every parameter is right within `share` of the largest.
fn named_alone(hidden: &str, seed: u64, share: f64) {
    let (analysis, truth) = look(hidden, seed);
    assert_eq!(analysis.verdict, Verdict::MissingEffect, "{}", analysis.terminal_summary());
    let [effect] = &analysis.effects[..] else { panic!("{}", analysis.terminal_summary()) };
    assert_eq!(truth["name"], effect.name.as_str());
    let wheels: Vec<u64> = truth["wheels"].as_array().unwrap().iter().map(|w| w.as_u64().unwrap()).collect();
    assert!(effect.wheels.iter().all(|w| wheels.contains(&(*w as u64))), "{:?}, in truth {wheels:?}", effect.wheels);
    let sizes = truth["parameters"].as_object().unwrap();
    let largest = sizes.values().map(|x| x.as_f64().unwrap().abs()).fold(0.0, f64::max);
    for (name, x) in sizes {
        let found = effect.parameters.iter().find(|p| p.0 == *name).map_or(0.0, |p| p.1);
        let true_size = x.as_f64().unwrap();
        assert!((found - true_size).abs() < share * largest, "{name}: {found}, in truth {true_size}");
    }
}

#[test]
fn a_robot_as_drawn_agrees_on_logs_of_a_physics_engine() {
    agrees(1, &[]);
}

#[test]
fn skew_is_named_on_logs_of_a_physics_engine() {
    named_alone("wheel-skew", 1, 0.06);
}

#[test]
fn friction_of_a_wheel_is_named_on_logs_of_a_physics_engine() {
    named_alone("coulomb-friction/wheel", 1, 0.2);
}

#[test]
fn late_commands_are_named_on_logs_of_a_physics_engine() {
    named_alone("command-latency", 1, 0.05);
}

#[test]
fn another_robot_as_drawn_agrees_on_logs_of_a_physics_engine() {
    // Four wheels, 2.35 kg, a loop and a camera of 100 Hz.
    agrees(32, &["--varied"]);
}

#[test]
fn creep_is_named_on_logs_of_a_physics_engine() {
    named_alone("wheel-creep", 1, 0.12);
}

#[test]
fn a_rotor_that_rattles_in_play_is_named_on_logs_of_a_physics_engine() {
    let (analysis, truth) = look("gear-backlash/stiff", 1);
    let [effect] = &analysis.effects[..] else { panic!("{}", analysis.terminal_summary()) };
    assert_eq!(effect.name, "gear-backlash");
    let play = truth["parameters"]["play_rad"].as_f64().unwrap();
    let (name, _, interval) = &effect.parameters[0];
    let [low, high] = interval.ends().expect("an interval");
    assert!(name == "play_rad" && low < play && play < high, "{name} from {low} to {high}, in truth {play}");
}
