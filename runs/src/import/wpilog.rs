//! WPILib data logs: a head, then records of an entry's number, a time stamp (µs) and a payload. Entries of numbers keep
//! their names; arrays become `name.0`, `name.1`, ..., poses `name.x`, `.y`, `.theta`, chassis speeds `name.vx`, `.vy`, `.w`.

use std::collections::HashMap;
use std::path::Path;

use super::{Table, damaged};
use crate::error::InputError;

pub(super) const MAGIC: &[u8] = b"WPILOG";

/// A little-endian number of 1 to 8 bytes.
fn number(bytes: &[u8]) -> u64 {
    bytes.iter().rev().fold(0, |n, b| n << 8 | u64::from(*b))
}

fn take<'a>(rest: &mut &'a [u8], length: usize) -> Option<&'a [u8]> {
    let (bytes, after) = rest.split_at_checked(length)?;
    *rest = after;
    Some(bytes)
}

fn text(rest: &mut &[u8]) -> Option<String> {
    let length = number(take(rest, 4)?) as usize;
    Some(String::from_utf8_lossy(take(rest, length)?).into_owned())
}

pub(super) fn read(bytes: &[u8], path: &Path) -> Result<Table, InputError> {
    if !bytes.starts_with(MAGIC) {
        return Err(InputError::new(path, "does not start as a WPILib log does", "give a *.wpilog"));
    }
    let mut rest = &bytes[MAGIC.len()..];
    let extra = take(&mut rest, 2).and_then(|_| take(&mut rest, 4)).map_or(0, number) as usize;
    if take(&mut rest, extra).is_none() {
        return Err(damaged(path, MAGIC.len(), "the head is longer than the file"));
    }
    let mut entries: HashMap<u64, (String, String)> = HashMap::new();
    let mut table = Table::default();
    // A log of a robot that was switched off ends with its last whole record.
    while let Some((entry, stamp, payload)) = record(&mut rest) {
        if entry == 0 {
            let mut control = payload;
            if take(&mut control, 1) == Some(&[0]) {
                let id = take(&mut control, 4).map_or(0, number);
                if let (Some(name), Some(kind)) = (text(&mut control), text(&mut control)) {
                    entries.insert(id, (name, kind));
                }
            }
        } else if let Some((name, kind)) = entries.get(&entry) {
            sample(&mut table, name, kind, stamp as f64 / 1e6, payload);
        }
    }
    Ok(table)
}

fn record<'a>(rest: &mut &'a [u8]) -> Option<(u64, u64, &'a [u8])> {
    let mut at = *rest;
    let widths = take(&mut at, 1)?[0];
    let entry = number(take(&mut at, usize::from(widths & 3) + 1)?);
    let size = number(take(&mut at, usize::from(widths >> 2 & 3) + 1)?);
    let stamp = number(take(&mut at, usize::from(widths >> 4 & 7) + 1)?);
    let payload = take(&mut at, usize::try_from(size).ok()?)?;
    *rest = at;
    Some((entry, stamp, payload))
}

fn sample(table: &mut Table, name: &str, kind: &str, t: f64, payload: &[u8]) {
    let doubles = || payload.chunks_exact(8).map(|b| f64::from_bits(number(b)));
    let floats = || payload.chunks_exact(4).map(|b| f64::from(f32::from_bits(number(b) as u32)));
    let whole = || payload.chunks_exact(8).map(|b| number(b) as i64 as f64);
    let mut named = |parts: &[&str]| {
        for (part, value) in parts.iter().zip(doubles()) {
            table.push(&format!("{name}.{part}"), t, value);
        }
    };
    match kind {
        "struct:Pose2d" => named(&["x", "y", "theta"]),
        "struct:ChassisSpeeds" => named(&["vx", "vy", "w"]),
        "struct:DifferentialDriveWheelSpeeds" => named(&["left", "right"]),
        "double" => doubles().take(1).for_each(|v| table.push(name, t, v)),
        "float" => floats().take(1).for_each(|v| table.push(name, t, v)),
        "int64" => whole().take(1).for_each(|v| table.push(name, t, v)),
        "boolean" => payload.iter().take(1).for_each(|v| table.push(name, t, f64::from(*v))),
        "double[]" => doubles().enumerate().for_each(|(i, v)| table.push(&format!("{name}.{i}"), t, v)),
        "float[]" => floats().enumerate().for_each(|(i, v)| table.push(&format!("{name}.{i}"), t, v)),
        "int64[]" => whole().enumerate().for_each(|(i, v)| table.push(&format!("{name}.{i}"), t, v)),
        _ => {}
    }
}
