//! Small changes of the source of `fixed-kin` and `driver`, one at a time, and whether the crate's own tests notice: writes
//! `docs/measured/mutation.md`.
//!
//! ```sh
//! cargo bench -p testbench --bench mutation -- [COUNT [SEED]] [CRATE ...]
//! ```
//!
//! The changes are drawn by a seed among all places where an operator, a bound or a truth value can be another; each is
//! made in a copy of the repository with a build folder of its own, so that only one crate is built again. A change that
//! survives is either one that makes no difference, or a test that is missing. The table is written after every change, so
//! that a campaign may be stopped at any time; with a folder in `RACBOT_SCRATCH` the next one finds everything built.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use testbench::repository;

/// Changes that are tried.
const COUNT: usize = 40;
/// Tests that take longer than this hang: noticed.
const PATIENCE: Duration = Duration::from_secs(900);
const CRATES: [&str; 2] = ["fixed-kin", "driver"];
/// What becomes of what.
const CHANGES: [(&str, &str); 21] = [
    (" + ", " - "),
    (" - ", " + "),
    (" < ", " <= "),
    (" <= ", " < "),
    (" > ", " >= "),
    (" >= ", " > "),
    (" == ", " != "),
    (" != ", " == "),
    (" && ", " || "),
    (" || ", " && "),
    (" & ", " | "),
    (" | ", " & "),
    (" << ", " >> "),
    (" += ", " -= "),
    (".min(", ".max("),
    (".max(", ".min("),
    ("wrapping_add(", "wrapping_sub("),
    ("wrapping_sub(", "wrapping_add("),
    ("saturating_sub(", "wrapping_sub("),
    ("true", "false"),
    ("false", "true"),
];

/// One change: file, line from 0, column, and which of [`CHANGES`].
#[derive(Clone, Debug)]
struct Site {
    package: &'static str,
    file: PathBuf,
    line: usize,
    column: usize,
    change: usize,
}

#[derive(Default)]
struct Tally {
    tried: usize,
    noticed: usize,
    no_program: usize,
    survivors: Vec<String>,
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> =
        fs::read_dir(folder).expect("a folder").map(|e| e.expect("an entry").path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") && path.file_name().is_some_and(|name| name != "tests.rs")
        {
            found.push(path);
        }
    }
}

/// Places in code that is no test, no comment, no attribute and no text.
fn sites(root: &Path, crates: &[&'static str]) -> Vec<Site> {
    let mut found = Vec::new();
    for package in crates.iter().copied() {
        let mut files = Vec::new();
        sources(&root.join(package).join("src"), &mut files);
        for file in files {
            let text = fs::read_to_string(&file).expect("a source");
            let code = text.split("#[cfg(test)]").next().unwrap_or_default();
            for (line, content) in code.lines().enumerate() {
                let start = content.trim_start();
                let bound =
                    ["impl", "pub trait", "where", "use ", "//", "#", "const fn"].iter().any(|w| start.starts_with(w));
                let end = content.find("//").unwrap_or(content.len());
                for (change, (from, _)) in CHANGES.iter().enumerate() {
                    let places = content[..end].match_indices(from).map(|(column, _)| column);
                    let outside = places.filter(|column| content[..*column].matches('"').count() % 2 == 0);
                    found.extend(outside.filter(|_| !bound).map(|column| Site {
                        package,
                        file: file.strip_prefix(root).expect("below the root").to_owned(),
                        line,
                        column,
                        change,
                    }));
                }
            }
        }
    }
    found
}

/// The text with the change made, and the line as it was and as it is.
fn changed(text: &str, site: &Site) -> (String, [String; 2]) {
    let (from, to) = CHANGES[site.change];
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let before = lines[site.line].clone();
    lines[site.line].replace_range(site.column..site.column + from.len(), to);
    let pair = [before.trim().to_owned(), lines[site.line].trim().to_owned()];
    (lines.join("\n") + "\n", pair)
}

/// Copies what git knows of the repository.
fn copy_of(from: &Path, to: &Path) {
    let listed = Command::new("git").args(["ls-files", "-z"]).current_dir(from).output().expect("git lists files");
    for name in String::from_utf8(listed.stdout).expect("names").split('\0').filter(|name| !name.is_empty()) {
        let target = to.join(name);
        fs::create_dir_all(target.parent().expect("a folder")).expect("a folder");
        // A file that was deleted and not yet committed is none.
        if from.join(name).is_file() {
            fs::copy(from.join(name), target).expect("a copy");
        }
    }
}

/// Whether the command ends well in time.
fn succeeds(command: &mut Command) -> bool {
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("cargo");
    let begin = Instant::now();
    loop {
        if let Some(status) = child.try_wait().expect("a child") {
            return status.success();
        }
        if begin.elapsed() > PATIENCE {
            let _ = child.kill();
            let _ = child.wait();
            return false;
        }
        std::thread::sleep(Duration::from_millis(200));
    }
}

fn main() {
    let numbers: Vec<u64> = std::env::args().skip(1).filter_map(|text| text.parse().ok()).collect();
    let (count, seed) = (numbers.first().map_or(COUNT, |n| *n as usize), numbers.get(1).copied().unwrap_or(1));
    let scratch = tempfile::tempdir().expect("a temporary folder");
    let folder = std::env::var_os("RACBOT_SCRATCH").map_or(scratch.path().to_owned(), PathBuf::from);
    let (root, target) = (folder.join("tree"), folder.join("target"));
    copy_of(&repository(), &root);
    let cargo = |package: &str, more: &[&str]| {
        let mut command = Command::new(env!("CARGO"));
        let crates = ["test", "-q", "--release", "--offline", "--lib", "--tests", "-p", package];
        command.args(crates).args(more).current_dir(&root).env("CARGO_TARGET_DIR", &target);
        // A test that writes its figures down notices nothing of them.
        command.env_remove("RACBOT_MEASURED").env_remove("RACBOT_MEASURED_DIR");
        command
    };
    let named: Vec<&'static str> =
        CRATES.into_iter().filter(|name| std::env::args().any(|argument| argument == *name)).collect();
    let crates = if named.is_empty() { CRATES.to_vec() } else { named };
    let all = sites(&root, &crates);
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let chosen: Vec<Site> = (0..count).map(|_| all[random.random_range(0..all.len())].clone()).collect();
    for package in CRATES.into_iter().filter(|package| chosen.iter().any(|site| site.package == *package)) {
        assert!(succeeds(&mut cargo(package, &[])), "{package} fails its tests as it is");
    }
    let mut tallies: BTreeMap<PathBuf, Tally> = BTreeMap::new();
    for (number, site) in chosen.iter().enumerate() {
        let path = root.join(&site.file);
        let text = fs::read_to_string(&path).expect("a source");
        let (mutant, [before, after]) = changed(&text, site);
        fs::write(&path, mutant).expect("a source");
        let tally = tallies.entry(site.file.clone()).or_default();
        tally.tried += 1;
        let verdict = if !succeeds(&mut cargo(site.package, &["--no-run"])) {
            tally.no_program += 1;
            "no program"
        } else if succeeds(&mut cargo(site.package, &[])) {
            tally.survivors.push(format!("line {}: `{after}` for `{before}`", site.line + 1).replace('|', "\\|"));
            "SURVIVES"
        } else {
            tally.noticed += 1;
            "noticed"
        };
        println!("{}/{count} {}:{}: {after}: {verdict}", number + 1, site.file.display(), site.line + 1);
        fs::write(&path, text).expect("a source");
        write(&tallies, [number + 1, all.len()], &crates, seed);
    }
}

/// The table of what was tried so far.
fn write(tallies: &BTreeMap<PathBuf, Tally>, [tried, possible]: [usize; 2], crates: &[&str], seed: u64) {
    let rows: Vec<Vec<String>> = tallies
        .iter()
        .map(|(file, t)| {
            let counts = [t.tried, t.no_program, t.noticed].map(|n| n.to_string());
            [vec![file.display().to_string()], counts.to_vec(), vec![t.survivors.join("; ")]].concat()
        })
        .collect();
    let title = format!(
        "{tried} of {possible} possible small changes of {}, seed {seed}, against the tests of their crate",
        crates.join(" and ")
    );
    let table = measured::Table {
        name: "mutation",
        title: &title,
        command: "cargo bench -p testbench --bench mutation",
        columns: &["file", "changes", "no program", "noticed", "survived"],
    };
    table.write(&rows);
}
