//! Camera frames that no robot can have driven, and frames that stand still.

use crate::analysis::Leftover;
use crate::thresholds::Thresholds;
use estimation::statistics::median;
use links::effect::Link;
use links::pieces::Pieces;

/// Fewer frames than this may be anything.
const FEWEST: usize = 8;

/// Camera frames that repeat the one before while the wheels turn: the tracker lost the robot.
pub(crate) fn frozen(pieces: &Pieces, thresholds: &Thresholds) -> Option<Leftover> {
    let (lost, seen) = pieces.iter().fold((0, 0), |(lost, seen), s| (lost + s.frozen, seen + s.own_frames().len()));
    let all = lost + seen;
    let share = lost as f64 / all.max(1) as f64;
    (lost >= FEWEST && share >= thresholds.frozen).then(|| Leftover {
        link: Link::Timing,
        structure: format!(
            "{:.1} % of the camera frames repeat the one before while the wheels turn (tracking lost); they are left out",
            100.0 * share
        ),
    })
}

/// Camera frames further apart than the wheels can have carried the robot: poses at wrong times, two robots mixed up.
///
/// `noise` is that of a frame's place (m, m).
pub(crate) fn torn(pieces: &Pieces, noise: [f64; 2], thresholds: &Thresholds) -> Option<Leftover> {
    let [times, scatters, often] = thresholds.torn;
    let scatter = noise[0].hypot(noise[1]);
    let (mut far, mut all, mut largest) = (0.0, 0.0_f64, 0.0_f64);
    for s in pieces.iter().filter(|s| s.wheels() > 0) {
        let fastest = s.twist.iter().map(|v| v.speed()).fold(0.0, f64::max);
        // Stamps of arrival come in bunches: a frame has at least the usual time to get somewhere.
        let mut periods: Vec<f64> = s.own_frames().windows(2).map(|p| p[1].t - p[0].t).collect();
        let usual = if periods.is_empty() { 0.0 } else { median(&mut periods) };
        for pair in s.own_frames().windows(2) {
            let (a, b) = (pair[0].pose, pair[1].pose);
            let apart = (b.x - a.x).hypot(b.y - a.y);
            all += 1.0;
            if apart > scatters * scatter + times * fastest * (pair[1].t - pair[0].t).max(usual) {
                far += 1.0;
                largest = largest.max(apart);
            }
        }
    }
    (all > 0.0 && far > often * all).then(|| Leftover {
        link: Link::Motion,
        structure: format!(
            "{:.0} % of the camera frames lie further from the one before than the wheels can have carried the robot, by up \
             to {largest:.2} m: poses at wrong times, or of another robot",
            100.0 * far / all
        ),
    })
}

#[cfg(test)]
mod tests {
    use std::borrow::Cow;

    use links::pieces::{PIECE, segments};
    use model::effects::Applied;
    use model::manoeuvre::{Manoeuvre, simulate};
    use runs::frames::Pose;
    use runs::robot::Robot;
    use runs::{CameraSample, Log, Run};

    use super::*;

    /// What is said of a drive whose frames were changed: number and frame.
    fn said(change: impl Fn(usize, &mut CameraSample)) -> Option<Leftover> {
        let robot = Robot::racbot();
        let mut run: Run = simulate(Manoeuvre::Star, &Applied::of(&robot), &robot, Pose::default(), 1).unwrap();
        run.camera.iter_mut().enumerate().for_each(|(n, frame)| change(n, frame));
        let logs = [Log::from(Cow::Owned(run))];
        torn(&segments(&robot, &robot.geometry().unwrap(), &logs, PIECE), [1e-3; 2], &Thresholds::default())
    }

    #[test]
    fn frames_that_no_wheels_lead_to_are_told_from_frames_in_bunches() {
        assert!(said(|_, _| ()).is_none());
        let another = |n: usize, frame: &mut CameraSample| {
            if n.is_multiple_of(8) {
                frame.pose.x += 0.5;
            }
        };
        assert!(said(another).is_some_and(|l| l.structure.contains("of another robot")));
        // Three frames at a time, some milliseconds apart, as a network delivers them.
        let bunches = |n: usize, frame: &mut CameraSample| frame.tick += 14 * (2 - n % 3);
        assert!(said(bunches).is_none());
    }
}
