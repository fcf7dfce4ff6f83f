//! Finds where simulation and measured data of an omnidirectional robot disagree, names the missing
//! physical effect, adds it to the model and shows how much of the gap it closes.

pub mod drive;
pub mod effect;
pub mod effects;
pub mod gram;
pub mod motion;
pub mod options;
pub mod problem;
pub mod ridge;
pub mod segment;
pub mod select;
pub mod state;
pub mod statistics;
