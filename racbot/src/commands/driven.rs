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
    match file.filter(|_| has_no_gains(&robot)) {
        Some(file) => Err(without_gains(file, proposed_gains(&robot))),
        None => Ok(robot),
    }
}

/// The same of one that is only simulated, which breaks nothing: where its file has no gains it has proposed ones, and what is
/// to be said of them.
#[cfg(feature = "simulation")]
pub(crate) fn simulated(file: Option<&Path>) -> Result<(Robot, Option<String>), InputError> {
    let mut any = any_robot(file)?;
    let Some(file) = file.filter(|_| has_no_gains(&any)) else { return Ok((any, None)) };
    let gains = proposed_gains(&any).ok_or_else(|| without_gains(file, None))?;
    [any.pi.kp, any.pi.ki] = gains;
    Ok((any, Some(format!("{} has no gains in [pi]: simulated with {}", file.display(), words(gains)))))
}

fn has_no_gains(robot: &Robot) -> bool {
    robot.pi.kp == 0.0 && robot.pi.ki == 0.0
}

/// What to say of a file without gains, for a robot that would do with these.
fn without_gains(file: &Path, proposed: Option<[f64; 2]>) -> InputError {
    let gains = |gains| format!("write, say, {} below [pi]", words(gains));
    let hint = proposed.map_or_else(|| "write kp and ki below [pi]".to_owned(), gains);
    InputError::new(file, "has no gains in [pi]: its speed loops would drive nothing", hint)
}

/// Gains, to be written and read.
fn words([kp, ki]: [f64; 2]) -> String {
    format!("kp = {kp:.2e} (duty per rad/s at the wheel) and ki = {ki:.2e} (duty per rad)")
}
