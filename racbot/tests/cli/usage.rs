//! Wrong usage: exit code 2.

use super::racbot;
use tempfile::tempdir;

#[test]
fn what_is_not_a_command_or_option_is_refused() {
    let folder = tempdir().unwrap();
    let table: [(&[&str], &str); 18] = [
        (&["fly"], "unrecognized subcommand 'fly'"),
        (&["simulat"], "similar"),
        (&["simulate", "--speed"], "unexpected argument '--speed'"),
        (&["simulate", "--fpga", "spartan"], "possible values: bit-true, rust-hdl, verilog"),
        (&["simulate", "--skew-deg", "4,x,2"], "'x' is no angle in degrees"),
        (&["simulate", "--skew-deg", "4,-3,2", "--hidden", "robot.toml"], "cannot be used with"),
        (&["simulate", "--start", "1,2"], "'1,2' is no pose"),
        (&["simulate", "--limit-s", "-1"], "not between 0 and 3600"),
        (&["simulate", "--manoeuvre", "sipn"], "no such manoeuvre; there are spin, star, square, chirp"),
        (&["simulate", "--manoeuvre", "spin", "--fpga", "verilog"], "cannot be used with"),
        (&["simulate", "--times", "3"], "--manoeuvre"),
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
