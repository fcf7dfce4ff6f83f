//! Names of files that are odd, and places where no file of ours belongs.

use super::{data, racbot};
use std::ffi::{OsStr, OsString};
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::path::Path;
use tempfile::tempdir;

#[test]
fn names_that_are_no_text_are_names_like_others() {
    let folder = tempdir().unwrap();
    let odd = folder.path().join(OsStr::from_bytes(b"set-\xff"));
    let log = data("runs/wheel-skew/run_01.csv");
    fs::write(folder.path().join("map.toml"), "[columns]\nenc_1 = \"enc_1\"\n").unwrap();
    let robot = ["--wheels", "90,210,330", "--body-radius-mm", "85", "--radius-mm", "27", "--gear", "3"];
    let words = |text: &[&str], name: &str| -> Vec<OsString> {
        text.iter().map(OsString::from).chain([odd.join(name).into_os_string()]).collect()
    };
    let mut init = words(&["init"], "robot.toml");
    init.extend([&robot[..], &["--counts-per-motor-rev", "64"]].concat().iter().map(OsString::from));
    let calls = [
        init,
        words(&["convert", "map.toml", log.to_str().unwrap()], "run.csv"),
        words(&["convert", "--draft", log.to_str().unwrap()], "map.toml"),
        words(&["wave", "bus", "--out"], "bus.vcd"),
        words(&["man"], "pages"),
        words(&["simulate", "--manoeuvre", "spin", "--out"], "spin"),
        words(&["drive", "--card", "virtual", "--limit-s", "0.1", "--setpoints", "points.csv", "--record"], "d.mcap"),
        words(&["radio", "--number", "3", "--velocity", "0,1,0", "--seconds", "0.1", "--out"], "f.txt"),
    ];
    fs::write(folder.path().join("points.csv"), "1,0,1,0\n").unwrap();
    for call in calls {
        let program = Path::new(env!("CARGO_BIN_EXE_racbot"));
        let output = std::process::Command::new(program).current_dir(folder.path()).args(&call).output().unwrap();
        assert!(output.status.success(), "{call:?}: {}", String::from_utf8_lossy(&output.stderr));
    }
    assert_eq!(fs::read_dir(&odd).unwrap().count(), 8, "robot.toml beside the recording is the one that was there");
}

#[test]
fn what_a_command_reads_it_does_not_write_over() {
    let folder = tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let log = fs::read(data("runs/wheel-skew/run_01.csv")).unwrap();
    fs::write(file("map.toml"), "[columns]\nenc_1 = \"enc_1\"\n").unwrap();
    fs::create_dir(file("logs")).unwrap();
    fs::write(file("logs/log.csv"), &log).unwrap();
    fs::write(file("points.csv"), "1,0,1,0\n").unwrap();
    let log_again = "logs/../logs/log.csv";
    let calls: [(&[&str], &str); 5] = [
        (&["convert", "map.toml", "logs/log.csv", log_again], log_again),
        (&["convert", "map.toml", "logs", "logs/"], "logs/log.csv"),
        (&["convert", "--draft", "logs/log.csv", "logs/log.csv"], "logs/log.csv"),
        (&["radio", "--number", "3", "--commands", "logs/log.csv", "--out", "logs/log.csv"], "logs/log.csv"),
        (&["drive", "--card", "virtual", "--setpoints", "points.csv", "--record", "points.csv"], "points.csv"),
    ];
    for (call, name) in calls {
        racbot(folder.path(), &[call, &["--force"]].concat()).refused(1, &[name, "is read by this very command"]);
    }
    assert_eq!(fs::read(file("logs/log.csv")).unwrap(), log);
    assert_eq!(fs::read(file("points.csv")).unwrap(), b"1,0,1,0\n");
}

#[test]
fn a_file_for_a_folder_and_a_folder_for_a_file_are_said() {
    let folder = tempdir().unwrap();
    let log = data("runs/wheel-skew/run_01.csv");
    let run = |arguments: &[&str]| racbot(folder.path(), arguments);
    for command in ["check", "gap", "calibrate", "replay"] {
        run(&[command, log.to_str().unwrap()]).refused(1, &["run_01.csv: is no folder", "robot.toml lie side by side"]);
    }
    fs::write(folder.path().join("file"), "").unwrap();
    fs::create_dir(folder.path().join("folder")).unwrap();
    run(&["simulate", "--limit-s", "0.1", "--out", "file"]).refused(1, &["file stands where"]);
    run(&["convert", "--list", "folder"]).refused(1, &["give a file, not a folder"]);
    run(&["wave", "bus", "--out", "folder", "--force"]).refused(1, &["is a folder; give the name of a file"]);
    // A run of this name would lie outside of the folder, in one below it, or be hidden from the commands that read it.
    for name in ["../run", "a/b", "", ".run"] {
        run(&["simulate", "--limit-s", "0.1", "--out", "s", "--name", name]).refused(2, &["no folder in it"]);
    }
}
