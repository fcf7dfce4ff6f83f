//! Several logs in one go: which files are logs, which second file belongs to which, and what their runs are called.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::Map;
use super::truth::{filled, folder, stem};
use crate::error::InputError;

/// A log that becomes a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Drive {
    /// The robot's own recording.
    pub log: PathBuf,
    /// The second file, where one was asked for; else the map names it.
    pub truth: Option<PathBuf>,
    /// The run's file.
    pub run: PathBuf,
}

impl Drive {
    /// The run's file of one recording of several.
    pub fn run_of(&self, recording: &str) -> PathBuf {
        let plain = |c: char| if c.is_alphanumeric() || c == '-' { c } else { '_' };
        let name: String = recording.chars().map(plain).collect();
        self.run.with_file_name(format!("{}_{name}.csv", stem(&self.run)))
    }
}

/// What becomes of `files`, each a log or a folder of logs, in a folder of runs. A run is called as its log, after its
/// folder, too, where several logs are called alike; the second file of another is no log. `truth` is a pattern as the
/// map's `truth.file`, but from here.
///
/// # Errors
/// [`InputError`] for folders that cannot be read, a pattern that a log does not fill, and logs whose runs would have
/// one name.
pub fn drives(map: &Map, files: &[PathBuf], truth: Option<&str>, runs: &Path) -> Result<Vec<Drive>, InputError> {
    let mut logs: Vec<PathBuf> = Vec::new();
    for file in files {
        if file.is_dir() { logs.extend(files_of(file)?) } else { logs.push(file.clone()) }
    }
    let named = |log: &Path| truth.map(|pattern| filled(pattern, log).map(PathBuf::from)).transpose();
    let second = |log: &Path| named(log).ok().flatten().or_else(|| map.truth_of(log));
    let seconds: BTreeSet<PathBuf> = logs.iter().filter_map(|log| second(log)?.canonicalize().ok()).collect();
    logs.retain(|log| log.canonicalize().map_or(true, |log| !seconds.contains(&log)));
    let mut alike: BTreeMap<String, usize> = BTreeMap::new();
    logs.iter().for_each(|log| *alike.entry(stem(log)).or_default() += 1);
    let mut taken: BTreeMap<String, PathBuf> = BTreeMap::new();
    let mut drives = Vec::new();
    for log in logs {
        let stem = stem(&log);
        let name = match folder(&log) {
            Some(folder) if alike[&stem] > 1 => format!("{folder}_{stem}"),
            _ => stem,
        };
        if let Some(other) = taken.insert(name.clone(), log.clone()) {
            let what = format!("its run would be called {name}.csv, as that of {}", other.display());
            return Err(InputError::new(&log, what, "give the two in calls of their own, or rename one"));
        }
        let truth = named(&log).map_err(|e| InputError { file: log.clone(), ..e.field("--truth") })?;
        drives.push(Drive { run: runs.join(format!("{name}.csv")), log, truth });
    }
    Ok(drives)
}

/// The files of a folder by name, without hidden ones.
fn files_of(folder: &Path) -> Result<Vec<PathBuf>, InputError> {
    let entries = std::fs::read_dir(folder).map_err(|e| InputError::io(folder, &e))?;
    let visible =
        |path: &PathBuf| path.is_file() && !path.file_name().is_some_and(|n| n.to_string_lossy().starts_with('.'));
    let mut files: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).filter(visible).collect();
    files.sort();
    if files.is_empty() {
        return Err(InputError::new(folder, "holds no file", "give the folder of the logs, or the logs"));
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn made(files: &[&str], given: &[&str], truth: Option<&str>) -> Result<Vec<[String; 2]>, String> {
        let folder = tempfile::tempdir().unwrap();
        let here = |file: &str| folder.path().join(file);
        for file in files {
            std::fs::create_dir_all(here(file).parent().unwrap()).unwrap();
            std::fs::write(here(file), "").unwrap();
        }
        let map = Map::parse("[truth]\nfile = \"{stem}_mocap.csv\"", Path::new("map.toml")).unwrap();
        let given: Vec<PathBuf> = given.iter().map(|file| here(file)).collect();
        let plain = |path: &Path| path.strip_prefix(folder.path()).unwrap_or(path).display().to_string();
        let all = drives(&map, &given, truth, Path::new("set")).map_err(|e| e.to_string())?;
        Ok(all.iter().map(|d| [plain(&d.log), d.run.display().to_string()]).collect())
    }

    #[test]
    fn runs_are_called_as_their_logs_and_second_files_are_none() {
        let files = ["in/a.csv", "in/a_mocap.csv", "in/b.csv", "in/.hidden", "x/odom.csv", "y/odom.csv"];
        let two = [["in/a.csv", "set/a.csv"], ["in/b.csv", "set/b.csv"]].map(|p| p.map(str::to_owned));
        assert_eq!(made(&files, &["in"], None).unwrap(), two);
        assert_eq!(made(&files, &["in/a.csv", "in/a_mocap.csv", "in/b.csv"], None).unwrap(), two);
        let alike = made(&files, &["x/odom.csv", "y/odom.csv"], None).unwrap();
        assert_eq!(alike.into_iter().map(|[_, run]| run).collect::<Vec<_>>(), ["set/x_odom.csv", "set/y_odom.csv"]);
        let twice = made(&files, &["in/a.csv", "in/a.csv"], None).unwrap_err();
        assert!(twice.contains("would be called in_a.csv, as that of"), "{twice}");
        let numbered = made(&files, &["in/a.csv"], Some("take{number}.csv")).unwrap_err();
        assert!(numbered.contains("in/a.csv: --truth: \"a\" has no number"), "{numbered}");
    }
}
