//! Counts of single wheels that are off by a factor of decoding, beside others that are right.

use runs::geometry::Geometry;
use runs::robot::Robot;

use super::samples::Sample;
use super::{Mistake, is_true, near, short};
use runs::frames::Twist;

/// Counts of a turn in those of the file: one edge of four, one channel of two, and the same the other way round.
pub const DECODED: [f64; 4] = [0.25, 0.5, 2.0, 4.0];
/// Share of the squared turn of every wheel, by the camera, that follows its own counts: a file of another robot, wheels that
/// slip or are swapped, and a camera read wrongly leave more than a tenth at one wheel at least, for each wheel's turn by
/// the camera is then made of several wheels' counts.
const FOLLOWS: f64 = 0.9;

/// Wheels whose turns by the camera follow their counts by such a factor, where at least as many follow them as they are.
pub(super) fn of_single_wheels(
    robot: &Robot,
    geometry: &Geometry,
    samples: &[Sample],
    seen: &[([f64; 2], f64)],
) -> Vec<Mistake> {
    let wheels = geometry.wheels().len();
    let mut sums = vec![[0.0_f64; 3]; wheels];
    for (sample, ([x, y], turn)) in samples.iter().zip(seen) {
        let needed = geometry.wheel_speeds(Twist::new(*x, *y, *turn));
        for ((sum, counted), needed) in sums.iter_mut().zip(&sample.turned).zip(needed) {
            sum[0] += counted * counted;
            sum[1] += counted * needed;
            sum[2] += needed * needed;
        }
    }
    let follow = sums.iter().all(|[xx, xy, yy]| *xy > 0.0 && xy * xy > FOLLOWS * xx * yy);
    let factors: Vec<f64> = sums.iter().map(|[xx, xy, _]| xx / xy).collect();
    let right = factors.iter().filter(|f| is_true(**f)).count();
    let odd: Vec<(usize, f64)> = (0..wheels)
        .filter_map(|i| DECODED.into_iter().find(|of| near(factors[i], *of)).map(|_| (i, factors[i])))
        .collect();
    if !follow || odd.is_empty() || odd.len() > right || odd.len() + right < wheels {
        return Vec::new();
    }
    odd.into_iter().map(|(wheel, factor)| said(robot, wheel, factor)).collect()
}

fn said(robot: &Robot, wheel: usize, factor: f64) -> Mistake {
    let speeds = runs::is_from_speeds(robot);
    let (column, has) = if speeds { ("speed", "speeds") } else { ("enc", "counts") };
    let what = format!(
        "wheel {} has {} times the {has} that it rolls by the camera, and the other wheels as many as they should",
        wheel + 1,
        short(factor)
    );
    let remedy = format!(
        "set its decoder to count as the others' do (all four edges of both channels), or look for a channel without signal \
         and another encoder; a log as it is: divide {column}_{} by {} (scale = {} in a map)",
        wheel + 1,
        short(factor),
        short(1.0 / factor)
    );
    Mistake { nameable: true, ..Mistake::new("wheel-counts", &format!("{column}_{}", wheel + 1), what, remedy) }
}
