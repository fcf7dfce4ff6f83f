//! `convert` with the pose in a second file.

use super::{data, racbot};
use runs::Run;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use tempfile::tempdir;

/// A run as its robot and a motion capture would have written it: counts on the robot's clock from its start, poses in
/// millimetres and degrees, x forward, in milliseconds of a clock that shows `ahead_s` more.
fn split(run: &Run, folder: &Path, name: &str, ahead_s: f64) {
    let wheels = run.counts.len();
    let mut log = format!("t,{}\n", (1..=wheels).map(|i| format!("motor{i}_ticks")).collect::<Vec<_>>().join(","));
    for k in 0..run.len() {
        let counts: Vec<String> = run.counts.iter().map(|c| c[k].to_string()).collect();
        let _ = writeln!(log, "{:.4},{}", run.t[k], counts.join(","));
    }
    let mut truth = "stamp_ms\tpos x [mm]\tpos y [mm]\tyaw [deg]\n".to_owned();
    for seen in &run.camera {
        let pose = seen.pose;
        let ms = 1e3 * (run.t[seen.tick] + ahead_s);
        let yaw = (pose.theta + std::f64::consts::FRAC_PI_2).to_degrees();
        let _ = writeln!(truth, "{ms:.1}\t{:.3}\t{:.3}\t{yaw:.4}", 1e3 * pose.x, 1e3 * pose.y);
    }
    fs::write(folder.join(format!("{name}.csv")), log).unwrap();
    fs::write(folder.join(format!("{name}_mocap.tsv")), truth).unwrap();
}

/// Names of the effects that `gap` finds, but those of clocks.
fn verdict(folder: &Path, set: &str) -> Vec<String> {
    let json = racbot(folder, &["--json", "gap", set]).json();
    let name = |e: &serde_json::Value| e["name"].as_str().unwrap().to_owned();
    let named = json["effects"].as_array().unwrap().iter().map(name);
    named.filter(|name| !name.starts_with("camera-")).collect()
}

#[test]
fn a_run_in_two_files_on_two_clocks_gets_the_verdict_of_one() {
    let folder = tempdir().unwrap();
    let path = folder.path();
    let whole = data("real/omni3-circles");
    fs::create_dir(path.join("set")).unwrap();
    fs::copy(whole.join("robot.toml"), path.join("set/robot.toml")).unwrap();
    for (run, ahead_s) in [(1, 1.7e9), (2, -12.0), (3, 0.31), (4, 5e4)] {
        let name = format!("run_{run:02}");
        let original = Run::read(whole.join(format!("{name}.csv"))).unwrap();
        split(&original, path, &name, ahead_s);
        let log = format!("{name}.csv");
        if run == 1 {
            let mocap = format!("{name}_mocap.tsv");
            racbot(path, &["convert", "--draft", &log, "map.toml", "--truth", &mocap]).done().fits_80_columns();
            let map = fs::read_to_string(path.join("map.toml")).unwrap();
            assert!(map.contains("file = \"{stem}_mocap.tsv\"") && map.contains("clock = \"match\""), "{map}");
        }
        let out = format!("set/{name}.csv");
        let json = racbot(path, &["--json", "convert", "map.toml", &log, &out]).json();
        let found = json["truth"]["offset_s"].as_f64().unwrap();
        // The latency of the camera is in it.
        assert!((found + ahead_s).abs() < 0.05, "{json}");
        assert!(json["truth"]["matched"]["share"].as_f64().unwrap() > 0.9, "{json}");
        let run = Run::read(path.join(&out)).unwrap();
        let left_out = ["before", "after"].map(|side| json["truth"][side].as_u64().unwrap() as usize);
        assert_eq!(run.camera.len() + left_out[0] + left_out[1], original.camera.len());
        assert!(left_out[0] + left_out[1] < 10, "{json}");
    }
    assert_eq!(verdict(path, "set"), verdict(path, whole.to_str().unwrap()));
}

#[test]
fn two_files_in_an_empty_folder_become_a_run_or_an_error_that_helps() {
    let folder = tempdir().unwrap();
    let path = folder.path();
    let original = Run::read(data("runs/wheel-skew/run_03.csv")).unwrap();
    split(&original, path, "drive7", 1.7e9);
    fs::rename(path.join("drive7_mocap.tsv"), path.join("take7.tsv")).unwrap();
    racbot(path, &["convert", "--draft", "drive7.csv", "map.toml", "--truth", "take7.tsv"]).done();
    let map = fs::read_to_string(path.join("map.toml")).unwrap();
    assert!(map.contains("file = \"take{number}.tsv\""), "{map}");
    let matched = racbot(path, &["convert", "map.toml", "drive7.csv", "a.csv"]).done().fits_80_columns();
    for part in ["added to its times: found by", "camera poses", "take7.tsv"] {
        assert!(matched.stdout.contains(part), "{}", matched.stdout);
    }
    fs::write(path.join("own.toml"), map.replace("clock = \"match\"", "clock = \"own\"")).unwrap();
    racbot(path, &["convert", "own.toml", "drive7.csv", "own.csv"]).done();
    let own = Run::read(path.join("own.csv")).unwrap();
    assert!(own.camera.len() + 2 >= original.camera.len(), "{}", own.camera.len());
    fs::write(path.join("same.toml"), map.replace("clock = \"match\"", "clock = \"same\"")).unwrap();
    racbot(path, &["convert", "same.toml", "drive7.csv", "b.csv"]).refused(
        1,
        &["take7.tsv: truth.clock", "1700000000", "nothing in common with those of drive7.csv", "clock = \"match\""],
    );
    let late = map.replace("clock = \"match\"", "clock = \"own\"\noffset_s = 2");
    fs::write(path.join("late.toml"), late).unwrap();
    let late = racbot(path, &["convert", "late.toml", "drive7.csv", "c.csv"]).done().fits_80_columns();
    assert!(late.stdout.contains("left out: 120 after") && late.stdout.contains("By the motion -"), "{}", late.stdout);
    racbot(path, &["convert", "map.toml", "drive7.csv", "d.csv", "--truth", "take8.tsv"])
        .refused(1, &["take8.tsv: ", "check the path"]);
    fs::write(path.join("one.toml"), "[columns]\nenc_1 = \"motor1_ticks\"\n").unwrap();
    racbot(path, &["convert", "one.toml", "drive7.csv", "d.csv", "--truth", "take7.tsv"])
        .refused(1, &["one.toml: has no [truth]", "--draft"]);
}

#[test]
fn a_folder_of_logs_becomes_a_folder_of_runs_in_one_call() {
    let folder = tempdir().unwrap();
    let path = folder.path();
    let logs = path.join("logs");
    fs::create_dir(&logs).unwrap();
    for run in 1..=3 {
        let original = Run::read(data(&format!("runs/wheel-skew/run_{run:02}.csv"))).unwrap();
        split(&original, &logs, &format!("drive{run}"), 100.0 * f64::from(run));
    }
    racbot(path, &["convert", "--draft", "logs/drive1.csv", "map.toml", "--truth", "logs/drive1_mocap.tsv"]).done();
    let map = fs::read_to_string(path.join("map.toml")).unwrap();
    // A drive there and back does not tell its offset.
    fs::write(path.join("map.toml"), map.replace("clock = \"match\"", "clock = \"own\"")).unwrap();
    let json = racbot(path, &["--json", "convert", "map.toml", "logs", "set/"]).json();
    let runs: Vec<&str> = json["runs"].as_array().unwrap().iter().map(|r| r["run"].as_str().unwrap()).collect();
    assert_eq!(runs, ["set/drive1.csv", "set/drive2.csv", "set/drive3.csv"], "{json}");
    for (run, r) in (1..).zip(json["runs"].as_array().unwrap()) {
        assert_eq!(r["truth"]["file"], format!("logs/drive{run}_mocap.tsv"), "{r}");
        assert!(Run::read(path.join(format!("set/drive{run}.csv"))).unwrap().camera.len() > 100);
    }
    // What is there stays, before anything is written.
    racbot(path, &["convert", "map.toml", "logs", "set/"]).refused(1, &["set/drive1.csv", "exists already"]);
    // A log that cannot be read is left out and named; the others are there.
    fs::write(logs.join("drive2.csv"), "t,motor1_ticks\n0,1\n1,nothing\n").unwrap();
    let bad = racbot(path, &["convert", "map.toml", "logs/drive1.csv", "logs/drive2.csv", "again/"]);
    assert_eq!(bad.code, Some(1), "{}", bad.stderr);
    assert!(bad.stdout.contains("left out: logs/drive2.csv: ") && bad.stdout.contains("again/drive1.csv: "));
    assert!(bad.stderr.contains("1 of 2 runs is left out: logs/drive2.csv: "), "{}", bad.stderr);
    assert!(path.join("again/drive1.csv").exists() && !path.join("again/drive2.csv").exists());
    let one =
        ["convert", "map.toml", "logs/drive1.csv", "logs/drive3.csv", "more/", "--truth", "logs/drive1_mocap.tsv"];
    racbot(path, &one).refused(2, &["one for all", "{stem}"]);
    let each =
        ["convert", "map.toml", "logs/drive1.csv", "logs/drive3.csv", "more/", "--truth", "logs/{stem}_mocap.tsv"];
    racbot(path, &each).done().fits_80_columns();
    racbot(path, &["convert", "map.toml", "logs/drive1.csv", "logs/drive3.csv", "out.csv"])
        .refused(2, &["out.csv", "folder"]);
}

#[test]
fn the_tests_of_a_characterised_machine_are_runs_of_one_map() {
    let folder = tempdir().unwrap();
    let path = folder.path();
    let mut tests = Vec::new();
    for (begins, (test, volts)) in
        [("fast-backward", -7.0), ("fast-forward", 7.0), ("slow-backward", -0.25)].iter().enumerate()
    {
        let row = |k: u32| {
            let t = 0.005 * f64::from(k);
            let u = if test.starts_with("slow") { volts * t } else { *volts };
            format!("[{}, {u}, {}, {}]", 100.0 * begins as f64 + t, 8.0 * u * t, 8.0 * u)
        };
        tests.push(format!("\"{test}\": [{}]", (0..400).map(row).collect::<Vec<_>>().join(", ")));
    }
    fs::write(path.join("sysid.json"), format!("{{{}, \"sysid\": true, \"test\": \"Simple\"}}", tests.join(", ")))
        .unwrap();
    racbot(path, &["convert", "--draft", "sysid.json", "map.toml"]).done().fits_80_columns();
    let map = fs::read_to_string(path.join("map.toml")).unwrap();
    assert!(map.contains("enc_1 = { from = \"position (rev)\", unit = \"rev\""), "{map}");
    assert!(map.contains("duty_1 = { from = \"motor_voltage\", scale = 0.1429 }"), "{map}");
    racbot(path, &["convert", "map.toml", "sysid.json", "run.csv"]).refused(1, &["3 recordings", "give a folder"]);
    let json = racbot(path, &["--json", "convert", "map.toml", "sysid.json", "set/"]).json();
    let runs: Vec<&str> = json["runs"].as_array().unwrap().iter().map(|r| r["run"].as_str().unwrap()).collect();
    assert_eq!(runs, ["set/sysid_fast-backward.csv", "set/sysid_fast-forward.csv", "set/sysid_slow-backward.csv"]);
    let fast = Run::read(path.join("set/sysid_fast-forward.csv")).unwrap();
    assert_eq!((fast.len(), fast.t[1]), (400, 0.005));
    assert!((fast.duty[0][200] - 1.0).abs() < 1e-3 && fast.counts[0][200] == (56.0 * 65_536.0) as i64);
}

#[test]
fn a_differential_drive_has_the_inertia_that_the_help_promises() {
    let folder = tempdir().unwrap();
    let duties = data("real/robojackets-excitation/run_01.csv");
    let init = ["init", "--track-mm", "200", "--radius-mm", "30", "--gear", "3", "--counts-per-motor-rev", "2048"];
    let motor = ["--resistance-ohm", "1", "--torque-constant", "0.02", "--rotor-inertia", "1e-5", "--supply-v", "18"];
    let log = ["--mass-kg", "2", "--log", duties.to_str().unwrap()];
    racbot(folder.path(), &[&init[..], &motor, &log].concat()).done();
    let text = fs::read_to_string(folder.path().join("robot.toml")).unwrap();
    // A disc of 2 kg and 0.1 m.
    assert!(text.contains("yaw_inertia_kg_m2 = 0.01 "), "{text}");
}

#[test]
fn the_printed_map_of_two_files_converts_them() {
    let page = fs::read_to_string(data("../docs/book/src/log-format.md")).unwrap();
    let mut blocks = page.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap());
    let map = blocks.find(|map| map.contains("[truth]\n")).unwrap();
    let folder = tempdir().unwrap();
    let path = folder.path();
    // Three rows do not tell an offset.
    fs::write(path.join("map.toml"), map.replace("clock = \"match\"", "clock = \"own\"")).unwrap();
    fs::write(path.join("run_1.csv"), "t,left/ticks,right/ticks\n7,1,2\n8,3,4\n9,5,6\n").unwrap();
    fs::write(path.join("run_1_mocap.csv"), "timestamp_ms,pos_x,pos_y,yaw\n100,1000,0,90\n1600,0,1000,0\n").unwrap();
    racbot(path, &["convert", "map.toml", "run_1.csv", "set/run_1.csv"]).done().fits_80_columns();
    let run = Run::read(path.join("set/run_1.csv")).unwrap();
    assert_eq!(run.t, [0.0, 1.0, 1.5, 2.0]);
    assert_eq!(
        run.camera.iter().map(|seen| (seen.tick, seen.pose.x, seen.pose.y)).collect::<Vec<_>>(),
        [(0, 1.0, 0.0), (2, 0.0, 1.0)]
    );
}
