//! Game logs of the RoboCup small-size league: 16 bytes of head, then records of a time stamp (ns), a type, a length
//! (all big-endian) and a message. Vision (type 4, `SSL_WrapperPacket`) is read: robots become `yellow.3.x`, `.y` (m) and
//! `.theta` (rad, heading of the **forward** axis), at the time of capture.

use std::io::Read;
use std::path::Path;

use super::{Table, damaged};
use crate::error::InputError;
use crate::vision::{FieldSize, WrapperPacket};
use prost::Message;

pub(super) const MAGIC: &[u8] = b"SSL_LOG_FILE";
const GZIP: &[u8] = &[0x1f, 0x8b];
/// Type of a record of vision.
const VISION: u32 = 4;
/// Most that a compressed log is unpacked to, bytes: two hours of a game are 2 GB.
const MOST: u64 = 4 << 30;

pub(super) fn read(bytes: &[u8], path: &Path) -> Result<Table, InputError> {
    let mut table = Table::default();
    packets(bytes, path, |packet| {
        detection(packet, &mut table);
        true
    })?;
    Ok(table)
}

/// Whether bytes begin as a game log does, packed or not.
#[must_use]
pub fn is_game_log(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC) || bytes.starts_with(GZIP)
}

/// The sizes of the field in a game log: those of its first geometry message.
///
/// # Errors
/// A damaged log, or one without such a message.
pub fn field_size(bytes: &[u8], path: &Path) -> Result<FieldSize, InputError> {
    let mut found = None;
    packets(bytes, path, |packet| {
        found = packet.geometry.map(|geometry| geometry.field);
        found.is_none()
    })?;
    found.ok_or_else(|| InputError::new(path, "has no geometry message", "give a log of a game, or a file of sizes"))
}

/// Hands on every packet of vision while `more` of them are wanted.
fn packets(bytes: &[u8], path: &Path, mut more: impl FnMut(WrapperPacket) -> bool) -> Result<(), InputError> {
    let unpacked;
    let bytes = if bytes.starts_with(GZIP) {
        let mut out = Vec::new();
        let packed = flate2::read::MultiGzDecoder::new(bytes).take(MOST).read_to_end(&mut out);
        packed.map_err(|e| damaged(path, 0, format!("cannot be unpacked: {e}")))?;
        unpacked = out;
        &unpacked[..]
    } else {
        bytes
    };
    if !bytes.starts_with(MAGIC) {
        return Err(InputError::new(
            path,
            "does not start as a game log does",
            "give a log of ssl-logtools, .log or .log.gz",
        ));
    }
    let mut rest = bytes.get(16..).unwrap_or_default();
    while let Some((head, after)) = rest.split_first_chunk::<16>() {
        let place = bytes.len() - rest.len();
        let word = |at: usize| u32::from_be_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]);
        // A log that was cut off ends with its last whole record.
        let Some((message, after)) = after.split_at_checked(word(12) as usize) else { break };
        rest = after;
        if word(8) == VISION {
            let packet = WrapperPacket::decode(message).map_err(|e| damaged(path, place, e.to_string()))?;
            if !more(packet) {
                break;
            }
        }
    }
    Ok(())
}

fn detection(packet: WrapperPacket, table: &mut Table) {
    let Some(detection) = packet.detection else { return };
    let t = detection.t_capture;
    for (team, robots) in [("yellow", &detection.robots_yellow), ("blue", &detection.robots_blue)] {
        for robot in robots {
            let Some(id) = robot.robot_id else { continue };
            table.push(&format!("{team}.{id}.x"), t, 1e-3 * f64::from(robot.x));
            table.push(&format!("{team}.{id}.y"), t, 1e-3 * f64::from(robot.y));
            if let Some(theta) = robot.orientation {
                table.push(&format!("{team}.{id}.theta"), t, f64::from(theta));
            }
        }
    }
}
