//! The protobuf messages, described the way `protoc` would.
//!
//! Field numbers are part of the format and never change.

use prost::Message;
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::source_code_info::Location;
use prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorProto, FileDescriptorSet, SourceCodeInfo};

use crate::columns::Column;

/// Message of every tick.
pub(super) const TICK: &str = "racbot.Tick";
/// Message of a camera pose.
pub(super) const CAMERA: &str = "racbot.Camera";
const PACKAGE: &str = "racbot";

/// The number of a column's field.
pub(super) fn number(column: Column) -> u32 {
    let wheel = |base: u32, wheel: usize| base + wheel as u32;
    match column {
        Column::Time => 1,
        Column::Command(i) | Column::Camera(i) => 2 + i as u32,
        Column::Supply => 5,
        Column::Reference(i) => wheel(101, i),
        Column::Counts(i) => wheel(201, i),
        Column::Duty(i) => wheel(301, i),
        Column::Measured(i) => wheel(401, i),
        Column::Speed(i) => wheel(501, i),
        Column::Current(i) => wheel(601, i),
        Column::Odometry(i) => wheel(6, i),
        Column::Gyro(i) => wheel(9, i),
        Column::Acceleration(i) => wheel(12, i),
        Column::ImuTemperature => 15,
        Column::Other => 0,
    }
}

/// Where a field stands in its file, by the numbers of `message_type`, `field` and its place, and the comment before it.
fn unit((place, column): (usize, &Column)) -> Location {
    Location {
        path: vec![4, 0, 2, place as i32],
        span: vec![place as i32, 0, 0],
        leading_comments: Some(format!(" {}\n", column.unit())),
        ..Location::default()
    }
}

/// A file descriptor set with one message of these columns, the unit of each in the comment before its field.
pub(super) fn descriptor(message: &str, columns: &[Column]) -> Vec<u8> {
    let field = |column: &Column| FieldDescriptorProto {
        name: Some(column.name()),
        number: Some(number(*column) as i32),
        label: Some(Label::Optional.into()),
        r#type: Some(if matches!(column, Column::Counts(_)) { Type::Sint64 } else { Type::Double }.into()),
        ..FieldDescriptorProto::default()
    };
    let name = message.rsplit('.').next().unwrap_or(message);
    let file = FileDescriptorProto {
        name: Some(format!("{PACKAGE}/{}.proto", name.to_lowercase())),
        package: Some(PACKAGE.to_owned()),
        message_type: vec![DescriptorProto {
            name: Some(name.to_owned()),
            field: columns.iter().map(field).collect(),
            ..DescriptorProto::default()
        }],
        source_code_info: Some(SourceCodeInfo { location: columns.iter().enumerate().map(unit).collect() }),
        // Of all syntaxes the one whose optional fields tell "no sample" from zero without more ado.
        syntax: Some("proto2".to_owned()),
        ..FileDescriptorProto::default()
    };
    FileDescriptorSet { file: vec![file] }.encode_to_vec()
}
