//! Logged speeds beside the counts that they should be of.

use estimation::statistics::median;
use runs::robot::Robot;
use runs::{Columns, CountSource, Log, Run};

use super::samples::MOST_TICKS;
use super::{Mistake, is_true, near, short};

/// Time over which counts and speeds are compared, s: long against the age of a speed that a firmware filters or counts for.
const STRETCH_S: f64 = 0.5;
/// Stretches from which anything is said, in which the wheel turned by this share of the most in one, and at least so many counts.
const FEWEST: usize = 8;
const TURNED: f64 = 0.2;
const COUNTS: i64 = 10;
/// Share of their middle by which the middle half of the ratios spread at most: a speed of something else follows no counts.
const ALIKE: f64 = 0.3;

/// Speeds that are some times what the counts say: one of the two is not what the columns and `robot.toml` say.
pub(super) fn mistakes(robot: &Robot, logs: &[Log]) -> Option<Mistake> {
    let columns = Columns { counts: true, measured: true, sensors: true, ..Columns::NONE };
    let both = |log: &&Log| {
        let layout = log.layout();
        layout.source.counts == CountSource::Encoders && !(layout.speed.is_empty() && layout.measured.is_empty())
    };
    let counted = logs.iter().filter(both);
    let runs: Vec<Run> = counted.map(|log| log.part(0..log.len().min(MOST_TICKS), columns)).collect();
    let of_column = |stem: &'static str, speeds: fn(&Run) -> &Vec<Vec<f64>>| {
        (0..robot.wheel_count()).find_map(|wheel| {
            let pairs = runs.iter().filter_map(|run| Some((run, speeds(run).get(wheel)?)));
            Some((stem, wheel, ratio(robot, wheel, pairs)?))
        })
    };
    let (stem, wheel, ratio) =
        of_column("speed", |run| &run.speed).or_else(|| of_column("meas", |run| &run.measured))?;
    let looks = unit(robot, ratio).map_or_else(String::new, |unit| format!(": it looks like {unit}"));
    let what = format!("it is {} times the speed by the counts{looks}", short(ratio));
    let counts = robot.counts_per_wheel_rad() * std::f64::consts::TAU;
    let remedy = format!(
        "write rad/s at the wheel, or name the unit to `racbot convert`; where the speeds are right, a turn of the wheel has {} \
         counts, and not {}",
        short(counts / ratio),
        short(counts)
    );
    Some(Mistake { nameable: true, ..Mistake::new("speed-counts", &format!("{stem}_{}", wheel + 1), what, remedy) })
}

/// What the speeds are in those of the counts, where they follow them and are not the same.
fn ratio<'a>(robot: &Robot, wheel: usize, logs: impl Iterator<Item = (&'a Run, &'a Vec<f64>)>) -> Option<f64> {
    let mut stretches: Vec<[f64; 2]> = Vec::new();
    for (run, speed) in logs {
        let counts = run.counts.get(wheel)?;
        let (mut from, mut way, mut last) = (0, 0.0, f64::NAN);
        for k in 1..run.t.len().min(speed.len()).min(counts.len()) {
            last = if speed[k - 1].is_finite() { speed[k - 1] } else { last };
            way += last * (run.t[k] - run.t[k - 1]);
            if run.t[k] - run.t[from] >= STRETCH_S {
                let turned = counts[k].wrapping_sub(counts[from]);
                if turned.abs() >= COUNTS && way.is_finite() {
                    stretches.push([turned as f64 / robot.counts_per_wheel_rad(), way]);
                }
                (from, way) = (k, 0.0);
            }
        }
    }
    let most = stretches.iter().fold(0.0_f64, |most, [turned, _]| most.max(turned.abs()));
    let far = stretches.iter().filter(|[turned, _]| turned.abs() >= TURNED * most);
    let mut ratios: Vec<f64> = far.map(|[turned, way]| way / turned).collect();
    if ratios.len() < FEWEST {
        return None;
    }
    let middle = median(&mut ratios);
    ratios.sort_by(f64::total_cmp);
    let spread = ratios[ratios.len() * 3 / 4] - ratios[ratios.len() / 4];
    (!is_true(middle) && spread <= ALIKE * middle.abs()).then_some(middle)
}

/// The unit in which speeds are so many times those of the wheel in rad/s.
fn unit(robot: &Robot, ratio: f64) -> Option<String> {
    use std::f64::consts::TAU;
    let geared = (robot.gear_ratio.ln().abs() > 0.5).then_some(robot.gear_ratio);
    let rim = robot.lacks(&["wheel_radius_m"]).is_empty().then_some(robot.wheel_radius_m);
    let mut units = vec![
        (-1.0, "a speed of the other sense".to_owned()),
        (60.0 / TAU, "turns per minute".to_owned()),
        (1.0 / TAU, "turns per second".to_owned()),
        (360.0 / TAU, "degrees per second".to_owned()),
    ];
    units.extend(rim.map(|r| (r, "metres per second at the rim".to_owned())));
    units.extend(rim.map(|r| (1e3 * r, "millimetres per second at the rim".to_owned())));
    units.extend(geared.map(|g| (g, "the speed of the motor, before its gear".to_owned())));
    units.extend(geared.map(|g| (g * 60.0 / TAU, "the motor's turns per minute".to_owned())));
    let off = |of: f64| (ratio / of - 1.0).abs();
    units
        .into_iter()
        .filter(|(of, _)| near(ratio, *of))
        .min_by(|a, b| off(a.0).total_cmp(&off(b.0)))
        .map(|(_, unit)| unit)
}
