//! Options that several subcommands share.

use crate::terminal::Failure;
use clap::ValueEnum;
use fixed_kin::speed::SpeedMode;
use model::error::InputError;
use model::robot::{Layout, Robot};
use std::path::Path;
use testbench::fpga::{Fpga, Kind};

/// Which FPGA.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum FpgaChoice {
    /// The bit-true model in fixed-point arithmetic: fast, needs nothing
    #[default]
    BitTrue,
    /// The rust-hdl description, simulated clock by clock: slow, needs nothing
    RustHdl,
    /// The emitted Verilog, compiled: needs Verilator
    Verilog,
}

impl FpgaChoice {
    pub(crate) fn kind(self) -> Kind {
        match self {
            Self::BitTrue => Kind::BitTrue,
            Self::RustHdl => Kind::RustHdl,
            Self::Verilog => Kind::Verilog,
        }
    }

    /// A new FPGA, just configured.
    pub(crate) fn open(self) -> Result<Box<dyn Fpga>, Failure> {
        self.kind().open().map_err(Failure::data)
    }
}

/// How the FPGA measures speeds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum SpeedChoice {
    /// Count difference of a control tick; the log then tells all the FPGA knew
    #[default]
    Difference,
    /// Counts between edges over the time between them: smooth at low speed
    CountAndTime,
}

impl From<SpeedChoice> for SpeedMode {
    fn from(choice: SpeedChoice) -> Self {
        match choice {
            SpeedChoice::Difference => Self::Difference,
            SpeedChoice::CountAndTime => Self::CountAndTime,
        }
    }
}

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

/// The robot with its wheels skewed by these angles more.
pub(crate) fn skewed(robot: &Robot, skew: &Degrees) -> Result<Robot, Failure> {
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

/// A robot's file, or the built-in robot.
pub(crate) fn load_robot(file: Option<&Path>) -> Result<Robot, InputError> {
    file.map_or_else(|| Ok(Robot::racbot()), Robot::load)
}

/// A remark on effects that a robot's file carries and the simulation does not.
pub(crate) fn remark_on_effects(robot: &Robot) -> Option<String> {
    let names: Vec<&str> = robot.effects.iter().map(|effect| effect.name.as_str()).collect();
    (!names.is_empty()).then(|| format!("not simulated: the file's effects {}", names.join(", ")))
}
