//! Logs as the links read them: whatever moves the wheels' prediction becomes counts, whatever drives the motors duties,
//! and what only repeats an older sample is none.

mod camera;
mod derive;
mod headings;
mod held;
mod interpolated;
mod stamps;

use std::f64::consts::TAU;
use std::path::Path;

use crate::columns::Column;
use crate::error::InputError;
use crate::geometry::Wheel;
use crate::robot::{Layout, Robot, Support, WHEELS};
use crate::{Run, RunError};

/// Counts per radian of the encoders that stand for speeds and dead reckoning: finer than any sensor, and 2^43 turns
/// before a count overflows.
const VIRTUAL_COUNTS_PER_RAD: f64 = 1_048_576.0;
/// Place of the wheel that measures the turn of a robot by its dead reckoning, m; any will do.
const VIRTUAL_ARM_M: f64 = 0.1;

/// What the counts of a run are made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CountSource {
    /// Cumulative counts (`enc_1..N`).
    #[default]
    Encoders,
    /// Wheel speeds (`speed_i`, else `meas_i`), integrated.
    Speeds,
    /// The robot's own dead reckoning, as three wheels at right angles that no robot has: see [`as_logged`].
    Odometry,
}

/// What the duties of a run are made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DutySource {
    /// Logged duties (`duty_1..N`).
    #[default]
    Duties,
    /// Motor currents: current times resistance over supply, without back-EMF.
    Currents,
}

/// What counts and duties of a run are made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Source {
    /// What the wheel angles are read from.
    pub counts: CountSource,
    /// What the drive of the motors is read from.
    pub duties: DutySource,
    /// Whether the camera gives positions alone, and headings are where the wheels' way points.
    pub positions_only: bool,
}

/// The robot as the columns of its logs show it: with the encoders, wheels and motors that [`Source`] speaks of, and
/// ticks as far apart as those of the logs where its file does not say. Written to no file.
#[must_use]
pub fn as_logged(robot: &Robot, source: Source, tick_s: Option<f64>) -> Robot {
    let mut robot = robot.clone();
    let mut known: Vec<&str> = Vec::new();
    match source.counts {
        CountSource::Encoders => {}
        CountSource::Speeds => {
            robot.encoder_counts_per_motor_rev = VIRTUAL_COUNTS_PER_RAD * TAU / robot.gear_ratio;
            known.push("encoder_counts_per_motor_rev");
        }
        CountSource::Odometry => {
            robot.layout = Layout::Wheels(virtual_wheels().to_vec());
            (robot.wheel_radius_m, robot.gear_ratio, robot.support) = (1.0, 1.0, Support::Floor);
            robot.encoder_counts_per_motor_rev = VIRTUAL_COUNTS_PER_RAD * TAU;
            known.extend(["encoder_counts_per_motor_rev", WHEELS, "wheel_radius_m"]);
        }
    }
    if source.duties == DutySource::Currents {
        robot.motor.back_emf_constant = Some(0.0);
        if !robot.lacks(&["supply_v", "motor.resistance_ohm"]).is_empty() {
            // Currents say what they are whatever the winding: an ohm and a volt make them duties.
            (robot.supply_v, robot.motor.resistance_ohm) = (1.0, 1.0);
        }
        known.extend(["supply_v", "motor.resistance_ohm"]);
    }
    if let Some(tick) = tick_s.filter(|_| !robot.lacks(&["control_rate_hz"]).is_empty()) {
        robot.control_rate_hz = 1.0 / tick;
        known.push("control_rate_hz");
    }
    robot.missing.retain(|m| !known.contains(&m.as_str()));
    robot
}

/// What of `robot.toml` the torques of the motors need.
pub const DRIVE_KEYS: [&str; 8] = [
    "mass_kg",
    "yaw_inertia_kg_m2",
    "gear_ratio",
    "supply_v",
    "motor.resistance_ohm",
    "motor.torque_constant",
    "motor.rotor_inertia",
    "motor.friction_torque",
];

/// What of [`DRIVE_KEYS`] a robot lacks; on blocks its body moves nothing.
pub fn drive_lacks(robot: &Robot) -> Vec<&'static str> {
    let mut lacks = robot.lacks(&DRIVE_KEYS);
    if robot.support == Support::Blocks {
        lacks.retain(|key| !["mass_kg", "yaw_inertia_kg_m2"].contains(key));
    }
    lacks
}

/// Whether a robot's wheels are those that stand for dead reckoning, see [`as_logged`].
pub fn is_dead_reckoning(robot: &Robot) -> bool {
    matches!(&robot.layout, Layout::Wheels(wheels) if wheels[..] == virtual_wheels())
}

/// Whether a robot's counts are integrated wheel speeds, see [`as_logged`]: gear and encoder have no part in them.
pub fn is_from_speeds(robot: &Robot) -> bool {
    !is_dead_reckoning(robot) && (robot.counts_per_wheel_rad() / VIRTUAL_COUNTS_PER_RAD - 1.0).abs() < 1e-9
}

/// Wheels that measure vx, vy and vx + arm · ω.
fn virtual_wheels() -> [Wheel; 3] {
    let wheel = |y_m: f64, drive_rad: f64| Wheel { x_m: 0.0, y_m, drive_rad, roller_rad: 0.0 };
    [wheel(0.0, 0.0), wheel(0.0, std::f64::consts::FRAC_PI_2), wheel(-VIRTUAL_ARM_M, 0.0)]
}

/// Turns a log, part by part, into one of counts, duties and fresh samples.
pub(crate) struct Reading {
    source: Source,
    derive: derive::Derive,
    stamps: stamps::Stamps,
    held: held::Held,
    camera: camera::Repeats,
    interpolated: interpolated::Interpolated,
    headings: headings::Headings,
}

impl Reading {
    /// For a log that begins with this part.
    ///
    /// # Errors
    /// All keys of `robot.toml` at once that the log's signals need and the robot lacks.
    pub(crate) fn new(robot: &Robot, first: &Run, path: &Path) -> Result<Self, RunError> {
        let counts = match () {
            () if !first.counts.is_empty() => CountSource::Encoders,
            () if !first.speed.is_empty() || !first.measured.is_empty() => CountSource::Speeds,
            () if first.odometry.is_some() => CountSource::Odometry,
            () => CountSource::Encoders,
        };
        let currents = first.duty.is_empty() && !first.current.is_empty();
        let duties = if currents { DutySource::Currents } else { DutySource::Duties };
        needed(robot, first, counts, path)?;
        let source = Source { counts, duties, positions_only: headings::Headings::are_missing(first) };
        Ok(Self {
            source,
            derive: derive::Derive::new(source, &as_logged(robot, source, None), robot, first),
            stamps: stamps::Stamps::of(first, robot.lacks(&["control_rate_hz"]).is_empty().then(|| robot.tick_s())),
            held: held::Held::of(first),
            camera: camera::Repeats::of(first),
            interpolated: interpolated::Interpolated::of(first),
            headings: headings::Headings::of(&as_logged(robot, source, None)),
        })
    }

    /// The next part.
    pub(crate) fn apply(&mut self, mut run: Run) -> Run {
        run.source = self.source;
        self.stamps.apply(&mut run);
        self.held.apply(&mut run);
        self.camera.apply(&mut run);
        self.interpolated.apply(&mut run);
        self.derive.apply(&mut run);
        if self.source.positions_only {
            self.headings.apply(&mut run);
            run.notes.extend(self.headings.note());
        } else {
            // A log whose first frames come late has no headings for them.
            run.camera.retain(|sample| !sample.pose.theta.is_nan());
        }
        run.notes.extend(self.stamps.note());
        run.notes.extend(self.held.note(&run));
        run.notes.extend(self.camera.note(&run));
        run.notes.extend(self.interpolated.note(&run));
        run.notes.extend(self.derive.note());
        run
    }
}

/// What the signals of a log need to know of the robot.
fn needed(robot: &Robot, run: &Run, counts: CountSource, path: &Path) -> Result<(), RunError> {
    let wheels = [WHEELS, "wheel_radius_m"];
    let (signals, keys): (&str, Vec<&str>) = match counts {
        CountSource::Encoders if run.counts.is_empty() => return Ok(()),
        CountSource::Encoders => {
            (&Column::Counts(0).name(), [&wheels[..], &["gear_ratio", "encoder_counts_per_motor_rev"]].concat())
        }
        CountSource::Speeds => ("speed_1", wheels.to_vec()),
        CountSource::Odometry => return Ok(()),
    };
    let missing = if robot.support == Support::Blocks { robot.lacks(&keys[1..]) } else { robot.lacks(&keys) };
    if missing.is_empty() {
        return Ok(());
    }
    let what = format!("the log has {signals}, but robot.toml does not say {}", missing.join(", "));
    let hint = "add what is missing to robot.toml; `racbot init` writes one with every key explained";
    Err(InputError::new(path, what, hint))
}

#[cfg(test)]
mod tests;
