//! A data set whose logs may be longer than memory.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use super::data_set::{robot_of, run_files};
use super::signals::{as_logged, drive_lacks};
use super::{DataSet, Log, RunError};
use crate::robot::{Robot, Support};

/// Ticks of a data set that stay in memory; logs beyond lie in a temporary file.
const IN_MEMORY: usize = 1 << 18;

/// A robot and its recorded runs, as [`DataSet`], but of any length.
#[derive(Debug)]
pub struct Logs<'a> {
    /// Where robot.toml and the runs lie.
    pub folder: PathBuf,
    /// The nominal robot.
    pub robot: Robot,
    /// Its runs, in the order of their names; at least one.
    pub logs: Vec<Log<'a>>,
}

impl<'a> From<&'a DataSet> for Logs<'a> {
    fn from(set: &'a DataSet) -> Self {
        let logs = set.runs.iter().map(|run| Log::from(Cow::Borrowed(run))).collect();
        Self { folder: set.folder.clone(), robot: set.robot.clone(), logs }
    }
}

impl Logs<'_> {
    /// The robot as the columns of the logs show it, see [`as_logged`].
    pub fn as_logged(&self) -> Robot {
        let source = self.logs.first().map(|log| log.layout().source).unwrap_or_default();
        as_logged(&self.robot, source, self.logs.iter().find_map(Log::tick_s))
    }

    /// What robot.toml does not say, and the duties in the logs need to be compared.
    pub fn lacking(&self) -> Option<String> {
        let drives = self.logs.iter().any(|log| !log.layout().duty.is_empty());
        let lacking = drive_lacks(&self.as_logged()).join(", ");
        (drives && !lacking.is_empty()).then_some(lacking)
    }

    /// What was read another way than it is written, by log, in sentences; one that several logs share stands once.
    pub fn notes(&self) -> Vec<String> {
        let mut notes: Vec<(String, Vec<&str>)> = Vec::new();
        for log in &self.logs {
            for note in &log.layout().notes {
                match notes.iter_mut().find(|(text, _)| text == note) {
                    Some((_, logs)) => logs.push(&log.name),
                    None => notes.push((note.clone(), vec![&log.name])),
                }
            }
        }
        let all = self.logs.len();
        let narrowed = self.lacking().map(|lacking| {
            format!("duties are not compared, for robot.toml does not say {lacking}: add it to have them compared")
        });
        let said = |(note, logs): (String, Vec<&str>)| {
            if logs.len() == all { note } else { format!("{}: {note}", logs.join(", ")) }
        };
        notes.into_iter().map(said).chain(narrowed).collect()
    }
}

impl Logs<'static> {
    /// Reads a folder as [`DataSet::open`] does. Of a CSV only a part is in memory at any time; an MCAP is read whole.
    ///
    /// # Errors
    /// As [`DataSet::open`], and where a long log cannot be laid out in a temporary file.
    pub fn open(folder: impl AsRef<Path>) -> Result<Self, RunError> {
        let folder = folder.as_ref();
        Self::open_as(folder, robot_of(folder)?)
    }

    /// Reads every run of a folder for a robot that is described elsewhere.
    ///
    /// # Errors
    /// As [`Logs::open`].
    pub fn open_as(folder: impl AsRef<Path>, robot: Robot) -> Result<Self, RunError> {
        Self::open_within(folder, robot, IN_MEMORY)
    }

    /// The same, with no more than so many ticks of all logs together in memory.
    ///
    /// # Errors
    /// As [`Logs::open`].
    pub fn open_within(folder: impl AsRef<Path>, robot: Robot, in_memory: usize) -> Result<Self, RunError> {
        let folder = folder.as_ref();
        let (mut left, mut spool, mut logs) = (in_memory, None, Vec::new());
        for file in run_files(folder)? {
            let log = Log::read(&file, Some(&robot), left, &mut spool)?;
            left = left.saturating_sub(log.len());
            logs.push(log);
        }
        // On blocks every axis is alone, and a log may speak of some of them only.
        let logged = logs.iter().map(|log| log.layout().wheel_count()).max().unwrap_or(0);
        let robot = if robot.support == Support::Blocks && logged > 0 { robot.first_axes(logged) } else { robot };
        for log in &logs {
            log.check(&robot)?;
        }
        Ok(Self { folder: folder.to_owned(), robot, logs })
    }
}
