//! Other tools' logs: whatever they hold becomes named series of numbers, of which a map (a TOML file) makes a run.
//!
//! One file a format: any CSV (PlotJuggler's among them), JSON, ROS 2 bags (MCAP with CDR messages), game logs of the RoboCup
//! small-size league, WPILib data logs.

mod agreement;
mod cdr;
mod columns;
mod csv;
mod dates;
mod draft;
mod fill;
mod frame;
mod join;
mod json;
mod labelled;
mod legend;
mod line;
mod many;
mod map;
mod misread;
mod owner;
mod reading;
mod ros2;
mod rotations;
mod rows;
mod scope;
mod sheet;
mod ssl;
mod sysid;
mod time;
mod titles;
mod trace;
mod track;
mod truth;
mod units;
mod wpilog;

use std::path::Path;

use crate::error::{InputError, nearest};

pub use agreement::Agreement;
pub use draft::{draft, draft_two};
pub use join::Joined;
pub use many::{Drive, drives};
pub use map::{Imported, Map, Recording};
pub use ssl::{field_size, is_game_log};

/// Samples of one quantity.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// Name, with the topic or entry it comes from.
    pub name: String,
    /// Times, s, in the order of the file.
    pub t: Vec<f64>,
    /// Values in the file's unit; as many as times.
    pub values: Vec<f64>,
}

/// Everything numeric that a file holds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// The series, in the order in which they appear.
    pub series: Vec<Series>,
    /// The column of time of a CSV and its unit, s.
    pub time: Option<(String, f64)>,
    /// The column that says whose each row is, by which the rows were taken apart.
    pub of: Option<String>,
    /// That it holds several recordings.
    pub restart: Option<Restart>,
    /// What the file calls them, in their order, where it does.
    pub recordings: Vec<String>,
    /// What its owner would want to know: rows that are left out, names that do not match the numbers.
    pub remarks: Vec<String>,
    index: std::collections::HashMap<String, usize>,
}

/// Recordings of one file, one after the other: the time starts again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Restart {
    /// Line where the second begins.
    pub line: usize,
    /// How many there are.
    pub recordings: usize,
}

/// The time of a text table or a JSON; other files have their own.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Clock<'a> {
    /// The name of its column; else the one that is named like time.
    pub column: Option<&'a str>,
    /// Its unit, s; else the one in its name, else a second.
    pub unit_s: Option<f64>,
    /// There is none: so many rows a second.
    pub rate_hz: Option<f64>,
    /// It is a counter that begins again after so many, in the file's unit.
    pub wraps: Option<f64>,
    /// Which recording of the file, from 1.
    pub recording: Option<usize>,
    /// The column that says of which motor, sensor or robot each row is: they are a table each.
    pub of: Option<&'a str>,
    /// Count rows where there is no such column.
    pub rows: bool,
}

/// A kind of file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Text in columns, one of them the time.
    Csv,
    /// Records, columns or rows of numbers in JSON, or JSON by the line.
    Json,
    /// ROS 2 bag in an MCAP.
    Ros2,
    /// Game log of the small-size league, `.log` or `.log.gz`.
    Ssl,
    /// WPILib data log.
    Wpilog,
}

impl Format {
    /// By the name that a map gives it.
    pub fn from_name(name: &str) -> Option<Self> {
        Some(match name {
            "csv" | "plotjuggler" => Self::Csv,
            "json" | "jsonl" => Self::Json,
            "ros2" | "mcap" => Self::Ros2,
            "ssl" | "ssl-log" => Self::Ssl,
            "wpilog" | "wpilib" => Self::Wpilog,
            _ => return None,
        })
    }

    /// By a file's first bytes, else its name.
    fn of(path: &Path, bytes: &[u8]) -> Self {
        let name = path.to_string_lossy().to_lowercase();
        match () {
            () if bytes.starts_with(mcap::MAGIC) => Self::Ros2,
            () if bytes.starts_with(wpilog::MAGIC) => Self::Wpilog,
            () if bytes.starts_with(ssl::MAGIC) || name.ends_with(".log.gz") => Self::Ssl,
            () if json::is_json(&name, bytes) => Self::Json,
            () => Self::Csv,
        }
    }
}

impl Series {
    /// Least and greatest value.
    pub fn range(&self) -> [f64; 2] {
        span(self.values.iter().copied())
    }
}

/// Least and greatest of some values.
fn span(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
}

impl Table {
    /// Its first and last time, s.
    fn times(&self) -> [f64; 2] {
        span(self.series.iter().flat_map(|s| s.t.iter().copied()))
    }

    /// Reads a file. `time` says what the map says of the time column of a CSV.
    ///
    /// # Errors
    /// [`InputError`] with the place (line and column of a CSV, byte of the others) of what cannot be read.
    pub fn read(path: &Path, format: Option<Format>, time: &Clock) -> Result<Self, InputError> {
        let bytes = std::fs::read(path).map_err(|e| InputError::io(path, &e))?;
        Self::of_bytes(&bytes, path, format, time)
    }

    /// The same of a file in memory.
    ///
    /// # Errors
    /// As [`Table::read`].
    pub fn of_bytes(bytes: &[u8], path: &Path, format: Option<Format>, time: &Clock) -> Result<Self, InputError> {
        let format = format.unwrap_or_else(|| Format::of(path, bytes));
        if time.of.is_some() && format != Format::Csv {
            let hint = "its series have names of their own: racbot convert --list shows them";
            return Err(
                InputError::new(path, "is no table of text, whose rows may be of several", hint).field("time.rows_of")
            );
        }
        let no_text = if matches!(format, Format::Csv | Format::Json) { binary(bytes) } else { None };
        if let Some((what, hint)) = no_text {
            return Err(InputError::new(path, what, hint));
        }
        let table = match format {
            Format::Csv => csv::read(bytes, path, time),
            Format::Json => json::read(bytes, path, time),
            Format::Ros2 => ros2::read(bytes, path),
            Format::Ssl => ssl::read(bytes, path),
            Format::Wpilog => wpilog::read(bytes, path),
        }?;
        if let (Some(wanted), recordings) = (time.recording, table.restart.map_or(1, |r| r.recordings))
            && !(1..=recordings).contains(&wanted)
        {
            let what = format!("has no recording {wanted}: its time starts {recordings} times");
            return Err(InputError::new(path, what, format!("give one of 1 to {recordings}")).field("time.recording"));
        }
        if table.series.is_empty() {
            return Err(InputError::new(
                path,
                "holds no numbers that can be read",
                "see `racbot convert --help` for formats",
            ));
        }
        Ok(table)
    }

    /// Adds a sample; one that is not finite is none.
    fn push(&mut self, name: &str, t: f64, value: f64) {
        if !(t.is_finite() && value.is_finite()) {
            return;
        }
        let at = match self.index.get(name) {
            Some(at) => *at,
            None => {
                self.series.push(Series { name: name.to_owned(), ..Series::default() });
                self.index.insert(name.to_owned(), self.series.len() - 1);
                self.series.len() - 1
            }
        };
        self.series[at].t.push(t);
        self.series[at].values.push(value);
    }

    /// The series called `name`, as the file spells it.
    pub fn find(&self, name: &str) -> Option<&Series> {
        self.index.get(name).map(|i| &self.series[*i])
    }

    /// What to say where there is no series of a name.
    fn suggestion(&self, name: &str) -> String {
        let names: Vec<&str> = self.series.iter().map(|s| s.name.as_str()).collect();
        match nearest(name, &names) {
            Some(near) => format!("did you mean {near}?"),
            None => {
                let some: Vec<&str> = names.iter().copied().take(8).collect();
                format!("it has {} (`racbot convert --list` shows all {})", some.join(", "), names.len())
            }
        }
    }
}

/// What a file is that is no table of text, and what to do with it.
fn binary(bytes: &[u8]) -> Option<(&'static str, &'static str)> {
    const KINDS: [(&[u8], &str, &str); 7] = [
        (
            b"#ROSBAG V",
            "is a bag of ROS 1",
            "convert it once: `pip install rosbags`, then `rosbags-convert --src IN.bag --dst OUT --dst-storage mcap`, and \
             give OUT/OUT.mcap; or write its topics with `rostopic echo -p`",
        ),
        (
            b"SQLite format 3",
            "is a bag of ROS 2 in SQLite",
            "convert it once: `ros2 bag convert` to storage mcap, or `pip install rosbags` and `rosbags-convert --src IN \
             --dst OUT --dst-storage mcap`",
        ),
        (b"MATLAB 5.0 MAT", "is a file of MATLAB", "write it as text: writetable(table(...), \"log.csv\")"),
        (b"\x89HDF", "is a file of HDF5", "write its arrays as columns of a CSV"),
        (b"At time ", "is what `tf_echo` prints", "record /tf in a bag, or write the pose with `rostopic echo -p`"),
        (b"header:", "is what `rostopic echo` prints", "repeat it with -p, which writes a line a message"),
        (b"PK\x03\x04", "is an archive or a workbook", "unpack it, or save the sheet as CSV"),
    ];
    let known = KINDS.into_iter().find(|(magic, ..)| bytes.starts_with(magic)).map(|(_, what, hint)| (what, hint));
    // Two bytes a letter, as some spreadsheets write: every second byte is 0.
    let wide = bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff");
    known.or_else(|| wide.then_some(("is text in UTF-16", "save it as UTF-8"))).or_else(|| {
        let begin = &bytes[..bytes.len().min(1024)];
        begin.contains(&0).then_some(("is no text", "see `racbot convert --help` for formats"))
    })
}

/// Heading of a quaternion x, y, z, w: the angle about the vertical.
fn heading([x, y, z, w]: [f64; 4]) -> f64 {
    f64::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
}

/// A damaged file.
fn damaged(path: &Path, byte: usize, what: impl std::fmt::Display) -> InputError {
    InputError::new(path, format!("byte {byte}: {what}"), "copy the file again")
}

#[cfg(test)]
mod tests;
