//! What a robot's model predicts of a log, link by link (motion, drive, inertial), and the catalogue of physical effects
//! that change a prediction.

// Several signals and matrices are walked through together, by one index.
#![allow(clippy::needless_range_loop)]

pub mod drive;
pub mod effect;
pub mod effects;
pub mod inertial;
pub mod motion;
pub mod pieces;
pub mod segment;
pub mod thresholds;
pub mod values;
