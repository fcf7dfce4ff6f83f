//! Reading a log.

use std::io::{BufRead, Read};
use std::path::Path;

use csv::ByteRecord;

use super::columns::{AS_SHARE, Column, GROUPS, MOST_DUTY, WHEEL_GROUPS, missing_member};
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
    let mut source = std::io::BufReader::with_capacity(1 << 16, source);
    let separator = separator(source.fill_buf().map_err(|e| RunError::io(path, &e))?);
    let mut csv = csv::ReaderBuilder::new()
        .delimiter(separator)
        .flexible(true)
        .has_headers(false)
        .trim(csv::Trim::All)
        .from_reader(source);
    let mut record = ByteRecord::new();
    let mut next = |record: &mut ByteRecord| {
        csv.read_byte_record(record).map_err(|e| RunError::new(path, e.to_string(), "save the log as CSV"))
    };
    if !next(&mut record)? {
        return Err(RunError::new(path, "is empty", "log at least a header row and one tick"));
    }
    let mut reader = Reader::header(path, text, &record, keep_other, separator)?;
    while next(&mut record)? {
        // A line of the last tick's time may belong to it.
        if reader.run.len() >= ticks
            && reader.time_of(&record) != reader.last_t
            && let Some(part) = reader.part()
        {
            take(part)?;
        }
        reader.row(&record)?;
        std::mem::swap(&mut record, &mut reader.before);
    }
    if let Some(rest) = reader.finish()? {
        take(rest)?;
    }
    Ok(())
}

/// What stands between the fields of a file: a comma, unless its first line has none but semicolons or tabs.
pub(crate) fn separator(head: &[u8]) -> u8 {
    let line = head.split(|b| *b == b'\n').next().unwrap_or(head);
    let number = |byte: u8| line.iter().filter(|b| **b == byte).count();
    match (number(b','), number(b';'), number(b'\t')) {
        (0, n, tabs) if n > 0 && n >= tabs => b';',
        (0, _, tabs) if tabs > 0 => b'\t',
        _ => b',',
    }
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
    separator: u8,
    /// Which fields the last tick has.
    filled: Vec<bool>,
    /// The part that is being read.
    run: Run,
    /// Time of the last tick, in this part or the one before.
    last_t: Option<f64>,
    /// Whether the camera's first sample has a heading.
    headed: Option<bool>,
    /// Last count of each wheel, once there was one.
    held: Vec<Option<i64>>,
    /// Whether no part was handed on yet.
    fresh: bool,
    /// Offset and number of fields of a short line: an error once it is known to be the last or not.
    short: Option<(usize, usize)>,
    /// The line before.
    before: ByteRecord,
    /// Lines that only repeat the one before: how many, and the offset of the first.
    repeated: Option<(usize, usize)>,
}

impl<'a> Reader<'a> {
    fn header(
        path: &'a Path,
        text: Text<'a>,
        record: &ByteRecord,
        keep_other: bool,
        separator: u8,
    ) -> Result<Self, RunError> {
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
        let notes = variants(&mut slots, separator);
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
                    _ if columns.iter().all(|c| *c == Column::Other) => {
                        "none of its columns is ours: `racbot convert --draft` writes a map to convert it with"
                            .to_owned()
                    }
                    _ => "log the time in seconds in a column named t".to_owned(),
                }
            };
            return missing("t".to_owned(), hint);
        }
        for (group, at_least) in GROUPS {
            if let Some(column) = missing_member(&columns, group, at_least) {
                return missing(column.name(), "log the whole group of columns, or none of it".to_owned());
            }
        }
        let width = |group: fn(usize) -> Column| (0..100).take_while(|i| columns.contains(&group(*i))).count();
        let widths: Vec<usize> = GROUPS[..WHEEL_GROUPS].iter().map(|(group, _)| width(*group)).collect();
        let wheels = widths.iter().copied().max().unwrap_or(0);
        for ((group, _), n) in GROUPS.iter().zip(&widths) {
            if (1..wheels).contains(n) {
                let hint = format!("other columns speak of {wheels} wheels; log this one for all of them");
                return missing(group(*n).name(), hint);
            }
        }
        let others = slots.iter().filter(|s| keep_other && s.column == Column::Other);
        let other = others.map(|s| (s.name.clone(), Vec::new())).collect();
        let run = Run { other, notes, ..Run::with_columns(&columns) };
        let (held, filled) = (vec![None; widths[1]], vec![false; slots.len()]);
        Ok(Self {
            path,
            text,
            slots,
            keep_other,
            separator,
            filled,
            run,
            last_t: None,
            headed: None,
            held,
            fresh: true,
            short: None,
            before: ByteRecord::new(),
            repeated: None,
        })
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
        // Two loggers of one topic, or a buffer that is written again: it says nothing new.
        if self.last_t.is_some() && *record == self.before {
            self.repeated.get_or_insert((0, offset)).0 += 1;
            return Ok(());
        }
        // Lines of one time with different fields are one tick of signals with clocks of their own.
        let same = self.last_t.is_some() && self.time_of(record) == self.last_t && !self.run.is_empty();
        let apart = || record.iter().zip(&self.slots).zip(&self.filled);
        let says = apart().any(|((f, s), _)| s.column != Column::Time && !f.is_empty());
        let joined =
            same && says && apart().all(|((f, s), filled)| s.column == Column::Time || f.is_empty() || !filled);
        if !joined {
            self.filled.fill(false);
        }
        let tick = self.run.t.len() - usize::from(joined);
        let mut camera = [f64::NAN; 3];
        let mut other = 0;
        let (path, text) = (self.path, self.text);
        for (i, field) in record.iter().enumerate() {
            let Slot { name, column } = &self.slots[i];
            let fail = |what: String, hint: &str| {
                Err(RunError::new(path, what, hint).at(text.line(offset), column_of(record, i)).field(name.clone()))
            };
            self.filled[i] |= !field.is_empty();
            let number = match column {
                Column::Other => {
                    if self.keep_other {
                        let text = String::from_utf8_lossy(field).into_owned();
                        let texts = &mut self.run.other[other].1;
                        match texts.get_mut(tick) {
                            Some(slot) if !text.is_empty() => *slot = text,
                            Some(_) => {}
                            None => texts.push(text),
                        }
                        other += 1;
                    }
                    continue;
                }
                Column::Counts(wheel) => {
                    let Ok(count) = counts(field) else {
                        let what = format!("{} is no whole number", quoted(field));
                        return fail(what, "log cumulative encoder counts, or leave the field empty");
                    };
                    let (counts, gaps) = (&mut self.run.counts[*wheel], &mut self.run.count_gaps[*wheel]);
                    if count.is_some() {
                        self.held[*wheel] = count;
                    }
                    if !joined {
                        // Before the first sample there is nothing to hold; take() fills it in.
                        counts.push(self.held[*wheel].unwrap_or(0));
                        gaps.extend(count.is_none().then_some(tick));
                    } else if let Some(count) = count {
                        counts[tick] = count;
                        gaps.pop_if(|gap| *gap == tick);
                    }
                    continue;
                }
                _ if field.is_empty() => f64::NAN,
                _ => match self.number(field) {
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
                Column::Time if joined => continue,
                Column::Time => {
                    if number.is_nan() {
                        return fail("is empty".to_owned(), "every tick needs its time");
                    }
                    if let Some(before) = self.last_t.filter(|before| number <= *before) {
                        if number == before {
                            let hint = "log one line a tick, with times of more digits; rows of one beat, whose times have \
                                        none, are numbered by `racbot convert` with rate_hz";
                            return fail(format!("time {number} s stands twice"), hint);
                        }
                        let what = format!("time runs backwards, from {before} s to {number} s");
                        return fail(what, "sort the log by time, one line a tick");
                    }
                    self.last_t = Some(number);
                }
                Column::Duty(_) if number.abs() > MOST_DUTY => {
                    return fail(format!("duty {number} is not within ±1"), AS_SHARE);
                }
                Column::Camera(i) => camera[*i] = number,
                _ => {}
            }
            if let Some(numbers) = self.run.real_mut(*column) {
                match numbers.get_mut(tick) {
                    Some(slot) if !number.is_nan() => *slot = number,
                    Some(_) => {}
                    None => numbers.push(number),
                }
            }
        }
        // An inertial sensor may have some of its axes only.
        for group in [&mut self.run.gyro, &mut self.run.acceleration].into_iter().flatten() {
            group.iter_mut().for_each(|axis| axis.resize(tick + 1, f64::NAN));
        }
        match camera.map(|c| !c.is_nan()) {
            [false, false, false] => {}
            // A log has headings, or none.
            [true, true, headed] if *self.headed.get_or_insert(headed) == headed => {
                self.run.camera.push(CameraSample { tick, pose: Pose::new(camera[0], camera[1], camera[2]) });
            }
            _ => {
                let what = "a camera sample has only a part of x, y and theta";
                let error = RunError::new(
                    self.path,
                    what,
                    "log all three, or none at this tick; without cam_theta throughout, positions are compared alone",
                );
                return Err(error.at(self.line(offset), 1).field("cam_x, cam_y, cam_theta"));
            }
        }
        Ok(())
    }

    /// The number in a field; German and French spreadsheets, which part fields by semicolons, have decimal commas.
    fn number(&self, field: &[u8]) -> Option<f64> {
        let text = std::str::from_utf8(field).ok()?;
        if self.separator != b',' && text.contains(',') {
            return text.replace(',', ".").parse().ok();
        }
        text.parse().ok()
    }

    /// The time in a line, if there is one.
    fn time_of(&self, record: &ByteRecord) -> Option<f64> {
        let slot = self.slots.iter().position(|s| s.column == Column::Time)?;
        record.get(slot).and_then(|field| self.number(field))
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
        if let Some((lines, offset)) = self.repeated {
            let first = self.line(offset);
            self.run.notes.push(match lines {
                1 => format!("line {first} repeats the line before it and is left out"),
                _ => format!("{lines} lines repeat the line before them and are left out, the first is line {first}"),
            });
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

/// Takes columns whose names are ours but for their spelling, and says so; and what looks like a slip of one of ours.
fn variants(slots: &mut [Slot], separator: u8) -> Vec<String> {
    let mut notes = Vec::new();
    if separator != b',' {
        let which = if separator == b';' { "semicolons" } else { "tabs" };
        notes.push(format!("fields are parted by {which}, decimal commas read as points"));
    }
    for i in 0..slots.len() {
        if slots[i].column != Column::Other {
            continue;
        }
        if let Some(column) = Column::from_variant(&slots[i].name).filter(|c| slots.iter().all(|s| s.column != *c)) {
            notes.push(format!("column {} is read as {}", slots[i].name, column.name()));
            slots[i].column = column;
        } else if let Some(ours) = Column::resembling(&slots[i].name)
            && slots.iter().all(|s| s.name != ours)
        {
            notes.push(format!("column {} is not read: if it is {ours}, rename it", slots[i].name));
        }
    }
    notes
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
