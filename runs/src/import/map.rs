//! The map: which series is which column, in which unit, sign and frame.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::columns::Source;
use super::fill::speeds_of_commands;
use super::frame::Frame;
use super::join::{Joined, join};
use super::reading::{Made, Reading};
use super::time::Time;
use super::truth::{self, Truth};
use super::{Clock, Format, Table};
use crate::Run;
use crate::error::{InputError, line_and_column};
use crate::geometry::Geometry;
use crate::robot::Robot;

/// A map as its TOML has it; see `docs/book/src/log-format.md`.
#[derive(Debug, Clone, Default)]
pub struct Map {
    path: PathBuf,
    pub(super) log: Reading,
    /// The second file, with the pose.
    truth: Option<Truth>,
    /// What [`Derive::speeds`] names.
    geometry: Option<Geometry>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Text {
    format: Option<String>,
    #[serde(default)]
    time: Time,
    #[serde(default)]
    frame: Frame,
    #[serde(default)]
    columns: BTreeMap<String, Source>,
    #[serde(default)]
    derive: Derive,
    truth: Option<truth::Text>,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Derive {
    /// A `robot.toml`, from the map's folder: wheel speeds are those that its geometry makes of the commands, for a
    /// robot whose wheels nobody logged.
    speeds: Option<PathBuf>,
}

/// A run, and how its poses came from a second file.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// What could be read, in the project's units and frames.
    pub run: Run,
    /// How a second file's poses were joined; `None` without one.
    pub joined: Option<Joined>,
    /// What its owner would want to know of the files.
    pub remarks: Vec<String>,
}

/// What a recording of a log is called, and what came of it.
pub type Recording = (Option<String>, Result<Imported, InputError>);

impl Map {
    /// Reads a map.
    ///
    /// # Errors
    /// [`InputError`] with line and column for text that is no TOML or has keys that no map has, and for formats, columns
    /// and units that nobody knows.
    pub fn load(path: &Path) -> Result<Self, InputError> {
        let text = std::fs::read_to_string(path).map_err(|e| InputError::io(path, &e))?;
        Self::parse(&text, path)
    }

    /// Reads the text of a map; `path` is for the error messages.
    ///
    /// # Errors
    /// As [`Map::load`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, InputError> {
        let Text { format, time, frame, columns, derive, truth } = toml::from_str(text).map_err(|e| {
            let (line, column) = line_and_column(text, e.span().map_or(0, |s| s.start));
            let hint = "see docs/book/src/log-format.md for what a map may say";
            InputError::new(path, e.message().replace('\n', " "), hint).at(line, column)
        })?;
        let here = |e: InputError| InputError { file: path.to_owned(), ..e };
        let log = Reading { format, time, frame, columns, pose_alone: false };
        log.check().map_err(here)?;
        let truth = truth.map(|text| Truth::new(text, &log)).transpose().map_err(here)?;
        let geometry = derive.speeds.map(|robot| {
            let file = path.parent().unwrap_or(Path::new("")).join(robot);
            let geometry = Robot::load_partial(&file)?.geometry();
            geometry.map_err(|e| InputError::new(&file, e.to_string(), "give the places of its wheels"))
        });
        Ok(Self { path: path.to_owned(), log, truth, geometry: geometry.transpose()? })
    }

    /// The kind of file that it is for, if it says so.
    pub fn format(&self) -> Option<Format> {
        self.log.format()
    }

    /// What it says of the time column of a CSV.
    ///
    /// # Errors
    /// [`InputError`] for a unit that is none of time.
    pub fn time(&self) -> Result<Clock<'_>, InputError> {
        self.log.time.clock()
    }

    /// Makes a run of what a file holds; without columns in the map, of the series that have our names.
    ///
    /// # Errors
    /// [`InputError`] about `path` for series that are not there, groups of columns that are not whole, and values that no
    /// column takes.
    pub fn run(&self, table: &Table, path: &Path) -> Result<Run, InputError> {
        self.made(table, path).map(|made| made.run)
    }

    fn made(&self, table: &Table, path: &Path) -> Result<Made, InputError> {
        let mut made = self.log.made(table, path)?;
        if let Some(geometry) = &self.geometry {
            speeds_of_commands(&mut made.run, geometry, path)?;
        }
        Ok(made)
    }

    /// Makes a run of a log, and of a second file with the pose where the map has one or `truth` names one.
    ///
    /// # Errors
    /// [`InputError`] as [`Table::read`] and [`Map::run`] for either file, and where they have no time in common.
    pub fn import(&self, log: &Path, truth: Option<&Path>) -> Result<Imported, InputError> {
        self.imported(&self.log.table(log)?, log, truth)
    }

    fn imported(&self, table: &Table, log: &Path, truth: Option<&Path>) -> Result<Imported, InputError> {
        let Some(second) = &self.truth else {
            if let Some(file) = truth {
                let what = format!("has no [truth], which says what {} holds", file.display());
                let hint = "racbot convert --draft LOG map.toml --truth FILE writes a map of two files";
                return Err(InputError::new(&self.path, what, hint));
            }
            return Ok(Imported { run: self.run(table, log)?, joined: None, remarks: self.log.remarks(table) });
        };
        let file = truth.map_or_else(|| self.second(second, log), |file| Ok(file.to_owned()))?;
        let poses = second.reading.table(&file)?;
        self.joined([(table, log), (&poses, &file)], second)
    }

    /// The same of every recording of a log, with what it is called: without a name where the log holds no more or the map
    /// says which.
    ///
    /// # Errors
    /// As [`Table::read`] for the log.
    pub fn import_each(&self, log: &Path, truth: Option<&Path>) -> Result<Vec<Recording>, InputError> {
        let table = self.log.table(log)?;
        let Some(restart) = table.restart.filter(|_| self.log.time.recording.is_none()) else {
            return Ok(vec![(None, self.imported(&table, log, truth))]);
        };
        let one = |number: usize| {
            let mut map = self.clone();
            map.log.time.recording = Some(number);
            let name = table.recordings.get(number - 1).cloned().unwrap_or_else(|| number.to_string());
            (Some(name), map.import(log, truth))
        };
        Ok((1..=restart.recordings).map(one).collect())
    }

    /// The second file that the map has for a log, if it has one.
    pub fn truth_of(&self, log: &Path) -> Option<PathBuf> {
        self.second(self.truth.as_ref()?, log).ok()
    }

    fn second(&self, truth: &Truth, log: &Path) -> Result<PathBuf, InputError> {
        truth.beside(log).map_err(|e| InputError { file: self.path.clone(), ..e })
    }

    fn joined(&self, [log, truth]: [(&Table, &Path); 2], second: &Truth) -> Result<Imported, InputError> {
        let made = [self.made(log.0, log.1)?, second.reading.made(truth.0, truth.1)?];
        let (run, joined) = join(made, second, [log, truth])?;
        let of_poses = truth.0.remarks.iter().map(|remark| format!("{}: {remark}", truth.1.display()));
        let remarks = self.log.remarks(log.0).into_iter().chain(of_poses).collect();
        Ok(Imported { run, joined: Some(joined), remarks })
    }
}
