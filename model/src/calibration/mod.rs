//! Finding the robot's true geometry (paper, section 5, and beyond it).

mod estimate;
mod excitation;
mod kinematic;

pub use estimate::{Residual, SkewEstimate, estimate_skew};
pub use kinematic::{KinematicModel, KinematicParameter};
