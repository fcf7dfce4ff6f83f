//! Camera frames that no robot can have driven, and frames that stand still.

use crate::analysis::Leftover;
use links::effect::Link;
use links::pieces::Pieces;

/// Camera frames that repeat the one before while the wheels turn: the tracker lost the robot.
pub(crate) fn frozen(pieces: &Pieces) -> Option<Leftover> {
    /// Share of all frames, and number, from which it is said.
    const WORTH: (f64, usize) = (0.015, 8);
    let (lost, seen) = pieces.iter().fold((0, 0), |(lost, seen), s| (lost + s.frozen, seen + s.own_frames().len()));
    let all = lost + seen;
    let share = lost as f64 / all.max(1) as f64;
    (lost >= WORTH.1 && share >= WORTH.0).then(|| Leftover {
        link: Link::Timing,
        structure: format!(
            "{:.1} % of the camera frames repeat the one before while the wheels turn (tracking lost); they are left out",
            100.0 * share
        ),
    })
}

/// Camera frames further apart than the wheels can have carried the robot: poses at wrong times, two robots mixed up.
pub(crate) fn torn(pieces: &Pieces) -> Option<Leftover> {
    /// Distance that noise and slip may add between two frames, m, and share of frames that may exceed it.
    const SLACK: (f64, f64) = (0.05, 0.1);
    let (mut far, mut all, mut largest) = (0.0, 0.0_f64, 0.0_f64);
    for s in pieces.iter().filter(|s| s.wheels() > 0) {
        let fastest = s.twist.iter().map(|v| v.speed()).fold(0.0, f64::max);
        for pair in s.own_frames().windows(2) {
            let (a, b) = (pair[0].pose, pair[1].pose);
            let apart = (b.x - a.x).hypot(b.y - a.y);
            all += 1.0;
            if apart > SLACK.0 + 2.0 * fastest * (pair[1].t - pair[0].t) {
                far += 1.0;
                largest = largest.max(apart);
            }
        }
    }
    (all > 0.0 && far > SLACK.1 * all).then(|| Leftover {
        link: Link::Motion,
        structure: format!(
            "{:.0} % of the camera frames lie further from the one before than the wheels can have carried the robot, by up \
             to {largest:.2} m: poses at wrong times, or of another robot",
            100.0 * far / all
        ),
    })
}
