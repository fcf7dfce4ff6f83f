//! What was driven where residuals are, for the report.

use links::drive::DriveLink;
use links::motion::WindowResiduals;
use links::pieces::Pieces;

/// Ticks over which a change of speed is looked at, on either side.
const AROUND: usize = 30;

/// A speed, signed with its direction, how its size changes, and whether it is late in a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// m/s of the robot, negative backwards; rad/s of a wheel.
    pub speed: f64,
    /// Change of its size round this moment.
    pub gain: f64,
    /// In the second half of its run.
    pub late: bool,
}

/// What was driven at the frames and test functions of a data set.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Driven {
    /// `[window][frame]`, of the robot.
    pub frames: Vec<Vec<Option<Moment>>>,
    /// `[test function][wheel]`.
    pub test_functions: Vec<Vec<Moment>>,
    /// Places at which the camera saw the robot in the first pieces of the runs, m; and the run of each piece.
    pub seen: Vec<(usize, Vec<[f64; 2]>)>,
}

impl Driven {
    pub(super) fn at_frames(pieces: &Pieces, windows: &[WindowResiduals]) -> Vec<Vec<Option<Moment>>> {
        let mut index = 0;
        let mut s = pieces.get(0);
        let mut moment = |run: usize, t: f64| {
            // Windows follow each other as the segments do.
            while s.run < run || s.run == run && s.t.last().is_none_or(|last| *last < t) {
                index += 1;
                if index == pieces.len() {
                    return None;
                }
                s = pieces.get(index);
            }
            if s.run != run || s.t.first().is_none_or(|first| *first > t) {
                return None;
            }
            let k = s.tick_at(t);
            let (from, to) = (k.saturating_sub(AROUND), (k + AROUND).min(s.t.len() - 1));
            let speed = s.twist[k].speed();
            Some(Moment {
                speed: if s.twist[k].vy < 0.0 { -speed } else { speed },
                gain: s.twist[to].speed() - s.twist[from].speed(),
                late: s.is_late(k),
            })
        };
        windows.iter().map(|w| w.t.iter().map(|t| moment(w.run, *t)).collect()).collect()
    }

    pub(super) fn at_test_functions(link: &DriveLink) -> Vec<Vec<Moment>> {
        link.at_middles(|s, k| {
            let (from, to) = (k.saturating_sub(AROUND), (k + AROUND).min(s.t.len() - 1));
            let of = |w: &Vec<f64>| Moment { speed: w[k], gain: w[to].abs() - w[from].abs(), late: s.is_late(k) };
            s.speed.iter().map(of).collect()
        })
    }

    pub(super) fn seen(pieces: &Pieces, first: usize) -> Vec<(usize, Vec<[f64; 2]>)> {
        let places = pieces
            .iter()
            .take(first.max(1))
            .map(|s| (s.run, s.own_frames().iter().map(|f| [f.pose.x, f.pose.y]).collect()));
        places.collect()
    }
}
