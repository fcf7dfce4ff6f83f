//! What becomes of the values of a series in the columns of a run.

use std::borrow::Cow;
use std::path::Path;

use super::map::Wanted;
use crate::Run;
use crate::columns::Column;
use crate::error::InputError;
use crate::frames::Twist;
use crate::geometry::Geometry;

/// The values of a column whose multiples of a turn were lost: counts go on from the last, others are those next to 0.
/// An encoder of one turn shows itself: angles within a turn that leap by more than half of it.
pub(super) fn unwrapped<'a>(wanted: &Wanted, values: &'a [f64]) -> Cow<'a, [f64]> {
    let counted = matches!(wanted.column, Column::Counts(_));
    let turn = wanted.turn.filter(|turn| {
        let [low, high] = values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(*v), h.max(*v)]);
        counted && high - low <= 1.001 * turn && values.windows(2).any(|w| (w[1] - w[0]).abs() > 0.5 * turn)
    });
    let Some(period) = wanted.wraps.or(turn) else { return values.into() };
    if !counted {
        return values.iter().map(|v| v - period * (v / period).round()).collect();
    }
    let mut last: Option<f64> = None;
    let follow = |value: &f64| {
        let before = last.unwrap_or(*value);
        let now = value - period * ((value - before) / period).round();
        last = Some(now);
        now
    };
    values.iter().map(follow).collect()
}

/// Poses of velocities, from the first on; a velocity between two samples is their mean.
pub(super) fn integrate(t: &[f64], odometry: &mut [Vec<f64>; 3], sense: f64) {
    let mut pose = [0.0; 3];
    let mut before: Option<(f64, [f64; 3])> = None;
    for (tick, t) in t.iter().enumerate() {
        let now = [0, 1, 2].map(|i| odometry[i][tick]);
        if !now.iter().all(|v| v.is_finite()) {
            odometry.iter_mut().for_each(|c| c[tick] = f64::NAN);
            continue;
        }
        if let Some((since, last)) = before {
            let step = [0, 1, 2].map(|i| 0.5 * (last[i] + now[i]) * (t - since));
            let (sin, cos) = (pose[2] + 0.5 * sense * step[2]).sin_cos();
            pose[0] += cos * step[0] - sin * step[1];
            pose[1] += sin * step[0] + cos * step[1];
            pose[2] += sense * step[2];
        }
        before = Some((*t, now));
        odometry[0][tick] = pose[0];
        odometry[1][tick] = pose[1];
        odometry[2][tick] = sense * pose[2];
    }
}

/// Counts of a wheel; ticks without one hold the last.
pub(super) fn counts(run: &mut Run, wheel: usize, column: &[f64]) {
    let mut held = column.iter().copied().find(|x| x.is_finite()).unwrap_or(0.0).round() as i64;
    for (tick, x) in column.iter().enumerate() {
        if x.is_finite() {
            held = x.round() as i64;
        } else {
            run.count_gaps[wheel].push(tick);
        }
        run.counts[wheel].push(held);
    }
}

/// Wheel speeds as commanded, where none were logged.
pub(super) fn speeds_of_commands(run: &mut Run, geometry: &Geometry, path: &Path) -> Result<(), InputError> {
    let refuse = |what: &str, hint: &str| Err(InputError::new(path, what, hint).field("derive.speeds"));
    if !run.speed.is_empty() || !run.counts.is_empty() {
        return refuse("the wheels are logged", "leave [derive] speeds out of the map");
    }
    let Some([vx, vy, w]) = &run.command else {
        return refuse("speeds are derived from commands, and none are mapped", "map cmd_vx, cmd_vy and cmd_w");
    };
    let twists = vx.iter().zip(vy).zip(w).map(|((vx, vy), w)| Twist::new(*vx, *vy, *w));
    let speeds: Vec<Vec<f64>> = twists.map(|twist| geometry.wheel_speeds(twist)).collect();
    run.speed = (0..geometry.wheel_count()).map(|wheel| speeds.iter().map(|tick| tick[wheel]).collect()).collect();
    Ok(())
}
