//! Writing a case: the data in one folder, the truth anywhere else.

use std::path::Path;

use rand::RngExt;
use serde::{Deserialize, Serialize};

use crate::ablation::Ablation;
use crate::axis;
use crate::case::{Case, Conditions, Kind};
use crate::draw::{draw_with, observable};
use crate::effects::{self, Hidden};
use crate::error::Error;
use crate::folder;
use crate::log::Log;
use crate::machine::Machine;
use crate::noise::{Stream, stream};
use crate::run::{simulate_run, ticks_of};

/// What is true about a data set.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// Seed it was drawn with.
    pub seed: u64,
    /// Kind of case.
    pub kind: String,
    /// Hidden effects of the catalogue.
    pub effects: Vec<Hidden>,
    /// Hidden effects outside the catalogue: the right answer is "none of these".
    pub outside: Vec<Hidden>,
    /// What was spoiled on purpose: scoring against `effects` must fail.
    pub ablation: Option<Ablation>,
    /// Whether every hidden effect can show in the columns that were written.
    pub observable: bool,
    /// Conditions of the runs.
    pub conditions: Conditions,
    /// What every set of a robot has.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nuisance: Option<Nuisance>,
    /// In the order of their files.
    pub runs: Vec<RunTruth>,
}

/// Nuisances as drawn; none is an effect to be named, unless an effect of the same kind was hidden on top.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Nuisance {
    /// Drag of the roller bearings of every wheel, N.
    pub roller_drag_n: Vec<f64>,
    /// Slip speed per force, s/kg.
    pub creep_s_per_kg: f64,
    /// Slip ratio per force, 1/N.
    pub slip_ratio_per_n: f64,
    /// Friction limit over load.
    pub friction_coefficient: f64,
    /// Battery resistance, Ω.
    pub battery_ohm: f64,
    /// Whether `supply_v` was measured or stands at nominal.
    pub supply_measured: bool,
    /// Wheel inertia, kg m².
    pub wheel_inertia_kg_m2: f64,
    /// Standard deviation of the carpet's force, N.
    pub ground_force_n: f64,
    /// Camera noise, m and rad.
    pub camera_noise: [f64; 2],
}

impl Nuisance {
    fn of(machine: &Machine) -> Self {
        Self {
            roller_drag_n: machine.wheels.iter().map(|wheel| wheel.roller_drag_n).collect(),
            creep_s_per_kg: machine.ground.creep_s_per_kg,
            slip_ratio_per_n: machine.ground.slip_ratio_per_n,
            friction_coefficient: machine.ground.friction_static,
            battery_ohm: machine.power.battery_ohm,
            supply_measured: machine.power.supply_measured,
            wheel_inertia_kg_m2: machine.wheels.first().map_or(0.0, |wheel| wheel.inertia_kg_m2),
            ground_force_n: machine.roughness.force_n,
            camera_noise: [machine.camera.noise_m, machine.camera.noise_rad],
        }
    }
}

/// A recording: what was driven, and how long.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunTruth {
    /// File name.
    pub file: String,
    /// Name of the excitation.
    pub excitation: String,
    /// Duration, s.
    pub seconds: f64,
}

/// Makes the logs of all runs of a case.
#[must_use]
pub fn simulate(case: &Case) -> Vec<Log> {
    let mut rng = stream(case.seed, Stream::Ablation);
    let count = case.machine.wheels.len();
    let first = case.effects.first().and_then(|e| e.wheels.first()).map_or(0, |wheel| wheel - 1);
    let second = (first + rng.random_range(1..count.max(2))) % count.max(1);
    (0..)
        .zip(&case.drives)
        .map(|(number, drive)| {
            let mut log = simulate_run(&case.robot, &case.machine, drive, case.seed, number);
            if let Some(ablation) = case.ablation {
                ablation.spoil(&mut log, [first, second], &mut rng);
            }
            log
        })
        .collect()
}

/// What a case hides, as written to its truth file.
#[must_use]
pub fn truth(case: &Case) -> Truth {
    let seen = |hidden: &Hidden| {
        effects::find(&hidden.name)
            .or_else(|_| effects::find_outside(&hidden.name))
            .is_ok_and(|entry| observable(entry, &case.conditions))
    };
    Truth {
        seed: case.seed,
        kind: case.kind.to_string(),
        effects: case.effects.clone(),
        outside: case.outside.clone(),
        ablation: case.ablation,
        observable: case.effects.iter().chain(&case.outside).all(seen),
        conditions: case.conditions.clone(),
        nuisance: Some(Nuisance::of(&case.machine)),
        runs: (0..)
            .zip(&case.drives)
            .map(|(number, drive)| RunTruth {
                file: run_name(number),
                excitation: drive.name.clone(),
                seconds: (drive.seconds() * 1000.0).round() / 1000.0,
            })
            .collect(),
    }
}

/// Simulates a case and writes `robot.toml` and `run_NN.csv` into `dir`; the truth is returned and not written.
///
/// # Errors
/// [`Error::File`], or [`Error::Diverged`] where the simulation left all bounds.
pub fn write(case: &Case, dir: &Path) -> Result<Truth, Error> {
    folder::begin(dir, &case.robot.to_toml())?;
    for ((number, log), drive) in (0..).zip(simulate(case)).zip(&case.drives) {
        if log.rows.len() < ticks_of(&case.robot, drive) {
            return Err(Error::Diverged { seed: case.seed, file: run_name(number), tick: log.rows.len() });
        }
        folder::put(dir, &run_name(number), &log.to_csv(case.columns))?;
    }
    Ok(truth(case))
}

/// Draws a case of this kind under these conditions, which are a robot's, and writes it as [`write()`] does.
///
/// # Errors
/// [`Error`] where the case cannot be drawn, simulated or written.
pub fn make(seed: u64, kind: &Kind, conditions: &Conditions, dir: &Path) -> Result<Truth, Error> {
    let Kind::Axis { effects, size } = kind else { return write(&draw_with(seed, kind, conditions)?, dir) };
    let case = axis::draw(seed, effects, *size)?;
    let run = |(file, excitation, seconds)| RunTruth { file, excitation, seconds };
    Ok(Truth {
        seed,
        kind: kind.to_string(),
        runs: case.write(dir)?.into_iter().map(run).collect(),
        effects: case.effects,
        outside: Vec::new(),
        ablation: None,
        observable: true,
        conditions: conditions.clone(),
        nuisance: None,
    })
}

/// Of a run numbered from 0.
fn run_name(number: u32) -> String {
    folder::run_name(number + 1)
}
