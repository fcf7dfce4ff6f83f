//! `racbot calibrate`

use crate::terminal::{Answer, Failure, Table, save, wrapped};
use clap::Args;
use model::calibration::{SkewEstimate, estimate_skew};
use model::robot::Robot;
use model::run::DataSet;
use std::fmt::Write as _;
use std::path::PathBuf;

/// Options of `calibrate`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    /// Folder with robot.toml and runs (*.csv) of encoders and camera
    #[arg(value_name = "DATASET")]
    data_set: PathBuf,

    /// Another robot.toml than the data set's own
    #[arg(long, value_name = "FILE")]
    robot: Option<PathBuf>,

    /// Write the calibrated robot.toml here
    #[arg(long, value_name = "FILE")]
    write: Option<PathBuf>,
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        let set = match &self.robot {
            None => DataSet::open(&self.data_set)?,
            Some(file) => DataSet::open_as(&self.data_set, Robot::load(file)?)?,
        };
        let estimate = estimate_skew(&set.robot, &set.runs)
            .map_err(|error| Failure::data(format!("{}: {error}", self.data_set.display())))?;
        let mut text = text(&estimate);
        if let Some(path) = &self.write {
            save(path, &estimate.apply(&set.robot).to_toml())?;
            let _ = writeln!(text, "written      {}", path.display());
        }
        Ok(Answer { text, json: estimate.to_json(), wrong: None })
    }
}

fn text(estimate: &SkewEstimate) -> String {
    let mut table = Table::new(1, &["wheel", "skew", "95 % from", "to"]);
    for (wheel, (skew, [low, high])) in estimate.skew_rad.iter().zip(&estimate.ci95).enumerate() {
        let degrees = |rad: f64| format!("{:.2}°", rad.to_degrees());
        table.row([(wheel + 1).to_string(), degrees(*skew), degrees(*low), degrees(*high)]);
    }
    let mut text = table.render();
    text.push('\n');
    for (i, j, half) in &estimate.differences {
        let difference = (estimate.skew_rad[*i] - estimate.skew_rad[*j]).to_degrees();
        let _ = writeln!(text, "wheel {} - {}    {difference:.2}° ± {:.2}°", i + 1, j + 1, half.to_degrees());
    }
    let residual = &estimate.residual;
    let shown = |[x, y, theta]: [f64; 3]| format!("{:.1} mm, {:.1} mm, {:.2}°", 1e3 * x, 1e3 * y, theta.to_degrees());
    let _ = writeln!(text, "residual     {} before", shown(residual.before));
    let _ = writeln!(text, "             {} after", shown(residual.after));
    let _ = writeln!(text, "noise        {}, {} camera frames", shown(residual.noise), residual.frames);
    for remark in &estimate.remarks {
        text += &wrapped(remark, 0);
    }
    text
}
