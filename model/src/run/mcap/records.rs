//! The records of a file, one after the other, as far as it goes.
//!
//! A walk of our own: the crate's reader has arithmetic that damaged lengths overflow (mcap 0.26.0), and
//! does not say whether a chunk that was cut off is the last one. Single records are parsed by the crate.

use std::borrow::Cow;
use std::collections::HashMap;

use mcap::MAGIC;
use mcap::records::{Channel, MessageHeader, Record, op};

/// A schema, as far as it matters.
#[derive(Debug)]
pub(super) struct Schema {
    pub(super) name: String,
    pub(super) data: Vec<u8>,
}

/// What goes by.
pub(super) struct Message<'a> {
    pub(super) header: MessageHeader,
    pub(super) channel: &'a Channel,
    pub(super) schema: Option<&'a Schema>,
    pub(super) data: &'a [u8],
}

/// Schemas and channels so far.
#[derive(Debug, Default)]
struct Known {
    schemas: HashMap<u16, Schema>,
    channels: HashMap<u16, Channel>,
}

/// Gives every message to `take`; whole chunks only. A file without its end, as a kill leaves it, ends with
/// its last whole record.
pub(super) fn messages<E>(
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

/// The content of a chunk; nothing for another record.
fn chunk(opcode: u8, body: &[u8]) -> Result<Option<Cow<'_, [u8]>>, String> {
    if opcode != op::CHUNK {
        return Ok(None);
    }
    let Record::Chunk { header, data } = mcap::parse_record(opcode, body).map_err(|e| e.to_string())? else {
        return Ok(None);
    };
    if !header.compression.is_empty() {
        return Err(format!("a chunk is compressed with {}: run `mcap decompress` on the file", header.compression));
    }
    // Zero says that there is none.
    let found = crc32fast::hash(&data);
    if header.uncompressed_crc != 0 && header.uncompressed_crc != found {
        return Err(format!("a chunk's CRC is {found:08x}, not {:08x}", header.uncompressed_crc));
    }
    Ok(Some(data))
}

fn record<E>(
    opcode: u8,
    body: &[u8],
    known: &mut Known,
    fail: &impl Fn(String) -> E,
    take: &mut impl FnMut(&Message<'_>) -> Result<(), E>,
) -> Result<(), E> {
    if !matches!(opcode, op::SCHEMA | op::CHANNEL | op::MESSAGE) {
        return Ok(());
    }
    match mcap::parse_record(opcode, body).map_err(|e| fail(e.to_string()))? {
        Record::Schema { header, data } => {
            known.schemas.insert(header.id, Schema { name: header.name, data: data.into_owned() });
        }
        Record::Channel(channel) => {
            known.channels.insert(channel.id, channel);
        }
        Record::Message { header, data } => {
            let Some(channel) = known.channels.get(&header.channel_id) else {
                return Err(fail(format!("a message of channel {}, which was never declared", header.channel_id)));
            };
            let schema = known.schemas.get(&channel.schema_id);
            take(&Message { header, channel, schema, data: &data })?;
        }
        _ => {}
    }
    Ok(())
}
