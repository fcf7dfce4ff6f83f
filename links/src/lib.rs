//! What a robot's model predicts of a log, link by link (motion, drive, inertial), and the catalogue of physical effects
//! that change a prediction.
//!
//! ```
//! use links::effects::{catalogue, find};
//! use links::motion::{MotionLink, MotionModel, WINDOW_S};
//! use links::pieces::{PIECE, segments};
//! use links::values::{Values, wheel_name};
//! use runs::Logs;
//!
//! let set = Logs::open(concat!(env!("CARGO_MANIFEST_DIR"), "/../data/runs/wheel-skew"))?;
//! let pieces = segments(&set.robot, &set.robot.geometry()?, &set.logs, PIECE);
//! // Second by second, what the camera saw less what the wheels predict, in units of 1 mm and 2 mrad.
//! let link = MotionLink::new(&pieces, [1e-3, 1e-3, 2e-3], WINDOW_S);
//! let left = |model: &MotionModel| -> f64 {
//!     let windows = link.residuals(model);
//!     windows.iter().flat_map(|w| &w.residuals).flatten().map(|r| r * r).sum()
//! };
//! let nominal = MotionModel::new(&set.robot);
//! // The hidden truth is +4, -3 and +2 degrees.
//! let skew = find("wheel-skew").expect("it is in the catalogue");
//! let sizes = [4.0_f64, -3.0, 2.0].iter().enumerate();
//! let values = Values(sizes.map(|(wheel, deg)| (wheel_name("skew", wheel, "rad"), deg.to_radians())).collect());
//! let mut skewed = MotionModel::new(&set.robot);
//! skew.motion(&values, &mut skewed);
//! assert!(left(&skewed) < 0.5 * left(&nominal), "{} of {}", left(&skewed), left(&nominal));
//! assert!(catalogue().iter().all(|effect| !effect.equation().is_empty()));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

// Several signals and matrices are walked through together, by one index.
#![allow(clippy::needless_range_loop)]

pub mod drive;
pub mod effect;
pub mod effects;
pub mod inertial;
mod memo;
pub mod motion;
pub mod pieces;
pub mod segment;
pub mod thresholds;
pub mod values;
