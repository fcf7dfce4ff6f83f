//! The file of a robot, and of one that is to be driven.

use model::pi::proposed_gains;
use runs::error::InputError;
use runs::robot::Robot;
use std::path::Path;

/// A robot's file, or the built-in robot.
pub(crate) fn any_robot(file: Option<&Path>) -> Result<Robot, InputError> {
    file.map_or_else(|| Ok(Robot::racbot()), Robot::load)
}

/// The same of one that is to be driven: loops without gains would stand still, and nobody would know why.
pub(crate) fn robot(file: Option<&Path>) -> Result<Robot, InputError> {
    let robot = any_robot(file)?;
    let Some(file) = file.filter(|_| robot.pi.kp == 0.0 && robot.pi.ki == 0.0) else { return Ok(robot) };
    let gains = |[kp, ki]: [f64; 2]| {
        format!("write, say, kp = {kp:.2e} (duty per rad/s at the wheel) and ki = {ki:.2e} (duty per rad) below [pi]")
    };
    let hint = proposed_gains(&robot).map_or_else(|| "write kp and ki below [pi]".to_owned(), gains);
    Err(InputError::new(file, "has no gains in [pi]: its speed loops would drive nothing", hint))
}
