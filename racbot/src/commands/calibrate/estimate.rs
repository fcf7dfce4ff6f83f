//! What an estimate from logs says.

use crate::terminal::{Table, wrapped};
use model::calibration::SkewEstimate;
use std::fmt::Write as _;

fn degrees(rad: f64) -> String {
    format!("{:.2}°", rad.to_degrees())
}

/// The skews, their intervals, their differences, and what the data cannot tell.
pub(super) fn text(estimate: &SkewEstimate) -> String {
    let mut text = String::new();
    // The wheels of a differential drive have no skew that a camera shows.
    let differences = if estimate.is_none() { &[][..] } else { &estimate.differences };
    if !differences.is_empty() {
        let mut table = Table::new(1, &["wheel", "skew", "95 % from", "to"]);
        for (wheel, (skew, [low, high])) in estimate.skew_rad.iter().zip(&estimate.ci95).enumerate() {
            table.row([(wheel + 1).to_string(), degrees(*skew), degrees(*low), degrees(*high)]);
        }
        text = table.render();
        text.push('\n');
    }
    for (i, j, half) in differences {
        let difference = estimate.skew_rad[*i] - estimate.skew_rad[*j];
        let _ = writeln!(text, "wheel {} - {}  {} ± {}", i + 1, j + 1, degrees(difference), degrees(*half));
    }
    let residual = &estimate.residual;
    let headed = residual.noise[2] < model::fit::NO_HEADING_RAD;
    let shown = |[x, y, theta]: [f64; 3]| {
        let heading = if headed { degrees(theta) } else { "no headings".to_owned() };
        format!("{:.1} mm, {:.1} mm, {heading}", 1e3 * x, 1e3 * y)
    };
    if residual.frames > 0 {
        let _ = writeln!(text, "residual     {} before", shown(residual.before));
        let _ = writeln!(text, "             {} after", shown(residual.after));
        let _ = writeln!(text, "noise        {}, {} camera frames", shown(residual.noise), residual.frames);
    }
    for remark in &estimate.remarks {
        text.extend((!text.is_empty()).then_some('\n'));
        text += &wrapped(remark, 0);
    }
    text
}
