//! The ring and its thread.

use super::Sample;
use fixed_kin::AXES;
use rtrb::{Consumer, Producer, PushError, RingBuffer};
use runs::output::Existing;
use runs::{Layout, RunStream, create};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// Ticks that the ring holds: four seconds at 1 kHz, for a medium that stalls.
pub const RING_SAMPLES: usize = 4_096;
/// At most so much of a drive is lost when the process is killed.
pub const FLUSH_EVERY: Duration = Duration::from_millis(100);
/// How often the thread looks into the ring.
const LOOK_EVERY: Duration = Duration::from_millis(10);

/// A recording that could not be made.
#[derive(Debug, thiserror::Error)]
#[error("{}: {cause}; choose another file for the recording", .file.display())]
pub struct RecordingError {
    /// Where the recording goes.
    pub file: PathBuf,
    /// What the system answered.
    pub cause: io::Error,
}

/// What became of a recording.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recorded {
    /// Where the recording goes.
    pub file: PathBuf,
    /// Rows written, gaps not counted.
    pub ticks: u64,
    /// Ticks that found the ring full and are not in it.
    pub lost: u64,
}

#[derive(Debug, Default)]
struct Shared {
    flushed: AtomicU64,
    finished: AtomicBool,
}

/// A run on its way to a file; belongs to the control loop.
#[derive(Debug)]
pub struct Recording {
    file: PathBuf,
    ring: Producer<Sample>,
    lost: u64,
    patient: bool,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<io::Result<u64>>>,
}

impl Recording {
    /// Creates the file, MCAP where its name ends in `.mcap`, else CSV, and starts the thread. To be
    /// called before the loop takes its rights, so that the thread does not inherit them. The file grows under
    /// its name: what was flushed is there whatever becomes of the process.
    ///
    /// # Errors
    /// [`RecordingError`] where the file cannot be created, or exists and is to stay.
    pub fn start(file: &Path, layout: Layout, existing: Existing) -> Result<Self, RecordingError> {
        Self::start_of(file, layout, existing, None)
    }

    /// The same with the text of the robot's `robot.toml` in the file, where that is an MCAP.
    ///
    /// # Errors
    /// As [`Recording::start`].
    pub fn start_of(
        file: &Path,
        layout: Layout,
        existing: Existing,
        robot: Option<&str>,
    ) -> Result<Self, RecordingError> {
        let fail = |cause: io::Error| RecordingError { file: file.to_owned(), cause };
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let start_ns = u64::try_from(now.as_nanos()).unwrap_or(0);
        let mut stream = create(file, layout, start_ns, existing).map_err(fail)?;
        if let Some(robot) = robot {
            stream.attach("robot.toml", robot).map_err(fail)?;
        }
        Self::onto(stream, file, layout.counts).map_err(fail)
    }

    /// The same onto any stream; `file` is its name.
    ///
    /// # Errors
    /// A system without threads to spare.
    pub fn onto(stream: Box<dyn RunStream>, file: &Path, wheels: usize) -> io::Result<Self> {
        let (ring, consumer) = RingBuffer::new(RING_SAMPLES);
        let shared = Arc::new(Shared::default());
        let writer = Writer { stream, wheels: wheels.min(AXES), ring: consumer, shared: Arc::clone(&shared) };
        let thread = std::thread::Builder::new().name("recording".to_owned()).spawn(move || writer.run())?;
        Ok(Self { file: file.to_owned(), ring, lost: 0, patient: false, shared, thread: Some(thread) })
    }

    /// From now on a full ring is waited for: for loops that do not run in real time.
    pub fn wait_where_full(&mut self) {
        self.patient = true;
    }

    /// Hands a tick over; where the ring is full it is counted as lost. Neither waits nor allocates.
    pub fn push(&mut self, sample: Sample) {
        let Err(PushError::Full(sample)) = self.ring.push(sample) else { return };
        if !self.patient || !self.waited_for(sample) {
            self.lost += 1;
        }
    }

    /// Waits for the thread to make room; not where it has ended, for a full medium say.
    fn waited_for(&mut self, sample: Sample) -> bool {
        while let Some(thread) = self.thread.as_ref().filter(|thread| !thread.is_finished()) {
            thread.thread().unpark();
            std::thread::sleep(Duration::from_micros(100));
            if self.ring.push(sample).is_ok() {
                return true;
            }
        }
        false
    }

    /// Ticks lost so far.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// Ticks that a kill can no longer take away.
    #[must_use]
    pub fn flushed(&self) -> u64 {
        self.shared.flushed.load(Ordering::Acquire)
    }

    /// Writes what is left and completes the file.
    ///
    /// # Errors
    /// [`RecordingError`] where the medium failed, now or before.
    pub fn finish(mut self) -> Result<Recorded, RecordingError> {
        let ended = self.end().unwrap_or_else(|| Err(io::Error::other("its thread is gone")));
        let file = std::mem::take(&mut self.file);
        match ended {
            Ok(ticks) => Ok(Recorded { file, ticks, lost: self.lost }),
            Err(cause) => Err(RecordingError { file, cause }),
        }
    }

    fn end(&mut self) -> Option<io::Result<u64>> {
        self.shared.finished.store(true, Ordering::Release);
        let thread = self.thread.take()?;
        thread.thread().unpark();
        Some(thread.join().unwrap_or_else(|_| Err(io::Error::other("its thread panicked"))))
    }
}

impl Drop for Recording {
    fn drop(&mut self) {
        // A panic unwinds through here: the file is completed all the same.
        let _ = self.end();
    }
}

/// The thread's side.
struct Writer {
    stream: Box<dyn RunStream>,
    wheels: usize,
    ring: Consumer<Sample>,
    shared: Arc<Shared>,
}

impl Writer {
    fn run(mut self) -> io::Result<u64> {
        let (mut taken, mut flushed_at) = (0, Instant::now());
        let mut counts = [None; AXES];
        loop {
            // Read before the ring is emptied: what was pushed before the end is then seen.
            let finished = self.shared.finished.load(Ordering::Acquire);
            while let Ok(sample) = self.ring.pop() {
                self.stream.tick(&sample.tick(self.wheels, &mut counts))?;
                taken += 1;
            }
            if finished {
                self.stream.finish()?;
                self.shared.flushed.store(taken, Ordering::Release);
                return Ok(taken);
            }
            if flushed_at.elapsed() >= FLUSH_EVERY {
                self.stream.flush()?;
                self.shared.flushed.store(taken, Ordering::Release);
                flushed_at = Instant::now();
            }
            std::thread::park_timeout(LOOK_EVERY);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use runs::{Run, RunStream, Tick};

    fn sample(tick: u32) -> Sample {
        let k = f64::from(tick);
        Sample {
            t: k * 1e-3,
            command: [k, 0.0, -k],
            counts: [i64::from(tick); AXES],
            supply_v: 7.2,
            ..Sample::default()
        }
    }

    #[test]
    fn every_tick_reaches_the_file_in_order() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["run.csv", "run.mcap"] {
            let path = folder.path().join(name);
            let mut recording = Recording::start(&path, Layout::of_robot(3, true), Existing::Refuse).unwrap();
            for tick in 0..3_000 {
                recording.push(sample(tick));
            }
            let recorded = recording.finish().unwrap();
            assert_eq!((recorded.ticks, recorded.lost), (3_000, 0));
            let run = Run::read(&path).unwrap();
            assert_eq!((run.len(), run.wheel_count()), (3_000, 3));
            assert_eq!(run.counts[2][2_999], 2_999);
            assert_eq!(run.command.unwrap()[2][5], -5.0);
        }
    }

    #[test]
    fn what_was_flushed_is_readable_while_the_drive_goes_on() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.mcap");
        let mut recording = Recording::start(&path, Layout::of_robot(3, false), Existing::Refuse).unwrap();
        for tick in 0..500 {
            recording.push(sample(tick));
        }
        while recording.flushed() < 500 {
            assert!(recording.thread.as_ref().is_some_and(|thread| !thread.is_finished()), "nothing was flushed");
            std::thread::sleep(Duration::from_millis(5));
        }
        assert_eq!(Run::read(&path).unwrap().len(), 500);
    }

    #[test]
    fn a_patient_recording_loses_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.mcap");
        let mut recording = Recording::start(&path, Layout::of_robot(3, false), Existing::Refuse).unwrap();
        recording.wait_where_full();
        for tick in 0..4 * RING_SAMPLES as u32 {
            recording.push(sample(tick));
        }
        assert_eq!(recording.finish().unwrap().ticks, 4 * RING_SAMPLES as u64);
    }

    /// A medium that is full after some ticks.
    struct Full(u32);

    impl RunStream for Full {
        fn tick(&mut self, _: &Tick<'_>) -> io::Result<()> {
            self.0 = self.0.checked_sub(1).ok_or_else(|| io::Error::from(io::ErrorKind::StorageFull))?;
            Ok(())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
        fn finish(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_full_medium_stops_the_recording_and_not_the_loop() {
        let mut recording = Recording::onto(Box::new(Full(10)), Path::new("run.csv"), 3).unwrap();
        for tick in 0..2 * RING_SAMPLES as u32 {
            recording.push(sample(tick));
        }
        let message = recording.finish().unwrap_err().to_string();
        assert!(message.starts_with("run.csv: ") && message.contains("another file"), "{message}");
        assert!(Recording::start(Path::new("/nowhere/run.csv"), Layout::of_robot(3, false), Existing::Refuse).is_err());
    }
}
