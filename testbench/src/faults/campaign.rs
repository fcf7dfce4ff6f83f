//! Thousands of drives, one fault each.

use super::judge::{Course, Injected};
use super::{BusFault, Cable, Outcome, RigFault, Trouble, Verdict};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// A line of the table.
#[derive(Clone, Debug)]
pub struct Line {
    /// What was broken.
    pub fault: &'static str,
    /// What became of every drive.
    pub cases: Vec<Verdict>,
}

impl Line {
    /// Cases with this outcome.
    #[must_use]
    pub fn count(&self, outcome: Outcome) -> usize {
        self.cases.iter().filter(|verdict| verdict.outcome == Ok(outcome)).count()
    }

    /// Cases after which the card could be armed again.
    #[must_use]
    pub fn armed_again(&self) -> usize {
        self.cases.iter().filter(|verdict| verdict.armed_again).count()
    }

    /// What should not have been.
    pub fn violations(&self) -> impl Iterator<Item = &str> {
        self.cases.iter().filter_map(|verdict| verdict.outcome.as_ref().err().map(String::as_str))
    }

    /// Longest time from fault to outputs off.
    #[must_use]
    pub fn slowest(&self) -> Option<Duration> {
        self.cases.iter().filter_map(|verdict| verdict.off_after).max()
    }
}

type Draw = fn(&Course, &mut ChaCha8Rng, u64) -> Injected;

/// Name, cases at size 1, and how the case of a number is drawn.
const FAULTS: [(&str, u64, Draw); 20] = [
    ("read: a bit flipped", 600, |c, r, i| read(c, r, i, |r| Trouble::Flip(r.random_range(0..32)))),
    ("read: lost, answered with zero", 300, |c, r, i| read(c, r, i, |_| Trouble::Drop)),
    ("read: made twice", 300, |c, r, i| read(c, r, i, |_| Trouble::Repeat)),
    ("read: answered late, with the word before", 300, |c, r, i| read(c, r, i, |_| Trouble::Delay)),
    ("write: a bit flipped", 600, |c, r, i| write(c, r, i, |r| Trouble::Flip(r.random_range(0..32)))),
    ("write: lost", 300, |c, r, i| write(c, r, i, |_| Trouble::Drop)),
    ("write: made twice", 300, |c, r, i| write(c, r, i, |_| Trouble::Repeat)),
    ("write: late, after the next", 300, |c, r, i| write(c, r, i, |_| Trouble::Delay)),
    ("every write lost from then on", 60, |c, r, _| Injected::Bus(BusFault::WritesFrom(c.write(r), Trouble::Drop))),
    ("every write flipped from then on", 60, |c, r, _| {
        Injected::Bus(BusFault::WritesFrom(c.write(r), Trouble::Flip(r.random_range(0..24))))
    }),
    ("bus errors for 1 to 40 transfers, then none", 300, |c, r, _| {
        Injected::Bus(BusFault::ErrorsFrom(c.any(r), r.random_range(1..=40)))
    }),
    ("card gone, reads all ones", 100, |c, r, _| Injected::Bus(BusFault::GoneFrom(c.any(r)))),
    ("process killed", 500, |c, r, i| {
        // Every transfer of the preparations and of the first ticks, then anywhere.
        let at = if i < c.armed_after + 60 { i } else { c.any(r) };
        Injected::Bus(BusFault::KilledFrom(at))
    }),
    ("host asleep for up to 45 ms", 100, |c, r, _| {
        let time = Duration::from_micros(r.random_range(1_000..45_000));
        Injected::Rig(c.moment(r), RigFault::Stall(time))
    }),
    ("host asleep for 55 ms to 1 s", 100, |c, r, _| {
        let time = Duration::from_micros(r.random_range(55_000..1_000_000));
        Injected::Rig(c.moment(r), RigFault::Stall(time))
    }),
    ("encoder: line cut, swapped, shorted, crossed", 360, |c, r, i| {
        let cable = [Cable::Cut, Cable::Swapped, Cable::Shorted, Cable::Crossed][(i % 4) as usize];
        Injected::Rig(c.moment(r), RigFault::Cable((i / 4 % 3) as usize, cable))
    }),
    ("wheel blocked, or both lines of an encoder cut", 120, |c, r, i| {
        Injected::Rig(c.moment(r), RigFault::Cable((i % 3) as usize, Cable::Silent))
    }),
    ("emergency stop pressed", 60, |c, r, _| Injected::Rig(c.moment(r), RigFault::EmergencyStop)),
    ("camera gone", 60, |c, r, _| Injected::Rig(c.moment(r), RigFault::CameraGone)),
    ("card's clock off by 25 %", 60, |c, r, i| {
        Injected::Rig(c.moment(r), RigFault::Clock(if i.is_multiple_of(2) { 0.75 } else { 1.25 }))
    }),
];

impl Course {
    /// Some transfer of the drive.
    fn any(&self, random: &mut impl Rng) -> u64 {
        random.random_range(0..self.transfers.0 + self.transfers.1)
    }

    fn write(&self, random: &mut impl Rng) -> u64 {
        random.random_range(0..self.transfers.1)
    }

    /// Some time of the drive, from after arming to before the last stretch.
    fn moment(&self, random: &mut impl Rng) -> Duration {
        self.time.mul_f64(random.random_range(0.05..0.7))
    }
}

/// The first reads of a drive one by one, then any.
fn read(course: &Course, random: &mut ChaCha8Rng, case: u64, trouble: fn(&mut ChaCha8Rng) -> Trouble) -> Injected {
    let at = if case < 200 { case } else { random.random_range(0..course.transfers.0) };
    Injected::Bus(BusFault::Read(at, trouble(random)))
}

/// The first writes of a drive one by one, then any.
fn write(course: &Course, random: &mut ChaCha8Rng, case: u64, trouble: fn(&mut ChaCha8Rng) -> Trouble) -> Injected {
    let at = if case < 120 { case } else { random.random_range(0..course.transfers.1) };
    Injected::Bus(BusFault::Write(at, trouble(random)))
}

/// Runs the campaign on all cores: `size` times the cases that the table names.
///
/// # Errors
/// A drive without a fault that does not work.
pub fn run(seed: u64, size: f64) -> Result<Vec<Line>, String> {
    let course = Course::new()?;
    let threads = std::thread::available_parallelism().map_or(2, usize::from);
    let mut lines = Vec::new();
    for (number, (fault, cases, draw)) in FAULTS.into_iter().enumerate() {
        let cases = ((cases as f64 * size) as u64).max(1);
        let next = AtomicUsize::new(0);
        let work = || {
            let mut done = Vec::new();
            loop {
                let case = next.fetch_add(1, Ordering::Relaxed) as u64;
                if case >= cases {
                    return done;
                }
                // A case's draws do not depend on who computes it.
                let mut random = ChaCha8Rng::seed_from_u64(seed);
                random.set_stream((number as u64) << 32 | case);
                let injected = draw(&course, &mut random, case);
                let mut verdict = course.judge(injected, random.random(), case.is_multiple_of(2));
                verdict.outcome = verdict.outcome.map_err(|why| format!("{injected:?}: {why}"));
                done.push((case, verdict));
            }
        };
        let mut done: Vec<(u64, Verdict)> = std::thread::scope(|scope| {
            let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
            workers.into_iter().flat_map(|worker| worker.join().unwrap_or_default()).collect()
        });
        if done.len() as u64 != cases {
            return Err(format!("{fault}: a drive panicked, {} of {cases} cases came back", done.len()));
        }
        done.sort_by_key(|(case, _)| *case);
        lines.push(Line { fault, cases: done.into_iter().map(|(_, verdict)| verdict).collect() });
    }
    Ok(lines)
}

/// Headings of [`rows`].
pub const COLUMNS: [&str; 9] = [
    "fault",
    "cases",
    "drove as commanded",
    "refused or ended, off, cause named",
    "off by watchdog",
    "over before noticed",
    "off after, at most, ms",
    "armed again once the cause is gone",
    "violations",
];

/// The campaign as a table, a row a fault and one for all.
#[must_use]
pub fn rows(lines: &[Line]) -> Vec<Vec<String>> {
    let outcomes = [Outcome::Drove, Outcome::Ended, Outcome::Watchdog, Outcome::Unnoticed];
    let row = |name: &str, lines: &[Line], slowest: Option<Duration>| {
        let total = |count: &dyn Fn(&Line) -> usize| lines.iter().map(count).sum::<usize>().to_string();
        let mut row = vec![name.to_owned(), total(&|line| line.cases.len())];
        row.extend(outcomes.map(|outcome| total(&|line| line.count(outcome))));
        row.push(slowest.map_or_else(String::new, |time| time.as_millis().to_string()));
        row.push(total(&Line::armed_again));
        row.push(total(&|line| line.violations().count()));
        row
    };
    let mut rows: Vec<_> =
        lines.iter().map(|line| row(line.fault, std::slice::from_ref(line), line.slowest())).collect();
    rows.push(row("all", lines, None));
    rows
}
