//! The paper's procedure on the virtual robot, every drive through the FPGA.

use crate::commands::options::{Degrees, skewed};
use crate::terminal::progress::Progress;
use crate::terminal::{Answer, Failure, Table, save, wrapped};
use clap::Args;
use fixed_kin::registers::NOMINAL_CLOCK_HZ;
use model::calibration::{Iteration, PaperCalibration, PaperOptions, Stage, calibrate_like_the_paper};
use model::error::InputError;
use model::plant::Contact;
use model::plot::Color;
use model::robot::{Layout, Robot};
use model::trajectory::FIG_6;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use testbench::calibration::{BoardRobot, before_and_after, coefficient_words, skew_fan};
use testbench::closed_loop::Driven;
use testbench::closed_loop::picture::{Curve, trajectory};

/// The virtual robot of `--procedure paper`.
#[derive(Args, Debug)]
pub(super) struct VirtualOptions {
    /// Skew of every wheel of the virtual robot in degrees, unknown to the host
    #[arg(long, value_name = "DEG,..", allow_hyphen_values = true, default_value = "4,-3,2")]
    skew_deg: Degrees,

    /// The virtual robot as it really is, instead of --skew-deg
    #[arg(long, value_name = "FILE")]
    hidden: Option<PathBuf>,

    /// Seed of the camera's noise
    #[arg(long, default_value_t = 1)]
    seed: u64,

    /// Folder for the pictures of the paper's procedure
    #[arg(long, value_name = "DIR", default_value = "out/calibrate")]
    out: PathBuf,
}

impl VirtualOptions {
    pub(super) fn run(&self, robot: Option<&Path>, write: Option<&Path>) -> Result<Answer, Failure> {
        let nominal = robot.map_or_else(|| Ok(Robot::racbot()), Robot::load)?;
        let actual = self.actual(&nominal)?;
        let progress = Progress::new("driving straight lines".to_owned(), 1);
        let mut virtual_robot = BoardRobot::new(&nominal, &actual, Contact::default(), self.seed);
        let found = calibrate_like_the_paper(&nominal, &mut virtual_robot, &PaperOptions::default())
            .map_err(Failure::data)?;
        progress.at(1);
        let calibrated = with_skew(&nominal, found.common);
        let drives = before_and_after(&nominal, &actual, &calibrated).map_err(Failure::data)?;
        let words = coefficient_words(&calibrated, f64::from(NOMINAL_CLOCK_HZ)).map_err(Failure::data)?;

        let mut files = vec![self.out.join("calibration.svg")];
        save(&files[0], &picture(&drives))?;
        if let Some(fan) = skew_fan(&nominal, 8_f64.to_radians()) {
            files.push(self.out.join("skew-fan.svg"));
            save(&files[1], &fan)?;
        }
        let robot_file = write.map_or_else(|| self.out.join("robot.toml"), Path::to_path_buf);
        save(&robot_file, &calibrated.to_toml())?;
        files.push(robot_file);

        let mut text = iterations(&found);
        text += &outcome(&found, &actual, &drives);
        let _ = writeln!(text, "registers    {} coefficient words from {:#05x}", words.len(), words[0].offset);
        for file in &files {
            let _ = writeln!(text, "written      {}", file.display());
        }
        let mut json = to_json(&found, &drives);
        json["coefficients"] = words.iter().map(|w| json!({ "offset": w.offset, "word": w.word })).collect();
        json["files"] = json!(files);
        Ok(Answer { text, json, wrong: None })
    }

    fn actual(&self, nominal: &Robot) -> Result<Robot, Failure> {
        let Some(file) = &self.hidden else { return skewed(nominal, &self.skew_deg) };
        let actual = Robot::load(file)?;
        if actual.wheel_count() != nominal.wheel_count() {
            return Err(InputError::new(file, "has another number of wheels", "hide a robot with as many").into());
        }
        Ok(actual)
    }
}

fn with_skew(robot: &Robot, skew_rad: [f64; 3]) -> Robot {
    let mut robot = robot.clone();
    if let Layout::Rac { skew_rad: place, .. } = &mut robot.layout {
        *place = skew_rad;
    }
    robot
}

fn degrees(skew: [f64; 3]) -> String {
    skew.map(|s| format!("{:+.2}", s.to_degrees())).join(", ") + "°"
}

/// Every drive, in order.
fn iterations(found: &PaperCalibration) -> String {
    let mut table = Table::new(1, &["drive", "step", "wheel", "skews believed", "turns by", "goes beside"]);
    for (number, Iteration { stage, wheel, skew_rad, seen }) in found.iterations.iter().enumerate() {
        let step = match stage {
            Stage::Straighten(round) => format!("straighten, round {round}"),
            Stage::Straight => "look".to_owned(),
            Stage::Scaled => "scaled, as printed".to_owned(),
            Stage::Common => "common, sound".to_owned(),
        };
        table.row([
            (number + 1).to_string(),
            step,
            (wheel + 1).to_string(),
            degrees(*skew_rad),
            format!("{:+.2}°/m", seen.heading_per_m.to_degrees()),
            format!("{:+.2}°", seen.direction_error.to_degrees()),
        ]);
    }
    table.render() + "\n"
}

fn outcome(found: &PaperCalibration, actual: &Robot, drives: &[Driven; 3]) -> String {
    let mut text = String::new();
    if let Layout::Rac { skew_rad, .. } = actual.layout {
        let _ = writeln!(text, "truth        {}", degrees(skew_rad));
    }
    let (straight, _) = found.quality(Stage::Straight);
    let (scaled, _) = found.quality(Stage::Scaled);
    let (common, _) = found.quality(Stage::Common);
    for (name, skew, turn) in [
        ("straight", found.straight, straight),
        ("as printed", found.scaled, scaled),
        ("sound", found.common, common),
    ] {
        let _ = writeln!(text, "{name:<12} {}, lines turn by {:.2}°/m RMS", degrees(skew), turn.to_degrees());
    }
    let [_, before, after] = drives.each_ref().map(|d| 1e3 * d.report.path_error_rms_m);
    let _ = writeln!(text, "Fig. 7       path error {before:.0} mm RMS before, {after:.0} mm after, on odometry alone");
    text += &wrapped(
        "Straight lines fix only the differences of the skews. The last step as printed scales all of them, which \
         bends the lines again; the sound one adds one angle to all, found from the direction of travel, which a \
         turned marker plate would shift alike.",
        0,
    );
    text
}

fn picture(drives: &[Driven; 3]) -> String {
    let looks = [
        ("ideal geometry", Color::Grey, true),
        ("skew unknown", Color::Red, false),
        ("skew calibrated", Color::Green, false),
    ];
    let curves: Vec<_> = drives
        .iter()
        .zip(looks)
        .map(|(driven, (label, color, dashed))| Curve { label, driven, color, dashed })
        .collect();
    trajectory("Before and after calibration", &FIG_6, &curves)
}

fn to_json(found: &PaperCalibration, drives: &[Driven; 3]) -> Value {
    let stage = |skew: [f64; 3], stage: Stage| {
        let (turn, direction) = found.quality(stage);
        json!({ "skew_rad": skew, "heading_per_m_rms": turn, "direction_error_rad": direction })
    };
    let [ideal, before, after] = drives.each_ref().map(|d| d.report.path_error_rms_m);
    json!({
        "procedure": "paper",
        "drives": found.iterations.len(),
        "skew_rad": found.common,
        "straight": stage(found.straight, Stage::Straight),
        "as_printed": stage(found.scaled, Stage::Scaled),
        "sound": stage(found.common, Stage::Common),
        "path_error_rms_m": { "ideal": ideal, "before": before, "after": after },
    })
}
