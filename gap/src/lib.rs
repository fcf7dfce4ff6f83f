//! Finds where simulation and measured data of an omnidirectional robot disagree, names the missing
//! physical effect, adds it to the model and shows how much of the gap it closes.
//!
//! ```no_run
//! let set = runs::DataSet::open("data/runs/wheel-skew")?;
//! let analysis = gap::analyse(&set, &gap::Options::default())?;
//! println!("{}", analysis.terminal_summary());
//! let written: gap::serde_json::Value = analysis.to_json();
//! println!("{}", written["verdict"]);
//! analysis.write("out")?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

// Several signals and matrices are walked through together, by one index.
#![allow(clippy::needless_range_loop)]

pub mod analysis;
pub mod candidates;
pub mod catalogue;
mod command;
mod controller;
mod error;
pub mod evidence;
pub mod exact;
pub mod experiment;
mod intervals;
mod leftover;
mod limits;
mod locate;
pub mod options;
mod parts;
pub mod problem;
mod report;
pub mod select;
pub mod state;
pub mod thresholds;
mod timing;
mod units;
pub mod user;
mod words;

pub use analysis::{Analysis, Verdict, analyse, analyse_logs, undo};
pub use error::GapError;
pub use evidence::{Evidence, Interval};
pub use options::Options;
// What stands in public types, in the version that they are of.
pub use {nalgebra, serde_json};
