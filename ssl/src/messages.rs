//! Messages of the league's simulation protocol, in protobuf (proto2): what comes to the ports of control and robots, and
//! what goes back. Vision is [`runs::vision`]. Field numbers and units are the protocol's: metres, seconds, radians
//! counter-clockwise but for `kick_angle` (degrees), the wheel angles (clockwise from forward) and the dribbler (rpm).

#![allow(missing_docs)] // names and units are those of the protocol, said above

/// Encodes and decodes them.
pub use prost::Message;
use prost::{Enumeration, Oneof};
use runs::vision::GeometryData;

/// To a team's port.
#[derive(Clone, PartialEq, Message)]
pub struct RobotControl {
    #[prost(message, repeated, tag = "1")]
    pub robot_commands: Vec<RobotCommand>,
}

/// What one robot is to do.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct RobotCommand {
    #[prost(uint32, required, tag = "1")]
    pub id: u32,
    #[prost(message, optional, tag = "2")]
    pub move_command: Option<RobotMoveCommand>,
    #[prost(float, optional, tag = "3")]
    pub kick_speed: Option<f32>,
    #[prost(float, optional, tag = "4")]
    pub kick_angle: Option<f32>,
    #[prost(float, optional, tag = "5")]
    pub dribbler_speed: Option<f32>,
}

/// Wheel speeds, or a velocity in the robot's or the field's frame.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct RobotMoveCommand {
    #[prost(oneof = "MoveCommand", tags = "1, 2, 3")]
    pub command: Option<MoveCommand>,
}

/// One of three.
#[derive(Clone, Copy, PartialEq, Oneof)]
pub enum MoveCommand {
    #[prost(message, tag = "1")]
    WheelVelocity(MoveWheelVelocity),
    #[prost(message, tag = "2")]
    LocalVelocity(MoveLocalVelocity),
    #[prost(message, tag = "3")]
    GlobalVelocity(MoveGlobalVelocity),
}

/// Speeds of the wheels at their rims.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct MoveWheelVelocity {
    #[prost(float, required, tag = "1")]
    pub front_right: f32,
    #[prost(float, required, tag = "2")]
    pub back_right: f32,
    #[prost(float, required, tag = "3")]
    pub back_left: f32,
    #[prost(float, required, tag = "4")]
    pub front_left: f32,
}

/// Velocity in the robot's frame.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct MoveLocalVelocity {
    #[prost(float, required, tag = "1")]
    pub forward: f32,
    #[prost(float, required, tag = "2")]
    pub left: f32,
    #[prost(float, required, tag = "3")]
    pub angular: f32,
}

/// Velocity in the field's frame.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct MoveGlobalVelocity {
    #[prost(float, required, tag = "1")]
    pub x: f32,
    #[prost(float, required, tag = "2")]
    pub y: f32,
    #[prost(float, required, tag = "3")]
    pub angular: f32,
}

/// Back to the sender.
#[derive(Clone, PartialEq, Message)]
pub struct RobotControlResponse {
    #[prost(message, repeated, tag = "1")]
    pub errors: Vec<SimulatorError>,
    #[prost(message, repeated, tag = "2")]
    pub feedback: Vec<RobotFeedback>,
}

/// What a robot says.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct RobotFeedback {
    #[prost(uint32, required, tag = "1")]
    pub id: u32,
    #[prost(bool, optional, tag = "2")]
    pub dribbler_ball_contact: Option<bool>,
}

/// What was wrong, by a stable code: [`crate::Code`].
#[derive(Clone, PartialEq, Message)]
pub struct SimulatorError {
    #[prost(string, optional, tag = "1")]
    pub code: Option<String>,
    #[prost(string, optional, tag = "2")]
    pub message: Option<String>,
}

/// To the control port.
#[derive(Clone, PartialEq, Message)]
pub struct SimulatorCommand {
    #[prost(message, optional, tag = "1")]
    pub control: Option<SimulatorControl>,
    #[prost(message, optional, tag = "2")]
    pub config: Option<SimulatorConfig>,
}

/// Back to the sender.
#[derive(Clone, PartialEq, Message)]
pub struct SimulatorResponse {
    #[prost(message, repeated, tag = "1")]
    pub errors: Vec<SimulatorError>,
}

/// What happens now.
#[derive(Clone, PartialEq, Message)]
pub struct SimulatorControl {
    #[prost(message, optional, tag = "1")]
    pub teleport_ball: Option<TeleportBall>,
    #[prost(message, repeated, tag = "2")]
    pub teleport_robot: Vec<TeleportRobot>,
    #[prost(float, optional, tag = "3")]
    pub simulation_speed: Option<f32>,
}

/// Where the ball is to be; what is left out stays as it is.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct TeleportBall {
    #[prost(float, optional, tag = "1")]
    pub x: Option<f32>,
    #[prost(float, optional, tag = "2")]
    pub y: Option<f32>,
    #[prost(float, optional, tag = "3")]
    pub z: Option<f32>,
    #[prost(float, optional, tag = "4")]
    pub vx: Option<f32>,
    #[prost(float, optional, tag = "5")]
    pub vy: Option<f32>,
    #[prost(float, optional, tag = "6")]
    pub vz: Option<f32>,
    #[prost(bool, optional, tag = "7")]
    pub teleport_safely: Option<bool>,
    #[prost(bool, optional, tag = "8")]
    pub roll: Option<bool>,
    #[prost(bool, optional, tag = "9")]
    pub by_force: Option<bool>,
}

/// Where a robot is to be, or whether.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct TeleportRobot {
    #[prost(message, required, tag = "1")]
    pub id: RobotId,
    #[prost(float, optional, tag = "2")]
    pub x: Option<f32>,
    #[prost(float, optional, tag = "3")]
    pub y: Option<f32>,
    #[prost(float, optional, tag = "4")]
    pub orientation: Option<f32>,
    #[prost(float, optional, tag = "5")]
    pub v_x: Option<f32>,
    #[prost(float, optional, tag = "6")]
    pub v_y: Option<f32>,
    #[prost(float, optional, tag = "7")]
    pub v_angular: Option<f32>,
    #[prost(bool, optional, tag = "8")]
    pub present: Option<bool>,
    #[prost(bool, optional, tag = "9")]
    pub by_force: Option<bool>,
}

/// Number and team of a robot.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct RobotId {
    #[prost(uint32, optional, tag = "1")]
    pub id: Option<u32>,
    /// A [`TeamColor`]; as protocol buffers have it, any number may come.
    #[prost(enumeration = "TeamColor", optional, tag = "2")]
    pub team: Option<i32>,
}

/// A team as the protocol numbers it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Enumeration)]
#[repr(i32)]
pub enum TeamColor {
    Unknown = 0,
    Yellow = 1,
    Blue = 2,
}

/// What is from now on.
#[derive(Clone, PartialEq, Message)]
pub struct SimulatorConfig {
    #[prost(message, optional, tag = "1")]
    pub geometry: Option<GeometryData>,
    #[prost(message, repeated, tag = "2")]
    pub robot_specs: Vec<RobotSpecs>,
    /// Simulators' own; only its presence is looked at.
    #[prost(bytes = "vec", optional, tag = "3")]
    pub realism_config: Option<Vec<u8>>,
    #[prost(uint32, optional, tag = "4")]
    pub vision_port: Option<u32>,
}

/// Size, weight and limits of a robot, as the simulator is told.
#[derive(Clone, PartialEq, Message)]
pub struct RobotSpecs {
    #[prost(message, required, tag = "1")]
    pub id: RobotId,
    #[prost(float, optional, tag = "2")]
    pub radius: Option<f32>,
    #[prost(float, optional, tag = "3")]
    pub height: Option<f32>,
    #[prost(float, optional, tag = "4")]
    pub mass: Option<f32>,
    #[prost(float, optional, tag = "7")]
    pub max_linear_kick_speed: Option<f32>,
    #[prost(float, optional, tag = "8")]
    pub max_chip_kick_speed: Option<f32>,
    #[prost(float, optional, tag = "9")]
    pub center_to_dribbler: Option<f32>,
    #[prost(message, optional, tag = "10")]
    pub limits: Option<RobotLimits>,
    #[prost(message, optional, tag = "13")]
    pub wheel_angles: Option<RobotWheelAngles>,
    /// Simulators' own; only its presence is looked at.
    #[prost(bytes = "vec", repeated, tag = "14")]
    pub custom: Vec<Vec<u8>>,
}

/// m/s², rad/s², m/s, rad/s.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct RobotLimits {
    #[prost(float, optional, tag = "1")]
    pub acc_speedup_absolute_max: Option<f32>,
    #[prost(float, optional, tag = "2")]
    pub acc_speedup_angular_max: Option<f32>,
    #[prost(float, optional, tag = "3")]
    pub acc_brake_absolute_max: Option<f32>,
    #[prost(float, optional, tag = "4")]
    pub acc_brake_angular_max: Option<f32>,
    #[prost(float, optional, tag = "5")]
    pub vel_absolute_max: Option<f32>,
    #[prost(float, optional, tag = "6")]
    pub vel_angular_max: Option<f32>,
}

/// Radians, clockwise from forward.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct RobotWheelAngles {
    #[prost(float, required, tag = "1")]
    pub front_right: f32,
    #[prost(float, required, tag = "2")]
    pub back_right: f32,
    #[prost(float, required, tag = "3")]
    pub back_left: f32,
    #[prost(float, required, tag = "4")]
    pub front_left: f32,
}
