//! The logs as segments, derived when they are asked for: whatever their length, only a few are in memory.
//!
//! A stretch of a log without gaps is one segment, or, if it is long, several of about [`PIECE`] ticks. Each of them
//! sees some ticks more on either side, so that nothing that is smoothed, delayed or laid across its ends differs from
//! what one segment would have given.

use std::collections::VecDeque;
use std::ops::Range;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use runs::frames::{Pose, displacement};
use runs::geometry::Geometry;
use runs::robot::Robot;
use runs::{Columns, Log};

pub use crate::segment::Driven;
use crate::segment::{Frame, Place, Segment, regular_stamps, segment};

/// A pause longer than this many ticks starts a new segment.
const GAP_TICKS: f64 = 20.0;
/// A stretch with fewer ticks is none.
const FEWEST: usize = 8;
/// Ticks of a piece of a long stretch; one that is a quarter longer is not cut.
pub const PIECE: usize = 1 << 16;
/// Ticks that a piece sees before its own: the oldest duty that acts, the smoothing of signals, a wheel that slides;
/// and after: a window of camera frames, a test function.
const BEFORE: usize = 1 << 12;
const AFTER: usize = 1 << 12;
/// Segments, in pieces' lengths, that are kept once they are derived, some 17 MB each with three wheels, their rows and their
/// test functions: 17 minutes at 1 kHz. Of the others only the last ones.
const KEPT: usize = 16;
const RECENT: usize = 2;
/// Ticks of a sample. Of 50 minutes at 1 kHz a search in 4.4 named what a search in all named (skews; the estimates, of
/// all ticks, differed by 1e-8 rad), and took a third of the processor time; of 86 minutes in 425 runs with skews of 2 to
/// 4 degrees one in 4.0 named them, too (1.4e-6 rad beside a search in all).
const SAMPLE: usize = 1 << 18;
/// Ticks of its pieces: eight windows of the motion at 1 kHz, and as many ticks again for what they see around them.
const SAMPLED: usize = 1 << 13;
/// Share of the golden section: its multiples fall evenly into an interval without a period, so that a drive that
/// repeats itself is not always seen at the same place.
const GOLDEN: f64 = 0.618_033_988_749_895;
/// What the links read.
const COLUMNS: Columns = Columns { reference: true, counts: true, duty: true, supply: true, ..Columns::NONE };

/// Clusters at most; beyond, neighbouring windows count as one.
pub(crate) const MOST_CLUSTERS: usize = 400;

/// Where the windows of each segment stand in a list that has them in order.
pub(crate) fn by_segment<W>(windows: &[W], segment: impl Fn(&W) -> usize) -> Vec<Range<usize>> {
    let mut first = 0;
    let part = |part: &[W]| {
        first += part.len();
        first - part.len()..first
    };
    windows.chunk_by(|a, b| segment(a) == segment(b)).map(part).collect()
}

/// All segments of a data set.
pub struct Pieces<'a> {
    robot: Robot,
    geometry: Geometry,
    logs: &'a [Log<'a>],
    /// Regularised stamps of each log's camera frames.
    stamps: Vec<Vec<f64>>,
    all: Vec<Piece>,
    kept: Vec<OnceLock<Arc<Segment>>>,
    recent: Mutex<VecDeque<(usize, Arc<Segment>)>>,
    /// Speed of the wheels while they turned, rad/s.
    speed: f64,
    /// See [`Pieces::seen_m`].
    seen_m: f64,
    /// How what drives the wheels is looked at.
    driving: Driving,
}

/// How the logs of a drive are looked at, settled before anything is fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Driving {
    /// What the rows say of what drives the wheels.
    pub driven: Driven,
    /// Half rows by which logged speeds are older than momentary ones beside their duties: one as means over the row before, as
    /// differences of counts are; two where such means are read in the middle between two duties.
    pub half_rows: usize,
    /// Length of a test function, s.
    pub test_function_s: f64,
}

impl Default for Driving {
    fn default() -> Self {
        Self { driven: Driven::Held, half_rows: 0, test_function_s: crate::drive::TEST_FUNCTION_S }
    }
}

/// Where a segment lies, and what it needs to know of the log before it.
#[derive(Clone)]
struct Piece {
    run: usize,
    /// Ticks that it sees, and its own, both counted from that of the log.
    rows: Range<usize>,
    own: Range<usize>,
    stretch: Range<usize>,
    stretch_s: [f64; 2],
    begins_s: f64,
    counts: Vec<i64>,
    pose: Pose,
    before: usize,
    history: Arc<Vec<(f64, Vec<f64>)>>,
}

/// Cuts logs into segments, stretches that are much longer than `piece` ticks into several.
pub fn segments<'a>(robot: &Robot, geometry: &Geometry, logs: &'a [Log<'a>], piece: usize) -> Pieces<'a> {
    let mut pieces = Pieces {
        robot: robot.clone(),
        geometry: geometry.clone(),
        logs,
        stamps: Vec::new(),
        all: Vec::new(),
        kept: Vec::new(),
        recent: Mutex::default(),
        speed: crate::segment::usual_speed(robot, logs),
        seen_m: seen_m(logs),
        driving: Driving::default(),
    };
    for (run, log) in logs.iter().enumerate() {
        let tick = log.tick_s();
        pieces.stamps.push(tick.map_or_else(Vec::new, |t| regular_stamps(log.camera(), robot.camera_rate_hz, t)));
        let stretches = tick.map_or_else(Vec::new, |t| Pieces::stretches(log, t));
        let begins_s = stretches.first().map_or(0.0, |(_, [from, _])| *from);
        for (stretch, stretch_s) in stretches {
            let cut = pieces.cut(run, &stretch, (stretch_s, begins_s), piece.max(1));
            pieces.all.extend(cut);
        }
    }
    pieces.keep(KEPT * piece);
    pieces
}

fn seen_m(logs: &[Log]) -> f64 {
    let squares = logs.iter().flat_map(Log::camera).map(|seen| seen.pose.x.powi(2) + seen.pose.y.powi(2));
    let [way, cube] = squares.fold([0.0; 2], |[way, cube], square| [way + square, cube + square.powi(3)]);
    if way > 0.0 { (cube / way).powf(0.25) } else { 0.0 }
}

impl<'a> Pieces<'a> {
    /// The same, looked at in another way.
    #[must_use]
    pub fn driven(&self, driving: Driving) -> Self {
        Self {
            robot: self.robot.clone(),
            geometry: self.geometry.clone(),
            logs: self.logs,
            stamps: self.stamps.clone(),
            all: self.all.clone(),
            kept: self.kept.iter().map(|_| OnceLock::new()).collect(),
            recent: Mutex::default(),
            speed: self.speed,
            seen_m: self.seen_m,
            driving,
        }
    }

    /// How the drive is looked at.
    pub(crate) fn driving(&self) -> Driving {
        self.driving
    }

    /// Half rows by which logged speeds are looked at as older than momentary ones.
    pub fn half_rows(&self) -> usize {
        self.driving.half_rows
    }

    /// Short pieces spread evenly over the logs, of `every_run` at least one; `None` where these would be more than half
    /// of them.
    pub fn sample(&self, every_run: bool) -> Option<Self> {
        if self.ticks() < 2 * SAMPLE {
            return None;
        }
        let mut sample = segments(&self.robot, &self.geometry, self.logs, SAMPLED);
        sample.driving = self.driving;
        let strata = (SAMPLE / SAMPLED).min(sample.len());
        let each = sample.len() as f64 / strata as f64;
        let mut taken: Vec<usize> =
            (0..strata).map(|k| ((k as f64 + (k as f64 * GOLDEN).fract()) * each) as usize).collect();
        let mut first = 0;
        for run in sample.all.chunk_by(|a, b| a.run == b.run) {
            if every_run && !taken.iter().any(|i| (first..first + run.len()).contains(i)) {
                taken.push(first + run.len() / 2);
            }
            first += run.len();
        }
        taken.sort_unstable();
        sample.all = taken.into_iter().map(|i| sample.all[i].clone()).collect();
        sample.keep(KEPT * PIECE);
        (2 * sample.ticks() <= self.ticks()).then_some(sample)
    }

    /// Keeps the first segments that together see so many ticks.
    fn keep(&mut self, ticks: usize) {
        let mut sum = 0;
        let fits = |p: &&Piece| {
            sum += p.rows.len();
            sum <= ticks
        };
        self.kept = self.all.iter().take_while(fits).map(|_| OnceLock::new()).collect();
    }

    /// Number of segments.
    pub fn len(&self) -> usize {
        self.all.len()
    }

    /// Whether there is no segment.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// The segment at `index`, cut from its run unless it is kept.
    pub fn get(&self, index: usize) -> Arc<Segment> {
        if let Some(kept) = self.kept.get(index) {
            return kept.get_or_init(|| Arc::new(self.derive(index))).clone();
        }
        let recent = || self.recent.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, found)) = recent().iter().find(|(i, _)| *i == index) {
            return found.clone();
        }
        let new = Arc::new(self.derive(index));
        let mut recent = recent();
        recent.truncate(RECENT - 1);
        recent.push_front((index, new.clone()));
        new
    }

    /// How many segments, from the first on, are kept once they are derived.
    pub(crate) fn kept(&self) -> usize {
        self.kept.len()
    }

    /// All segments, one after the other.
    pub fn iter(&self) -> impl Iterator<Item = Arc<Segment>> {
        (0..self.len()).map(|i| self.get(i))
    }

    /// The robot as its file has it.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Speed of the wheels while they turned, rad/s; 0 if they never did.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// How far from the camera's origin it saw the robot, m, as [`crate::effect::Sizes::seen_m`] has it; 0 without frames.
    pub fn seen_m(&self) -> f64 {
        self.seen_m
    }

    /// Ticks of all pieces together, each once.
    pub fn ticks(&self) -> usize {
        self.all.iter().map(|p| p.own.len()).sum()
    }

    /// Length of all segments together, s.
    pub fn seconds(&self) -> f64 {
        let share = |p: &Piece| p.own.len() as f64 / p.stretch.len() as f64;
        self.all.iter().map(|p| share(p) * (p.stretch_s[1] - p.stretch_s[0])).sum()
    }

    /// Index of the run of a segment.
    pub fn run(&self, index: usize) -> usize {
        self.all[index].run
    }

    /// Whether any log has camera frames.
    pub fn have_frames(&self) -> bool {
        self.logs.iter().any(|log| !log.camera().is_empty())
    }

    /// Whether any log has an inertial sensor.
    pub fn have_sensor(&self) -> bool {
        self.logs.iter().any(|log| log.layout().gyro.is_some() || log.layout().acceleration.is_some())
    }

    /// Whether any log has duties.
    pub fn have_duties(&self) -> bool {
        self.logs.iter().any(|log| !log.layout().duty.is_empty())
    }

    /// Stretches of a log without gaps, with their first and last times, each from the first tick to the last at which every
    /// wheel has counted: a camera with a clock of its own sees the robot before and after, where no count says how far it went.
    fn stretches(log: &Log, tick: f64) -> Vec<(Range<usize>, [f64; 2])> {
        let mut out = Vec::new();
        // First and last tick with counts.
        let mut open: Option<[(usize, f64); 2]> = None;
        let mut last = f64::NAN;
        let mut close = |[(start, from), (end, to)]: [(usize, f64); 2]| {
            if end + 1 - start >= FEWEST {
                out.push((start..end + 1, [from, to]));
            }
        };
        for first in (0..log.len()).step_by(PIECE) {
            let columns = Columns { counts: true, ..Columns::NONE };
            let part = log.part(first..(first + PIECE).min(log.len()), columns);
            for (k, t) in part.t.iter().enumerate() {
                if t - last > GAP_TICKS * tick {
                    open.take().into_iter().for_each(&mut close);
                }
                last = *t;
                if part.count_gaps.iter().all(|gaps| gaps.binary_search(&k).is_err()) {
                    let here = (first + k, *t);
                    open = Some([open.map_or(here, |[start, _]| start), here]);
                }
            }
        }
        open.into_iter().for_each(close);
        out
    }

    /// Cuts a stretch of a run that begins so into pieces.
    fn cut(
        &self,
        run: usize,
        stretch: &Range<usize>,
        (stretch_s, begins_s): ([f64; 2], f64),
        piece: usize,
    ) -> Vec<Piece> {
        let number = if stretch.len() <= piece * 5 / 4 { 1 } else { stretch.len().div_ceil(piece) };
        let length = stretch.len().div_ceil(number);
        let mut pieces: Vec<Piece> = (0..number)
            .map(|k| {
                let own = stretch.start + k * length..(stretch.start + (k + 1) * length).min(stretch.end);
                let rows = own.start.saturating_sub(BEFORE).max(stretch.start)..(own.end + AFTER).min(stretch.end);
                Piece {
                    run,
                    rows,
                    own,
                    stretch: stretch.clone(),
                    stretch_s,
                    begins_s,
                    counts: Vec::new(),
                    pose: Pose::default(),
                    before: 0,
                    history: Arc::default(),
                }
            })
            .collect();
        if number > 1 {
            self.carry(&mut pieces);
        }
        pieces
    }

    /// Walks along a stretch and writes down what its pieces need to know of it.
    fn carry(&self, pieces: &mut [Piece]) {
        let log = &self.logs[pieces[0].run];
        let stretch = pieces[0].stretch.clone();
        let n = self.robot.wheel_count();
        let mut history: Vec<(f64, Vec<f64>)> = Vec::new();
        let (mut pose, mut square, mut duty) = (Pose::default(), vec![0.0; n], vec![0.0; n]);
        let (mut opened, mut last, mut total) = (f64::NAN, f64::NAN, vec![0_i64; n]);
        let mut counts: Vec<i64> = Vec::new();
        let mut next = 0;
        for first in stretch.clone().step_by(PIECE) {
            let part = log.part(first..(first + PIECE).min(stretch.end), COLUMNS);
            let counted = part.counts.len() == n;
            for k in 0..part.len() {
                let t = part.t[k];
                if counted {
                    let now: Vec<i64> = part.counts.iter().map(|c| c[k]).collect();
                    if counts.len() == n {
                        let steps: Vec<i64> = now.iter().zip(&counts).map(|(a, b)| a.wrapping_sub(*b)).collect();
                        let turned: Vec<f64> =
                            steps.iter().map(|s| *s as f64 / self.robot.counts_per_wheel_rad()).collect();
                        pose = pose.compose(displacement(self.geometry.twist(&turned)));
                        total.iter_mut().zip(&steps).for_each(|(total, step)| *total += step);
                    }
                    counts = now;
                }
                let due = pieces.get(next).is_some_and(|p| p.rows.start == first + k);
                // Duties act from their tick to the next.
                if last.is_finite() {
                    square.iter_mut().zip(&duty).for_each(|(s, d)| *s += d * d * (t - last));
                    if t - opened >= 1.0 || due {
                        history.push((t - opened, square.iter().map(|s| s / (t - opened)).collect()));
                        square.fill(0.0);
                        opened = t;
                    }
                } else {
                    opened = t;
                }
                last = t;
                duty.iter_mut().zip(&part.duty).filter(|(_, d)| d[k].is_finite()).for_each(|(now, d)| *now = d[k]);
                if due {
                    let p = &mut pieces[next];
                    (p.pose, p.before) = (pose, history.len());
                    p.counts.clone_from(&total);
                    next += 1;
                }
            }
        }
        let history = Arc::new(history);
        pieces.iter_mut().for_each(|p| p.history = history.clone());
    }

    fn derive(&self, index: usize) -> Segment {
        let p = &self.all[index];
        let log = &self.logs[p.run];
        let layout = log.layout();
        let sensors = layout.gyro.is_some() || layout.acceleration.is_some();
        let part = log.part(p.rows.clone(), Columns { sensors, ..COLUMNS });
        let seen = log.camera();
        let at = |tick: usize| seen.partition_point(|f| f.tick < tick);
        let frames = at(p.rows.start)..at(p.rows.end);
        let place = Place {
            run: p.run,
            own: p.own.start - p.rows.start..p.own.end - p.rows.start,
            stretch: p.stretch_s,
            begins_s: p.begins_s,
            cut: [p.own.start > p.stretch.start, p.own.end < p.stretch.end],
            counts: &p.counts,
            pose: p.pose,
            stretch_frames: at(p.stretch.end) - at(p.stretch.start),
            frames: frames.map(|i| Frame { t: self.stamps[p.run][i], pose: seen[i].pose }).collect(),
            before: &p.history[..p.before],
            speed: self.speed,
            driven: self.driving.driven,
            half_rows: self.driving.half_rows,
        };
        segment(&self.robot, &self.geometry, &part, place)
    }
}

#[cfg(test)]
mod tests {
    use std::borrow::Cow;

    use model::effects::Applied;
    use model::manoeuvre::{Manoeuvre, simulate};

    use super::*;

    /// Greatest distance of two columns.
    fn apart(a: &[f64], b: &[f64]) -> f64 {
        assert_eq!(a.len(), b.len());
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn pieces_hold_what_the_whole_stretch_holds() {
        let robot = Robot::racbot();
        let run = simulate(Manoeuvre::Star, &Applied::of(&robot), &robot, Pose::default(), 1).unwrap();
        let logs = [Log::from(Cow::Owned(run))];
        let geometry = robot.geometry().unwrap();
        let whole = segments(&robot, &geometry, &logs, PIECE).get(0);
        let pieces = segments(&robot, &geometry, &logs, 5000);
        assert!(pieces.len() > 3);
        let (mut next, mut frames) = (0, 0);
        for (p, s) in pieces.all.iter().zip(pieces.iter()) {
            assert_eq!(p.own.start, next);
            next = p.own.end;
            frames += s.own_frames().len();
            let (here, there) = (s.own.clone(), p.own.clone());
            assert_eq!(s.t[here.clone()], whole.t[there.clone()]);
            for i in 0..3 {
                assert!(apart(&s.angle[i][here.clone()], &whole.angle[i][there.clone()]) < 1e-9);
                assert!(apart(&s.speed[i][here.clone()], &whole.speed[i][there.clone()]) < 1e-9);
                assert_eq!(s.duty[i][here.clone()], whole.duty[i][there.clone()]);
                // Heat: mean squares of the seconds before, against every tick.
                let mean: f64 = whole.duty[i][..p.rows.start].iter().map(|d| d * d * 1e-3).sum();
                assert!((s.before.iter().map(|(t, squares)| t * squares[i]).sum::<f64>() - mean).abs() < 1e-6);
            }
            let turn = |a: f64, b: f64| (a - b).sin().abs();
            let headings = s.heading[here.clone()].iter().zip(&whole.heading[there.clone()]);
            assert!(headings.map(|(a, b)| turn(*a, *b)).fold(0.0, f64::max) < 1e-9);
            for j in 0..2 {
                let axis =
                    |s: &Segment, range: Range<usize>| s.position[range].iter().map(|p| p[j]).collect::<Vec<_>>();
                assert!(apart(&axis(&s, here.clone()), &axis(&whole, there.clone())) < 1e-9);
            }
        }
        assert_eq!((next, frames), (whole.t.len(), whole.frames.len()));
    }

    #[test]
    fn a_stretch_goes_from_count_to_count() {
        // Rows are missing, and beside the gap the camera has rows of its own in which no wheel counts.
        const GAP: usize = 3000;
        let robot = Robot::racbot();
        let mut run = simulate(Manoeuvre::Star, &Applied::of(&robot), &robot, Pose::default(), 1).unwrap();
        run.t[GAP..].iter_mut().for_each(|t| *t += 2.0);
        for (counts, gaps) in run.counts.iter_mut().zip(&mut run.count_gaps) {
            gaps.extend(GAP - 5..GAP + 3);
            let last = counts[GAP - 6];
            counts[GAP - 5..GAP + 3].fill(last);
        }
        let logs = [Log::from(Cow::Owned(run))];
        let pieces = segments(&robot, &robot.geometry().unwrap(), &logs, PIECE);
        let stretches: Vec<_> = pieces.all.iter().map(|p| p.stretch.clone()).collect();
        assert_eq!(stretches, [0..GAP - 5, GAP + 3..logs[0].len()]);
    }
}
