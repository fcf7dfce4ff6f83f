//! The records of a file, one after the other, as far as it goes.
//!
//! A walk of our own: the crate's reader has arithmetic that damaged lengths overflow (mcap 0.26.0), takes as
//! much memory as a damaged length says, and does not say whether a chunk that was cut off is the last one.

use std::borrow::Cow;
use std::collections::HashMap;
use std::io::Read;

use mcap::MAGIC;
use mcap::records::op;

/// Largest chunk that is unpacked, bytes: writers make chunks of megabytes.
const MOST_UNPACKED: u64 = 1 << 30;

/// A schema, as far as it matters.
#[derive(Debug)]
pub(crate) struct Schema {
    pub(crate) name: String,
    pub(crate) data: Vec<u8>,
}

/// A topic, as far as it matters.
#[derive(Debug)]
pub(crate) struct Channel {
    pub(crate) id: u16,
    pub(crate) topic: String,
    pub(crate) message_encoding: String,
    schema_id: u16,
}

/// What goes by.
pub(crate) struct Message<'a> {
    pub(crate) log_time: u64,
    pub(crate) channel: &'a Channel,
    pub(crate) schema: Option<&'a Schema>,
    pub(crate) data: &'a [u8],
}

/// Schemas and channels so far.
#[derive(Debug, Default)]
struct Known {
    schemas: HashMap<u16, Schema>,
    channels: HashMap<u16, Channel>,
}

/// Gives every message to `take`; whole chunks only. A file without its end, as a kill leaves it, ends with
/// its last whole record.
pub(crate) fn messages<E>(
    bytes: &[u8],
    damaged: impl Fn(String) -> E,
    mut take: impl FnMut(&Message<'_>) -> Result<(), E>,
) -> Result<(), E> {
    let whole = bytes.len() >= 2 * MAGIC.len() && bytes.ends_with(MAGIC);
    let mut rest = &bytes[MAGIC.len()..];
    let mut known = Known::default();
    while !rest.is_empty() {
        let place = bytes.len() - rest.len();
        let fail = |what: String| damaged(format!("byte {place}: {what}"));
        let Some((opcode, body)) = next(&mut rest) else {
            return if whole { Err(fail("a record is longer than the file".to_owned())) } else { Ok(()) };
        };
        if opcode == op::DATA_END {
            return Ok(());
        }
        let Some(chunk) = chunk(opcode, body).map_err(fail)? else {
            record(opcode, body, &mut known, &fail, &mut take)?;
            continue;
        };
        let mut inner = &chunk[..];
        while !inner.is_empty() {
            let Some((opcode, body)) = next(&mut inner) else {
                return Err(fail("a record is longer than its chunk".to_owned()));
            };
            record(opcode, body, &mut known, &fail, &mut take)?;
        }
    }
    Ok(())
}

/// The next record; nothing where the bytes end before it does.
fn next<'a>(rest: &mut &'a [u8]) -> Option<(u8, &'a [u8])> {
    let (&opcode, after) = rest.split_first()?;
    let (length, after) = after.split_first_chunk::<8>()?;
    let (body, after) = after.split_at_checked(usize::try_from(u64::from_le_bytes(*length)).ok()?)?;
    *rest = after;
    Some((opcode, body))
}

/// The fields of a record, one after the other; a length is believed as far as there are bytes.
struct Fields<'a>(&'a [u8]);

impl<'a> Fields<'a> {
    fn bytes(&mut self, length: u64) -> Result<&'a [u8], String> {
        let (bytes, rest) = usize::try_from(length)
            .ok()
            .and_then(|length| self.0.split_at_checked(length))
            .ok_or("a field is longer than its record")?;
        self.0 = rest;
        Ok(bytes)
    }

    fn number(&mut self, width: u64) -> Result<u64, String> {
        Ok(self.bytes(width)?.iter().rev().fold(0, |number, byte| number << 8 | u64::from(*byte)))
    }

    fn id(&mut self) -> Result<u16, String> {
        Ok(self.number(2)? as u16)
    }

    fn text(&mut self) -> Result<String, String> {
        let length = self.number(4)?;
        String::from_utf8(self.bytes(length)?.to_vec()).map_err(|_| "a name is no UTF-8".to_owned())
    }
}

/// The content of a chunk; nothing for another record.
fn chunk(opcode: u8, body: &[u8]) -> Result<Option<Cow<'_, [u8]>>, String> {
    if opcode != op::CHUNK {
        return Ok(None);
    }
    let mut fields = Fields(body);
    // Times of the first and last message.
    fields.bytes(16)?;
    let size = fields.number(8)?;
    let crc = fields.number(4)?;
    let compression = fields.text()?;
    let length = fields.number(8)?;
    let data = unpacked(&compression, fields.bytes(length)?, size)?;
    // Zero says that there is none.
    let found = crc32fast::hash(&data);
    if crc != 0 && crc != u64::from(found) {
        return Err(format!("a chunk's CRC is {found:08x}, not {crc:08x}"));
    }
    Ok(Some(data))
}

/// A chunk's records; of a compressed one as many bytes as it says, and no more than [`MOST_UNPACKED`].
fn unpacked<'a>(compression: &str, data: &'a [u8], size: u64) -> Result<Cow<'a, [u8]>, String> {
    let all = |packed: &mut dyn Read| {
        let mut out = Vec::new();
        packed
            .take(size.min(MOST_UNPACKED))
            .read_to_end(&mut out)
            .map_err(|e| format!("a chunk cannot be unpacked: {e}"))?;
        if out.len() as u64 == size {
            Ok(Cow::Owned(out))
        } else {
            Err(format!("a chunk unpacks to {} bytes, not {size}", out.len()))
        }
    };
    match compression {
        "" => Ok(Cow::Borrowed(data)),
        "zstd" => {
            let decoder = ruzstd::decoding::StreamingDecoder::new(data);
            all(&mut decoder.map_err(|e| format!("a chunk cannot be unpacked: {e}"))?)
        }
        "lz4" => all(&mut lz4_flex::frame::FrameDecoder::new(data)),
        other => Err(format!("a chunk is compressed with {other}: run `mcap decompress` on the file")),
    }
}

fn record<E>(
    opcode: u8,
    body: &[u8],
    known: &mut Known,
    fail: &impl Fn(String) -> E,
    take: &mut impl FnMut(&Message<'_>) -> Result<(), E>,
) -> Result<(), E> {
    match opcode {
        op::SCHEMA => known.schema(body).map_err(fail),
        op::CHANNEL => known.channel(body).map_err(fail),
        op::MESSAGE => take(&known.message(body).map_err(fail)?),
        _ => Ok(()),
    }
}

/// Records by <https://mcap.dev/spec>, section "Records".
impl Known {
    fn schema(&mut self, body: &[u8]) -> Result<(), String> {
        let mut fields = Fields(body);
        let (id, name, _encoding) = (fields.id()?, fields.text()?, fields.text()?);
        let length = fields.number(4)?;
        self.schemas.insert(id, Schema { name, data: fields.bytes(length)?.to_vec() });
        Ok(())
    }

    fn channel(&mut self, body: &[u8]) -> Result<(), String> {
        let mut fields = Fields(body);
        let (id, schema_id) = (fields.id()?, fields.id()?);
        let (topic, message_encoding) = (fields.text()?, fields.text()?);
        self.channels.insert(id, Channel { id, topic, message_encoding, schema_id });
        Ok(())
    }

    fn message<'a>(&'a self, body: &'a [u8]) -> Result<Message<'a>, String> {
        let mut fields = Fields(body);
        let id = fields.id()?;
        let (_sequence, log_time, _publish_time) = (fields.number(4)?, fields.number(8)?, fields.number(8)?);
        let channel =
            self.channels.get(&id).ok_or_else(|| format!("a message of channel {id}, which was never declared"))?;
        Ok(Message { log_time, channel, schema: self.schemas.get(&channel.schema_id), data: fields.0 })
    }
}
