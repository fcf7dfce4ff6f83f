//! Motors with one load each, of any size: lifted wheels, flywheels, linear axes, and drive trains that go straight ahead.
//!
//! The robots of the rest of this crate have one motor, one controller and one log. Here everything is drawn over the
//! decades in which people build: motors from a tenth of a watt to some kilowatts, rows from 1 to 20 ms, encoders from 12
//! counts a turn, speeds in place of counts, bridges of 8 bits, drives open and in a speed loop.

mod draw;
mod drives;
mod effects;
mod log;
mod motion;

use std::path::Path;

pub(crate) use draw::draw;
pub use effects::{PAIRS, names};

use crate::effects::Hidden;
use crate::error::Error;
use crate::folder;

/// Motor, gear and load; torques, speeds and angles at the output shaft unless said otherwise.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Axis {
    /// Voltage of the supply, V.
    pub(crate) supply_v: f64,
    /// Resistance of the winding, Ω.
    pub(crate) resistance_ohm: f64,
    /// Nm/A and V s/rad at the motor.
    pub(crate) constant: f64,
    /// Motor turns per turn of the output shaft.
    pub(crate) gear: f64,
    /// Rotor's inertia at the motor, kg m².
    pub(crate) rotor: f64,
    /// Inertia of the load, kg m².
    pub(crate) load: f64,
    /// Dry friction for positive and for negative speed, Nm.
    pub(crate) dry: [f64; 2],
    /// Extra dry friction at rest, Nm, and the speed at which 1/e of it is left, rad/s.
    pub(crate) stribeck: [f64; 2],
    /// Nm s.
    pub(crate) viscous: f64,
    /// Nm s²/rad².
    pub(crate) quadratic: f64,
    /// Torque at angle θ: `g[0] sin θ + g[1] cos θ`, Nm.
    pub(crate) gravity: [f64; 2],
    /// Torque of a weight on a rope or a spindle, the same at every angle, Nm.
    pub(crate) hanging: f64,
    /// Torque of the magnets over the motor's angle: amplitude at the output, Nm, and how often a motor turn.
    pub(crate) cogging: [f64; 2],
    /// Duty that the bridge swallows.
    pub(crate) dead_band: f64,
    /// `u (1 + c (|u| − 1))`.
    pub(crate) curvature: f64,
    /// Share of the time between pulses in which the bridge is open.
    pub(crate) coasting: f64,
    /// Current of the motor at most, A.
    pub(crate) limit_a: f64,
    /// From the row's time to the voltage, s.
    pub(crate) latency_s: f64,
    /// Of battery and cables, Ω.
    pub(crate) source_ohm: f64,
}

impl Axis {
    /// Torque of the motor at standstill and full duty, Nm.
    pub(crate) fn stall(&self) -> f64 {
        self.gear * self.constant * self.supply_v / self.resistance_ohm
    }

    /// Speed without load, rad/s.
    pub(crate) fn no_load(&self) -> f64 {
        self.supply_v / (self.gear * self.constant)
    }

    /// kg m².
    pub(crate) fn inertia(&self) -> f64 {
        self.load + self.gear * self.gear * self.rotor
    }

    /// Mechanical time constant, s.
    pub(crate) fn time_constant(&self) -> f64 {
        self.inertia() * self.no_load() / self.stall()
    }
}

/// How an axis is logged.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Logger {
    /// Time between rows, s, and its scatter.
    pub(crate) row_s: f64,
    pub(crate) jitter_s: f64,
    /// Counts a turn of the output shaft, and how far edges are from their places, counts.
    pub(crate) counts: f64,
    pub(crate) edges: f64,
    /// Once a turn of its shaft an encoder that sits beside the middle is so far ahead, with sine and cosine, rad.
    pub(crate) eccentric: [f64; 2],
    /// Steps of the stamps, s.
    pub(crate) stamp_s: Option<f64>,
    /// Share of the rows that never arrive.
    pub(crate) lost: f64,
    /// Mean speeds of so many rows in place of counts.
    pub(crate) mean_rows: Option<usize>,
    /// Time constant of the firmware's low-pass on those, s.
    pub(crate) filter_s: f64,
    /// Steps of the duty from 0 to 1, where it has any.
    pub(crate) duty_steps: Option<f64>,
    /// Whether `supply_v` is logged.
    pub(crate) supply: bool,
}

/// What carries the motors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Carrier {
    /// A load of its own.
    Blocks,
    /// Two equal wheels of this radius, m, on the floor, straight ahead; each moves half of the load.
    Floor(f64),
}

/// Half the track of a drive train whose wheels have this radius, m.
fn half_track(radius: f64) -> f64 {
    (3.0 * radius).min(0.8)
}

/// An axis whose logs hide effects.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct AxisCase {
    /// What the file says, without any effect.
    nominal: Axis,
    /// What is true.
    machine: Axis,
    carrier: Carrier,
    logger: Logger,
    /// Duty or set point of speed, row by row, of every run.
    drives: Vec<drives::Drive>,
    seed: u64,
    /// Effects that the simulated machine has and its `robot.toml` does not.
    pub(crate) effects: Vec<Hidden>,
}

impl AxisCase {
    /// The file that describes the machine.
    fn robot_toml(&self) -> String {
        let a = &self.nominal;
        let motor_dry = a.dry[0] / a.gear;
        let (radius, carrier, wheels) = match self.carrier {
            Carrier::Blocks => (1.0, format!("support = \"blocks\"\nwheel_inertia_kg_m2 = {}\n", a.load), &[0.0][..]),
            Carrier::Floor(radius) => {
                let mass = 2.0 * a.load / (radius * radius);
                let half_track = half_track(radius);
                let about = mass * half_track * half_track;
                let text = format!("mass_kg = {mass}\nyaw_inertia_kg_m2 = {about}\n");
                (radius, text, &[1.0, -1.0][..])
            }
        };
        let mut text = format!(
            "wheel_radius_m = {radius}\ngear_ratio = {}\nencoder_counts_per_wheel_rev = {}\nsupply_v = {}\n{carrier}\
             [motor]\nresistance_ohm = {}\ntorque_constant = {}\nrotor_inertia = {}\nfriction_torque = {motor_dry}\n",
            a.gear, self.logger.counts, a.supply_v, a.resistance_ohm, a.constant, a.rotor
        );
        for side in wheels {
            let x = half_track(radius) * side;
            text += &format!("[[wheel]]\nx_m = {x}\ny_m = 0\ndrive_deg = 90\n");
        }
        text
    }

    /// Writes `robot.toml` and `run_NN.csv`; gives names and durations (s) of the runs.
    pub(crate) fn write(&self, dir: &Path) -> Result<Vec<(String, String, f64)>, Error> {
        folder::begin(dir, &self.robot_toml())?;
        let axes = match self.carrier {
            Carrier::Blocks => 1,
            Carrier::Floor(_) => 2,
        };
        let mut runs = Vec::new();
        for (number, drive) in (1_u32..).zip(&self.drives) {
            let name = folder::run_name(number);
            let recording = motion::record(&self.machine, &self.logger, drive, self.seed, number);
            if recording.angles.iter().any(|a| !a.is_finite()) {
                let tick = recording.angles.iter().take_while(|a| a.is_finite()).count();
                return Err(Error::Diverged { seed: self.seed, file: name, tick });
            }
            folder::put(dir, &name, &log::csv(&recording, &self.logger, axes, self.seed, number))?;
            runs.push((name, drive.name.to_owned(), drive.wanted.len() as f64 * self.logger.row_s));
        }
        Ok(runs)
    }
}
