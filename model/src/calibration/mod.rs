//! Finding the robot's true geometry (paper, section 5, and beyond it).

mod drives;
mod estimate;
mod excitation;
mod kinematic;
mod paper;
mod size;
mod structure;

pub use drives::{DriveError, Drives, Straightness};
pub use estimate::{Residual, SkewEstimate, estimate_skew};
pub use kinematic::{KinematicModel, KinematicParameter};
pub use paper::{Iteration, PaperCalibration, PaperError, PaperOptions, Stage, calibrate_like_the_paper};
pub use size::{Estimated, Sizes};
pub use structure::Part;
