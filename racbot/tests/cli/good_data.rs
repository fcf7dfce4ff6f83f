//! What works, works: tables that fit the terminal, JSON that parses, files that other commands read.

use super::{data, racbot};
use std::fs;
use std::process::{Command, Stdio};
use tempfile::tempdir;

#[test]
fn simulate_drives_fig_6_and_its_run_replays_bit_for_bit() {
    let folder = tempdir().unwrap();
    let outcome = racbot(folder.path(), &["simulate", "--out", "drive"]).done().fits_80_columns();
    assert!(!outcome.stdout.contains("missed") && outcome.stdout.contains("at rest"), "{}", outcome.stdout);
    for (name, start) in [("trajectory.svg", "<svg"), ("speeds.svg", "<svg"), ("run.csv", "t,cmd_vx")] {
        let text = fs::read_to_string(folder.path().join("drive").join(name)).unwrap();
        assert!(text.starts_with(start) && !text.contains("NaN"), "{name}");
    }
    let robot = fs::read_to_string(folder.path().join("drive/robot.toml")).unwrap();
    assert!(robot.contains("arithmetic = \"fixed-kin\"") && robot.contains("registers = {"), "{robot}");

    let replayed = racbot(folder.path(), &["replay", "drive", "--json"]).done().json();
    let wheels = replayed["runs"][0]["wheels"].as_array().unwrap();
    assert_eq!(wheels.len(), 3);
    for wheel in wheels {
        assert!(wheel["fpga_against_log"]["max_lsb"].as_f64().unwrap() < 0.1, "{wheel}");
        assert!(wheel["fpga_against_log"]["ticks"].as_u64().unwrap() > 10_000, "{wheel}");
    }
}

#[test]
fn hidden_skew_leads_astray_the_camera_leads_back_and_calibration_finds_it() {
    let folder = tempdir().unwrap();
    let astray = ["simulate", "--skew-deg", "4,-3,2", "--out", "red"];
    let outcome = racbot(folder.path(), &astray).done().fits_80_columns();
    assert!(outcome.stdout.contains("missed"), "{}", outcome.stdout);

    let hidden = data("robot-skewed.toml");
    let corrected = ["--json", "simulate", "--hidden", hidden.to_str().unwrap(), "--camera", "--out", "blue"];
    let json = racbot(folder.path(), &corrected).done().json();
    assert!(json["time_s"].as_f64().is_some_and(|t| t < 20.0), "{json}");
    assert!(json["path_error_max_m"].as_f64().unwrap() < 0.1, "{json}");

    let found = racbot(folder.path(), &["calibrate", "red", "--json", "--out", "found"]).done().json();
    let skew = |i: usize| found["skew_rad"][i].as_f64().unwrap().to_degrees();
    assert!((skew(0) - skew(1) - 7.0).abs() < 0.3 && (skew(0) - skew(2) - 2.0).abs() < 0.3, "{found}");
    assert!(
        fs::read_to_string(folder.path().join("found/configuration.csv")).unwrap().starts_with("offset,word\n0x400,")
    );
    let again = ["simulate", "--robot", "found/robot.toml", "--hidden", hidden.to_str().unwrap(), "--out", "green"];
    let outcome = racbot(folder.path(), &again).done();
    assert!(!outcome.stdout.contains("missed"), "{}", outcome.stdout);
}

#[test]
fn the_papers_procedure_ends_where_its_mathematics_says() {
    let folder = tempdir().unwrap();
    let arguments = ["calibrate", "--procedure", "paper", "--skew-deg", "4,-3,2", "--out", "paper"];
    let outcome = racbot(folder.path(), &arguments).done().fits_80_columns();
    assert!(outcome.stdout.contains("straighten, round 2"), "{}", outcome.stdout);
    assert!(folder.path().join("paper/trajectory.svg").exists());
    let json = racbot(folder.path(), &[&arguments[..], &["--json", "--force"]].concat()).done().json();
    for (i, truth) in [4.0, -3.0, 2.0].into_iter().enumerate() {
        let found = json["skew_rad"][i].as_f64().unwrap().to_degrees();
        assert!((found - truth).abs() < 0.4, "wheel {}: {found}", i + 1);
    }
    assert_eq!(json["configuration"].as_array().map(Vec::len), Some(52));
}

#[test]
fn the_gap_of_a_skewed_robot_is_named_said_to_be_typed_in_and_taken_back() {
    let folder = tempdir().unwrap();
    let (set, own) = (data("runs/wheel-skew"), data("effects/air-drag.toml"));
    let arguments = ["gap", set.to_str().unwrap(), "--effect", own.to_str().unwrap(), "--out", "gap"];
    let outcome = racbot(folder.path(), &arguments).done().fits_80_columns();
    assert!(outcome.stdout.contains("air-drag, an effect of yours, is not named"), "{}", outcome.stdout);
    let report = fs::read_to_string(folder.path().join("gap/report.html")).unwrap();
    assert!(report.contains("air-drag, an effect of yours, is not named"));
    let line = outcome.stdout.lines().skip_while(|l| !l.contains("wheels_from_body[3][3]")).nth(1).unwrap();
    assert!(report.contains(line), "{line}");
    // Wheel 1, in front, drives to the right; skewed by 4 degrees clockwise, a little to the back.
    let row: Vec<f64> = line
        .trim_matches([' ', '{', '}', ','])
        .split("f, ")
        .map(|x| x.trim_end_matches('f').parse().unwrap())
        .collect();
    let (skew, r) = (4.0_f64.to_radians(), 0.0275);
    let true_row = [-skew.sin() / r, -skew.cos() / r, -0.085 * skew.cos() / r];
    assert!(row.iter().zip(true_row).all(|(a, b)| (a - b).abs() < 0.3), "{row:?} {true_row:?}");

    assert!(outcome.stdout.contains("wheel-skew"), "{}", outcome.stdout);
    let json = fs::read_to_string(folder.path().join("gap/gap.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(
        (json["verdict"].as_str(), json["effects"][0]["name"].as_str()),
        (Some("missing-effect"), Some("wheel-skew"))
    );
    assert!(fs::read_to_string(folder.path().join("gap/report.html")).unwrap().contains("<svg"));

    racbot(folder.path(), &["gap", "--undo", "wheel-skew", "--robot", "gap/robot.toml"]).done();
    assert!(!fs::read_to_string(folder.path().join("gap/robot.toml")).unwrap().contains("wheel-skew"));
    racbot(folder.path(), &["gap", "--undo", "wheel-skew", "--robot", "gap/robot.toml"])
        .refused(1, &["gap/robot.toml: carries no effect wheel-skew"]);
}

#[test]
fn the_catalogue_is_listed_and_described() {
    let folder = tempdir().unwrap();
    let list = racbot(folder.path(), &["gap", "--list"]).done().fits_80_columns();
    assert!(
        list.stdout.contains("wheel-skew (motion)") && list.stdout.contains("pi-gain (controller)"),
        "{}",
        list.stdout
    );
    let page = racbot(folder.path(), &["gap", "--list", "gear-backlash"]).done();
    assert!(page.stdout.contains("play_i_rad") && page.stdout.contains("Nordin and Gutman 2002"), "{}", page.stdout);
    racbot(folder.path(), &["gap", "--list", "wheel-skw"])
        .refused(2, &["no effect wheel-skw; did you mean wheel-skew?"]);
    let json = racbot(folder.path(), &["--json", "gap", "--list"]).done().json();
    let effects = json["effects"].as_array().unwrap();
    assert!(effects.len() > 40);
    let skew = effects.iter().find(|effect| effect["name"] == "wheel-skew").unwrap();
    assert_eq!(skew["twins"]["always"], serde_json::json!(["wheel-angle"]));
}

#[test]
fn the_seed_decides_the_run() {
    let folder = tempdir().unwrap();
    let drive = |seed: &str, out: &str| {
        racbot(folder.path(), &["simulate", "--limit-s", "0.3", "--seed", seed, "--out", out]).done();
        fs::read(folder.path().join(out).join("run.csv")).unwrap()
    };
    let first = drive("7", "a");
    assert_eq!(first, drive("7", "b"));
    assert_ne!(first, drive("8", "c"));
}

#[test]
fn example_set_points_and_four_wheels_are_driven() {
    let folder = tempdir().unwrap();
    let (points, robot) = (data("set-points/fig-6.csv"), data("robot-four-wheels.toml"));
    for arguments in [&["--setpoints", points.to_str().unwrap()], &["--robot", robot.to_str().unwrap()]] {
        let outcome = racbot(folder.path(), &[&["simulate"], &arguments[..]].concat()).done().fits_80_columns();
        assert!(!outcome.stdout.contains("missed"), "{}", outcome.stdout);
    }
    let square = data("set-points/square.toml");
    let outcome = racbot(folder.path(), &["simulate", "--setpoints", square.to_str().unwrap()]).done();
    assert!(outcome.stdout.contains("stop"), "{}", outcome.stdout);
}

#[test]
fn the_measured_log_replays_within_its_rounding() {
    let folder = tempdir().unwrap();
    let set = data("runs/wheel-skew");
    let replay = |more: &[&str]| {
        racbot(folder.path(), &[&["replay", set.to_str().unwrap()], more].concat()).done().fits_80_columns()
    };
    let outcome = replay(&["--out", "pictures"]);
    assert!(outcome.stdout.contains("run_04"), "{}", outcome.stdout);
    assert!(folder.path().join("pictures/run_01-wheel-3.svg").exists());
    let json = replay(&["--json", "--from", "1000", "--ticks", "500"]).json();
    for run in json["runs"].as_array().unwrap() {
        assert_eq!((run["from"].as_u64(), run["ticks"].as_u64()), (Some(1_000), Some(500)));
        for wheel in run["wheels"].as_array().unwrap() {
            assert!(wheel["fpga_against_log"]["max"].as_f64().unwrap() < 0.000_53, "{wheel}");
            assert_eq!(wheel["law_against_log"]["beyond"].as_u64(), Some(0));
        }
    }
    let late = replay(&["--from", "6300"]);
    assert!(late.stdout.contains("run_02: only 6000 ticks"), "{}", late.stdout);
}

#[test]
fn one_tick_on_rust_hdl_is_the_same_as_on_the_bit_true_model() {
    let folder = tempdir().unwrap();
    // One run: rust-hdl takes a minute of a tick.
    let set = folder.path().join("set");
    fs::create_dir(&set).unwrap();
    for name in ["robot.toml", "run_01.csv"] {
        fs::copy(data("runs/wheel-skew").join(name), set.join(name)).unwrap();
    }
    let wheels = |fpga: &str| {
        let arguments = ["replay", set.to_str().unwrap(), "--from", "3000", "--ticks", "1", "--json", "--fpga", fpga];
        let mut json = racbot(folder.path(), &arguments).done().json();
        json["runs"].as_array_mut().unwrap().iter_mut().map(|run| run["wheels"].take()).collect::<Vec<_>>()
    };
    assert_eq!(wheels("bit-true"), wheels("rust-hdl"));
}

#[test]
fn the_committed_gateware_is_current() {
    let folder = tempdir().unwrap();
    let generated = data("../generated");
    let arguments = ["generate", "--check", "--out", generated.to_str().unwrap(), "--json"];
    assert_eq!(racbot(folder.path(), &arguments).done().json()["current"], true);
    racbot(folder.path(), &["generate", "--out", "fresh"]).done();
    let name = "rac4i65.v";
    assert!(fs::read(folder.path().join("fresh").join(name)).unwrap() == fs::read(generated.join(name)).unwrap());
}

#[test]
fn the_demo_runs_anywhere_and_all_is_well() {
    let folder = tempdir().unwrap();
    let outcome = racbot(folder.path(), &["demo", "--ticks", "2"]).done().fits_80_columns();
    assert!(outcome.stdout.contains("0 words differ") && !outcome.stdout.contains("WRONG"), "{}", outcome.stdout);
    let page = fs::read_to_string(folder.path().join("out/demo/index.html")).unwrap();
    assert!(page.matches("<svg ").count() >= 3 && !page.contains("http://") | page.contains("www.w3.org"));
    let json = racbot(folder.path(), &["demo", "--ticks", "1", "--json"]).done().json();
    assert_eq!((json["good"].as_bool(), json["parts"].as_array().map(Vec::len)), (Some(true), Some(5)));
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let folder = tempdir().unwrap();
    let mut child = Command::new(assert_cmd::cargo::cargo_bin("racbot"))
        .args(["replay", data("runs/wheel-skew").to_str().unwrap()])
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), String::from_utf8_lossy(&output.stderr).as_ref()), (Some(0), ""));
}

#[test]
fn wave_writes_a_scene_and_lists_those_that_exist() {
    let folder = tempdir().unwrap();
    let json = racbot(folder.path(), &["wave", "bus", "--json"]).done().json();
    let vcd = fs::read_to_string(folder.path().join("out/bus.vcd")).unwrap();
    assert!(
        vcd.contains(" lad [31:0] $end")
            && vcd.contains(" kicker_discharge $end")
            && vcd.contains("$enddefinitions $end")
    );
    assert!(json["clocks"].as_u64().is_some_and(|clocks| clocks > 600), "{json}");
    racbot(folder.path(), &["wave", "dance"]).refused(2, &["bus, arm, reversal, kick, stop, radio"]);
}

#[test]
fn manoeuvres_make_a_data_set_in_which_a_hidden_effect_is_found() {
    let folder = tempdir().unwrap();
    let nominal = format!("# Our robot.\n{}", fs::read_to_string(data("robot.toml")).unwrap());
    let late = "\n[[effect]]\nname = \"camera-latency\"\n[effect.parameters]\nlatency_s = { value = 0.04 }\n";
    fs::write(folder.path().join("nominal.toml"), &nominal).unwrap();
    fs::write(folder.path().join("truth.toml"), nominal.clone() + late).unwrap();
    for (manoeuvre, name) in [("chirp", "run_01"), ("star", "run_02")] {
        let arguments = ["simulate", "--robot", "nominal.toml", "--hidden", "truth.toml", "--manoeuvre", manoeuvre];
        let outcome = racbot(folder.path(), &[&arguments[..], &["--out", "set", "--name", name]].concat())
            .done()
            .fits_80_columns();
        assert!(outcome.stdout.contains(name), "{}", outcome.stdout);
    }
    // The robot's own file, with its comments, is what the effect is added to and taken out of.
    fs::write(folder.path().join("set/robot.toml"), &nominal).unwrap();
    let effect = data("effects/air-drag.toml");
    let json = racbot(folder.path(), &["gap", "set", "--effect", effect.to_str().unwrap(), "--json"]).done().json();
    assert_eq!(json["effects"][0]["name"], "camera-latency", "{json}");
    assert!((json["effects"][0]["parameters"]["latency_s"]["value"].as_f64().unwrap() - 0.04).abs() < 0.004);
    let added = fs::read_to_string(folder.path().join("out/gap/robot.toml")).unwrap();
    assert!(added.starts_with(&nominal) && added.contains("name = \"camera-latency\""), "{added}");
    racbot(folder.path(), &["gap", "--undo", "camera-latency", "--robot", "out/gap/robot.toml"]).done();
    assert_eq!(fs::read_to_string(folder.path().join("out/gap/robot.toml")).unwrap().trim_end(), nominal.trim_end());
    // The same effect, believed: over the FPGA's set points it acts as well.
    let drive = ["simulate", "--robot", "truth.toml", "--limit-s", "1", "--out", "fpga"];
    assert!(!racbot(folder.path(), &drive).done().fits_80_columns().stdout.contains("not simulated"));
}

#[test]
fn what_is_there_stays_unless_it_is_to_be_replaced() {
    let folder = tempdir().unwrap();
    let run = |arguments: &[&str]| racbot(folder.path(), arguments);
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    let points = data("set-points/square.toml");
    let points = points.to_str().unwrap();
    let wheel_skew = data("runs/wheel-skew");
    let wheel_skew = wheel_skew.to_str().unwrap();
    fs::create_dir(folder.path().join("d")).unwrap();
    let targets: [(&[&str], &str); 8] = [
        (&["drive", "--card", "virtual", "--setpoints", points, "--record", "d/a.csv"], "d/a.csv"),
        (&["drive", "--card", "virtual", "--setpoints", points, "--record", "d/a.mcap"], "d/a.mcap"),
        (&["simulate", "--limit-s", "0.1", "--out", "s"], "s/run.csv"),
        (&["simulate", "--manoeuvre", "spin", "--out", "m"], "m/run.csv"),
        (&["calibrate", wheel_skew, "--out", "c"], "c/robot.toml"),
        (&["generate", "--out", "g"], "g/rac4i65.v"),
        (&["wave", "bus", "--out", "bus.vcd"], "bus.vcd"),
        (&["radio", "--number", "3", "--velocity", "0,0.5,0", "--seconds", "0.1", "--out", "f.txt"], "f.txt"),
    ];
    for (arguments, target) in targets {
        run(arguments).done();
        let good = read(target);
        fs::write(folder.path().join(target), "precious").unwrap();
        run(arguments).refused(1, &[target, "exists already", "--force"]);
        assert_eq!(read(target), b"precious", "{arguments:?}");
        run(&[arguments, &["--force"]].concat()).done();
        // Stamps of an MCAP's poses are as long as the time of day makes them.
        let slack = if target.ends_with(".mcap") { good.len() / 100 } else { 0 };
        assert!(read(target).len().abs_diff(good.len()) <= slack, "{arguments:?}");
        // No temporary file is left behind.
        let parent = folder.path().join(target);
        let hidden = fs::read_dir(parent.parent().unwrap()).unwrap();
        assert!(hidden.map(|e| e.unwrap().file_name()).all(|name| !name.to_string_lossy().starts_with(".racbot")));
    }
    // A place that nobody asked for is a free one.
    for expected in ["out/bus.vcd", "out/bus-2.vcd"] {
        assert!(run(&["wave", "bus"]).done().stdout.starts_with(expected));
    }
    // Another run joins the folder of the first, pictures and all.
    run(&["simulate", "--limit-s", "0.1", "--out", "s", "--name", "b"]).done();
    for name in ["s/run.csv", "s/trajectory.svg", "s/b.csv", "s/b-trajectory.svg"] {
        assert!(folder.path().join(name).is_file(), "{name}");
    }
}

#[test]
fn a_report_is_refused_before_the_analysis_where_one_is() {
    let folder = tempdir().unwrap();
    fs::create_dir(folder.path().join("g")).unwrap();
    fs::write(folder.path().join("g/gap.json"), "precious").unwrap();
    fs::create_dir_all(folder.path().join("demo/board/runs")).unwrap();
    fs::write(folder.path().join("demo/board/runs/run_01.csv"), "precious").unwrap();
    let set = data("runs/wheel-skew");
    racbot(folder.path(), &["gap", set.to_str().unwrap(), "--out", "g"])
        .refused(1, &["g/gap.json", "exists already", "--force"]);
    racbot(folder.path(), &["demo", "--out", "demo"]).refused(1, &["run_01.csv", "exists already", "--force"]);
    assert_eq!(fs::read(folder.path().join("g/gap.json")).unwrap(), b"precious");
    assert!(!folder.path().join("g/report.html").exists());
}
