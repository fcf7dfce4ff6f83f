//! Options about robots that several subcommands share.

use crate::terminal::Failure;
use clap::Args;
use gap::catalogue::strangers;
use links::effect::Effect;
use runs::error::InputError;
use runs::robot::{Layout, Robot};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A list of angles in degrees, such as `4,-3,2`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Degrees(pub(crate) Vec<f64>);

impl std::str::FromStr for Degrees {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let angle = |field: &str| match field.trim().parse::<f64>() {
            Ok(angle) if angle.abs() <= 360.0 => Ok(angle),
            _ => Err(format!("'{field}' is no angle in degrees; give one per wheel, such as 4,-3,2")),
        };
        text.split(',').map(angle).collect::<Result<_, _>>().map(Self)
    }
}

/// What the virtual robot really is.
#[derive(Args, Debug)]
pub(crate) struct Hidden {
    /// Robot as it really is, unknown to the controller
    #[arg(long, value_name = "FILE", conflicts_with = "skew_deg")]
    hidden: Option<PathBuf>,

    /// Skew of every wheel in degrees, clockwise, unknown to the controller, such as 4,-3,2
    #[arg(long, value_name = "DEG,..", allow_hyphen_values = true)]
    skew_deg: Option<Degrees>,
}

impl Hidden {
    /// Whether anything is hidden.
    pub(crate) fn is_given(&self) -> bool {
        self.hidden.is_some() || self.skew_deg.is_some()
    }

    /// The robot as it is, where the controller believes in another.
    pub(crate) fn robot(&self, believed: &Robot) -> Result<Robot, Failure> {
        if let Some(skew) = &self.skew_deg {
            let actual = skewed(believed, skew)?;
            actual.geometry().map_err(|error| Failure::usage(format!("--skew-deg: {error}")))?;
            return Ok(actual);
        }
        let Some(file) = &self.hidden else { return Ok(believed.clone()) };
        let actual = Robot::load(file)?;
        if actual.wheel_count() != believed.wheel_count() {
            let what = format!("has {} wheels, but the robot {}", actual.wheel_count(), believed.wheel_count());
            return Err(InputError::new(file, what, "hide a robot with as many wheels").into());
        }
        known_effects(file, &actual, None)?;
        Ok(actual)
    }
}

/// The robot with its wheels skewed by these angles more.
fn skewed(robot: &Robot, skew: &Degrees) -> Result<Robot, Failure> {
    if skew.0.len() != robot.wheel_count() {
        let (given, wheels) = (skew.0.len(), robot.wheel_count());
        return Err(Failure::usage(format!(
            "--skew-deg: {given} angles for a robot with {wheels} wheels; give one per wheel, such as 4,-3,2"
        )));
    }
    let mut skewed = robot.clone();
    match &mut skewed.layout {
        Layout::Rac { skew_rad, .. } => {
            for (rad, degrees) in skew_rad.iter_mut().zip(&skew.0) {
                *rad += degrees.to_radians();
            }
        }
        Layout::Wheels(wheels) => {
            for (wheel, degrees) in wheels.iter_mut().zip(&skew.0) {
                // Skew turns clockwise, the drive direction counts counter-clockwise.
                wheel.drive_rad -= degrees.to_radians();
            }
        }
    }
    Ok(skewed)
}

/// Refuses a robot's file with an effect, or a parameter of one, that nothing reads; `own` are the user's effects, `None`
/// where any may be one.
pub(crate) fn known_effects(file: &Path, robot: &Robot, own: Option<&[Arc<dyn Effect>]>) -> Result<(), InputError> {
    let all = strangers(robot, own.unwrap_or_default());
    let Some(found) = all.iter().find(|s| !s.own || own.is_some()) else { return Ok(()) };
    let text = std::fs::read_to_string(file).map_err(|error| InputError::io(file, &error))?;
    Err(Robot::fault_of_effect(&text, file, found.effect, found.parameter.as_deref(), &found.what, &found.hint))
}
