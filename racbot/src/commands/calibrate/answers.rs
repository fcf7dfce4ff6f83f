//! Tables of what was found.

use crate::terminal::{Table, wrapped};
use model::calibration::{PaperCalibration, SkewEstimate, Stage};
use serde_json::{Value, json};
use std::fmt::Write as _;

fn degrees(rad: f64) -> String {
    format!("{:.2}°", rad.to_degrees())
}

/// The skews, their intervals, their differences, and what the data cannot tell.
pub(super) fn estimate(estimate: &SkewEstimate) -> String {
    let mut table = Table::new(1, &["wheel", "skew", "95 % from", "to"]);
    for (wheel, (skew, [low, high])) in estimate.skew_rad.iter().zip(&estimate.ci95).enumerate() {
        table.row([(wheel + 1).to_string(), degrees(*skew), degrees(*low), degrees(*high)]);
    }
    let mut text = table.render();
    text.push('\n');
    for (i, j, half) in &estimate.differences {
        let difference = estimate.skew_rad[*i] - estimate.skew_rad[*j];
        let _ = writeln!(text, "wheel {} - {}  {} ± {}", i + 1, j + 1, degrees(difference), degrees(*half));
    }
    let residual = &estimate.residual;
    let shown = |[x, y, theta]: [f64; 3]| format!("{:.1} mm, {:.1} mm, {}", 1e3 * x, 1e3 * y, degrees(theta));
    let _ = writeln!(text, "residual     {} before", shown(residual.before));
    let _ = writeln!(text, "             {} after", shown(residual.after));
    let _ = writeln!(text, "noise        {}, {} camera frames", shown(residual.noise), residual.frames);
    for remark in &estimate.remarks {
        text.push('\n');
        text += &wrapped(remark, 0);
    }
    text
}

fn stage(stage: Stage) -> String {
    match stage {
        Stage::Straighten(round) => format!("straighten, round {round}"),
        Stage::Straight => "straight".to_owned(),
        Stage::Scaled => "scaled, as printed".to_owned(),
        Stage::Common => "common angle instead".to_owned(),
    }
}

fn skews(skew_rad: [f64; 3]) -> String {
    skew_rad.map(degrees).join(", ")
}

/// Every drive of the paper's procedure and where it ends.
pub(super) fn paper(found: &PaperCalibration) -> String {
    let mut table = Table::new(3, &["stage", "axle", "skews believed in", "turn/m", "off by"]);
    for drive in &found.iterations {
        table.row([
            stage(drive.stage),
            (drive.wheel + 1).to_string(),
            skews(drive.skew_rad),
            degrees(drive.seen.heading_per_m),
            degrees(drive.seen.direction_error),
        ]);
    }
    let mut text = table.render();
    text.push('\n');
    for (label, skew, at) in [
        ("straight", found.straight, Stage::Straight),
        ("scaled", found.scaled, Stage::Scaled),
        ("common", found.common, Stage::Common),
    ] {
        let (turn, direction) = found.quality(at);
        let (turn, direction) = (degrees(turn), degrees(direction));
        let _ = writeln!(text, "{label:<10} {:<24} turns {turn}/m RMS, off by {direction}", skews(skew));
    }
    text.push('\n');
    text += &wrapped(
        &format!(
            "Straight lines fix the differences of the skews and leave their common part open. The printed last step \
             scales all skews (here by {:.2}), which bends the lines again; adding one angle to all ({}) does not. The \
             last line is the result.",
            found.factor,
            degrees(found.angle)
        ),
        0,
    );
    text
}

/// The same for programs.
pub(super) fn paper_json(found: &PaperCalibration) -> Value {
    let drives = found.iterations.iter().map(|drive| {
        json!({
            "stage": stage(drive.stage), "wheel": drive.wheel + 1, "skew_rad": drive.skew_rad,
            "turn_rad_per_m": drive.seen.heading_per_m, "direction_error_rad": drive.seen.direction_error,
        })
    });
    json!({
        "skew_rad": found.common, "straight_rad": found.straight, "scaled_rad": found.scaled,
        "factor": found.factor, "angle_rad": found.angle, "drives": drives.collect::<Vec<_>>(),
    })
}
