//! Poses that a camera, or a program after it, has filtered: a low-pass of first order of x, y and heading.

use runs::frames::{Pose, Twist, Walk};

use crate::segment::{Frame, Segment};

/// Time constants before a window's first frame from which a filter is followed: what it was before is 0.2 % by then.
const BEGUN: f64 = 6.0;

/// A low-pass on the camera's poses.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CameraFilter {
    /// Time constant, s; 0 for none.
    pub time_s: f64,
    /// Whether it steps once a frame, as a program's does, and not all the time.
    pub at_frames: bool,
}

/// A filtered pose, heading not wrapped.
#[derive(Clone, Copy)]
struct Lagging {
    filter: CameraFilter,
    at: [f64; 3],
}

impl Lagging {
    /// What is kept of a difference after `dt` s.
    fn kept(&self, dt: f64) -> f64 {
        (-dt / self.filter.time_s).exp()
    }

    /// While the pose goes straight from `from` to `to` within `dt` s.
    #[must_use]
    fn along(self, [from, to]: [Pose; 2], dt: f64) -> Self {
        if dt <= 0.0 || self.filter.at_frames {
            return self;
        }
        let ([from, to], kept) = ([from, to].map(places), self.kept(dt));
        let at = [0, 1, 2].map(|i| {
            let less = self.filter.time_s * (to[i] - from[i]) / dt;
            to[i] - less + (self.at[i] - from[i] + less) * kept
        });
        Self { at, ..self }
    }

    /// With a frame that shows a pose, `dt` s after the one before.
    #[must_use]
    fn with(self, frame: Pose, dt: f64) -> Self {
        if !self.filter.at_frames {
            return self;
        }
        let (now, kept) = (places(frame), self.kept(dt));
        Self { at: [0, 1, 2].map(|i| now[i] + (self.at[i] - now[i]) * kept), ..self }
    }

    fn walk(&self) -> Walk {
        Walk::from(Pose::new(self.at[0], self.at[1], self.at[2]))
    }
}

fn places(p: Pose) -> [f64; 3] {
    [p.x, p.y, p.theta]
}

/// Filtered poses at some frames, relative to that at the first one, by the body's displacement from a tick to the next.
pub(super) fn walk(
    segment: &Segment,
    moved: &impl Fn(usize) -> Twist,
    exposure: &impl Fn(f64) -> f64,
    filter: CameraFilter,
    frames: &[Frame],
    keep: &mut impl FnMut(Walk),
) {
    let Some(first) = frames.first() else { return };
    let last_tick = segment.t.len() - 1;
    // Frames before the window, as often as in it.
    let dt = frames.get(1).map_or(filter.time_s, |next| next.t - first.t).max(1e-3 * filter.time_s);
    let before = (BEGUN * filter.time_s / dt).ceil() as usize;
    let stamps = (1..=before).rev().map(|k| first.t - k as f64 * dt).chain(frames.iter().map(|f| f.t));
    let origin = segment.tick_at(exposure(first.t - before as f64 * dt));
    let begun = Lagging { filter, at: [0.0; 3] };
    let (mut tick, mut walk, mut seen, mut last) = (origin, Walk::from(Pose::default()), begun, f64::NEG_INFINITY);
    let mut back = walk;
    for (i, stamp) in stamps.enumerate() {
        let exposed = exposure(stamp);
        if exposed < segment.t[tick] && tick > origin {
            // As delays may differ from frame to frame.
            (tick, walk, seen) = (origin, Walk::from(Pose::default()), begun);
        }
        while tick < last_tick && segment.t[tick + 1] <= exposed {
            let next = walk.then(&Walk::by(moved(tick)));
            seen = seen.along([walk.pose(), next.pose()], segment.t[tick + 1] - segment.t[tick]);
            (walk, tick) = (next, tick + 1);
        }
        let (mut to, mut at) = (walk, seen);
        if tick < last_tick && exposed > segment.t[tick] {
            let (own, dt) = (exposed - segment.t[tick], segment.t[tick + 1] - segment.t[tick]);
            to = walk.then(&Walk::by(moved(tick).scaled(own / dt)));
            at = seen.along([walk.pose(), to.pose()], own);
        }
        at = at.with(to.pose(), stamp - last);
        if filter.at_frames {
            seen = at;
        }
        last = stamp;
        if i == before {
            back = at.walk().inverse();
        }
        if i >= before {
            keep(back.then(&at.walk()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(filter: CameraFilter, stamps: &[f64]) -> Vec<f64> {
        let t: Vec<f64> = (0..400).map(|k| 0.01 * f64::from(k)).collect();
        let segment = Segment { t, ..Segment::default() };
        // 0.5 m/s for two seconds, then nothing.
        let moved = |k: usize| Twist::new(if k < 200 { 0.005 } else { 0.0 }, 0.0, 0.0);
        let frames: Vec<Frame> = stamps.iter().map(|t| Frame { t: *t, pose: Pose::default() }).collect();
        let mut seen = Vec::new();
        walk(&segment, &moved, &|t: f64| t, filter, &frames, &mut |p: Walk| seen.push(p.pose().x));
        seen
    }

    #[test]
    fn a_pose_that_moves_for_long_is_seen_where_it_was_and_one_that_stops_is_reached() {
        let found = seen(CameraFilter { time_s: 0.08, at_frames: false }, &[1.0, 1.9987, 2.08, 3.9]);
        let wanted = [0.0, 0.5 * 0.9987, 0.54 - 0.04 * (-1.0_f64).exp(), 0.54];
        assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 2e-4), "{found:?} {wanted:?}");
    }

    #[test]
    fn a_filter_that_steps_once_a_frame_lags_by_its_recursion() {
        let stamps: Vec<f64> = (0..60).map(|k| 1.005 + 0.03 * f64::from(k)).collect();
        let found = seen(CameraFilter { time_s: 0.08, at_frames: true }, &stamps);
        let kept = (-0.03_f64 / 0.08).exp();
        let mut lagging = 0.5 * (stamps[0] - 0.03 * kept / (1.0 - kept));
        let begun = lagging;
        for (t, found) in stamps.iter().zip(&found).skip(1) {
            let place = 0.5 * t.min(2.0);
            lagging = place + (lagging - place) * kept;
            assert!((found - (lagging - begun)).abs() < 2e-4, "{t}: {found} {}", lagging - begun);
        }
    }
}
