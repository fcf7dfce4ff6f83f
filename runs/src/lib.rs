//! Files people exchange: `robot.toml`, the robot as it is described ([`robot::Robot`]); recorded runs, CSV or
//! MCAP, and folders of them ([`Run`], [`DataSet`]); and the frames, geometry and errors they share.

mod check;
mod columns;
mod data_set;
pub mod error;
pub mod frames;
pub mod geometry;
mod log;
mod logs;
mod mcap;
mod part;
mod read;
pub mod robot;
mod spool;
mod stream;
pub mod ticks;
mod write;

use crate::error::InputError;
use crate::frames::Pose;

pub use data_set::DataSet;
pub use log::{Log, Seen};
pub use logs::Logs;
pub use mcap::McapStream;
pub use part::Columns;
pub use stream::{CsvStream, Layout, RunStream, Tick, create};

/// What is wrong in a log, where, and what to do about it.
pub type RunError = InputError;

/// One recorded drive, column by column; every column has one entry a tick.
///
/// The file is a CSV with a header row, SI units, columns in any order:
/// `t, cmd_vx, cmd_vy, cmd_w, ref_1..N, enc_1..N, duty_1..N, meas_1..N, supply_v, cam_x, cam_y, cam_theta`.
/// An MCAP has fields of the same names. Only `t` must be there. An empty field means no sample at this tick: it is NaN in the columns
/// of numbers here, and see [`Run::counts`] for the encoders.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Run {
    /// Name of the run: the file's name without extension.
    pub name: String,
    /// Time of each tick, s, strictly increasing.
    pub t: Vec<f64>,
    /// `cmd_vx`, `cmd_vy`, `cmd_w`: commanded body twist (m/s, m/s, rad/s), if logged.
    pub command: Option<[Vec<f64>; 3]>,
    /// `ref_i`: wheel speed set points (rad/s at the wheel), `[wheel][tick]`; empty if not logged.
    pub reference: Vec<Vec<f64>>,
    /// `enc_i`: cumulative encoder counts at the motor shaft, `[wheel][tick]`; empty if not logged.
    ///
    /// Ticks without a sample hold the count before them and stand in [`Run::count_gaps`].
    pub counts: Vec<Vec<i64>>,
    /// Ticks without an encoder sample, `[wheel]`, increasing.
    pub count_gaps: Vec<Vec<usize>>,
    /// `duty_i` in [−1, 1], applied from its tick to the next, `[wheel][tick]`; empty if not logged.
    pub duty: Vec<Vec<f64>>,
    /// `meas_i`: wheel speeds as the speed loop measured them (rad/s at the wheel), `[wheel][tick]`; empty if not
    /// logged. With them a loop can be replayed whose measurement cannot be told from the counts.
    pub measured: Vec<Vec<f64>>,
    /// `supply_v`, V, if logged.
    pub supply_v: Option<Vec<f64>>,
    /// Camera poses, on the ticks that had one.
    pub camera: Vec<CameraSample>,
    /// Whether the log has camera columns at all.
    pub has_camera: bool,
    /// Columns we do not know, in the order of the file, as text.
    pub other: Vec<(String, Vec<String>)>,
}

/// One pose from the overhead camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraSample {
    /// Tick at which the log has it, from 0.
    pub tick: usize,
    /// What the camera reports, in the field frame, θ wrapped.
    pub pose: Pose,
}

impl Run {
    /// Number of ticks.
    pub fn len(&self) -> usize {
        self.t.len()
    }

    /// Whether the run has no tick.
    pub fn is_empty(&self) -> bool {
        self.t.is_empty()
    }

    /// Number of wheels in the log's columns, 0 if it has none by wheel.
    pub fn wheel_count(&self) -> usize {
        self.reference.len().max(self.counts.len()).max(self.duty.len())
    }

    /// From the first to the last tick, s.
    pub fn duration_s(&self) -> f64 {
        match (self.t.first(), self.t.last()) {
            (Some(first), Some(last)) => last - first,
            _ => 0.0,
        }
    }

    /// Median distance of two ticks, s; `None` for fewer than two ticks.
    pub fn tick_s(&self) -> Option<f64> {
        let mut steps: Vec<f64> = self.t.windows(2).map(|w| w[1] - w[0]).collect();
        let middle = steps.len() / 2;
        (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
    }
}

#[cfg(test)]
mod tests;
