//! A log that is looked at part by part, so that its length does not matter.

use std::borrow::Cow;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use super::signals::Reading;
use super::spool::{Spool, Spooled};
use super::{Columns, Run, RunError};
use crate::frames::Pose;
use crate::robot::Robot;

/// Ticks that are read and written at once.
const PART: usize = 1 << 16;
/// Ticks over whose steps the period of a long log is taken.
const STEPS: usize = 1 << 18;

/// A camera frame of a log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Tick at which the log has it, from 0.
    pub tick: usize,
    /// Time of that tick, s.
    pub t: f64,
    /// What the camera reports.
    pub pose: Pose,
}

/// One recorded drive of any length, in memory; but the ticks of a long one in an unnamed temporary file, and only its
/// camera frames in memory.
#[derive(Debug)]
pub struct Log<'a> {
    /// Name of the run.
    pub name: String,
    path: PathBuf,
    store: Store<'a>,
    /// Which columns there are; no ticks.
    layout: Run,
    tick_s: Option<f64>,
    camera: Vec<Seen>,
    failure: OnceLock<RunError>,
}

#[derive(Debug)]
enum Store<'a> {
    Memory(Cow<'a, Run>),
    File(Spooled),
}

impl<'a> From<Cow<'a, Run>> for Log<'a> {
    fn from(run: Cow<'a, Run>) -> Self {
        Self {
            name: run.name.clone(),
            path: PathBuf::from(&run.name),
            layout: run.emptied(Columns::ALL),
            tick_s: run.tick_s(),
            camera: seen(&run, 0).collect(),
            failure: OnceLock::new(),
            store: Store::Memory(run),
        }
    }
}

fn seen(run: &Run, first: usize) -> impl Iterator<Item = Seen> {
    run.camera.iter().map(move |f| Seen { tick: first + f.tick, t: run.t[f.tick], pose: f.pose })
}

impl Log<'static> {
    /// Reads a log, as the links read it where the robot is given; up to `in_memory` ticks stay in memory, and else all of them go to `spool`, which is made when it
    /// is needed first.
    pub(super) fn read(
        path: &Path,
        robot: Option<&Robot>,
        in_memory: usize,
        spool: &mut Option<Arc<Spool>>,
    ) -> Result<Self, RunError> {
        let name = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        let mut whole: Option<Run> = None;
        let mut file: Option<Spooled> = None;
        let (mut camera, mut steps): (Vec<Seen>, Vec<f64>) = Default::default();
        let mut last = None;
        let mut reading = None;
        let mut take = |run: Run| -> Result<(), RunError> {
            let run = match (robot, &mut reading) {
                (None, _) => run,
                (_, Some(reading)) => Reading::apply(reading, run),
                (Some(robot), slot) => slot.insert(Reading::new(robot, &run, path)?).apply(run),
            };
            if file.is_none() && whole.as_ref().map_or(0, Run::len) + run.len() <= in_memory {
                match &mut whole {
                    Some(whole) => whole.append(run),
                    None => whole = Some(run),
                }
                return Ok(());
            }
            for run in whole.take().into_iter().chain([run]) {
                let spooled = match &mut file {
                    Some(file) => file,
                    slot => {
                        let spool = match spool {
                            Some(spool) => spool.clone(),
                            None => spool.insert(Spool::new().map_err(|e| no_room(path, &e))?).clone(),
                        };
                        slot.insert(Spooled::new(spool, &run))
                    }
                };
                camera.extend(seen(&run, spooled.len()));
                for t in run.sampled().iter() {
                    if let Some(last) = last.replace(*t).filter(|_| steps.len() < STEPS) {
                        steps.push(t - last);
                    }
                }
                spooled.push(&run).map_err(|e| no_room(path, &e))?;
            }
            Ok(())
        };
        if super::stream::is_mcap(path) {
            let run = Run::read(path)?;
            if run.len() <= in_memory {
                take(run)?;
            } else {
                let mut frames = run.camera.iter().copied().peekable();
                for first in (0..run.len()).step_by(PART) {
                    let ticks = first..(first + PART).min(run.len());
                    let mut part = run.part(ticks.clone(), Columns::ALL);
                    while let Some(frame) = frames.next_if(|f| f.tick < ticks.end) {
                        part.camera.push(super::CameraSample { tick: frame.tick - first, ..frame });
                    }
                    take(part)?;
                }
            }
        } else {
            super::read::in_parts(path, PART, &mut take)?;
        }
        let path = path.to_owned();
        match (whole, file) {
            (Some(run), _) => Ok(Self { name, path, ..Self::from(Cow::Owned(run)) }),
            (None, Some(file)) => {
                let middle = steps.len() / 2;
                let tick_s = (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1);
                let layout = file.part(0..0, Columns::ALL).map_err(|e| RunError::io(&path, &e))?;
                Ok(Self { name, path, layout, tick_s, camera, failure: OnceLock::new(), store: Store::File(file) })
            }
            (None, None) => Err(RunError::new(&path, "has a header but no ticks", "log at least one line")),
        }
    }
}

fn no_room(path: &Path, error: &std::io::Error) -> RunError {
    let hint = "make room for 8 bytes a number of the log in the folder of temporary files, or set TMPDIR to another";
    RunError::new(path, format!("cannot be laid out in a temporary file: {error}"), hint)
}

impl Log<'_> {
    /// Number of ticks.
    pub fn len(&self) -> usize {
        match &self.store {
            Store::Memory(run) => run.len(),
            Store::File(file) => file.len(),
        }
    }

    /// Whether it has no tick.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Which columns it has, as a run without ticks.
    pub fn layout(&self) -> &Run {
        &self.layout
    }

    /// Median distance of two ticks, s, of a long log over its first quarter of a million; `None` for fewer than two.
    pub fn tick_s(&self) -> Option<f64> {
        self.tick_s
    }

    /// Its camera frames.
    pub fn camera(&self) -> &[Seen] {
        &self.camera
    }

    /// Some ticks of some columns, counted from the first of them, without the camera's frames. Should the temporary
    /// file not be readable any more, [`Log::failure`] says so, and the ticks are evenly spaced and without samples.
    pub fn part(&self, ticks: Range<usize>, columns: Columns) -> Run {
        let count = ticks.len();
        let mut run = match &self.store {
            Store::Memory(run) => run.part(ticks, columns),
            Store::File(file) => file.part(ticks, columns).unwrap_or_else(|e| {
                self.failure.get_or_init(|| {
                    RunError::new(&self.path, format!("its temporary file cannot be read: {e}"), "check the medium")
                });
                self.layout.blank(count, self.tick_s.unwrap_or(1.0), columns)
            }),
        };
        run.name.clone_from(&self.name);
        run
    }

    /// Why ticks could not be read again, if that ever happened: whatever was made of them is worth nothing.
    pub fn failure(&self) -> Option<&RunError> {
        self.failure.get()
    }

    /// Does it fit the robot it is said to come from? See [`Run::check`].
    ///
    /// # Errors
    /// As [`Run::check`].
    pub fn check(&self, robot: &Robot) -> Result<(), RunError> {
        let file = match &self.store {
            Store::Memory(run) => return run.check(robot, &self.path),
            Store::File(file) => file,
        };
        let columns = Columns { counts: true, supply: true, ..Columns::NONE };
        for first in (0..file.len()).step_by(PART) {
            // With enough of the ticks before to hold a sample.
            let first = first.saturating_sub(PART / 16);
            let part = self.part(first..(first + PART + PART / 16).min(file.len()), columns);
            part.check_from(first, robot, &self.path)?;
        }
        self.failure().cloned().map_or(Ok(()), Err)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A log of more than one part, whose counters begin late, miss samples, and see a camera now and then.
    fn text() -> String {
        let mut text = "t,enc_1,enc_2,duty_1,duty_2,note,cam_x,cam_y,cam_theta\n".to_owned();
        for k in 0..PART + 3000 {
            let count =
                |wheel: usize| if k < 5 || k % (7 + wheel) == 0 { String::new() } else { (k * wheel).to_string() };
            let duty = if k % 11 == 0 { String::new() } else { format!("0.{:03}", k % 997) };
            let camera = if k % 17 == 3 { format!("{k},0.5,-1") } else { ",,".to_owned() };
            text += &format!("{}.{:03},{},{},{duty},0.5,a,{camera}\n", k / 1000, k % 1000, count(1), count(2));
        }
        text
    }

    fn write(text: &str) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.csv");
        std::fs::write(&path, text).unwrap();
        (folder, path)
    }

    #[test]
    fn a_log_in_a_file_has_what_a_run_has() {
        let (_folder, path) = write(&text());
        let run = Run::read(&path).unwrap();
        let (here, there) =
            (Log::read(&path, None, usize::MAX, &mut None).unwrap(), Log::read(&path, None, 0, &mut None).unwrap());
        assert!(matches!(there.store, Store::File(_)) && matches!(here.store, Store::Memory(_)));
        assert_eq!((there.len(), there.tick_s()), (run.len(), run.tick_s()));
        assert_eq!((here.camera(), there.camera()), (&seen(&run, 0).collect::<Vec<_>>()[..], here.camera()));
        let bits = |run: &Run| {
            let reals: Vec<Vec<u64>> =
                run.reals().iter().map(|column| column.iter().map(|x| x.to_bits()).collect()).collect();
            (reals, run.counts.clone(), run.count_gaps.clone())
        };
        let few = Columns { counts: true, ..Columns::NONE };
        for (ticks, columns) in [
            (0..run.len(), Columns::ALL),
            (PART - 20..PART + 30, Columns::ALL),
            (3..40, few),
            (PART..PART, few),
            (PART + 7..PART + 2999, Columns { duty: true, ..Columns::NONE }),
        ] {
            let expected = bits(&run.part(ticks.clone(), columns));
            assert_eq!(bits(&here.part(ticks.clone(), columns)), expected, "{ticks:?}");
            assert_eq!(bits(&there.part(ticks.clone(), columns)), expected, "{ticks:?}");
        }
        assert_eq!(there.failure(), None);
    }

    #[test]
    fn faults_of_a_later_part_are_told_with_line_column_and_field() {
        let good = text();
        let lines: Vec<&str> = good.lines().collect();
        let line = PART + 2000;
        let swap = |with: &str| {
            let mut lines = lines.clone();
            lines[line - 1] = with;
            lines.join("\r\n") + "\r\n"
        };
        let t = lines[line - 1].split(',').next().unwrap();
        for (with, field) in [
            (format!("{t},1,2,x,0.5,a,,,"), "duty_1"),
            ("0.5,1,2,0.1,0.5,a,,,".to_owned(), "t"),
            (format!("{t},1.5,2,0.1,0.5,a,,,"), "enc_1"),
            (format!("{t},1,2,0.1,0.5,a,1,,"), "cam_x, cam_y, cam_theta"),
            (format!("{t},1,2"), ""),
        ] {
            let (_folder, path) = write(&swap(&with));
            let expected = Run::read(&path).unwrap_err();
            assert_eq!((expected.line, expected.field.as_str()), (u32::try_from(line).ok(), field));
            for in_memory in [0, 1000, usize::MAX] {
                assert_eq!(Log::read(&path, None, in_memory, &mut None).unwrap_err(), expected);
            }
        }
        let jump = swap(&format!("{t},90000000,2,0.1,0.5,a,,,"));
        let (_folder, path) = write(&jump);
        let robot = Robot { support: crate::robot::Support::Blocks, ..Robot::racbot() }.first_axes(2);
        let expected = Run::read(&path).unwrap().check(&robot, &path).unwrap_err();
        assert_eq!(expected.line, u32::try_from(line).ok());
        assert_eq!(Log::read(&path, None, 0, &mut None).unwrap().check(&robot).unwrap_err(), expected);
    }
}
