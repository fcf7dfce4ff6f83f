//! The paper's procedure on the virtual robot, every drive through the FPGA.

use super::result::Calibrated;
use crate::terminal::progress::Progress;
use crate::terminal::{Answer, Failure, Table, wrapped};
use model::calibration::{Iteration, PaperCalibration, PaperOptions, Stage, calibrate_like_the_paper};
use model::plant::Contact;
use runs::robot::{Layout, Robot};
use serde_json::{Value, json};
use simulator::calibration::{BoardRobot, skew_fan};
use std::fmt::Write as _;

/// Largest skew of the fan of trajectories, degrees.
const FAN_DEG: f64 = 8.0;

/// Drives and adjusts until the lines are straight; gives the answer and the calibration.
pub(super) fn run(nominal: &Robot, actual: &Robot, seed: u64) -> Result<(Answer, Calibrated), Failure> {
    let progress = Progress::new("driving straight lines", 1);
    let mut robot = BoardRobot::new(nominal, actual, Contact::default(), seed);
    let found = calibrate_like_the_paper(nominal, &mut robot, &PaperOptions::default()).map_err(Failure::data)?;
    progress.at(1);
    let calibrated = Calibrated::new(nominal, actual, &with_skew(nominal, found.common))?;
    let errors = calibrated.path_errors_m();
    let mut text = iterations(&found);
    text += &outcome(&found, actual, errors);
    let calibrated = calibrated.with_picture("skew-fan.svg", skew_fan(nominal, FAN_DEG.to_radians()));
    Ok((Answer { text, json: to_json(&found, errors), wrong: None }, calibrated))
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
    let mut table = Table::new(4, &["drive", "step", "wheel", "skews believed", "turns by", "goes beside"]);
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

fn outcome(found: &PaperCalibration, actual: &Robot, [_, before, after]: [f64; 3]) -> String {
    let mut text = String::new();
    if let Layout::Rac { skew_rad, .. } = actual.layout {
        let _ = writeln!(text, "truth        {}", degrees(skew_rad));
    }
    let (straight, _) = found.quality(Stage::Straight);
    let (scaled, _) = found.quality(Stage::Scaled);
    let (common, _) = found.quality(Stage::Common);
    for (name, skew, turn) in
        [("straight", found.straight, straight), ("as printed", found.scaled, scaled), ("sound", found.common, common)]
    {
        let _ = writeln!(text, "{name:<12} {}, lines turn by {:.2}°/m RMS", degrees(skew), turn.to_degrees());
    }
    let (before, after) = (1e3 * before, 1e3 * after);
    let _ = writeln!(text, "Fig. 7       path error {before:.0} mm RMS before, {after:.0} mm after, on odometry alone");
    text.push('\n');
    text += &wrapped(
        "Straight lines fix only the differences of the skews. The last step as printed scales all of them, which \
         bends the lines again; the sound one adds one angle to all, found from the direction of travel, which a \
         turned marker plate would shift alike.",
        0,
    );
    text
}

fn to_json(found: &PaperCalibration, [ideal, before, after]: [f64; 3]) -> Value {
    let stage = |skew: [f64; 3], stage: Stage| {
        let (turn, direction) = found.quality(stage);
        json!({ "skew_rad": skew, "heading_per_m_rms": turn, "direction_error_rad": direction })
    };
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
