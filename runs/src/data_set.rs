//! A data set: a folder with `robot.toml` and `*.csv` or `*.mcap`.

use std::path::{Path, PathBuf};

use super::signals::{Reading, as_logged};
use super::{Run, RunError};
use crate::robot::{Robot, Support};

/// A robot and its recorded runs.
#[derive(Debug, Clone, PartialEq)]
pub struct DataSet {
    /// Where robot.toml and the runs lie.
    pub folder: PathBuf,
    /// The nominal robot.
    pub robot: Robot,
    /// Its runs, in the order of their names; at least one.
    pub runs: Vec<Run>,
}

impl DataSet {
    /// Reads `robot.toml`, which need say no more than the logs' signals ask for, and every `*.csv` and `*.mcap` of a folder, and checks that they belong
    /// together. Of a CSV and an MCAP of one name, the CSV is read: it is the same run twice.
    ///
    /// # Errors
    /// [`RunError`] about the folder or the first file that is wrong.
    pub fn open(folder: impl AsRef<Path>) -> Result<Self, RunError> {
        let folder = folder.as_ref();
        Self::open_as(folder, robot_of(folder)?)
    }

    /// Reads every run of a folder for a robot that is described elsewhere.
    ///
    /// # Errors
    /// As [`DataSet::open`].
    pub fn open_as(folder: impl AsRef<Path>, robot: Robot) -> Result<Self, RunError> {
        let folder = folder.as_ref();
        let files = run_files(folder)?;
        let runs = files.iter().map(Run::read).collect::<Result<Vec<Run>, RunError>>()?;
        // On blocks every axis is alone, and a log may speak of some of them only.
        let logged = runs.iter().map(Run::wheel_count).max().unwrap_or(0);
        let robot = if robot.support == Support::Blocks && logged > 0 { robot.first_axes(logged) } else { robot };
        let reading = |(run, path): (Run, &PathBuf)| Ok(Reading::new(&robot, &run, path)?.apply(run));
        let runs = runs.into_iter().zip(&files).map(reading).collect::<Result<Vec<Run>, RunError>>()?;
        for (run, path) in runs.iter().zip(&files) {
            run.check(&robot, path)?;
        }
        Ok(Self { folder: folder.to_owned(), robot, runs })
    }

    /// The robot as the columns of the logs show it, see [`as_logged`].
    pub fn as_logged(&self) -> Robot {
        let source = self.runs.first().map(|run| run.source).unwrap_or_default();
        as_logged(&self.robot, source, self.runs.iter().find_map(Run::tick_s))
    }
}

/// The robot that lies in a folder of runs.
pub(super) fn robot_of(folder: &Path) -> Result<Robot, RunError> {
    if folder.exists() && !folder.is_dir() {
        let hint = "give the folder in which logs and robot.toml lie side by side";
        return Err(RunError::new(folder, "is no folder", hint));
    }
    let robot = folder.join("robot.toml");
    if folder.is_dir() && !robot.exists() {
        let hint = "put the robot's robot.toml beside its logs";
        return Err(RunError::new(folder, "has no robot.toml", hint));
    }
    Robot::load_partial(robot)
}

/// Every run of a folder, in the order of their names; at least one.
pub(super) fn run_files(folder: &Path) -> Result<Vec<PathBuf>, RunError> {
    let entries = std::fs::read_dir(folder).map_err(|e| RunError::io(folder, &e))?;
    let mut files = Vec::new();
    for entry in entries {
        let path = entry.map_err(|e| RunError::io(folder, &e))?.path();
        let is_run = path.extension().is_some_and(|e| ["csv", "mcap"].iter().any(|x| e.eq_ignore_ascii_case(x)));
        let hidden = path.file_name().is_some_and(|n| n.to_string_lossy().starts_with('.'));
        if is_run && !hidden && path.is_file() {
            files.push(path);
        }
    }
    if files.is_empty() {
        return Err(RunError::new(folder, "holds no runs", "put at least one *.csv or *.mcap log there"));
    }
    files.sort();
    files.dedup_by(|later, earlier| later.file_stem() == earlier.file_stem());
    Ok(files)
}
