//! Runs as MCAP files, which Foxglove and Rerun open: <https://mcap.dev/spec>.
//!
//! Two protobuf topics, whose fields have the names and units of the CSV's columns:
//! `/racbot/tick`, every tick, and `/racbot/camera`, where there is a pose; with it goes the robot as 3D views draw it
//! (`scene`). The `robot.toml` of a recording is an attachment. The reader takes any topic, protobuf or JSON, with fields
//! of the columns' names.

mod fields;
mod read;
mod records;
mod scene;
mod schema;
mod write;

pub use write::McapStream;

pub(crate) use fields::Topic;
pub(super) use read::read;
pub(crate) use records::messages;

#[cfg(test)]
mod tests;
