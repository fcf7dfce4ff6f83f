//! Files people exchange: `robot.toml`, the robot as it is described ([`robot::Robot`]); recorded runs, CSV or
//! MCAP, and folders of them ([`Run`], [`DataSet`]); and the frames, geometry and errors they share. Matrices of the
//! geometry are those of [`nalgebra`], and what a `robot.toml` says beside its own keys is in [`toml`]; both stand here in the
//! version that they are of.
//!
//! ```
//! use runs::frames::Pose;
//! use runs::{DataSet, Run};
//!
//! let set = DataSet::open(concat!(env!("CARGO_MANIFEST_DIR"), "/../data/runs/wheel-skew"))?;
//! let (run, geometry) = (&set.runs[0], set.robot.geometry()?);
//! // Where the wheels say that the robot is after the first second, from where the camera saw it first.
//! let shaft_rad = std::f64::consts::TAU / set.robot.encoder_counts_per_motor_rev;
//! let turned = |i: usize| run.cumulative(i)[1000] * shaft_rad / set.robot.gear_ratio;
//! let way: Vec<f64> = (0..set.robot.wheel_count()).map(turned).collect();
//! let pose: Pose = run.camera[0].pose.advance(geometry.twist(&way), 1.0);
//! assert!(pose.distance(run.camera[0].pose) < 1.0);
//!
//! // A log is text with a column a signal, SI units; what is not logged is left out.
//! let log = "t,cam_x,cam_y,cam_theta\n0,0,0,0\n0.02,,,\n0.04,0.01,0,0\n";
//! let run = Run::from_bytes(log.as_bytes(), "mine.csv".as_ref())?;
//! assert_eq!((run.len(), run.camera.len(), run.tick_s()), (3, 2, Some(0.02)));
//! // A mistake is said with its line, its column and what to do.
//! let wrong = Run::from_bytes(b"t,duty_1\n0,0.1\n0.01,x\n", "mine.csv".as_ref()).unwrap_err();
//! assert!(wrong.to_string().contains("duty_1"), "{wrong}");
//!
//! // An effect that somebody measured, with where it is from, as the robot's file has it.
//! use runs::robot::{Effect, EffectParameter, Robot};
//! let heavier = EffectParameter { value: 0.1, ..EffectParameter::default() };
//! let other = runs::toml::Table::from_iter([("source".to_owned(), runs::toml::Value::from("kitchen scales"))]);
//! let parameters = vec![("scale".to_owned(), heavier)];
//! let effect = Effect { name: "robot-mass".to_owned(), parameters, other, ..Effect::default() };
//! let robot = Robot { effects: vec![effect], ..set.robot.clone() };
//! assert!(robot.to_toml().contains("source = \"kitchen scales\""));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod check;
mod columns;
mod data_set;
pub mod error;
pub mod frames;
pub mod geometry;
pub mod import;
mod log;
mod logs;
mod mcap;
pub mod output;
mod part;
mod read;
pub mod robot;
mod signals;
mod spool;
mod stream;
pub mod ticks;
pub mod vision;
mod write;

use crate::columns::Column;
use crate::error::InputError;
use crate::frames::Pose;

pub use data_set::DataSet;
pub use log::{Log, Seen};
pub use logs::Logs;
pub use mcap::McapStream;
pub use nalgebra;
pub use part::Columns;
pub use signals::{
    CountSource, DRIVE_KEYS, DutySource, Source, as_logged, drive_lacks, is_dead_reckoning, is_from_speeds,
};
pub use stream::{CsvStream, Layout, RunStream, Tick, create};
pub use toml;

/// How far the clocks of a robot and its camera may be apart in a run, s: `gap` looks for no more.
pub const CLOCK_OFF_S: f64 = 0.5;

/// What is wrong in a log, where, and what to do about it.
pub type RunError = InputError;

/// One recorded drive, column by column; every column has one entry a tick.
///
/// The file is a CSV with a header row, SI units, columns in any order:
/// `t, cmd_vx, cmd_vy, cmd_w, ref_1..N, enc_1..N, duty_1..N, meas_1..N, supply_v, cam_x, cam_y, cam_theta`, and
/// `speed_1..N, current_1..N, odom_x, odom_y, odom_theta, gyro_x..z, acc_x..z, imu_temp`.
/// An MCAP has fields of the same names. Only `t` must be there. An empty field means no sample at this tick: it is NaN in the columns
/// of numbers here, and see [`Run::counts`] for the encoders. Signals need not share a clock: lines of one time
/// are one tick where none of their fields stands twice.
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
    /// `speed_i`: wheel speeds (rad/s at the wheel), where there are no counts, `[wheel][tick]`; empty if not logged.
    pub speed: Vec<Vec<f64>>,
    /// `current_i`: motor currents, A, `[wheel][tick]`; empty if not logged.
    pub current: Vec<Vec<f64>>,
    /// `odom_x`, `odom_y`, `odom_theta`: the robot's own dead reckoning (m, m, rad), if logged.
    pub odometry: Option<[Vec<f64>; 3]>,
    /// `gyro_x..z`: rates of turn about the body's axes, rad/s, if any is logged; an axis that is not is NaN.
    pub gyro: Option<[Vec<f64>; 3]>,
    /// `acc_x..z`: accelerations along the body's axes, m/s², likewise.
    pub acceleration: Option<[Vec<f64>; 3]>,
    /// `imu_temp`, °C, if logged.
    pub imu_temp: Option<Vec<f64>>,
    /// Camera poses, on the ticks that had one.
    pub camera: Vec<CameraSample>,
    /// Whether the log has camera columns at all.
    pub has_camera: bool,
    /// Columns we do not know, in the order of the file, as text.
    pub other: Vec<(String, Vec<String>)>,
    /// What its counts and duties were made of.
    pub source: Source,
    /// What was read another way than it is written, in sentences.
    pub notes: Vec<String>,
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
        let groups = [&self.reference, &self.duty, &self.measured, &self.speed, &self.current];
        groups.iter().map(|g| g.len()).fold(self.counts.len(), usize::max)
    }

    /// Counts of a wheel since the first tick; ticks without a sample lie on the line between their neighbours.
    #[must_use]
    pub fn cumulative(&self, wheel: usize) -> Vec<f64> {
        let mut sum = 0.0;
        let steps = self.counts[wheel].windows(2).map(|pair| {
            sum += pair[1].wrapping_sub(pair[0]) as f64;
            sum
        });
        let mut out: Vec<f64> = std::iter::once(0.0).chain(steps).take(self.len()).collect();
        let lost = self.count_gaps.get(wheel).map_or(&[][..], Vec::as_slice);
        for gap in lost.chunk_by(|a, b| a + 1 == *b) {
            let (first, last) = (gap[0], gap[gap.len() - 1]);
            if first == 0 || last + 1 >= out.len() {
                continue;
            }
            let (a, b) = (out[first - 1], out[last + 1]);
            let (from, to) = (self.t[first - 1], self.t[last + 1]);
            for (slot, t) in out[first..=last].iter_mut().zip(&self.t[first..=last]) {
                *slot = a + (b - a) * (t - from) / (to - from);
            }
        }
        out
    }

    /// Times of the ticks at which the first encoder counts, or what stands in its place is logged; all where that is not twice.
    pub fn sampled(&self) -> std::borrow::Cow<'_, [f64]> {
        if self.counts.is_empty() {
            let first = self.speed.first().or_else(|| self.odometry.as_ref().map(|of| &of[0]));
            let logged =
                first.map(|of| self.t.iter().zip(of).filter(|(_, x)| x.is_finite()).map(|(t, _)| *t).collect());
            return logged.filter(|times: &Vec<f64>| times.len() > 1).map_or(self.t[..].into(), Into::into);
        }
        let gaps = self.count_gaps.first().map_or(&[][..], Vec::as_slice);
        if gaps.is_empty() || gaps.len() + 2 > self.len() {
            return std::borrow::Cow::Borrowed(&self.t);
        }
        let mut gaps = gaps.iter().peekable();
        let counts = |tick: &usize| gaps.next_if(|gap| **gap == *tick).is_none();
        (0..self.len()).filter(counts).map(|tick| self.t[tick]).collect()
    }

    /// A column of numbers; `None` for those of another kind and those that are not logged.
    pub(crate) fn real(&self, column: Column) -> Option<&Vec<f64>> {
        match column {
            Column::Time => Some(&self.t),
            Column::Command(i) => self.command.as_ref().map(|c| &c[i]),
            Column::Reference(wheel) => self.reference.get(wheel),
            Column::Duty(wheel) => self.duty.get(wheel),
            Column::Measured(wheel) => self.measured.get(wheel),
            Column::Supply => self.supply_v.as_ref(),
            Column::Speed(wheel) => self.speed.get(wheel),
            Column::Current(wheel) => self.current.get(wheel),
            Column::Odometry(i) => self.odometry.as_ref().map(|c| &c[i]),
            Column::Gyro(i) => self.gyro.as_ref().map(|c| &c[i]),
            Column::Acceleration(i) => self.acceleration.as_ref().map(|c| &c[i]),
            Column::ImuTemperature => self.imu_temp.as_ref(),
            Column::Counts(_) | Column::Camera(_) | Column::Other => None,
        }
    }

    /// The same to be written to.
    pub(crate) fn real_mut(&mut self, column: Column) -> Option<&mut Vec<f64>> {
        match column {
            Column::Time => Some(&mut self.t),
            Column::Command(i) => self.command.as_mut().map(|c| &mut c[i]),
            Column::Reference(wheel) => self.reference.get_mut(wheel),
            Column::Duty(wheel) => self.duty.get_mut(wheel),
            Column::Measured(wheel) => self.measured.get_mut(wheel),
            Column::Supply => self.supply_v.as_mut(),
            Column::Speed(wheel) => self.speed.get_mut(wheel),
            Column::Current(wheel) => self.current.get_mut(wheel),
            Column::Odometry(i) => self.odometry.as_mut().map(|c| &mut c[i]),
            Column::Gyro(i) => self.gyro.as_mut().map(|c| &mut c[i]),
            Column::Acceleration(i) => self.acceleration.as_mut().map(|c| &mut c[i]),
            Column::ImuTemperature => self.imu_temp.as_mut(),
            Column::Counts(_) | Column::Camera(_) | Column::Other => None,
        }
    }

    /// A run with these columns and no ticks.
    pub(crate) fn with_columns(columns: &[Column]) -> Self {
        let width = |group: fn(usize) -> Column| (0..100).take_while(|i| columns.contains(&group(*i))).count();
        let wheels = |group: fn(usize) -> Column| vec![Vec::new(); width(group)];
        let triple = |group: fn(usize) -> Column| (0..3).any(|i| columns.contains(&group(i))).then(Default::default);
        let single = |column: Column| columns.contains(&column).then(Vec::new);
        Self {
            command: triple(Column::Command),
            reference: wheels(Column::Reference),
            counts: vec![Vec::new(); width(Column::Counts)],
            count_gaps: vec![Vec::new(); width(Column::Counts)],
            duty: wheels(Column::Duty),
            measured: wheels(Column::Measured),
            supply_v: single(Column::Supply),
            speed: wheels(Column::Speed),
            current: wheels(Column::Current),
            odometry: triple(Column::Odometry),
            gyro: triple(Column::Gyro),
            acceleration: triple(Column::Acceleration),
            imu_temp: single(Column::ImuTemperature),
            has_camera: columns.contains(&Column::Camera(0)),
            ..Self::default()
        }
    }

    /// From the first to the last tick, s.
    pub fn duration_s(&self) -> f64 {
        match (self.t.first(), self.t.last()) {
            (Some(first), Some(last)) => last - first,
            _ => 0.0,
        }
    }

    /// Median distance of two ticks, s; `None` for fewer than two ticks. Where the encoders do not count at every
    /// tick, as in logs of several clocks, of those at which they do.
    pub fn tick_s(&self) -> Option<f64> {
        let mut steps: Vec<f64> = self.sampled().windows(2).map(|w| w[1] - w[0]).collect();
        let middle = steps.len() / 2;
        (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
    }
}

#[cfg(test)]
mod tests;
