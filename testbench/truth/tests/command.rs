//! The command as a user runs it.

use std::path::PathBuf;
use std::process::{Command, Output};

fn truth(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_truth")).args(arguments).output().expect("the command starts")
}

fn folder(name: &str) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    if path.exists() {
        std::fs::remove_dir_all(&path).expect("an old folder can be removed");
    }
    path
}

#[test]
fn sets_have_opaque_names_and_the_truth_stands_outside() {
    let out = folder("opaque");
    let text = out.to_string_lossy().into_owned();
    let run = truth(&["--out", &text, "--count", "2", "--seed", "4", "--kind", "single:floor-tilt:3"]);
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let sealed: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(out.join("truth-4.json")).unwrap()).unwrap();
    assert_eq!(sealed["sets"][1]["set"], "set-0002");
    assert_eq!(sealed["sets"][1]["effects"][0]["name"], "floor-tilt");
    assert!(sealed["sets"][1]["effects"][0]["parameters"]["x_rad"].is_f64());
    for entry in std::fs::read_dir(out.join("set-0001")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        assert!(name == "robot.toml" || name.starts_with("run_"), "{name}");
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(!text.contains("tilt") && !text.contains("seed"), "{name} gives the answer away");
    }
}

#[test]
fn wrong_requests_are_refused_with_a_reason() {
    for (arguments, reason) in [
        (vec!["--out", "x", "--kind", "single:wheel-skewed"], "wheel-skewed"),
        (vec!["--out", "x", "--kind", "single:wheel-skew:9"], "size 9"),
        (vec!["--out", "x", "--rate", "5"], "between 100 and 2000"),
        (vec![], "--out"),
    ] {
        let run = truth(&arguments);
        assert_eq!(run.status.code(), Some(2), "{arguments:?}");
        let message = String::from_utf8_lossy(&run.stderr).into_owned();
        assert!(message.contains(reason), "{arguments:?}: {message}");
    }
    let run = truth(&["--out", "/dev/null/nowhere", "--kind", "effect-free"]);
    assert_eq!(run.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&run.stderr).contains("/dev/null/nowhere"));
}

#[test]
fn the_list_names_every_effect() {
    let run = truth(&["--list"]);
    let text = String::from_utf8_lossy(&run.stdout).into_owned();
    for name in ["wheel-skew", "camera-timing", "gear-backlash", "late-sticking"] {
        assert!(text.contains(name), "{name}");
    }
}
