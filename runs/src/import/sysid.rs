//! Recordings of WPILib's SysId, and of frc-characterization before it: a JSON with a table of rows for every test of one
//! machine. The rows have no names; how many numbers they have says what they are.
//!
//! Columns as both programs write them, positions of SysId in turns (its `unitsPerRotation` makes the team's unit of them).

use serde_json::Value;

/// Names of the tests, one of which every such file has: the voltage ramps or jumps.
const TESTS: [&str; 4] = ["slow-forward", "slow-backward", "fast-forward", "fast-backward"];

/// Columns of a test of a mechanism with one motor.
const MECHANISM: [&str; 4] = ["time", "motor_voltage", "position (rev)", "motor_velocity (rev/s)"];
/// A drive train.
const DRIVETRAIN: [&str; 9] = [
    "time",
    "left_voltage",
    "right_voltage",
    "left_position (rev)",
    "right_position (rev)",
    "left_velocity (rev/s)",
    "right_velocity (rev/s)",
    "heading",
    "heading_rate",
];
/// A drive train by frc-characterization: positions and velocities in the team's unit.
const CHARACTERIZATION: [&str; 10] = [
    "time",
    "battery",
    "autospeed",
    "left_voltage",
    "right_voltage",
    "left_position",
    "right_position",
    "left_velocity",
    "right_velocity",
    "heading",
];

/// What the columns of its tables are, where a file is one of these: `width` numbers stand in every row of each.
pub(super) fn columns(file: &Value, width: usize) -> Option<&'static [&'static str]> {
    let known: [&[&str]; 3] = [&MECHANISM, &DRIVETRAIN, &CHARACTERIZATION];
    let tests = file.as_object()?;
    TESTS.iter().any(|test| tests.contains_key(*test)).then(|| known.into_iter().find(|names| names.len() == width))?
}
