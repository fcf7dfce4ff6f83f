//! A log and the poses of a second file become one run: every pose is a tick at its own time.

use std::path::{Path, PathBuf};

use super::agreement::{self, Agreement};
use super::reading::Made;
use super::time::nanoseconds;
use super::truth::{Clocks, Truth};
use super::{Table, span};
use crate::error::InputError;
use crate::frames::Pose;
use crate::{CLOCK_OFF_S, CameraSample, Run};

/// How the poses of a second file came into a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Joined {
    /// The second file.
    pub file: PathBuf,
    /// What was added to its times, s.
    pub offset_s: f64,
    /// How surely the motion told that offset, where it did.
    pub matched: Option<Agreement>,
    /// By how much the motion tells another offset than the clocks do, s, where `gap` would not find it.
    pub apart_s: Option<f64>,
    /// Poses before the log's first row and after its last, which are left out.
    pub outside: [usize; 2],
    /// Times with a part of a pose, which are left out.
    pub incomplete: usize,
    /// Poses that have the time of another, of which the last counts.
    pub alike: usize,
}

/// Puts the poses of the second file into the run of the first.
pub(super) fn join(
    [log, poses]: [Made; 2],
    truth: &Truth,
    files: [(&Table, &Path); 2],
) -> Result<(Run, Joined), InputError> {
    let path = files[1].1;
    // From here on times of the runs; those of the files begin `first_s` earlier.
    let seen: Vec<(f64, Pose)> = poses.run.camera.iter().map(|s| (poses.run.t[s.tick], s.pose)).collect();
    if seen.is_empty() {
        let hint = "see its cam_x, cam_y and cam_theta: they have no time in common, or no numbers";
        return Err(InputError::new(path, "holds no whole pose", hint).field("truth.columns"));
    }
    let files_s = log.first_s - poses.first_s;
    // Positions alone do not show a motion in the body's frame.
    let headed = seen.iter().all(|(_, pose)| !pose.theta.is_nan());
    let told = headed.then(|| agreement::by_motion(&log.run, &seen));
    let (by, matched) = match truth.clock {
        Clocks::Same => (truth.offset_s - files_s, None),
        Clocks::Own => {
            let own = [(files[0].0, &log), (files[1].0, &poses)].map(|(table, made)| table.times()[0] - made.first_s);
            (own[0] - own[1] + truth.offset_s, None)
        }
        Clocks::Match => {
            let hint = "map cam_theta too, or give clock = \"same\" or \"own\", with an offset_s where it is known";
            let what = "positions without headings do not tell how the clocks stand to each other";
            let told = told.as_ref().ok_or_else(|| InputError::new(path, what, hint).field("truth.clock"))?;
            let found = told.as_ref().map_err(|doubt| {
                let hint = "give clock = \"own\" or an offset_s that brings it within 0.5 s: `gap` finds the rest";
                let what =
                    format!("the motion does not tell how the clocks stand to each other: {}", doubt.shifted(files_s));
                InputError::new(path, what, hint).field("truth.clock")
            })?;
            (found.offset_s, Some(*found))
        }
    };
    let offset_s = by + files_s;
    let ours = span(log.run.t.iter().copied());
    let theirs = span(seen.iter().map(|(t, _)| t + by));
    if ours[0] > theirs[1] || theirs[0] > ours[1] {
        let [a, b] = [(ours, log.first_s), (theirs, log.first_s - offset_s)]
            .map(|([from, to], first)| format!("{:.3} to {:.3} s", from + first, to + first));
        let shifted = if offset_s == 0.0 { String::new() } else { format!(", {offset_s} s added to them,") };
        let what =
            format!("its times, {b},{shifted} have nothing in common with those of {}, {a}", files[0].1.display());
        return Err(InputError::new(path, what, remedy(truth.clock, ours, theirs)).field("truth.clock"));
    }
    let before = seen.iter().filter(|(t, _)| nanoseconds(t + by) < nanoseconds(ours[0])).count();
    let after = seen.iter().filter(|(t, _)| nanoseconds(t + by) > nanoseconds(ours[1])).count();
    let within: Vec<(i64, Pose)> = seen
        .iter()
        .map(|(t, pose)| (nanoseconds(t + by), *pose))
        .filter(|(k, _)| (nanoseconds(ours[0])..=nanoseconds(ours[1])).contains(k))
        .collect();
    let apart = told.and_then(Result::ok).filter(|_| matched.is_none()).map(|found| found.offset_s - by);
    let joined = Joined {
        file: path.to_owned(),
        offset_s,
        matched,
        apart_s: apart.filter(|apart| apart.abs() > CLOCK_OFF_S),
        outside: [before, after],
        incomplete: poses.run.len() - seen.len(),
        alike: poses.poses.saturating_sub(poses.run.len()),
    };
    Ok((merged(log.run, &within), joined))
}

/// What brings two spans of time together.
fn remedy(clock: Clocks, ours: [f64; 2], theirs: [f64; 2]) -> String {
    let ratio = (theirs[1] - theirs[0]) / (ours[1] - ours[0]);
    // Within a factor of two of a thousand or more, it is the unit.
    let wrong =
        [1e3, 1e6, 1e9].into_iter().find(|k| ratio.is_finite() && (0.5..2.0).contains(&(ratio.max(1.0 / ratio) / k)));
    let unit = wrong.map_or(String::new(), |k| {
        let longer = if ratio > 1.0 { "the second file lasts" } else { "the log lasts" };
        format!("{longer} about {k} times as long: see the unit in [truth.time] and [time]; else ")
    });
    let else_ = match clock {
        Clocks::Same => {
            "write clock = \"own\" if both files begin together, clock = \"match\" to find it by the motion, or the seconds to add in offset_s"
        }
        Clocks::Own | Clocks::Match => "see offset_s",
    };
    format!("{unit}{else_}")
}

/// A run with poses at times of their own, in ns.
fn merged(run: Run, poses: &[(i64, Pose)]) -> Run {
    let ours: Vec<i64> = run.t.iter().map(|t| nanoseconds(*t)).collect();
    let mut keys: Vec<i64> = ours.iter().copied().chain(poses.iter().map(|(k, _)| *k)).collect();
    keys.sort_unstable();
    keys.dedup();
    let place = |k: i64| keys.partition_point(|other| *other < k);
    let places: Vec<usize> = ours.iter().map(|k| place(*k)).collect();
    let mut out = Run { has_camera: true, ..run };
    for column in out.reals_mut().into_iter().skip(1) {
        let mut wide = vec![f64::NAN; keys.len()];
        places.iter().zip(column.iter()).for_each(|(tick, x)| wide[*tick] = *x);
        *column = wide;
    }
    for (counts, gaps) in out.counts.iter_mut().zip(&mut out.count_gaps) {
        let mut sampled = vec![true; counts.len()];
        gaps.iter().for_each(|gap| sampled[*gap] = false);
        let mut held = counts.first().copied().unwrap_or(0);
        let mut next = 0;
        let (mut wide, mut blanks) = (Vec::with_capacity(keys.len()), Vec::new());
        for tick in 0..keys.len() {
            let own = places.get(next) == Some(&tick);
            if own {
                held = counts[next];
            }
            if !own || !sampled[next] {
                blanks.push(tick);
            }
            next += usize::from(own);
            wide.push(held);
        }
        (*counts, *gaps) = (wide, blanks);
    }
    out.camera = poses.iter().map(|(k, pose)| CameraSample { tick: place(*k), pose: *pose }).collect();
    let whole = |k: &i64| *k as f64 / 1e9;
    out.t = keys.iter().map(whole).collect();
    out
}

#[cfg(test)]
mod tests;
