//! Wrong usage: exit code 2.

use super::racbot;
use tempfile::tempdir;

#[test]
fn what_is_not_a_command_or_option_is_refused() {
    let folder = tempdir().unwrap();
    let table: [(&[&str], &str); 24] = [
        (&["fly"], "unrecognized subcommand 'fly'"),
        (&["simulat"], "similar"),
        (&["simulate", "--speed"], "unexpected argument '--speed'"),
        (&["simulate", "--fpga", "spartan"], "possible values: bit-true, rust-hdl, verilog"),
        (&["simulate", "--skew-deg", "4,x,2"], "'x' is no angle in degrees"),
        (&["simulate", "--skew-deg", "4,-3,2", "--hidden", "robot.toml"], "cannot be used with"),
        (&["simulate", "--start", "1,2"], "'1,2' is no pose"),
        (&["simulate", "--limit-s", "-1"], "-1 is not more than 0 and at most 3600"),
        (&["simulate", "--manoeuvre", "sipn"], "no such manoeuvre; there are spin, star, square, chirp"),
        (&["simulate", "--manoeuvre", "spin", "--fpga", "verilog"], "cannot be used with"),
        (&["simulate", "--times", "3"], "--manoeuvre"),
        (&["simulate", "--start", "1e300,0,0"], "no place within 10000 m"),
        (&["simulate", "--limit-s", "1e300"], "1e300 is not more than 0"),
        (&["serve", "--as-robot", "blue:3"], "--card"),
        (&["serve", "--card", "virtual", "--yellow", "3"], "cannot be used with"),
        (&["serve", "--card", "virtual", "--skew-deg", "4,-3,2"], "leave out --card"),
        (&["serve", "--seconds", "0"], "0 is not more than 0"),
        (&["replay"], "<DATASET>"),
        (&["calibrate"], "<DATASET>"),
        (&["gap"], "<DATASET>"),
        (&["gap", "--undo", "wheel-skew"], "say which robot.toml"),
        (&["calibrate", "--procedure", "paper"], "say what the virtual robot really is"),
        (&["calibrate", "--procedure", "paper", "--skew-deg", "1,2,3", "logs"], "reads no data set"),
        (&["calibrate", "logs", "--skew-deg", "1,2,3"], "for the virtual robot"),
    ];
    for (arguments, part) in table {
        racbot(folder.path(), arguments).refused(2, &[part]);
    }
}

#[test]
fn as_many_angles_as_wheels_and_not_more_than_a_robot_stands() {
    let folder = tempdir().unwrap();
    racbot(folder.path(), &["simulate", "--skew-deg", "4,-3"]).refused(2, &["2 angles for a robot with 3 wheels"]);
    racbot(folder.path(), &["simulate", "--skew-deg", "90,90,90"]).refused(2, &["--skew-deg", "singular"]);
}

#[test]
fn help_and_version_are_no_errors() {
    let folder = tempdir().unwrap();
    for arguments in [&["--help"][..], &["help", "simulate"], &["replay", "--help"], &["--version"]] {
        let outcome = racbot(folder.path(), arguments).done();
        assert!(outcome.stdout.contains("racbot"));
    }
}

#[test]
fn shells_complete_and_every_subcommand_has_a_manual_page() {
    let folder = tempfile::tempdir().unwrap();
    let script = racbot(folder.path(), &["completions", "bash"]).done().stdout;
    assert!(script.contains("_racbot()") && script.contains("--lock-step"));
    racbot(folder.path(), &["man", "pages"]).done();
    let help = racbot(folder.path(), &["--help"]).done().stdout;
    let commands = help.split("Commands:").nth(1).unwrap().split("\n\n").next().unwrap();
    let names = commands.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names: Vec<&str> = names.filter_map(|line| line.split_whitespace().next()).filter(|n| *n != "help").collect();
    assert!(names.len() > 15, "{names:?}");
    for name in names {
        let page = std::fs::read_to_string(folder.path().join(format!("pages/racbot-{name}.1"))).unwrap();
        assert!(page.contains(".SH SYNOPSIS"), "{name}");
    }
    racbot(folder.path(), &["man", "pages"]).done();
}
