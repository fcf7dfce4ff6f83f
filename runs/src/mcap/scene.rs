//! The robot for 3D views: where it is, in the messages that Foxglove and others draw (`foxglove.FrameTransform`,
//! `foxglove.PoseInFrame`; <https://docs.foxglove.dev/docs/visualization/message-schemas>). Their x points forward.

use prost::Message;
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorProto, FileDescriptorSet, Timestamp};
use std::f64::consts::FRAC_PI_2;

use crate::frames::Pose;

/// Messages and the topics they go to.
pub(super) const TOPICS: [(&str, &str); 2] =
    [("/tf", "foxglove.FrameTransform"), ("/racbot/pose", "foxglove.PoseInFrame")];
/// The frame of the camera, and the robot's.
const FRAMES: [&str; 2] = ["field", "robot"];

#[derive(Clone, PartialEq, Message)]
struct Vector3 {
    #[prost(double, tag = "1")]
    x: f64,
    #[prost(double, tag = "2")]
    y: f64,
    #[prost(double, tag = "3")]
    z: f64,
}

#[derive(Clone, PartialEq, Message)]
struct Quaternion {
    #[prost(double, tag = "1")]
    x: f64,
    #[prost(double, tag = "2")]
    y: f64,
    #[prost(double, tag = "3")]
    z: f64,
    #[prost(double, tag = "4")]
    w: f64,
}

#[derive(Clone, PartialEq, Message)]
struct Placed {
    #[prost(message, optional, tag = "1")]
    position: Option<Vector3>,
    #[prost(message, optional, tag = "2")]
    orientation: Option<Quaternion>,
}

#[derive(Clone, PartialEq, Message)]
struct FrameTransform {
    #[prost(message, optional, tag = "1")]
    timestamp: Option<Timestamp>,
    #[prost(string, tag = "2")]
    parent_frame_id: String,
    #[prost(string, tag = "3")]
    child_frame_id: String,
    #[prost(message, optional, tag = "4")]
    translation: Option<Vector3>,
    #[prost(message, optional, tag = "5")]
    rotation: Option<Quaternion>,
}

#[derive(Clone, PartialEq, Message)]
struct PoseInFrame {
    #[prost(message, optional, tag = "1")]
    timestamp: Option<Timestamp>,
    #[prost(string, tag = "2")]
    frame_id: String,
    #[prost(message, optional, tag = "3")]
    pose: Option<Placed>,
}

/// The messages of a pose, in the order of [`TOPICS`].
pub(super) fn messages(pose: Pose, stamp_ns: u64) -> [Vec<u8>; 2] {
    let nanos = (stamp_ns % 1_000_000_000) as i32;
    let timestamp = Some(Timestamp { seconds: (stamp_ns / 1_000_000_000) as i64, nanos });
    let (z, w) = (0.5 * (pose.theta + FRAC_PI_2)).sin_cos();
    let (place, turn) = (Vector3 { x: pose.x, y: pose.y, z: 0.0 }, Quaternion { x: 0.0, y: 0.0, z, w });
    let [parent, child] = FRAMES.map(str::to_owned);
    let transform = FrameTransform {
        timestamp,
        parent_frame_id: parent.clone(),
        child_frame_id: child,
        translation: Some(place.clone()),
        rotation: Some(turn.clone()),
    };
    let pose = Placed { position: Some(place), orientation: Some(turn) };
    [transform.encode_to_vec(), PoseInFrame { timestamp, frame_id: parent, pose: Some(pose) }.encode_to_vec()]
}

/// The file descriptor set of both messages.
pub(super) fn descriptor() -> Vec<u8> {
    let numbers = |names: &[&str]| -> Vec<FieldDescriptorProto> {
        names.iter().zip(1..).map(|(name, number)| field(name, number, Type::Double, None)).collect()
    };
    let parts = |names: &[(&str, &str)]| -> Vec<FieldDescriptorProto> {
        let part = |((name, kind), number): (&(&str, &str), i32)| match *kind {
            "string" => field(name, number, Type::String, None),
            kind => field(name, number, Type::Message, Some(kind)),
        };
        names.iter().zip(1..).map(part).collect()
    };
    let message = |name: &str, field: Vec<FieldDescriptorProto>| DescriptorProto {
        name: Some(name.to_owned()),
        field,
        ..DescriptorProto::default()
    };
    let time = FileDescriptorProto {
        name: Some("google/protobuf/timestamp.proto".to_owned()),
        package: Some("google.protobuf".to_owned()),
        message_type: vec![message(
            "Timestamp",
            vec![field("seconds", 1, Type::Int64, None), field("nanos", 2, Type::Int32, None)],
        )],
        syntax: Some("proto3".to_owned()),
        ..FileDescriptorProto::default()
    };
    let stamp = ("timestamp", ".google.protobuf.Timestamp");
    let transform = [
        stamp,
        ("parent_frame_id", "string"),
        ("child_frame_id", "string"),
        ("translation", ".foxglove.Vector3"),
        ("rotation", ".foxglove.Quaternion"),
    ];
    let scene = FileDescriptorProto {
        name: Some("foxglove/scene.proto".to_owned()),
        package: Some("foxglove".to_owned()),
        dependency: vec!["google/protobuf/timestamp.proto".to_owned()],
        message_type: vec![
            message("Vector3", numbers(&["x", "y", "z"])),
            message("Quaternion", numbers(&["x", "y", "z", "w"])),
            message("Pose", parts(&[("position", ".foxglove.Vector3"), ("orientation", ".foxglove.Quaternion")])),
            message("FrameTransform", parts(&transform)),
            message("PoseInFrame", parts(&[stamp, ("frame_id", "string"), ("pose", ".foxglove.Pose")])),
        ],
        syntax: Some("proto3".to_owned()),
        ..FileDescriptorProto::default()
    };
    FileDescriptorSet { file: vec![time, scene] }.encode_to_vec()
}

fn field(name: &str, number: i32, kind: Type, of: Option<&str>) -> FieldDescriptorProto {
    FieldDescriptorProto {
        name: Some(name.to_owned()),
        number: Some(number),
        label: Some(Label::Optional.into()),
        r#type: Some(kind.into()),
        type_name: of.map(str::to_owned),
        ..FieldDescriptorProto::default()
    }
}
