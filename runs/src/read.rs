//! Reading a log.

use std::io::{BufRead, Read};
use std::path::Path;

use csv::ByteRecord;

use super::columns::{Column, missing_member};
use super::{CameraSample, Columns, Run, RunError};
use crate::error::nearest;
use crate::frames::Pose;

impl Run {
    /// Reads a log: MCAP where the name ends in `.mcap`, else CSV.
    ///
    /// # Errors
    /// [`RunError`] with line, column and field for an unreadable or empty file, a header without
    /// `t` or with columns twice or missing from a group, text where a number must be, NaN,
    /// infinity, time that does not increase, and lines with too few or too many fields.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, RunError> {
        let path = path.as_ref();
        let bytes = std::fs::read(path).map_err(|e| RunError::io(path, &e))?;
        let mut run = Self::from_bytes(&bytes, path)?;
        run.name = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        Ok(run)
    }

    /// Reads a log in memory, of the kind that the name of `path` says.
    ///
    /// # Errors
    /// As [`Run::read`].
    pub fn from_bytes(bytes: &[u8], path: &Path) -> Result<Self, RunError> {
        if super::stream::is_mcap(path) { super::mcap::read(bytes, path) } else { Self::from_reader(bytes, path) }
    }

    /// Reads a CSV log from anywhere; `path` is for the error messages.
    ///
    /// # Errors
    /// As [`Run::read`].
    pub fn from_reader(mut reader: impl Read, path: &Path) -> Result<Self, RunError> {
        let mut bytes = Vec::new();
        reader.read_to_end(&mut bytes).map_err(|e| RunError::io(path, &e))?;
        let mut whole = None;
        parse(&bytes[..], Text::Bytes(&bytes), path, usize::MAX, true, |run| {
            whole = Some(run);
            Ok(())
        })?;
        whole.ok_or_else(|| RunError::new(path, "has a header but no ticks", "log at least one line"))
    }
}

/// Reads a CSV log from its file and hands it on in parts of `ticks`, without the columns that nobody knows. Every part
/// counts its ticks from 0.
///
/// # Errors
/// As [`Run::read`], and what `take` returns; parts before the fault were handed on.
pub(super) fn in_parts(
    path: &Path,
    ticks: usize,
    take: impl FnMut(Run) -> Result<(), RunError>,
) -> Result<(), RunError> {
    let file = std::fs::File::open(path).map_err(|e| RunError::io(path, &e))?;
    parse(file, Text::File(path), path, ticks, false, take)
}

/// What the lines of a fault are counted in.
#[derive(Clone, Copy)]
enum Text<'a> {
    Bytes(&'a [u8]),
    File(&'a Path),
}

impl Text<'_> {
    /// Line (from 1) of the record read from `offset`; what is blank in between is not part of it.
    fn line(self, offset: usize) -> usize {
        let count = |bytes: &mut dyn BufRead| -> std::io::Result<usize> {
            let (mut place, mut newlines) = (0, 0);
            loop {
                let part = bytes.fill_buf()?;
                let length = part.len();
                for byte in part {
                    if place >= offset && !matches!(byte, b'\r' | b'\n') {
                        return Ok(newlines + 1);
                    }
                    newlines += usize::from(*byte == b'\n');
                    place += 1;
                }
                if length == 0 {
                    return Ok(newlines + 1);
                }
                bytes.consume(length);
            }
        };
        match self {
            Self::Bytes(mut bytes) => count(&mut bytes).unwrap_or(1),
            Self::File(path) => {
                std::fs::File::open(path).and_then(|f| count(&mut std::io::BufReader::new(f))).unwrap_or(1)
            }
        }
    }
}

fn parse(
    source: impl Read,
    text: Text,
    path: &Path,
    ticks: usize,
    keep_other: bool,
    mut take: impl FnMut(Run) -> Result<(), RunError>,
) -> Result<(), RunError> {
    let mut csv = csv::ReaderBuilder::new().flexible(true).has_headers(false).trim(csv::Trim::All).from_reader(source);
    let mut record = ByteRecord::new();
    let mut next = |record: &mut ByteRecord| {
        csv.read_byte_record(record).map_err(|e| RunError::new(path, e.to_string(), "save the log as CSV"))
    };
    if !next(&mut record)? {
        return Err(RunError::new(path, "is empty", "log at least a header row and one tick"));
    }
    let mut reader = Reader::header(path, text, &record, keep_other)?;
    while next(&mut record)? {
        reader.row(&record)?;
        if reader.run.len() >= ticks
            && let Some(part) = reader.part()
        {
            take(part)?;
        }
    }
    if let Some(rest) = reader.finish()? {
        take(rest)?;
    }
    Ok(())
}

/// What one column fills.
struct Slot {
    name: String,
    column: Column,
}

struct Reader<'a> {
    path: &'a Path,
    text: Text<'a>,
    slots: Vec<Slot>,
    keep_other: bool,
    /// The part that is being read.
    run: Run,
    /// Time of the last tick, in this part or the one before.
    last_t: Option<f64>,
    /// Last count of each wheel, once there was one.
    held: Vec<Option<i64>>,
    /// Whether no part was handed on yet.
    fresh: bool,
    /// Offset and number of fields of a short line: an error once it is known to be the last or not.
    short: Option<(usize, usize)>,
}

impl<'a> Reader<'a> {
    fn header(path: &'a Path, text: Text<'a>, record: &ByteRecord, keep_other: bool) -> Result<Self, RunError> {
        let mut slots: Vec<Slot> = Vec::new();
        for (i, field) in record.iter().enumerate() {
            let field = if i == 0 { field.strip_prefix(b"\xef\xbb\xbf").unwrap_or(field) } else { field };
            // Other people's column names need not be UTF-8; ours are ASCII.
            let name = String::from_utf8_lossy(field).trim().to_owned();
            if slots.iter().any(|s| s.name == name) {
                let error = RunError::new(path, "stands twice in the header", "rename or remove one of the two");
                return Err(error.at(1, column_of(record, i)).field(name));
            }
            slots.push(Slot { column: Column::from_name(&name), name });
        }
        let names: Vec<&str> = slots.iter().map(|s| s.name.as_str()).collect();
        let columns: Vec<Column> = slots.iter().map(|s| s.column).collect();
        let missing =
            |name: String, hint: String| Err(RunError::new(path, "no such column", hint).at(1, 1).field(name));
        if !columns.contains(&Column::Time) {
            let hint = if names.iter().any(|n| n.parse::<f64>().is_ok()) {
                "the first line must be a header with column names".to_owned()
            } else {
                match nearest("t", &names).or_else(|| names.iter().find(|n| n.starts_with("time")).copied()) {
                    Some(name) if !name.is_empty() => format!("name the column with the time in seconds t, not {name}"),
                    _ => "log the time in seconds in a column named t".to_owned(),
                }
            };
            return missing("t".to_owned(), hint);
        }
        type Group = (fn(usize) -> Column, usize);
        let groups: [Group; 6] = [
            (Column::Reference, 0),
            (Column::Counts, 0),
            (Column::Duty, 0),
            (Column::Measured, 0),
            (Column::Command, 3),
            (Column::Camera, 3),
        ];
        for (group, at_least) in groups {
            if let Some(column) = missing_member(&columns, group, at_least) {
                return missing(column.name(), "log the whole group of columns, or none of it".to_owned());
            }
        }
        let width = |group: fn(usize) -> Column| (0..100).take_while(|i| columns.contains(&group(*i))).count();
        let widths = [Column::Reference, Column::Counts, Column::Duty, Column::Measured].map(width);
        let wheels = widths.into_iter().max().unwrap_or(0);
        for ((group, _), n) in groups.iter().zip(widths) {
            if n > 0 && n < wheels {
                let hint = format!("other columns speak of {wheels} wheels; log this one for all of them");
                return missing(group(n).name(), hint);
            }
        }
        let run = Run {
            command: columns.contains(&Column::Command(0)).then(Default::default),
            reference: vec![Vec::new(); widths[0]],
            counts: vec![Vec::new(); widths[1]],
            count_gaps: vec![Vec::new(); widths[1]],
            duty: vec![Vec::new(); widths[2]],
            measured: vec![Vec::new(); widths[3]],
            supply_v: columns.contains(&Column::Supply).then(Vec::new),
            has_camera: columns.contains(&Column::Camera(0)),
            other: slots
                .iter()
                .filter(|s| keep_other && s.column == Column::Other)
                .map(|s| (s.name.clone(), Vec::new()))
                .collect(),
            ..Run::default()
        };
        let held = vec![None; widths[1]];
        Ok(Self { path, text, slots, keep_other, run, last_t: None, held, fresh: true, short: None })
    }

    fn row(&mut self, record: &ByteRecord) -> Result<(), RunError> {
        // A line of blanks is read as one empty field.
        if record.iter().all(<[u8]>::is_empty) && record.len() == 1 && self.slots.len() > 1 {
            return Ok(());
        }
        let offset = record.position().map_or(0, csv::Position::byte) as usize;
        if let Some((offset, fields)) = self.short {
            return Err(self.wrong_width(offset, fields, "complete the line"));
        }
        if record.len() > self.slots.len() {
            return Err(self.wrong_width(offset, record.len(), "quote fields that contain a comma"));
        }
        if record.len() < self.slots.len() {
            self.short = Some((offset, record.len()));
            return Ok(());
        }
        let tick = self.run.t.len();
        let mut camera = [f64::NAN; 3];
        let mut other = 0;
        for (i, field) in record.iter().enumerate() {
            let Slot { name, column } = &self.slots[i];
            let fail = |what: String, hint: &str| {
                Err(RunError::new(self.path, what, hint)
                    .at(self.line(offset), column_of(record, i))
                    .field(name.clone()))
            };
            let number = match column {
                Column::Other => {
                    if self.keep_other {
                        self.run.other[other].1.push(String::from_utf8_lossy(field).into_owned());
                        other += 1;
                    }
                    continue;
                }
                Column::Counts(wheel) => {
                    let Ok(count) = counts(field) else {
                        let what = format!("{} is no whole number", quoted(field));
                        return fail(what, "log cumulative encoder counts, or leave the field empty");
                    };
                    if count.is_some() {
                        self.held[*wheel] = count;
                    } else {
                        self.run.count_gaps[*wheel].push(tick);
                    }
                    // Before the first sample there is nothing to hold; take() fills it in.
                    self.run.counts[*wheel].push(self.held[*wheel].unwrap_or(0));
                    continue;
                }
                _ if field.is_empty() => f64::NAN,
                _ => match std::str::from_utf8(field).ok().and_then(|s| s.parse::<f64>().ok()) {
                    Some(x) if x.is_finite() => x,
                    Some(x) => {
                        return fail(
                            format!("{x} is not a finite number"),
                            "leave the field empty if there is no sample",
                        );
                    }
                    None => {
                        return fail(format!("{} is no number", quoted(field)), "write numbers with a decimal point");
                    }
                },
            };
            match column {
                Column::Time => {
                    if number.is_nan() {
                        return fail("is empty".to_owned(), "every tick needs its time");
                    }
                    if let Some(before) = self.last_t.filter(|before| number <= *before) {
                        let what = if number == before {
                            format!("time {number} s stands twice")
                        } else {
                            format!("time runs backwards, from {before} s to {number} s")
                        };
                        return fail(what, "sort the log by time, one line a tick");
                    }
                    self.run.t.push(number);
                    self.last_t = Some(number);
                }
                Column::Command(i) => {
                    if let Some(command) = &mut self.run.command {
                        command[*i].push(number);
                    }
                }
                Column::Reference(wheel) => self.run.reference[*wheel].push(number),
                Column::Measured(wheel) => self.run.measured[*wheel].push(number),
                Column::Duty(wheel) => {
                    // Roundings of a logger may pass the limit by a digit, no more.
                    if number.abs() > 1.001 {
                        return fail(
                            format!("duty {number} is not within ±1"),
                            "log the duty as a share of the supply",
                        );
                    }
                    self.run.duty[*wheel].push(number);
                }
                Column::Supply => {
                    if let Some(supply) = &mut self.run.supply_v {
                        supply.push(number);
                    }
                }
                Column::Camera(i) => camera[*i] = number,
                Column::Counts(_) | Column::Other => {}
            }
        }
        match camera.iter().filter(|c| !c.is_nan()).count() {
            0 => {}
            3 => self.run.camera.push(CameraSample { tick, pose: Pose::new(camera[0], camera[1], camera[2]) }),
            _ => {
                let what = "a camera sample has only a part of x, y and theta";
                let error = RunError::new(self.path, what, "log all three, or none at this tick");
                return Err(error.at(self.line(offset), 1).field("cam_x, cam_y, cam_theta"));
            }
        }
        Ok(())
    }

    /// What was read since the last part; nothing while a wheel has no count to begin with.
    fn part(&mut self) -> Option<Run> {
        self.held.iter().all(Option::is_some).then(|| self.take())
    }

    fn take(&mut self) -> Run {
        for (counts, gaps) in self.run.counts.iter_mut().zip(&self.run.count_gaps) {
            // Only the first part begins without a count to hold.
            let leading = gaps.iter().enumerate().take_while(|(i, tick)| i == *tick).count();
            if let Some(first) = counts.get(leading).copied().filter(|_| self.fresh) {
                counts[..leading].fill(first);
            }
        }
        self.fresh = false;
        let empty = self.run.emptied(Columns::ALL);
        std::mem::replace(&mut self.run, empty)
    }

    /// The last part; nothing where it would be empty.
    fn finish(mut self) -> Result<Option<Run>, RunError> {
        if let Some((line, fields)) = self.short {
            return Err(self.wrong_width(
                line,
                fields,
                "the file ends too early: copy it again or delete its last line",
            ));
        }
        if self.last_t.is_none() {
            return Err(RunError::new(self.path, "has a header but no ticks", "log at least one line"));
        }
        Ok((!self.run.is_empty()).then(|| self.take()))
    }

    fn line(&self, offset: usize) -> usize {
        self.text.line(offset)
    }

    fn wrong_width(&self, offset: usize, fields: usize, hint: &str) -> RunError {
        let what = format!("{fields} fields, but the header has {}", self.slots.len());
        RunError::new(self.path, what, hint).at(self.line(offset), 1)
    }
}

/// Column (from 1) of a field in its line; exact where nothing is quoted.
fn column_of(record: &ByteRecord, field: usize) -> usize {
    record.range(field).map_or(1, |r| r.start + field + 1)
}

/// A count, or `None` for an empty field; `1e3` and `12.0` are whole numbers too.
fn counts(field: &[u8]) -> Result<Option<i64>, ()> {
    if field.is_empty() {
        return Ok(None);
    }
    let text = std::str::from_utf8(field).map_err(|_| ())?;
    if let Ok(count) = text.parse::<i64>() {
        return Ok(Some(count));
    }
    // Beyond 2^53 a floating-point number no longer says which count it was.
    let exact = |x: &f64| x.fract() == 0.0 && x.abs() <= 9.007_199_254_740_992e15;
    text.parse::<f64>().ok().filter(exact).map(|x| Some(x as i64)).ok_or(())
}

/// A field as an error message can show it.
fn quoted(field: &[u8]) -> String {
    let text: String = String::from_utf8_lossy(field).chars().take(24).collect();
    format!("{text:?}")
}
