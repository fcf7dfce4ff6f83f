//! The robot in floating point: geometry, motors and body, files, trajectories, localisation and
//! calibration, after Rodrigues, Brandão, Lobo, Rocha and Dias, "RAC robotic soccer small-size
//! team: omnidirectional drive modelling and robot construction".
//!
//! Four types carry the rest:
//!
//! - [`Robot`](runs::robot::Robot), what the designers know: `robot.toml`;
//! - [`Geometry`](runs::geometry::Geometry), where the wheels are: equations (1) to (6) for any number of
//!   wheels;
//! - [`Run`](runs::Run), what a robot did: a CSV log;
//! - [`Plant`](plant::Plant), how it moves: motors, wheels and body in time.
//!
//! Units are SI everywhere. Body frame: x to the right, y forward ([`Twist`](runs::frames::Twist)). World frame:
//! the camera's field, heading of the body **x** axis ([`Pose`](runs::frames::Pose)). Matrices are those of [`nalgebra`]
//! and what is written of an estimate is of [`serde_json`]; both stand here in the version that they are of.
//!
//! ```
//! use model::calibration::estimate_skew;
//! use runs::DataSet;
//!
//! let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/runs/wheel-skew");
//! let set = DataSet::open(folder)?;
//! let found = estimate_skew(&set.robot, &set.runs)?;
//! // The hidden truth is +4, −3 and +2 degrees.
//! assert!((found.skew_rad[0].to_degrees() - 4.0).abs() < 0.2);
//! let written: model::serde_json::Value = found.to_json();
//! assert_eq!(written["skew_rad"][0], found.skew_rad[0]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub use nalgebra;
pub use serde_json;

pub mod calibration;
pub mod camera;
pub mod effects;
pub mod firmware;
pub mod fit;
pub mod fusion;
pub mod imu;
pub mod inertial;
pub mod localisation;
pub mod manoeuvre;
pub mod measurement;
pub mod motor;
pub mod odometry;
pub mod pi;
pub mod plant;
pub mod setup;
pub mod simulation;
pub mod trajectory;
