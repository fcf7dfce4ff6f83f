//! The paper's Fig. 6 and 7 by kinematics alone: `cargo run -p model --example fig_6_and_7 > fig.svg`.

use model::trajectory::{FIG_6, FIG_7_SKEW_DEG, MotionSample, simulate_motion};
use plot::{Axis, Color, Figure, Panel, Series};
use runs::frames::Pose;
use runs::geometry::{Geometry, GeometryError};

fn main() -> Result<(), GeometryError> {
    let ideal = Geometry::rac(0.0275, 0.085, [0.0; 3])?;
    let skewed = Geometry::rac(0.0275, 0.085, FIG_7_SKEW_DEG.map(f64::to_radians))?;
    let drive = |actual| simulate_motion(&FIG_6, Pose::default(), &ideal, actual, 0.001, 60.0);
    let map = |label: &str, run: &[MotionSample], color| {
        let ticks = run.iter().step_by(500).map(|s| [s.actual.x, s.actual.y, s.actual.theta]).collect();
        Series::line(label, run.iter().map(|s| [s.actual.x, s.actual.y]).collect()).color(color).headings(ticks)
    };
    let (green, red) = (drive(&ideal), drive(&skewed));
    let crosses = FIG_6.iter().map(|p| [p.x, p.y]).collect();
    let path = Panel::new(Axis::new("x", "m"), Axis::new("y", "m"))
        .equal_aspect()
        .with(map("skew 4°, −3°, 2°, unknown", &red, Color::Red))
        .with(map("ideal geometry", &green, Color::Green))
        .with(Series::crosses("set points", crosses).color(Color::Black));
    let mut speeds = Panel::new(Axis::new("time", "s"), Axis::new("wheel speed", "rad/s")).height(200.0);
    for wheel in 0..3 {
        let points = green.iter().map(|s| [s.t, s.wheel_speeds[wheel]]).collect();
        speeds = speeds.with(Series::line(format!("wheel {}", wheel + 1), points));
    }
    print!("{}", Figure::new("Trajectory over four set points").with(path).with(speeds).to_svg());
    Ok(())
}
