//! The robot in floating point: SI units, body frame x right and y forward, heading from the
//! field's x axis to the body x axis (see [`frames`]).

pub mod calibration;
pub mod camera;
pub mod error;
pub mod fit;
pub mod frames;
pub mod fusion;
pub mod geometry;
pub mod localisation;
pub mod motor;
pub mod odometry;
pub mod pi;
pub mod plant;
pub mod plot;
pub mod robot;
pub mod run;
pub mod simulation;
pub mod trajectory;
