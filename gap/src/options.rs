//! What a user may choose.

use crate::thresholds::Thresholds;
use links::effect::Effect;

/// Choices before anything is fitted.
#[derive(Default)]
pub struct Options {
    /// What decides.
    pub thresholds: Thresholds,
    /// The robot's file, whose comments the new one keeps [default: robot.toml in the data set].
    pub robot_file: Option<std::path::PathBuf>,
    /// Mistakes of the set-up that are to be passed over, as sentences, for the report to say.
    pub mistakes: Vec<String>,
    /// Effects beyond the catalogue.
    pub effects: Vec<std::sync::Arc<dyn Effect>>,
    /// Is told the share of the work that is done, 0 to 1, after every stage.
    pub progress: Option<Progress>,
}

/// What is told how far an analysis is.
pub type Progress = Box<dyn Fn(f64) + Send + Sync>;

impl Options {
    /// Says that a stage is done.
    pub(crate) fn reached(&self, stage: Stage) {
        if let Some(progress) = &self.progress {
            progress(f64::from(stage as u32) / 100.0);
        }
    }
}

/// Stages of an analysis with the percentage of its time after which each is done. The percentages are guesses for logs
/// with camera and duties: no experiment set them, and they move the bar alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stage {
    /// Logs read and cut, exact links replayed.
    Exact = 5,
    /// Effects of the motion selected.
    MotionChosen = 25,
    /// Judged.
    MotionStudied = 40,
    /// Effects of the drive selected.
    DriveChosen = 75,
    /// Judged.
    DriveStudied = 85,
    /// The written file measured.
    Measured = 95,
}
