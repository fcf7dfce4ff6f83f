//! Cameras whose last pose is logged again until the next one comes, or whose poses come in bunches.

use crate::Run;
use crate::frames::Pose;

/// Poses from which the habit is told.
pub(super) const FEWEST: usize = 60;
/// Share of poses that repeat the one before to the last digit, from which the log holds poses: a camera of half the
/// log's rate repeats every second one. A tracker that loses the robot now and then stays below.
const HABIT: f64 = 0.4;

/// Share of the usual time from frame to frame below which one came in a bunch with the one before.
const AT_ONCE: f64 = 0.2;
/// How many times as fast the robot would be within bunches as between them, where their stamps are no times of the frames.
const TOO_FAST: f64 = 5.0;

/// How many times as fast the robot would be within bunches of frames as between them, if most frames come in bunches and it is
/// too fast: their stamps say when a network delivered them.
fn bunches(run: &Run) -> Option<f64> {
    let frames = &run.camera;
    let t = |k: usize| run.t[frames[k].tick];
    let usual = (t(frames.len().checked_sub(1)?) - t(0)) / (frames.len() as f64 - 1.0);
    let (mut sums, mut at_once) = ([[0.0; 2]; 2], 0);
    for k in 1..frames.len() {
        let (dt, [a, b]) = (t(k) - t(k - 1), [frames[k - 1].pose, frames[k].pose]);
        let late = usize::from(dt >= AT_ONCE * usual);
        at_once += 1 - late;
        sums[late][0] += (b.x - a.x).hypot(b.y - a.y);
        sums[late][1] += dt;
    }
    let [within, between] = sums.map(|[way, time]| way / time);
    let most = frames.len() >= FEWEST && 2 * at_once > frames.len();
    (most && within > TOO_FAST * between).then(|| within / between)
}

/// Whether two poses are the same to the last digit; positions have no heading.
fn same(a: Pose, b: Pose) -> bool {
    a.x == b.x && a.y == b.y && (a.theta == b.theta || a.theta.is_nan() && b.theta.is_nan())
}

/// Whether poses are held, and the last of them.
pub(super) struct Repeats {
    held: bool,
    bunches: Option<f64>,
    last: Option<Pose>,
    said: bool,
}

impl Repeats {
    /// By the first part of a log. Frozen poses of a robot that is not tracked come in one long row; held ones in many.
    pub(super) fn of(run: &Run) -> Self {
        let repeats = run.camera.windows(2).map(|w| same(w[0].pose, w[1].pose) && w[1].tick == w[0].tick + 1);
        let repeats: Vec<bool> = repeats.collect();
        let number = repeats.iter().filter(|r| **r).count();
        let rows = repeats.windows(2).filter(|w| w[1] && !w[0]).count();
        let changes = repeats.len() - number;
        let held = run.camera.len() >= FEWEST
            && number as f64 >= HABIT * repeats.len() as f64
            && 2 * rows >= changes
            && rows > FEWEST / 10;
        Self { held, bunches: bunches(run).filter(|_| !held), last: None, said: false }
    }

    /// Drops what repeats.
    pub(super) fn apply(&mut self, run: &mut Run) {
        if !self.held {
            return;
        }
        let last = &mut self.last;
        run.camera.retain(|sample| !last.replace(sample.pose).is_some_and(|last| same(last, sample.pose)));
    }

    /// What was found, said once.
    pub(super) fn note(&mut self, run: &Run) -> Option<String> {
        if std::mem::replace(&mut self.said, true) {
            return None;
        }
        if let Some(fast) = self.bunches {
            return Some(format!(
                "the camera's frames come in bunches, within which the robot would be {fast:.0} times as fast: stamps of when they \
                 arrived, not of when they were taken; log the tracker's own"
            ));
        }
        if !self.held {
            return None;
        }
        let rate = run.camera.len() as f64 / run.duration_s().max(f64::MIN_POSITIVE);
        Some(format!(
            "the camera's last pose is logged again until the next one: repeats are no sample ({rate:.0} new poses a second)"
        ))
    }
}
