//! All skews at once from logs of encoders and camera.

use crate::terminal::{Answer, Failure, Table, save, wrapped};
use model::calibration::{SkewEstimate, estimate_skew};
use model::robot::Robot;
use model::run::DataSet;
use std::fmt::Write as _;
use std::path::Path;

pub(super) fn run(data_set: &Path, robot: Option<&Path>, write: Option<&Path>) -> Result<Answer, Failure> {
    let set = match robot {
        None => DataSet::open(data_set)?,
        Some(file) => DataSet::open_as(data_set, Robot::load(file)?)?,
    };
    let estimate = estimate_skew(&set.robot, &set.runs)
        .map_err(|error| Failure::data(format!("{}: {error}", data_set.display())))?;
    let mut text = text(&estimate);
    if let Some(path) = write {
        save(path, &estimate.apply(&set.robot).to_toml())?;
        let _ = writeln!(text, "written      {}", path.display());
    }
    Ok(Answer { text, json: estimate.to_json(), wrong: None })
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
