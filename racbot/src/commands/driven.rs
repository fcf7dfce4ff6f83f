//! The file of a robot that is to be driven.

use model::pi::proposed_gains;
use runs::error::InputError;
use runs::robot::Robot;
use std::path::Path;

/// A robot's file, or the built-in robot; loops without gains would stand still, and nobody would know why.
pub(crate) fn robot(file: Option<&Path>) -> Result<Robot, InputError> {
    let Some(file) = file else { return Ok(Robot::racbot()) };
    let robot = Robot::load(file)?;
    if robot.pi.kp != 0.0 || robot.pi.ki != 0.0 {
        return Ok(robot);
    }
    let gains = |[kp, ki]: [f64; 2]| {
        format!("write, say, kp = {kp:.2e} (duty per rad/s at the wheel) and ki = {ki:.2e} (duty per rad) below [pi]")
    };
    let hint = proposed_gains(&robot).map_or_else(|| "write kp and ki below [pi]".to_owned(), gains);
    Err(InputError::new(file, "has no gains in [pi]: its speed loops would drive nothing", hint))
}
