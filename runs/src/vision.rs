//! Messages of the small-size league's vision, as game logs hold them and simulators send them: `SSL_WrapperPacket` and
//! what is in it, in protobuf (proto2). Field numbers and units are the league's; lengths are **millimetres**, angles
//! radians counter-clockwise from the field's x axis, headings those of the robot's forward axis, times seconds of the
//! Unix epoch. Fields that the protocol requires stand without `Option`: a message that lacks one has it as zero.

#![allow(missing_docs)] // names and units are those of the protocol, said above

use prost::{Enumeration, Message};

/// One datagram.
#[derive(Clone, PartialEq, Message)]
pub struct WrapperPacket {
    #[prost(message, optional, tag = "1")]
    pub detection: Option<DetectionFrame>,
    #[prost(message, optional, tag = "2")]
    pub geometry: Option<GeometryData>,
    /// Where the frame is from, one of [`Source`].
    #[prost(enumeration = "Source", optional, tag = "3")]
    pub source: Option<i32>,
}

/// Who saw.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Enumeration)]
#[repr(i32)]
pub enum Source {
    Unknown = 0,
    Other = 1,
    SslVision = 2,
    VisionProcessor = 3,
    GrSim = 4,
    ErForceSim = 5,
}

/// What one camera saw at once.
#[derive(Clone, PartialEq, Message)]
pub struct DetectionFrame {
    #[prost(uint32, required, tag = "1")]
    pub frame_number: u32,
    #[prost(double, required, tag = "2")]
    pub t_capture: f64,
    #[prost(double, required, tag = "3")]
    pub t_sent: f64,
    #[prost(uint32, required, tag = "4")]
    pub camera_id: u32,
    #[prost(message, repeated, tag = "5")]
    pub balls: Vec<DetectionBall>,
    #[prost(message, repeated, tag = "6")]
    pub robots_yellow: Vec<DetectionRobot>,
    #[prost(message, repeated, tag = "7")]
    pub robots_blue: Vec<DetectionRobot>,
    #[prost(double, optional, tag = "8")]
    pub t_capture_camera: Option<f64>,
}

/// A ball; `z` is its height over the floor.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct DetectionBall {
    #[prost(float, required, tag = "1")]
    pub confidence: f32,
    #[prost(uint32, optional, tag = "2")]
    pub area: Option<u32>,
    #[prost(float, required, tag = "3")]
    pub x: f32,
    #[prost(float, required, tag = "4")]
    pub y: f32,
    #[prost(float, optional, tag = "5")]
    pub z: Option<f32>,
    #[prost(float, required, tag = "6")]
    pub pixel_x: f32,
    #[prost(float, required, tag = "7")]
    pub pixel_y: f32,
}

/// What a frame says of one robot.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct DetectionRobot {
    #[prost(float, required, tag = "1")]
    pub confidence: f32,
    #[prost(uint32, optional, tag = "2")]
    pub robot_id: Option<u32>,
    #[prost(float, required, tag = "3")]
    pub x: f32,
    #[prost(float, required, tag = "4")]
    pub y: f32,
    #[prost(float, optional, tag = "5")]
    pub orientation: Option<f32>,
    #[prost(float, required, tag = "6")]
    pub pixel_x: f32,
    #[prost(float, required, tag = "7")]
    pub pixel_y: f32,
    #[prost(float, optional, tag = "8")]
    pub height: Option<f32>,
}

/// Field, cameras and ball models.
#[derive(Clone, PartialEq, Message)]
pub struct GeometryData {
    #[prost(message, required, tag = "1")]
    pub field: FieldSize,
    #[prost(message, repeated, tag = "2")]
    pub calib: Vec<CameraCalibration>,
    #[prost(message, optional, tag = "3")]
    pub ball_models: Option<BallModels>,
}

/// Sizes in whole millimetres.
#[derive(Clone, PartialEq, Message)]
pub struct FieldSize {
    #[prost(int32, required, tag = "1")]
    pub field_length: i32,
    #[prost(int32, required, tag = "2")]
    pub field_width: i32,
    #[prost(int32, required, tag = "3")]
    pub goal_width: i32,
    #[prost(int32, required, tag = "4")]
    pub goal_depth: i32,
    #[prost(int32, required, tag = "5")]
    pub boundary_width: i32,
    #[prost(message, repeated, tag = "6")]
    pub field_lines: Vec<LineSegment>,
    #[prost(message, repeated, tag = "7")]
    pub field_arcs: Vec<CircularArc>,
    #[prost(int32, optional, tag = "8")]
    pub penalty_area_depth: Option<i32>,
    #[prost(int32, optional, tag = "9")]
    pub penalty_area_width: Option<i32>,
}

/// A point, mm.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct Point {
    #[prost(float, required, tag = "1")]
    pub x: f32,
    #[prost(float, required, tag = "2")]
    pub y: f32,
}

/// A straight marking.
#[derive(Clone, PartialEq, Message)]
pub struct LineSegment {
    #[prost(string, required, tag = "1")]
    pub name: String,
    #[prost(message, required, tag = "2")]
    pub p1: Point,
    #[prost(message, required, tag = "3")]
    pub p2: Point,
    #[prost(float, required, tag = "4")]
    pub thickness: f32,
    /// [`Shape`].
    #[prost(enumeration = "Shape", optional, tag = "5")]
    pub r#type: Option<i32>,
}

/// A curved marking.
#[derive(Clone, PartialEq, Message)]
pub struct CircularArc {
    #[prost(string, required, tag = "1")]
    pub name: String,
    #[prost(message, required, tag = "2")]
    pub center: Point,
    #[prost(float, required, tag = "3")]
    pub radius: f32,
    #[prost(float, required, tag = "4")]
    pub a1: f32,
    #[prost(float, required, tag = "5")]
    pub a2: f32,
    #[prost(float, required, tag = "6")]
    pub thickness: f32,
    /// [`Shape`].
    #[prost(enumeration = "Shape", optional, tag = "7")]
    pub r#type: Option<i32>,
}

/// Which marking.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Enumeration)]
#[repr(i32)]
pub enum Shape {
    Undefined = 0,
    CenterCircle = 1,
    TopTouchLine = 2,
    BottomTouchLine = 3,
    LeftGoalLine = 4,
    RightGoalLine = 5,
    HalfwayLine = 6,
    CenterLine = 7,
    LeftPenaltyStretch = 8,
    RightPenaltyStretch = 9,
    LeftFieldLeftPenaltyStretch = 10,
    LeftFieldRightPenaltyStretch = 11,
    RightFieldLeftPenaltyStretch = 12,
    RightFieldRightPenaltyStretch = 13,
}

/// A camera: pixels and mm.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct CameraCalibration {
    #[prost(uint32, required, tag = "1")]
    pub camera_id: u32,
    #[prost(float, required, tag = "2")]
    pub focal_length: f32,
    #[prost(float, required, tag = "3")]
    pub principal_point_x: f32,
    #[prost(float, required, tag = "4")]
    pub principal_point_y: f32,
    #[prost(float, required, tag = "5")]
    pub distortion: f32,
    #[prost(float, required, tag = "6")]
    pub q0: f32,
    #[prost(float, required, tag = "7")]
    pub q1: f32,
    #[prost(float, required, tag = "8")]
    pub q2: f32,
    #[prost(float, required, tag = "9")]
    pub q3: f32,
    #[prost(float, required, tag = "10")]
    pub tx: f32,
    #[prost(float, required, tag = "11")]
    pub ty: f32,
    #[prost(float, required, tag = "12")]
    pub tz: f32,
    #[prost(float, optional, tag = "13")]
    pub derived_camera_world_tx: Option<f32>,
    #[prost(float, optional, tag = "14")]
    pub derived_camera_world_ty: Option<f32>,
    #[prost(float, optional, tag = "15")]
    pub derived_camera_world_tz: Option<f32>,
    #[prost(uint32, optional, tag = "16")]
    pub pixel_image_width: Option<u32>,
    #[prost(uint32, optional, tag = "17")]
    pub pixel_image_height: Option<u32>,
}

/// How balls move.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct BallModels {
    #[prost(message, optional, tag = "1")]
    pub straight_two_phase: Option<StraightTwoPhase>,
    #[prost(message, optional, tag = "2")]
    pub chip_fixed_loss: Option<ChipFixedLoss>,
}

/// A straight kick: sliding, then rolling. Accelerations in m/s², negative.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct StraightTwoPhase {
    #[prost(double, required, tag = "1")]
    pub acc_slide: f64,
    #[prost(double, required, tag = "2")]
    pub acc_roll: f64,
    /// Share of the first speed at which it begins to roll.
    #[prost(double, required, tag = "3")]
    pub k_switch: f64,
}

/// A chip kick: what is left of the velocity after every hop.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct ChipFixedLoss {
    #[prost(double, required, tag = "1")]
    pub damping_xy_first_hop: f64,
    #[prost(double, required, tag = "2")]
    pub damping_xy_other_hops: f64,
    #[prost(double, required, tag = "3")]
    pub damping_z: f64,
}
