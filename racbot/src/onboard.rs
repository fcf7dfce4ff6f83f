//! `--vision onboard`: poses by the pictures of a camera on the robot.

mod frames;
mod watcher;

use crate::terminal::Failure;
use clap::{Args, ValueEnum};
use driver::drive::PoseSource;
use model::odometry::{Covariance, Estimate};
use runs::frames::Pose;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};
use vision::camera::Camera;
use vision::field::Field;

/// How well the start is known of a robot that is set down by hand (m, m, rad): as in the starts of
/// `docs/measured/blackout.md`.
const START_SD: [f64; 3] = [0.04, 0.04, 0.03];

/// Who sees the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Source {
    /// A camera on the robot that matches the field's lines
    Onboard,
}

/// Options of a camera on the robot.
#[derive(Args, Clone, Debug)]
pub(crate) struct Vision {
    /// Let a camera on the robot correct the controller's pose by the field's lines
    #[arg(long, value_enum, value_name = "SOURCE", conflicts_with = "camera")]
    vision: Option<Source>,

    /// The field: A, B, a TOML file of sizes, or a game log with the league's geometry message
    #[arg(long, value_name = "FIELD", default_value = "B")]
    field: PathBuf,

    /// Where a real robot's pictures come from: a video device (/dev/video0), or a folder of pictures to play
    #[arg(long, value_name = "DEVICE|FOLDER", requires = "vision")]
    frames: Option<PathBuf>,

    /// The camera's calibration, TOML; the built-in card's robot has its own
    #[arg(long, value_name = "FILE", requires = "vision")]
    lens: Option<PathBuf>,
}

/// Why pictures gave no pose, and how many, while the drive goes on.
pub(crate) type Refusals = Arc<Mutex<BTreeMap<String, usize>>>;

impl Vision {
    /// Whether a camera on the robot is asked for.
    pub(crate) fn is_onboard(&self) -> bool {
        self.vision.is_some()
    }

    /// How well the controller knows the start with such a camera: what it sees of the field may say otherwise.
    pub(crate) fn start_covariance(&self) -> Option<Covariance> {
        self.is_onboard().then(|| Estimate::new(Pose::default(), START_SD).covariance)
    }

    /// Field and camera, read before anything moves.
    pub(crate) fn setting(&self) -> Result<Setting, Failure> {
        let field = Field::of(&self.field)?;
        let lens = self.lens.as_ref().map(|file| Camera::load(file)).transpose()?;
        Ok(Setting { field, lens, frames: self.frames.clone() })
    }
}

/// What a drive by an on-board camera needs.
pub(crate) struct Setting {
    field: Field,
    lens: Option<Camera>,
    frames: Option<PathBuf>,
}

impl Setting {
    /// Standard deviation of the place, m, with which a robot stays on this field's carpet.
    pub(crate) fn sure_m(&self) -> f64 {
        self.field.sure_m()
    }

    /// The camera of a real robot.
    pub(crate) fn real(self) -> Result<(Box<dyn PoseSource>, Refusals), Failure> {
        let need = |what: &str| Failure::usage(format!("--vision onboard: {what}"));
        let frames = self.frames.ok_or_else(|| need("give --frames, a video device or a folder of pictures"))?;
        let lens = self.lens.ok_or_else(|| need("give --lens, the camera's calibration"))?;
        let frames = frames::open(&frames, [lens.width, lens.height])?;
        let (watcher, refusals) = watcher::Watcher::start(frames, lens, self.field).map_err(Failure::data)?;
        Ok((Box::new(watcher), refusals))
    }

    /// A rendered one on the robot of the built-in card.
    #[cfg(feature = "simulation")]
    pub(crate) fn built_in(
        &self,
        card: simulator::virtual_card::SharedCard,
    ) -> Result<(Box<dyn PoseSource>, simulator::eye::SharedEye), Failure> {
        use simulator::eye::{Eye, RidingEye, shared};
        /// Seconds between two pictures, and the hall's seed.
        const EVERY_S: f64 = 0.1;
        const SEED: u64 = 1;
        if self.frames.is_some() {
            return Err(Failure::usage("--frames is for a real robot: the built-in card's camera is rendered"));
        }
        let eye = shared(Eye::new(self.lens.unwrap_or_else(Eye::small), self.field, None, SEED));
        Ok((Box::new(RidingEye::new(card, eye.clone(), EVERY_S)), eye))
    }
}
