//! `racbot calibrate`

mod estimate;
#[cfg(feature = "simulation")]
mod paper;
mod result;

use super::check::Despite;
#[cfg(feature = "simulation")]
use super::driven::any_robot;
#[cfg(feature = "simulation")]
use super::options::Hidden;
use crate::terminal::{Answer, Failure, Target, wrapped};
use clap::{Args, ValueEnum};
use model::calibration::estimate_skew;
use result::Calibrated;
use runs::DataSet;
use runs::robot::Robot;
use std::path::PathBuf;

/// Options of `calibrate`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    /// Folder with robot.toml and runs (*.csv) of encoders and camera
    #[arg(value_name = "DATASET", required_if_eq("procedure", "estimate"))]
    data_set: Option<PathBuf>,

    /// Procedure by which the skews are found
    #[arg(long, value_enum, default_value_t)]
    procedure: Procedure,

    /// Nominal robot [default: that of the data set, or the built-in one]
    #[arg(long, value_name = "FILE")]
    robot: Option<PathBuf>,

    #[cfg(feature = "simulation")]
    #[command(flatten)]
    hidden: Hidden,

    /// Seed of the camera's noise on the virtual robot
    #[cfg(feature = "simulation")]
    #[arg(long, default_value_t = 1)]
    seed: u64,

    /// Folder for the calibrated robot.toml, the FPGA's coefficient words and pictures
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    #[command(flatten)]
    target: Target,

    #[command(flatten)]
    despite: Despite,
}

/// How to calibrate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Procedure {
    /// All skews at once from the logs of a data set, with confidence intervals
    #[default]
    Estimate,
    /// The paper's three steps of straight lines, on a virtual robot (--skew-deg or --hidden)
    #[cfg(feature = "simulation")]
    Paper,
}

/// Largest skew that is one: a wheel turned further drives another way altogether.
const LARGEST_DEG: f64 = 45.0;

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        let (mut answer, calibrated) = match self.procedure {
            Procedure::Estimate => self.estimate()?,
            #[cfg(feature = "simulation")]
            Procedure::Paper => self.paper()?,
        };
        answer.json["configuration"] = calibrated.words();
        let files = match &self.out {
            Some(folder) => calibrated.save(folder, self.target, &answer.text)?,
            None => Vec::new(),
        };
        if let Some(firmware) = calibrated.firmware() {
            answer.text += &format!("\nInto your firmware\n{}\n", firmware.c_arrays());
        }
        if let Some(folder) = &self.out {
            answer.text += &wrapped(&format!("written to {}: {}", folder.display(), files.join(", ")), 2);
        }
        Ok(answer)
    }

    fn estimate(&self) -> Result<(Answer, Calibrated), Failure> {
        #[cfg(feature = "simulation")]
        if self.hidden.is_given() {
            return Err(Failure::usage("--hidden and --skew-deg are for the virtual robot of --procedure paper"));
        }
        let Some(folder) = &self.data_set else {
            return Err(Failure::usage("<DATASET> is missing: a folder with robot.toml and runs to estimate from"));
        };
        let set = match &self.robot {
            None => DataSet::open(folder)?,
            Some(file) => DataSet::open_as(folder, Robot::load_partial(file)?)?,
        };
        if runs::is_dead_reckoning(&set.as_logged()) {
            let what =
                "the logs have the robot's odometry and no wheels: log enc_1..N or speed_1..N to find their skews";
            return Err(Failure::about(folder, what));
        }
        let mut checked = super::check::first_stage(folder, &runs::Logs::from(&set), self.despite)?;
        let estimate = estimate_skew(&set.as_logged(), &set.runs).map_err(|error| Failure::about(folder, error))?;
        let largest = estimate.skew_rad.iter().map(|s| s.abs()).fold(0.0, f64::max).to_degrees();
        if largest > LARGEST_DEG {
            let what = format!("the best fit turns a wheel by {largest:.0}°: no skew does that; see `racbot check`");
            if !self.despite.mistakes() {
                return Err(Failure::about(folder, format!("{what} (--despite-mistakes goes on nevertheless)")));
            }
            checked.mistakes.push(what);
        }
        let found = estimate.apply(&set.robot);
        // What the robot really is nobody knows; the estimate is the best guess.
        let mut text = checked.text() + &estimate::text(&estimate);
        if estimate.is_none() {
            return Ok((Answer { text, json: estimate.to_json(), wrong: None }, Calibrated::not_at_all(&found)));
        }
        // Logs come from robots of any kind; words and drives are for those that the card can drive.
        let whole = set.robot.missing.is_empty();
        let card = if whole { Calibrated::new(&set.robot, &found, &found).ok() } else { None };
        let calibrated = card.unwrap_or_else(|| {
            text += "\nNo words for the FPGA and no drive: this robot is none that the card drives.\n";
            Calibrated::without_card(&found)
        });
        Ok((Answer { text, json: estimate.to_json(), wrong: None }, calibrated))
    }

    #[cfg(feature = "simulation")]
    fn paper(&self) -> Result<(Answer, Calibrated), Failure> {
        if self.data_set.is_some() {
            return Err(Failure::usage("--procedure paper drives a virtual robot and reads no data set"));
        }
        if !self.hidden.is_given() {
            return Err(Failure::usage("say what the virtual robot really is: --skew-deg 4,-3,2 or --hidden FILE"));
        }
        let nominal = any_robot(self.robot.as_deref())?;
        let actual = self.hidden.robot(&nominal)?;
        paper::run(&nominal, &actual, self.seed)
    }
}
