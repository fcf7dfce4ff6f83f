//! `racbot calibrate`

mod answers;
mod result;

use super::options::{Hidden, load_robot, remark_on_effects};
use crate::terminal::{Answer, Failure, wrapped};
use clap::{Args, ValueEnum};
use model::calibration::{PaperOptions, calibrate_like_the_paper, estimate_skew};
use model::camera::CameraModel;
use model::frames::Pose;
use model::plant::Contact;
use model::robot::{Layout, Robot};
use model::run::DataSet;
use model::simulation::VirtualRobot;
use result::Calibrated;
use std::path::PathBuf;

/// Options of `calibrate`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    /// Folder with robot.toml and runs (*.csv) of encoders and camera
    #[arg(value_name = "DATASET", required_if_eq("procedure", "estimate"))]
    data_set: Option<PathBuf>,

    /// How
    #[arg(long, value_enum, default_value_t)]
    procedure: Procedure,

    /// Nominal robot [default: that of the data set, or the built-in one]
    #[arg(long, value_name = "FILE")]
    robot: Option<PathBuf>,

    #[command(flatten)]
    hidden: Hidden,

    /// Seed of the camera's noise on the virtual robot
    #[arg(long, default_value_t = 1)]
    seed: u64,

    /// Folder for the calibrated robot.toml, the FPGA's coefficient words and a picture
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// How to calibrate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Procedure {
    /// All skews at once from the logs of a data set, with confidence intervals
    #[default]
    Estimate,
    /// The paper's three steps of straight lines, on a virtual robot (--skew-deg or --hidden)
    Paper,
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        match self.procedure {
            Procedure::Estimate => self.estimate(),
            Procedure::Paper => self.paper(),
        }
    }

    fn estimate(&self) -> Result<Answer, Failure> {
        if self.hidden.is_given() {
            return Err(Failure::usage("--hidden and --skew-deg are for the virtual robot of --procedure paper"));
        }
        let Some(folder) = &self.data_set else { return Err(Failure::usage("a data set is needed to estimate from")) };
        let set = match &self.robot {
            None => DataSet::open(folder)?,
            Some(file) => DataSet::open_as(folder, Robot::load(file)?)?,
        };
        let estimate = estimate_skew(&set.robot, &set.runs).map_err(|error| Failure::about(folder, error))?;
        let calibrated = estimate.apply(&set.robot);
        // What the robot really is nobody knows; the estimate is the best guess.
        let result = Calibrated { nominal: &set.robot, actual: &calibrated, calibrated: &calibrated };
        self.finish(&result, Answer { text: answers::estimate(&estimate), json: estimate.to_json(), wrong: None })
    }

    fn paper(&self) -> Result<Answer, Failure> {
        if self.data_set.is_some() {
            return Err(Failure::usage("--procedure paper drives a virtual robot and reads no data set"));
        }
        if !self.hidden.is_given() {
            return Err(Failure::usage("say what the virtual robot really is: --skew-deg 4,-3,2 or --hidden FILE"));
        }
        let nominal = load_robot(self.robot.as_deref())?;
        let actual = self.hidden.robot(&nominal)?;
        let camera = CameraModel::of(&actual);
        let mut robot = VirtualRobot::new(&actual, Contact::default(), camera, Pose::default(), self.seed)
            .map_err(Failure::data)?;
        let found = calibrate_like_the_paper(&nominal, &mut robot, &PaperOptions::default()).map_err(Failure::data)?;
        let mut calibrated = nominal.clone();
        if let Layout::Rac { skew_rad, .. } = &mut calibrated.layout {
            *skew_rad = found.common;
        }
        let result = Calibrated { nominal: &nominal, actual: &actual, calibrated: &calibrated };
        self.finish(&result, Answer { text: answers::paper(&found), json: answers::paper_json(&found), wrong: None })
    }

    /// Writes what is asked for and adds the words for the FPGA.
    fn finish(&self, result: &Calibrated<'_>, mut answer: Answer) -> Result<Answer, Failure> {
        if let Some(remark) = remark_on_effects(result.nominal) {
            answer.text += &wrapped(&remark, 2);
        }
        answer.json["configuration"] = result.words()?.into();
        if let Some(folder) = &self.out {
            let files = result.save(folder)?;
            answer.text += &wrapped(&format!("written      {}: {}", folder.display(), files.join(", ")), 13);
        }
        Ok(answer)
    }
}
