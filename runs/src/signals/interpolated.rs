//! Cameras whose poses a logger has interpolated to its rows, or a file of poses to times of its own: between two frames they
//! lie on a line, and say nothing new. Where frames come about as often as rows, only the gaps between them show, bridged by
//! lines.

use super::camera::FEWEST;
use crate::frames::wrap_angle;
use crate::{CameraSample, Run};

/// Share of the rows in motion that lie between their neighbours on a line, from which poses are interpolated: with a
/// frame every four rows it is half of them, with noise of three times the rounding a quarter.
const HABIT: f64 = 0.4;
/// Bends in what rounding leaves, at the middle of all bends, from which they are no noise of a camera: as much of it as leaves
/// that share of the rows on a line bends the others by 1.4 in the middle, or by 2 where it is in one channel alone.
const BEND: f64 = 2.0;
/// Share of the bends that are a row or two wide, as a frame between two rows makes them.
const NARROW: f64 = 0.8;
/// Rows on a line that bridge a gap, and the middle of all bends from which a camera's noise makes no such row of them: of
/// three times the rounding it leaves a quarter of the rows on a line, eight at a time once in 65000.
const BRIDGE: (usize, f64) = (8, 3.0);
/// Roundings that a channel goes over two rows from which it moves.
const MOVES: f64 = 8.0;
/// Steps by which poses may be written, m or rad.
const STEPS: [f64; 6] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7];
/// Share of the differences of poses that are whole steps: not those where a heading goes once around.
const WRITTEN: f64 = 0.95;
/// What times written in microseconds leave of a line at usual speeds, m or rad.
const BY_TIMES: f64 = 2e-6;
/// Rounding, m or rad, up to which poses at times of their own that lie on a line were interpolated: a frame of a camera
/// scatters by 0.05 mm and more. Of coarser ones at 5 a second those of a robot that drives straight lie on a line.
const FINE: f64 = 2e-5;
/// Steps of the usual length between poses at times of their own, from which one is missing.
const GAP: f64 = 1.5;

/// What was interpolated.
#[derive(Clone, Copy, PartialEq)]
enum Between {
    /// Poses from frame to frame.
    Frames,
    /// Gaps alone.
    Gaps,
}

/// Whether poses are interpolated.
pub(super) struct Interpolated {
    /// Where, and what rounding leaves of a line, of x, y and heading; `None` where poses are as the camera gave them.
    found: Option<(Between, [f64; 3])>,
    dropped: bool,
    said: bool,
}

impl Interpolated {
    /// By the first part of a log.
    pub(super) fn of(run: &Run) -> Self {
        let rounding = rounding(&run.camera);
        let bends = bends(run, &rounding);
        let moving: Vec<&Bend> = bends.iter().flatten().filter(|b| b.moves).collect();
        let on_a_line = moving.iter().filter(|b| b.size <= 1.0).count();
        let mut sizes: Vec<f64> = moving.iter().map(|b| b.size).filter(|size| *size > 1.0).collect();
        sizes.sort_by(f64::total_cmp);
        let middle = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
        let bent: Vec<bool> = bends.iter().map(|b| b.as_ref().is_some_and(|b| b.size > 1.0)).collect();
        let wide: Vec<usize> = bent.chunk_by(|a, b| a == b).filter(|rows| rows[0]).map(<[bool]>::len).collect();
        let narrow = wide.iter().filter(|rows| **rows <= 2).count();
        let frames = on_a_line as f64 >= HABIT * moving.len() as f64
            && sizes.len() >= FEWEST / 10
            && middle >= BEND
            && narrow as f64 >= NARROW * wide.len() as f64;
        let gaps = (on_a_line as f64) < HABIT * moving.len() as f64 && middle >= BRIDGE.1;
        let between = if frames { Some(Between::Frames) } else { gaps.then_some(Between::Gaps) };
        let found = between.filter(|_| moving.len() >= FEWEST).map(|between| (between, rounding));
        Self { found, dropped: false, said: false }
    }

    /// Keeps the rows next to frames, one for each; or drops those that bridge gaps.
    pub(super) fn apply(&mut self, run: &mut Run) {
        let Some((between, rounding)) = self.found else { return };
        let bends = bends(run, &rounding);
        let keep = match between {
            Between::Frames => next_to_frames(&bends),
            Between::Gaps => beside_bridges(&bends),
        };
        self.dropped |= keep.contains(&false);
        let mut rows = keep.iter();
        run.camera.retain(|_| rows.next().is_some_and(|keep| *keep));
    }

    /// What was found, said once.
    pub(super) fn note(&mut self, run: &Run) -> Option<String> {
        let (between, _) = self.found?;
        if !self.dropped || std::mem::replace(&mut self.said, true) {
            return None;
        }
        let rate = run.camera.len() as f64 / run.duration_s().max(f64::MIN_POSITIVE);
        Some(match between {
            Between::Frames => format!(
                "the camera's poses are interpolated: rows between two frames are no sample ({rate:.*} frames a second)",
                usize::from(rate < 10.0)
            ),
            Between::Gaps => "gaps of the camera are bridged by lines: rows on them are no sample".to_owned(),
        })
    }
}

/// Of every pose.
fn bends(run: &Run, rounding: &[f64; 3]) -> Vec<Option<Bend>> {
    let mut steps: Vec<f64> = run.camera.windows(2).map(|w| run.t[w[1].tick] - run.t[w[0].tick]).collect();
    steps.sort_by(f64::total_cmp);
    let longest = GAP * steps.get(steps.len() / 2).copied().unwrap_or(0.0);
    (0..run.camera.len()).map(|k| Bend::at(run, k, rounding, longest)).collect()
}

fn next_to_frames(bends: &[Option<Bend>]) -> Vec<bool> {
    let at = |k: usize| bends.get(k).and_then(Option::as_ref).map_or(0.0, |b| b.size);
    (0..bends.len()).map(|k| at(k) > 1.0 && at(k) >= at(k + 1) && (k == 0 || at(k) > at(k - 1))).collect()
}

fn beside_bridges(bends: &[Option<Bend>]) -> Vec<bool> {
    let straight: Vec<bool> = bends.iter().map(|b| b.as_ref().is_some_and(|b| b.moves && b.size <= 1.0)).collect();
    let alike = straight.chunk_by(|a, b| a == b);
    alike.flat_map(|rows| std::iter::repeat_n(!rows[0] || rows.len() < BRIDGE.0, rows.len())).collect()
}

/// How far a pose lies from the line between its neighbours.
struct Bend {
    /// In what rounding leaves, of the channel that is bent most.
    size: f64,
    /// Whether a channel moves by so much that a line shows.
    moves: bool,
}

impl Bend {
    /// `None` where a neighbouring row has no pose, and of poses at times of their own where one is missing, more than
    /// `longest` before the next.
    fn at(run: &Run, k: usize, rounding: &[f64; 3], longest: f64) -> Option<Self> {
        let [a, b, c] = [k.checked_sub(1)?, k, k + 1].map(|k| run.camera.get(k));
        let (a, b, c) = (a?, b?, c?);
        let [ta, tb, tc] = [a, b, c].map(|s| run.t[s.tick]);
        let in_rows = a.tick + 1 == b.tick && b.tick + 1 == c.tick;
        let fine = rounding.iter().all(|r| *r <= FINE);
        if !(in_rows || fine && tb - ta < longest && tc - tb < longest) {
            return None;
        }
        let share = (tb - ta) / (tc - ta);
        let way = |a: &CameraSample, b: &CameraSample| {
            [b.pose.x - a.pose.x, b.pose.y - a.pose.y, wrap_angle(b.pose.theta - a.pose.theta)]
        };
        let (half, whole) = (way(a, b), way(a, c));
        let mut bend = Self { size: 0.0, moves: false };
        for i in (0..3).filter(|i| half[*i].is_finite() && whole[*i].is_finite()) {
            bend.size = bend.size.max((half[i] - share * whole[i]).abs() / rounding[i]);
            bend.moves |= whole[i].abs() > MOVES * rounding[i];
        }
        Some(bend)
    }
}

/// What the rounding of the poses leaves of a line, of x, y and heading: half a step here, and half a step of what lies
/// between the neighbours.
fn rounding(camera: &[CameraSample]) -> [f64; 3] {
    let channel: [fn(&CameraSample) -> f64; 3] = [|s| s.pose.x, |s| s.pose.y, |s| s.pose.theta];
    channel.map(|of| {
        // Differences: headings may have been counted on when they were written.
        let steps: Vec<f64> = camera.windows(2).map(|w| of(&w[1]) - of(&w[0])).filter(|d| d.is_finite()).collect();
        // Positions alone have no headings.
        if steps.is_empty() {
            return BY_TIMES;
        }
        let is_whole = |d: f64, step: f64| (d / step - (d / step).round()).abs() < 1e-3;
        let whole =
            |step: f64| steps.iter().filter(|d| is_whole(**d, step)).count() as f64 >= WRITTEN * steps.len() as f64;
        STEPS.into_iter().find(|step| whole(*step)).unwrap_or(0.0) + BY_TIMES
    })
}
