//! What can be wrong with a message, by codes that do not change.

use crate::messages::SimulatorError;

/// A code of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Code {
    /// No message of the port's kind.
    Unreadable,
    /// More robots in one message than a team has.
    TooMany,
    /// A robot that is not on the field.
    UnknownRobot,
    /// A number that is none, or beyond what anything here can do.
    Value,
    /// Wheel velocities for a robot without the four wheels that they name.
    VelocityType,
    /// A kick's angle that the kicker does not have.
    AngleValue,
    /// A kick faster than the kicker's longest pulse.
    KickSpeed,
    /// A dribbler where there is none.
    Dribbler,
    /// The robot's own watch switched it off.
    RobotFault,
    /// `by_force` was asked for.
    TeleportByForce,
    /// A teleport that makes room.
    TeleportSafely,
    /// A robot's number or team that cannot be.
    RobotId,
    /// A simulation speed out of range.
    SimulationSpeed,
    /// A field that cannot be.
    Geometry,
    /// What a robot cannot be made into.
    RobotSpecs,
    /// Simulators' own settings.
    Custom,
    /// A port that cannot be.
    VisionPort,
    /// Nothing here is simulated: a real robot.
    NotSimulated,
}

impl Code {
    /// Every code, in the order of their declaration.
    pub const ALL: [Self; 18] = [
        Self::Unreadable,
        Self::TooMany,
        Self::UnknownRobot,
        Self::Value,
        Self::VelocityType,
        Self::AngleValue,
        Self::KickSpeed,
        Self::Dribbler,
        Self::RobotFault,
        Self::TeleportByForce,
        Self::TeleportSafely,
        Self::RobotId,
        Self::SimulationSpeed,
        Self::Geometry,
        Self::RobotSpecs,
        Self::Custom,
        Self::VisionPort,
        Self::NotSimulated,
    ];

    /// As it stands in an answer.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Unreadable => "UNREADABLE",
            Self::TooMany => "TOO_MANY",
            Self::UnknownRobot => "UNKNOWN_ROBOT",
            Self::Value => "VALUE",
            Self::VelocityType => "VELOCITY_TYPE",
            Self::AngleValue => "ANGLE_VALUE",
            Self::KickSpeed => "KICK_SPEED",
            Self::Dribbler => "DRIBBLER",
            Self::RobotFault => "ROBOT_FAULT",
            Self::TeleportByForce => "TELEPORT_BY_FORCE",
            Self::TeleportSafely => "TELEPORT_SAFELY",
            Self::RobotId => "ROBOT_ID",
            Self::SimulationSpeed => "SIMULATION_SPEED",
            Self::Geometry => "GEOMETRY",
            Self::RobotSpecs => "ROBOT_SPECS",
            Self::Custom => "CUSTOM",
            Self::VisionPort => "VISION_PORT",
            Self::NotSimulated => "NOT_SIMULATED",
        }
    }

    /// The error with its words.
    #[must_use]
    pub fn says(self, what: impl Into<String>) -> SimulatorError {
        SimulatorError { code: Some(self.name().to_owned()), message: Some(what.into()) }
    }
}
