//! A picture of a replay.

use super::Replayed;
use super::compare::lsb;
use plot::{Axis, Color, Figure, Panel, Series};
use runs::Run;

/// Ticks of the close look.
const CLOSE: usize = 160;
/// Points of the difference over the whole run.
const POINTS: usize = 1_200;

/// Logged duty and the FPGA's, close up and all along, and their difference.
#[must_use]
pub fn duties(run: &Run, replayed: &Replayed, wheel: usize) -> String {
    let (from, ticks) = (replayed.from, replayed.ticks);
    let logged = |i: usize| run.duty.get(wheel).map_or(f64::NAN, |column| column[from + i]);
    let fpga = |i: usize| replayed.duty[wheel][i];
    // Where the duty moves most there is most to see.
    let start = busiest(&replayed.duty[wheel]);
    let window = || start..(start + CLOSE).min(ticks);
    let time = || Axis::new("time", "s");
    let close = Panel::new(time(), Axis::new("duty", ""))
        .title(format!("wheel {}: {} ticks close up", wheel + 1, window().len()))
        .height(220.0)
        .with(Series::steps("FPGA", window().map(|i| [run.t[from + i], fpga(i)]).collect()).color(Color::Blue))
        .with(Series::points("log", window().map(|i| [run.t[from + i], logged(i)]).collect()).color(Color::Orange));
    let step = (ticks / POINTS).max(1);
    let difference = (0..ticks).step_by(step).map(|i| [run.t[from + i], lsb(fpga(i) - logged(i))]).collect();
    let rounding = lsb(0.5 * replayed.quantum);
    let ends = [run.t[from], run.t[from + ticks.max(1) - 1]];
    let bound = |sign: f64| ends.iter().map(|t| [*t, sign * rounding]).collect();
    let residual = Panel::new(time(), Axis::new("FPGA − log", "LSB, 2⁻²⁴"))
        .height(170.0)
        .with(Series::points("difference", difference).color(Color::Blue))
        .with(Series::dashed("half a quantum of the log", bound(1.0)).color(Color::Red))
        .with(Series::dashed("", bound(-1.0)).color(Color::Red));
    Figure::new(format!("Replay of {}", replayed.name)).with(close).with(residual).to_svg()
}

/// Start of the window with the largest span.
fn busiest(duty: &[f64]) -> usize {
    let span = |start: usize| {
        let window = &duty[start..(start + CLOSE).min(duty.len())];
        let ends = window.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], d| [low.min(*d), high.max(*d)]);
        ends[1] - ends[0]
    };
    let starts = (0..duty.len().saturating_sub(CLOSE)).step_by(CLOSE / 4);
    starts.max_by(|a, b| span(*a).total_cmp(&span(*b))).unwrap_or(0)
}
