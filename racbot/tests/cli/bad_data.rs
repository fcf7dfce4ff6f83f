//! Bad data: exit code 1 and one line with file, place, field, what is wrong and what to do.

use super::{data, racbot};
use std::fs;
use std::path::Path;
use tempfile::tempdir;

fn robot_toml() -> String {
    fs::read_to_string(data("robot.toml")).unwrap()
}

#[test]
fn robots_that_are_none_are_refused_with_line_and_field() {
    let folder = tempdir().unwrap();
    let wheel = "\n[[wheel]]\nx_m = 0.0\ny_m = 0.085\ndrive_rad = 0.0\nroller_rad = 0.0\n";
    let table = [
        (robot_toml().replace("mass_kg = 2.4\n", ""), "robot.toml:1:1: mass_kg: is missing"),
        (robot_toml().replace("mass_kg = 2.4", "mass_kg = -2.4"), "robot.toml:5:11: mass_kg: -2.4 is not positive"),
        (robot_toml().replace("supply_v = 7.2", "supply_v = nan"), "supply_v: "),
        (robot_toml().replace("supply_v = 7.2", "supply_v = inf"), "supply_v: "),
        (robot_toml().replace("mass_kg", "mas_kg"), "mas_kg: "),
        (robot_toml() + wheel, "wheel"),
        ("wheel_radius_m = = 1".to_owned(), "robot.toml:1:"),
    ];
    for (text, part) in table {
        fs::write(folder.path().join("robot.toml"), text).unwrap();
        for command in [&["simulate", "--robot", "robot.toml"], &["simulate", "--hidden", "robot.toml"]] {
            racbot(folder.path(), command).refused(1, &["robot.toml", part]);
        }
    }
    racbot(folder.path(), &["simulate", "--robot", "nowhere.toml"]).refused(1, &["nowhere.toml: ", "check the path"]);
    assert!(!folder.path().join("out").exists(), "nothing is written before the input is read");
}

#[test]
fn robots_that_do_not_fit_the_card_or_each_other_are_refused() {
    let folder = tempdir().unwrap();
    let fast = robot_toml().replace("control_rate_hz = 1000", "control_rate_hz = 50000");
    fs::write(folder.path().join("fast.toml"), fast).unwrap();
    racbot(folder.path(), &["simulate", "--robot", "fast.toml"]).refused(1, &["fast.toml: ", "50000 Hz"]);
    let four = data("robot-four-wheels.toml");
    racbot(folder.path(), &["simulate", "--hidden", four.to_str().unwrap()])
        .refused(1, &["robot-four-wheels.toml: has 4 wheels, but the robot 3"]);
}

#[test]
fn set_points_with_three_numbers_are_refused() {
    let folder = tempdir().unwrap();
    for (name, text, part) in [
        ("points.csv", "3,3,1,0.5\n3,0,1\n", "points.csv:2:1: 3 values instead of 4"),
        ("points.csv", "3,3,inf,0.5\n", "points.csv:1:1: v: inf is not finite"),
        ("points.csv", "", "points.csv: holds no set points"),
        ("points.toml", "[[set_point]]\nx = 1\ny = 1\nv = 1\n", "points.toml:1:1: omega: is missing"),
    ] {
        fs::write(folder.path().join(name), text).unwrap();
        racbot(folder.path(), &["simulate", "--setpoints", name]).refused(1, &[part]);
    }
}

fn data_set(folder: &Path, run: &str) {
    fs::write(folder.join("robot.toml"), robot_toml()).unwrap();
    fs::write(folder.join("run.csv"), run).unwrap();
}

#[test]
fn logs_that_cannot_be_are_refused_with_line_and_column() {
    let header = "t,ref_1,ref_2,ref_3,enc_1,enc_2,enc_3,duty_1,duty_2,duty_3\n";
    let row = |t: &str, enc: &str, duty: &str| format!("{t},0,0,0,{enc},0,0,{duty},0,0\n");
    let table = [
        (row("0.0", "0", "0") + &row("0.002", "1", "0") + &row("0.001", "2", "0"), "run.csv:4:1: t: "),
        (row("0.0", "0", "0") + &row("0.001", "4000", "0"), "run.csv:3: enc_1: jumps by 4000 counts"),
        (row("0.0", "0", "NaN"), "run.csv:2:17: duty_1: NaN is not a finite number"),
        (row("0.0", "0", "inf"), "run.csv:2:17: duty_1: "),
        (row("0.0", "fast", "0"), "run.csv:2:11: enc_1: "),
        ("0.0,0\n0.001,0\n".to_owned(), "run.csv:"),
    ];
    for (rows, part) in table {
        let folder = tempdir().unwrap();
        data_set(folder.path(), &format!("{header}{rows}"));
        for command in ["replay", "calibrate"] {
            racbot(folder.path(), &[command, "."]).refused(1, &[part]);
        }
    }
    let folder = tempdir().unwrap();
    racbot(folder.path(), &["replay", "."]).refused(1, &[".: has no robot.toml"]);
    fs::write(folder.path().join("robot.toml"), robot_toml()).unwrap();
    racbot(folder.path(), &["replay", "."]).refused(1, &[".: holds no runs"]);
    racbot(folder.path(), &["replay", "nowhere"]).refused(1, &["nowhere"]);
}

#[test]
fn folders_that_cannot_be_written_are_named() {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("file"), "in the way").unwrap();
    racbot(folder.path(), &["simulate", "--limit-s", "0.01", "--out", "file/run"]).refused(1, &["file/run: "]);
    racbot(folder.path(), &["generate", "--out", "file/generated"]).refused(1, &["file/generated: "]);
}

#[test]
fn stale_gateware_is_named_with_its_line() {
    let folder = tempdir().unwrap();
    racbot(folder.path(), &["generate"]).done();
    let ucf = folder.path().join("generated/rac4i65.ucf");
    let text = fs::read_to_string(&ucf).unwrap();
    fs::write(&ucf, text.replacen('\n', "\n# by hand\n", 3)).unwrap();
    let outcome = racbot(folder.path(), &["generate", "--check"]);
    assert_eq!(outcome.code, Some(1));
    assert!(outcome.stdout.contains("differs from line 2 on"), "{}", outcome.stdout);
    assert!(outcome.stderr.starts_with("racbot: generated/rac4i65.ucf:2: "), "{}", outcome.stderr);
    fs::remove_file(&ucf).unwrap();
    racbot(folder.path(), &["generate", "--check"]).refused(1, &["generated/rac4i65.ucf: "]);
}

#[test]
fn an_effect_of_ones_own_that_is_none_is_shown_with_a_caret() {
    let folder = tempdir().unwrap();
    let set = data("runs/wheel-skew");
    let good = fs::read_to_string(data("effects/air-drag.toml")).unwrap();
    let table = [
        (good.replace("abs(w)", "abs(ww)"), "`ww` is no signal or parameter"),
        (good.replace("-c * w", "-c * * w"), "does not belong here"),
        (good.replace("air-drag", "wheel-skew"), "must be in kebab-case and not that of an effect of the catalogue"),
        (good.replace("torque =", "torqe ="), "torqe is not known"),
        (good.replace("scale = 1e-7", "scale = 0.0"), "parameters.c: give a scale greater than 0"),
        (good.replace("[parameters]", "wheels = [7]\n[parameters]"), "wheel 7"),
    ];
    for (text, part) in table {
        fs::write(folder.path().join("own.toml"), text).unwrap();
        let outcome = racbot(folder.path(), &["gap", set.to_str().unwrap(), "--effect", "own.toml"]);
        assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(1), ""), "{}", outcome.stderr);
        assert!(outcome.stderr.contains(part), "no {part:?} in {}", outcome.stderr);
        let caret = outcome.stderr.lines().any(|line| line.trim() == "^");
        assert_eq!(caret, part.starts_with('`') || part.starts_with("does"), "{}", outcome.stderr);
    }
    racbot(folder.path(), &["gap", set.to_str().unwrap(), "--effect", "nowhere.toml"]).refused(1, &["nowhere.toml"]);
}

#[test]
fn effects_that_nothing_reads_are_refused_with_line_and_column() {
    let folder = tempdir().unwrap();
    data_set(folder.path(), "t,enc_1,enc_2,enc_3\n0,0,0,0\n0.001,0,0,0\n");
    let lines = robot_toml().lines().count();
    let table = [
        (
            "viscous-frictoin",
            "coefficient_nms",
            3,
            1,
            "effect.name: viscous-frictoin is no effect",
            "viscous-friction?",
        ),
        (
            "wheel-skew",
            "skew_1_rat",
            5,
            1,
            "effect.parameters.skew_1_rat: wheel-skew has no",
            "did you mean skew_1_rad?",
        ),
    ];
    for (name, parameter, line, column, what, hint) in table {
        let effect = format!("\n[[effect]]\nname = \"{name}\"\n[effect.parameters]\n{parameter} = 0.01\n");
        fs::write(folder.path().join("robot.toml"), robot_toml() + &effect).unwrap();
        let place = format!("robot.toml:{}:{column}: {what}", lines + line);
        for command in [&["check", "."][..], &["gap", "."], &["simulate", "--hidden", "robot.toml"]] {
            racbot(folder.path(), command).refused(1, &[&place, hint]);
        }
    }
    // One that gap wrote for an effect of somebody's own is none of the catalogue's.
    let own = "\n[[effect]]\nname = \"air-drag\"\n[effect.parameters]\nb = 0.01\n";
    fs::write(folder.path().join("robot.toml"), robot_toml() + own).unwrap();
    racbot(folder.path(), &["gap", "."]).refused(1, &["air-drag is no effect", "comes with --effect FILE"]);
}

#[test]
fn a_manoeuvre_does_not_join_another_robots_data() {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("robot.toml"), robot_toml().replace("mass_kg = 2.4", "mass_kg = 3.4")).unwrap();
    let arguments = ["simulate", "--manoeuvre", "spin", "--out", "."];
    racbot(folder.path(), &arguments).refused(1, &["robot.toml: describes another robot", "--out"]);
    assert!(!folder.path().join("run.csv").exists());
}
