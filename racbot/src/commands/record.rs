//! A recorded drive and the robot.toml beside it, which together are a data set.

use crate::terminal::{Failure, Target};
use driver::recording::{Recorded, Recording};
use runs::Layout;
use runs::error::InputError;
use runs::robot::Robot;
use std::path::Path;

/// Where a drive is recorded, if it is.
#[derive(Clone, Copy)]
pub(crate) struct Record<'a> {
    /// The run's file, .csv or .mcap.
    pub(crate) file: Option<&'a Path>,
    /// Whether it may be replaced.
    pub(crate) target: Target,
}

/// That a run's name is one by which it is read again; `hint` is what else the name could have been meant for.
pub(crate) fn check_name(run: &Path, hint: &str) -> Result<(), Failure> {
    if run.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv") || e.eq_ignore_ascii_case("mcap")) {
        return Ok(());
    }
    Err(Failure::about(run, format!("is neither *.csv nor *.mcap; runs are one of the two{hint}")))
}

/// What became of a recording.
pub(crate) struct Kept {
    /// The run, if it is whole.
    pub(crate) run: Option<Recorded>,
    /// What there is to say of the robot.toml beside it.
    pub(crate) robot: Option<String>,
    /// What failed. The drive was driven nevertheless, and is reported.
    pub(crate) failed: Option<String>,
}

impl Record<'_> {
    /// Before anything moves: that the run has a name, and it is free.
    pub(crate) fn check(self) -> Result<(), Failure> {
        self.file.map_or(Ok(()), |file| check_name(file, ""))?;
        self.target.check_free(self.file)
    }

    /// Starts the recording of this robot, which an MCAP has in it, and makes the folders above it.
    pub(crate) fn start(self, robot: &Robot, camera: bool) -> Result<Option<Recording>, Failure> {
        let Some(file) = self.file else { return Ok(None) };
        if let Some(folder) = file.parent() {
            std::fs::create_dir_all(folder).map_err(|error| Failure::about(folder, error))?;
        }
        let layout = Layout::of_robot(robot.wheel_count(), camera).with_imu(robot.imu.is_some());
        let recording = Recording::start_of(file, layout, self.target.existing(), Some(&robot.to_toml()));
        recording.map(Some).map_err(Failure::data)
    }

    /// Ends a recording of this robot.
    pub(crate) fn finish(self, recording: Option<Recording>, robot: &Robot) -> Kept {
        let mut failed = Vec::new();
        let run = recording.and_then(|recording| recording.finish().map_err(|e| failed.push(e.to_string())).ok());
        let robot = self.robot_beside(robot).map_err(|error| failed.push(error.to_string())).ok().flatten();
        Kept { run, robot, failed: (!failed.is_empty()).then(|| failed.join("; ")) }
    }

    /// Makes a data set of the recording's folder, unless it is one already; what there is to say of its robot.toml.
    fn robot_beside(self, robot: &Robot) -> Result<Option<String>, InputError> {
        let Some(file) = self.file else { return Ok(None) };
        let path = file.parent().unwrap_or(Path::new("")).join("robot.toml");
        if path.exists() {
            return Ok(Some(format!("{}, as it was", path.display())));
        }
        runs::output::write_whole(&path, robot.to_toml().as_bytes(), self.target.existing())?;
        Ok(Some(path.display().to_string()))
    }
}
