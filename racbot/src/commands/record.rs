//! A recorded drive and the robot.toml beside it, which together are a data set.

use crate::terminal::{Failure, Target};
use driver::recording::Recording;
use runs::Layout;
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

impl Record<'_> {
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

    /// Makes a data set of the recording's folder, unless it is one already; what there is to say of its robot.toml.
    pub(crate) fn robot_beside(self, robot: &Robot) -> Result<Option<String>, Failure> {
        let Some(file) = self.file else { return Ok(None) };
        let path = file.parent().unwrap_or(Path::new("")).join("robot.toml");
        if path.exists() {
            return Ok(Some(format!("{}, as it was", path.display())));
        }
        self.target.save(&path, &robot.to_toml())?;
        Ok(Some(path.display().to_string()))
    }
}
