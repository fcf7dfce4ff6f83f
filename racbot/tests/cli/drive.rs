//! Commands that work on a card, over the built-in one.

use super::{data, racbot};
use runs::Run;

#[test]
fn a_drive_reaches_its_set_points_and_leaves_a_data_set_for_the_other_commands() {
    let folder = tempfile::tempdir().unwrap();
    let points = data("set-points/square.toml");
    let points = points.to_str().unwrap();
    let arguments = ["drive", "--card", "virtual", "--setpoints", points, "--camera", "--skew-deg", "4,-3,2"];
    for file in ["set/a.csv", "set/b.mcap"] {
        let text =
            racbot(folder.path(), &[&arguments[..], &["--record", file]].concat()).done().fits_80_columns().stdout;
        assert!(text.contains("at rest") && text.contains("outputs off") && !text.contains("not reached"), "{text}");
    }
    let json = racbot(folder.path(), &[&arguments[..], &["--json"]].concat()).done().json();
    assert_eq!((json["ended"].as_str(), json["outputs_off"].as_bool()), (Some("finished"), Some(true)));
    assert_eq!(json["set_points"][3]["state"], "reached");
    let [csv, mcap] = ["set/a.csv", "set/b.mcap"].map(|name| Run::read(folder.path().join(name)).unwrap());
    assert_eq!(Run { name: csv.name.clone(), ..mcap }, csv);
    let replayed = racbot(folder.path(), &["replay", "set", "--json"]).done().json();
    let off = replayed["runs"][1]["wheels"][0]["fpga_against_log"]["max_lsb"].as_f64().unwrap();
    assert!(off < 0.5, "every duty to the last bit: {off}");
    let found = racbot(folder.path(), &["calibrate", "set", "--json"]).done().json();
    let interval: Vec<f64> = found["ci95"][0].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
    let middle = (0.5 * (interval[0] + interval[1])).to_degrees();
    assert!((middle - 4.0).abs() < 0.3, "{found}");
}

#[test]
fn what_cannot_be_driven_is_refused_before_a_card_is_touched() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("bad.csv"), "0,0,fast,0\n").unwrap();
    let points = data("set-points/fig-6.csv");
    let points = points.to_str().unwrap();
    let run = |arguments: &[&str]| racbot(folder.path(), arguments);
    run(&["drive", "--setpoints", "bad.csv"]).refused(1, &["bad.csv:1:5: v: \"fast\" is no number"]);
    run(&["drive", "--setpoints", points, "--limit-s", "0"])
        .refused(2, &["--limit-s: 0 is not more than 0 and at most 3600"]);
    run(&["drive", "--setpoints", points, "--skew-deg", "1,2,3"]).refused(2, &["--card virtual"]);
    run(&["drive", "--setpoints", points, "--card", "virtual", "--record", "/proc/no/run.csv"])
        .refused(1, &["/proc/no"]);
    // A run of this name would be read by nothing.
    run(&["drive", "--setpoints", points, "--card", "virtual", "--record", "run.txt"])
        .refused(1, &["run.txt: is neither *.csv nor *.mcap"]);
    run(&["kick", "--card", "virtual", "--charge-s", "17"]).refused(2, &["--charge-s: 17 is not between 0 and 16"]);
    run(&["kick", "--card", "9999:00:00.0"]).refused(1, &[]);
    run(&["latency", "--seconds", "-1"]).refused(2, &[]);
}

#[test]
fn a_robot_that_cannot_get_there_ends_with_a_fault_that_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let points = data("set-points/fig-6.csv");
    let weak = std::fs::read_to_string(data("robot.toml")).unwrap();
    let weak = weak.lines().map(|l| if l.starts_with("friction_torque") { "friction_torque = 0.5" } else { l });
    std::fs::write(folder.path().join("weak.toml"), weak.collect::<Vec<_>>().join("\n")).unwrap();
    let arguments = ["drive", "--card", "virtual", "--setpoints", points.to_str().unwrap(), "--hidden", "weak.toml"];
    let outcome = racbot(folder.path(), &arguments);
    assert_eq!(outcome.code, Some(1));
    assert!(outcome.stderr.contains("driven hard, but the encoder stands still"), "{}", outcome.stderr);
    assert!(outcome.stdout.contains("with a fault") && outcome.stdout.contains("outputs off"), "{}", outcome.stdout);
}

/// The drive was driven, whatever became of its files: who drove it is told of both.
#[test]
fn a_drive_whose_robot_cannot_be_written_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    // A link to nowhere is there, and no file that says what the robot is.
    std::os::unix::fs::symlink("/proc/self/no/robot.toml", folder.path().join("robot.toml")).unwrap();
    let points = data("set-points/fig-6.csv");
    let points = points.to_str().unwrap();
    for more in [
        &["drive", "--card", "virtual", "--setpoints", points, "--limit-s", "0.5", "--record", "run.csv"][..],
        &["serve", "--card", "virtual", "--ports", "0,0,0", "--seconds", "0.5", "--record", "other.csv"],
    ] {
        let outcome = racbot(folder.path(), more);
        assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
        assert!(outcome.stderr.contains("robot.toml: exists already"), "{}", outcome.stderr);
        assert!(outcome.stdout.contains("ended ") && outcome.stdout.contains("recorded "), "{}", outcome.stdout);
    }
}

#[test]
fn kick_monitor_and_latency_answer_people_and_programs() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| racbot(folder.path(), arguments).done();
    let kicked = run(&["kick", "--card", "virtual", "--charge-s", "0.05", "--pulse-us", "3000", "--json"]).json();
    assert_eq!(kicked["pulse_us"], 3_000);
    let picture = run(&["monitor", "--card", "virtual", "--once"]).fits_80_columns().stdout;
    assert!(picture.contains("disarmed") && picture.lines().count() <= 24, "{picture}");
    assert_eq!(run(&["monitor", "--card", "virtual", "--json"]).json()["armed"], false);
    let text = run(&["latency", "--seconds", "0.2"]).fits_80_columns().stdout;
    assert!(text.contains("T: 0") && text.contains("missed periods"), "{text}");
    let json = run(&["latency", "--seconds", "0.2", "--period-us", "500", "--json"]).json();
    assert_eq!(json["cycles"], 400);
    let counted: u64 = json["histogram"].as_array().unwrap().iter().map(|bar| bar["count"].as_u64().unwrap()).sum();
    assert_eq!(counted, 400);
}
