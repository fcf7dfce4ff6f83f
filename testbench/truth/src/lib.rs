//! A simulated robot whose logs hide effects, to test blind whether a workflow finds them.
//!
//! [`draw`] makes a [`Case`] from a seed and a [`Kind`]: a nominal robot, a true one, drawn runs. [`write()`] simulates it
//! and writes the data set (`robot.toml`, `run_NN.csv`) into one folder; the [`Truth`] is returned, to be kept elsewhere.
//!
//! The physics is this crate's own and shares no code with any model of the robot: soft contacts with creep and a
//! friction limit, load transfer, dry friction that holds, gear loss, play, inductance, battery, coloured ground noise,
//! quantised counters, a camera with its own clock; leapfrog at 0.05 ms.
//!
//! ```
//! let case = truth::draw(7, &"single:wheel-skew:3".parse()?)?;
//! assert_eq!(case.effects[0].name, "wheel-skew");
//! # Ok::<(), truth::Error>(())
//! ```

mod ablation;
pub mod axis;
mod camera;
mod case;
mod controller;
mod disturbance;
mod draw;
mod effects;
mod error;
mod excitation;
mod folder;
mod geometry;
mod inertial;
mod log;
mod machine;
mod noise;
mod nuisance;
mod plant;
mod record;
mod robot;
mod run;
mod truth_file;

pub use ablation::Ablation;
pub use camera::Frame;
pub use case::{Case, Conditions, Kind};
pub use disturbance::{Disturbance, Hit};
pub use draw::{LOOK_ALIKES, draw, draw_with, observable};
pub use effects::{Entry, Hidden, Link, catalogue, find, find_outside, outside};
pub use error::Error;
pub use excitation::{COMMAND_PERIOD_S, Pattern};
pub use geometry::{Mount, wrap};
pub use log::{Columns, Log, Row};
pub use machine::{Camera, Controller, Ground, Machine, Power, Roughness, Wheel};
pub use noise::set_seed;
pub use nuisance::SLIDING;
pub use plant::{GRAVITY, Plant, Shake};
pub use robot::{Layout, Robot};
pub use run::{Drive, LONGEST_STEP_S, simulate_run};
pub use truth_file::{Nuisance, RunTruth, Truth, make, simulate, truth, write};
