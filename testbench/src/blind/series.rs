//! A series of sets: in parallel, within a time budget, every score kept as soon as it is known.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use super::{BlindError, Group, Plan, Report, Scored, Task};

/// How a plan is carried out.
#[derive(Debug, Clone, Default)]
pub struct Series {
    /// No set is begun after this time; `None` = all are tried.
    pub budget: Option<Duration>,
    /// File to which every score is added, a JSON object a line; what it holds already is not tried again.
    pub scores: Option<PathBuf>,
    /// Sets at a time; 0 = one a core.
    pub workers: usize,
}

/// Runs a plan; `done` is called after every set with the number done so far.
///
/// # Errors
/// [`BlindError`] if a set cannot be made, or the scores not be kept.
pub fn run(plan: &Plan, series: &Series, done: impl Fn(usize) + Sync) -> Result<Report, BlindError> {
    let began = Instant::now();
    let mut tasks = plan.tasks();
    // Every kind of set comes early: a series that is cut short says something of each.
    tasks.sort_by_key(|t| t.seed);
    let kept = series.scores.as_deref().map(read).transpose()?.unwrap_or_default();
    let file = series.scores.as_deref().map(append).transpose()?.map(Mutex::new);
    let (next, finished) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let results: Mutex<Vec<(usize, Scored)>> = Mutex::new(Vec::new());
    let worker = || -> Result<(), BlindError> {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(task) = tasks.get(index) else { return Ok(()) };
            let scored = match kept.get(&(task.group, task.seed)) {
                Some(scored) => scored.clone(),
                None if series.budget.is_some_and(|b| began.elapsed() > b) => continue,
                None => match scored_now(task, series.scores.as_deref(), file.as_ref()) {
                    // No set, no score: the report says how many of those planned it holds.
                    Err(BlindError::Truth(truth::Error::Diverged { .. })) => continue,
                    scored => scored?,
                },
            };
            lock(&results).push((index, scored));
            done(finished.fetch_add(1, Ordering::Relaxed) + 1);
        }
    };
    let workers = match series.workers {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        n => n,
    };
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..workers).map(|_| scope.spawn(worker)).collect();
        threads.into_iter().try_for_each(|t| t.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })?;
    let mut scored = results.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    scored.sort_by_key(|(index, _)| *index);
    Ok(Report { seed: plan.seed, planned: tasks.len(), scored: scored.into_iter().map(|s| s.1).collect() })
}

fn scored_now(task: &Task, path: Option<&Path>, file: Option<&Mutex<File>>) -> Result<Scored, BlindError> {
    let scored = task.run()?;
    if let (Some(path), Some(file)) = (path, file) {
        let line = serde_json::to_string(&scored).map_err(|e| wrong(path, &e))?;
        writeln!(lock(file), "{line}").map_err(|e| wrong(path, &e))?;
    }
    Ok(scored)
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

fn append(path: &Path) -> Result<File, BlindError> {
    OpenOptions::new().create(true).append(true).open(path).map_err(|e| wrong(path, &e))
}

/// Scores of an earlier series; a last line that was cut off is left out.
fn read(path: &Path) -> Result<HashMap<(Group, u64), Scored>, BlindError> {
    let mut out = HashMap::new();
    if !path.exists() {
        return Ok(out);
    }
    let lines: Vec<String> = BufReader::new(File::open(path).map_err(|e| wrong(path, &e))?)
        .lines()
        .collect::<Result<_, _>>()
        .map_err(|e| wrong(path, &e))?;
    for (number, line) in lines.iter().enumerate() {
        match serde_json::from_str::<Scored>(line) {
            Ok(scored) => drop(out.insert((scored.group, scored.seed), scored)),
            Err(_) if number + 1 == lines.len() => {}
            Err(error) => {
                return Err(wrong(path, &format!("line {}: {error}; delete the line or the file", number + 1)));
            }
        }
    }
    Ok(out)
}

fn wrong(path: &Path, why: &dyn std::fmt::Display) -> BlindError {
    BlindError::Scores { path: path.to_owned(), why: why.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_scored_is_not_tried_again() {
        let folder = tempfile::tempdir().unwrap();
        let series = Series { scores: Some(folder.path().join("scores.jsonl")), workers: 1, budget: None };
        let plan = Plan { effect_free: 1, ..Plan::new(5) };
        let first = run(&plan, &series, |_| ()).unwrap();
        let again = Series { budget: Some(Duration::ZERO), ..series.clone() };
        let second = run(&Plan { effect_free: 3, ..Plan::new(5) }, &again, |_| ()).unwrap();
        let seen = |r: &Report| r.scored.iter().map(|s| (s.seed, s.grade)).collect::<Vec<_>>();
        assert_eq!((second.planned, seen(&second)), (3, seen(&first)));
        std::fs::write(folder.path().join("scores.jsonl"), "nonsense\n{}\n").unwrap();
        let error = run(&plan, &series, |_| ()).unwrap_err().to_string();
        assert!(error.contains("line 1"), "{error}");
    }
}
