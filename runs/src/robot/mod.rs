//! The robot as its designers describe it: `robot.toml`.

mod edit;
mod effect;
mod fields;
mod imu;
mod layout;
mod parse;
mod section;
mod write;

use std::f64::consts::TAU;
use std::path::Path;

pub use effect::{Effect, EffectParameter};
pub use imu::{Axis, ImuMount, SensorName};

use crate::error::InputError;
use crate::geometry::{Geometry, GeometryError, Wheel, rac_wheels};

/// Nominal parameters of a robot, in SI units; frames as in [`crate::frames::Twist`].
///
/// The fields carry the names of `robot.toml`; [`Robot::load`] explains what it does not accept.
#[derive(Debug, Clone, PartialEq)]
pub struct Robot {
    /// Nominal radius of every wheel, m.
    pub wheel_radius_m: f64,
    /// Where the wheels are.
    pub layout: Layout,
    /// Mass of the whole robot, kg.
    pub mass_kg: f64,
    /// Moment of inertia of the whole robot about the vertical through the chassis centre, kg m².
    pub yaw_inertia_kg_m2: f64,
    /// Motor turns per wheel turn.
    pub gear_ratio: f64,
    /// Share of the transmitted torque that is not lost in the gear, in (0, 1].
    pub gear_efficiency: f64,
    /// Counts per turn of the motor shaft, after ×4 decoding; any positive number.
    pub encoder_counts_per_motor_rev: f64,
    /// Nominal supply of the motors, V.
    pub supply_v: f64,
    /// Fastest turn of a wheel, rad/s, where it is not the supply that limits it.
    pub top_speed_rad_s: Option<f64>,
    /// Control ticks a second.
    pub control_rate_hz: f64,
    /// Frames a second of the overhead camera; 0 where the file says nothing of it.
    pub camera_rate_hz: f64,
    /// Known delay from exposure to log, s.
    pub camera_latency_s: f64,
    /// Standard deviation of a camera pose (m, m, rad), where known.
    pub camera_noise: Option<[f64; 3]>,
    /// Rounding of logged set points, rad/s, where known.
    pub ref_quantum: Option<f64>,
    /// Rounding of logged duties, where known.
    pub duty_quantum: Option<f64>,
    /// What carries the robot.
    pub support: Support,
    /// Inertia at each wheel shaft beside the reflected rotor, kg m².
    pub wheel_inertia_kg_m2: f64,
    /// The motors, all alike.
    pub motor: MotorParameters,
    /// The speed loop of every axis; both gains 0 where the file says nothing of one.
    pub pi: PiParameters,
    /// The inertial sensor, where there is one.
    pub imu: Option<ImuMount>,
    /// Effects beyond the nominal model, in the order of the file.
    pub effects: Vec<Effect>,
    /// What the file says beside: (table, key, value), kept and ignored. A key that resembles one of ours
    /// is refused as a slip instead.
    pub other: Vec<(String, String, toml::Value)>,
    /// Keys that the file leaves out and only some answers need, such as `motor.resistance_ohm` or [`WHEELS`]; what
    /// stands here in their place is no statement about the robot. Empty for [`Robot::load`].
    pub missing: Vec<String>,
}

/// What [`Robot::missing`] says where the file has neither `[[wheel]]` nor `body_radius_m`.
pub const WHEELS: &str = "[[wheel]]";

/// Where the wheels are.
#[derive(Debug, Clone, PartialEq)]
pub enum Layout {
    /// The paper's robot: three wheels 120° apart, see [`Geometry::rac`].
    Rac {
        /// Chassis centre to contact points, m.
        body_radius_m: f64,
        /// Skew α of each wheel, clockwise, rad.
        skew_rad: [f64; 3],
    },
    /// Any wheels, `[[wheel]]` in the file.
    Wheels(Vec<Wheel>),
}

impl Layout {
    /// Place and directions of every wheel, in the order of the motors.
    pub fn wheels(&self) -> Vec<Wheel> {
        match self {
            Self::Rac { body_radius_m, skew_rad } => rac_wheels(*body_radius_m, *skew_rad),
            Self::Wheels(wheels) => wheels.clone(),
        }
    }
}

/// What carries the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Support {
    /// The wheels stand on the floor.
    #[default]
    Floor,
    /// The wheels are in the air, every axis alone.
    Blocks,
}

/// `[motor]`: a DC motor with permanent magnets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotorParameters {
    /// Terminal resistance, Ω.
    pub resistance_ohm: f64,
    /// Torque per current, Nm/A.
    pub torque_constant: f64,
    /// Voltage per speed of the motor shaft, V s/rad, where it differs from the torque constant.
    pub back_emf_constant: Option<f64>,
    /// Rotor inertia, kg m².
    pub rotor_inertia: f64,
    /// Coulomb friction at the motor shaft, Nm.
    pub friction_torque: f64,
}

impl MotorParameters {
    /// Voltage per speed of the motor shaft, V s/rad.
    pub fn back_emf(&self) -> f64 {
        self.back_emf_constant.unwrap_or(self.torque_constant)
    }
}

/// `[pi]`: gains of the speed loop, a PI law whose integral stops where the duty does.
#[derive(Debug, Clone, PartialEq)]
pub struct PiParameters {
    /// Duty per rad/s at the wheel.
    pub kp: f64,
    /// Duty per rad at the wheel.
    pub ki: f64,
    /// The arithmetic of the loop that ran, such as `fixed-kin`; `None` for floating point.
    pub arithmetic: Option<String>,
    /// Register words of that arithmetic, by name.
    pub registers: Vec<(String, i64)>,
}

impl Robot {
    /// The robot of the paper with zero skew: built in, so that nothing needs a file.
    pub fn racbot() -> Self {
        Self {
            wheel_radius_m: 0.0275,
            layout: Layout::Rac { body_radius_m: 0.085, skew_rad: [0.0; 3] },
            mass_kg: 2.4,
            yaw_inertia_kg_m2: 0.0095,
            gear_ratio: 3.71,
            gear_efficiency: 0.88,
            encoder_counts_per_motor_rev: 2048.0,
            supply_v: 7.2,
            top_speed_rad_s: None,
            control_rate_hz: 1000.0,
            camera_rate_hz: 60.0,
            camera_latency_s: 0.0,
            camera_noise: None,
            ref_quantum: None,
            duty_quantum: None,
            support: Support::Floor,
            wheel_inertia_kg_m2: 0.0,
            motor: MotorParameters {
                resistance_ohm: 1.94,
                torque_constant: 0.00692,
                back_emf_constant: None,
                rotor_inertia: 2.7e-7,
                friction_torque: 0.00015,
            },
            pi: PiParameters { kp: 0.15, ki: 0.8, arithmetic: None, registers: Vec::new() },
            imu: None,
            effects: Vec::new(),
            other: Vec::new(),
            missing: Vec::new(),
        }
    }

    /// Reads a `robot.toml`.
    ///
    /// # Errors
    /// [`InputError`] with line, column and field for text that is no TOML, missing, unknown or
    /// contradictory fields (`[[wheel]]` beside another `body_radius_m` or `skew_rad`), numbers that are
    /// not finite or out of physical range, and wheels that cannot drive the robot. All missing fields are named at once.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, InputError> {
        let path = path.as_ref();
        let text = std::fs::read_to_string(path).map_err(|e| InputError::io(path, &e))?;
        Self::parse(&text, path)
    }

    /// Reads the text of a `robot.toml`; `path` is for the error messages.
    ///
    /// # Errors
    /// As [`Robot::load`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, InputError> {
        parse::robot(text, path, true)
    }

    /// A complaint about an effect of the text of a `robot.toml`, by its index from 0, with the place of its name or of one
    /// of its parameters: what an effect means is known elsewhere.
    pub fn fault_of_effect(
        text: &str,
        path: &Path,
        effect: usize,
        parameter: Option<&str>,
        what: &str,
        hint: &str,
    ) -> InputError {
        parse::fault_of_effect(text, path, (effect, parameter), what, hint)
    }

    /// Reads a `robot.toml` that need not say everything: [`Robot::missing`] has what it leaves out.
    ///
    /// # Errors
    /// As [`Robot::load`], but for missing fields.
    pub fn load_partial(path: impl AsRef<Path>) -> Result<Self, InputError> {
        let path = path.as_ref();
        let text = std::fs::read_to_string(path).map_err(|e| InputError::io(path, &e))?;
        Self::parse_partial(&text, path)
    }

    /// Reads the text of such a file; `path` is for the error messages.
    ///
    /// # Errors
    /// As [`Robot::load_partial`].
    pub fn parse_partial(text: &str, path: &Path) -> Result<Self, InputError> {
        parse::robot(text, path, false)
    }

    /// Those of some keys (such as `mass_kg` or `motor.resistance_ohm`) that the file leaves out.
    pub fn lacks<'a>(&self, keys: &[&'a str]) -> Vec<&'a str> {
        keys.iter().copied().filter(|key| self.missing.iter().any(|m| m == key)).collect()
    }

    /// Writes a `robot.toml` that [`Robot::load`] reads back as an equal robot. Comments of a file
    /// it was read from are not kept.
    ///
    /// # Errors
    /// [`InputError`] if the robot is not valid or the file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), InputError> {
        let path = path.as_ref();
        self.validate(path)?;
        crate::output::write_whole(path, self.to_toml().as_bytes(), crate::output::Existing::Replace)
    }

    /// The text of the robot's `robot.toml`.
    pub fn to_toml(&self) -> String {
        write::robot(self)
    }

    /// The text of a robot's file with exactly these effects; everything else stays as it was
    /// written, comments included. `path` is for the error messages.
    ///
    /// # Errors
    /// As [`Robot::load`], about the text.
    pub fn edited(text: &str, effects: &[Effect], path: &Path) -> Result<String, InputError> {
        edit::effects(text, effects, path)
    }

    /// Checks a robot that was changed in memory by the rules of [`Robot::load`].
    ///
    /// # Errors
    /// [`InputError`] about `path`, without line numbers.
    pub fn validate(&self, path: &Path) -> Result<(), InputError> {
        parse::robot(&self.to_toml(), path, true).map(|_| ()).map_err(|e| InputError { line: None, column: None, ..e })
    }

    /// The kinematics of the nominal robot.
    ///
    /// # Errors
    /// [`GeometryError`] if the wheels cannot drive the robot; never for a robot that was loaded.
    pub fn geometry(&self) -> Result<Geometry, GeometryError> {
        let wheels = self.layout.wheels();
        if self.support == Support::Blocks && wheels.len() < 3 {
            return Geometry::axes(wheels, self.wheel_radius_m);
        }
        Geometry::new(wheels, self.wheel_radius_m)
    }

    /// The robot with its first wheels only: what a log of one axis on blocks speaks of.
    #[must_use]
    pub fn first_axes(&self, wheels: usize) -> Self {
        if wheels >= self.wheel_count() {
            return self.clone();
        }
        Self { layout: Layout::Wheels(self.layout.wheels()[..wheels].to_vec()), ..self.clone() }
    }

    /// Number of wheels.
    pub fn wheel_count(&self) -> usize {
        match &self.layout {
            Layout::Rac { .. } => 3,
            Layout::Wheels(wheels) => wheels.len(),
        }
    }

    /// Encoder counts per radian of the motor shaft.
    pub fn counts_per_motor_rad(&self) -> f64 {
        self.encoder_counts_per_motor_rev / TAU
    }

    /// Encoder counts per radian of the wheel.
    pub fn counts_per_wheel_rad(&self) -> f64 {
        self.counts_per_motor_rad() * self.gear_ratio
    }

    /// One control tick, s.
    pub fn tick_s(&self) -> f64 {
        1.0 / self.control_rate_hz
    }

    /// The speed (rad/s at the wheel) at which back-EMF eats up a supply, or the top speed if that is less;
    /// infinite for a motor whose drive makes up for the back-EMF, or of which nothing is known, and whose top speed
    /// nobody gave.
    pub fn no_load_wheel_speed(&self, supply_v: f64) -> f64 {
        let by_supply = if self.lacks(&["supply_v", "motor.torque_constant", "gear_ratio"]).is_empty() {
            supply_v / (self.motor.back_emf() * self.gear_ratio)
        } else {
            f64::INFINITY
        };
        self.top_speed_rad_s.map_or(by_supply, |top| top.min(by_supply))
    }

    /// The effect of this name, if the file carries it.
    pub fn effect(&self, name: &str) -> Option<&Effect> {
        self.effects.iter().find(|e| e.name == name)
    }
}

#[cfg(test)]
mod tests;
