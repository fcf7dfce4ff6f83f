//! Pictures of a drive.

use super::Driven;
use model::trajectory::SetPoint;
use plot::{Axis, Color, Figure, Panel, Series};

/// Seconds between two heading arrows.
const HEADING_EVERY_S: f64 = 0.5;
/// Points of a curve over time; more would not show.
const POINTS: usize = 700;

/// One curve of a [`trajectory`] picture.
#[derive(Clone, Copy, Debug)]
pub struct Curve<'a> {
    /// Name in the legend.
    pub label: &'a str,
    /// Where the robot went.
    pub driven: &'a Driven,
    /// Its colour.
    pub color: Color,
    /// Dashed, for a curve that lies over another.
    pub dashed: bool,
}

/// Where the robot went, with its heading at regular intervals and the set points.
#[must_use]
pub fn trajectory(title: &str, set_points: &[SetPoint], curves: &[Curve<'_>]) -> String {
    let mut map = Panel::new(Axis::new("x", "m"), Axis::new("y", "m")).equal_aspect();
    for curve in curves {
        let track = &curve.driven.track;
        let dt = track.get(1).map_or(1.0, |(t, _)| *t);
        let every = ((HEADING_EVERY_S / dt).round() as usize).max(1);
        let arrows = track.iter().step_by(every).map(|(_, p)| [p.x, p.y, p.theta]).collect();
        let line = thinned(track.len()).map(|i| [track[i].1.x, track[i].1.y]).collect();
        let series = if curve.dashed { Series::dashed(curve.label, line) } else { Series::line(curve.label, line) };
        map = map.with(series.color(curve.color).headings(arrows));
    }
    let crosses = set_points.iter().map(|p| [p.x, p.y]).collect();
    map = map.with(Series::crosses("set points", crosses).color(Color::Black));
    Figure::new(title).with(map).to_svg()
}

/// Wheel speeds, duties and heading over time.
#[must_use]
pub fn speeds(title: &str, driven: &Driven) -> String {
    let time = || Axis::new("time", "s");
    let run = &driven.run;
    let mut speeds = Panel::new(time(), Axis::new("wheel speed", "rad/s")).height(230.0);
    for (wheel, actual) in driven.wheel_speeds.iter().enumerate() {
        let points = thinned(run.len()).map(|i| [run.t[i], actual[i]]).collect();
        speeds = speeds.with(Series::line(format!("wheel {}", wheel + 1), points));
    }
    for (wheel, reference) in run.reference.iter().enumerate() {
        let label = if wheel == 0 { "set points" } else { "" };
        let points = thinned(run.len()).map(|i| [run.t[i], reference[i]]).collect();
        speeds = speeds.with(Series::dashed(label, points).color(Color::Grey));
    }
    let heading = |of: &dyn Fn(usize) -> f64| -> Vec<[f64; 2]> {
        thinned(run.len()).map(|i| [run.t[i], of(i).to_degrees()]).collect()
    };
    let believed = heading(&|i| driven.believed[i].theta);
    let headings = Panel::new(time(), Axis::new("heading", "°"))
        .height(150.0)
        .with(Series::line("robot", heading(&|i| driven.track[i].1.theta)).color(Color::Blue))
        .with(Series::dashed("as the controller believes", believed).color(Color::Orange));
    let mut duties = Panel::new(time(), Axis::new("duty", "")).height(150.0);
    for (wheel, duty) in run.duty.iter().enumerate() {
        let points = averaged(&run.t, duty);
        duties = duties.with(Series::line(format!("wheel {}", wheel + 1), points));
    }
    Figure::new(title).with(speeds).with(headings).with(duties).to_svg()
}

/// Ticks to draw.
fn thinned(ticks: usize) -> impl Iterator<Item = usize> {
    (0..ticks).step_by((ticks / POINTS).max(1))
}

/// Means over what one point stands for: a quantised speed makes a duty that jumps every tick.
fn averaged(t: &[f64], values: &[f64]) -> Vec<[f64; 2]> {
    let wide = (t.len() / POINTS).max(1) * 2;
    t.chunks(wide).zip(values.chunks(wide)).map(|(t, v)| [t[0], v.iter().sum::<f64>() / v.len() as f64]).collect()
}
