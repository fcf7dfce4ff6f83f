//! Writing.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{self, Seek, Write};

use mcap::records::MessageHeader;
use mcap::{Attachment, McapError, WriteOptions, Writer};
use prost::encoding::{double, sint64};

use super::scene;
use super::schema::{CAMERA, TICK, descriptor, number};
use crate::columns::Column;
use crate::stream::{Layout, RunStream, Tick};

/// An MCAP that is complete up to its last flush at any time.
pub struct McapStream<W: Write + Seek> {
    writer: Writer<W>,
    tick: Topic,
    camera: Option<Topic>,
    /// What 3D views draw, beside the camera.
    scene: Vec<(u16, u32)>,
    start_ns: u64,
}

struct Topic {
    channel: u16,
    columns: Vec<Column>,
    sequence: u32,
}

impl<W: Write + Seek> McapStream<W> {
    /// Writes the head; `start_ns` is the time of t = 0 since 1970.
    ///
    /// # Errors
    /// What the writer reports.
    pub fn new(writer: W, layout: Layout, start_ns: u64) -> io::Result<Self> {
        // Without seeking a chunk leaves as a whole, so that a kill cuts between chunks.
        let options = WriteOptions::new().disable_seeking(true).profile("racbot").library("racbot");
        let mut writer = options.create(writer).map_err(other)?;
        let tick: Vec<Column> =
            layout.columns().into_iter().filter(|column| !matches!(column, Column::Camera(_))).collect();
        let camera = layout.camera.then(|| {
            let columns = std::iter::once(Column::Time).chain((0..3).map(Column::Camera)).collect();
            topic(&mut writer, "/racbot/camera", CAMERA, columns)
        });
        let mut scene = Vec::new();
        for (name, message) in scene::TOPICS.iter().filter(|_| layout.camera) {
            let schema = writer.add_schema(message, "protobuf", &scene::descriptor()).map_err(other)?;
            scene.push((writer.add_channel(schema, name, "protobuf", &BTreeMap::new()).map_err(other)?, 0));
        }
        Ok(Self {
            scene,
            tick: topic(&mut writer, "/racbot/tick", TICK, tick)?,
            camera: camera.transpose()?,
            writer,
            start_ns,
        })
    }
}

fn topic<W: Write + Seek>(
    writer: &mut Writer<W>,
    name: &str,
    message: &str,
    columns: Vec<Column>,
) -> io::Result<Topic> {
    let schema = writer.add_schema(message, "protobuf", &descriptor(message, &columns)).map_err(other)?;
    let channel = writer.add_channel(schema, name, "protobuf", &BTreeMap::new()).map_err(other)?;
    Ok(Topic { channel, columns, sequence: 0 })
}

impl Topic {
    fn write<W: Write + Seek>(&mut self, writer: &mut Writer<W>, start_ns: u64, tick: &Tick<'_>) -> io::Result<()> {
        let mut data = Vec::with_capacity(16 * self.columns.len());
        for &column in &self.columns {
            if let Column::Counts(wheel) = column {
                if let Some(count) = tick.count(wheel) {
                    sint64::encode(number(column), &count, &mut data);
                }
                continue;
            }
            let value = tick.number(column);
            if !value.is_nan() {
                double::encode(number(column), &value, &mut data);
            }
        }
        let exact = stamp(start_ns, tick.t);
        let header =
            MessageHeader { channel_id: self.channel, sequence: self.sequence, log_time: exact, publish_time: exact };
        self.sequence = self.sequence.wrapping_add(1);
        writer.write_to_known_channel(&header, &Cow::Owned(data)).map_err(other)
    }
}

/// Nanoseconds since 1970; times before have no stamp, the field t keeps them.
fn stamp(start_ns: u64, t: f64) -> u64 {
    if t >= 0.0 {
        return start_ns.saturating_add((t * 1e9).round() as u64);
    }
    (start_ns as f64 + t * 1e9).round().max(0.0) as u64
}

impl<W: Write + Seek + Send> RunStream for McapStream<W> {
    fn tick(&mut self, tick: &Tick<'_>) -> io::Result<()> {
        if let (Some(camera), Some(pose)) = (&mut self.camera, tick.camera) {
            camera.write(&mut self.writer, self.start_ns, tick)?;
            let at = stamp(self.start_ns, tick.t);
            for ((channel_id, sequence), data) in self.scene.iter_mut().zip(scene::messages(pose, at)) {
                let header =
                    MessageHeader { channel_id: *channel_id, sequence: *sequence, log_time: at, publish_time: at };
                *sequence = sequence.wrapping_add(1);
                self.writer.write_to_known_channel(&header, &Cow::Owned(data)).map_err(other)?;
            }
        }
        self.tick.write(&mut self.writer, self.start_ns, tick)
    }

    fn attach(&mut self, name: &str, text: &str) -> io::Result<()> {
        let attachment = Attachment {
            log_time: self.start_ns,
            create_time: self.start_ns,
            name: name.to_owned(),
            media_type: "text/plain".to_owned(),
            data: Cow::Borrowed(text.as_bytes()),
        };
        self.writer.attach(&attachment).map_err(other)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush().map_err(other)
    }

    fn finish(&mut self) -> io::Result<()> {
        self.writer.finish().map(drop).map_err(other)
    }
}

fn other(error: McapError) -> io::Error {
    match error {
        McapError::Io(error) => error,
        error => io::Error::other(error),
    }
}
