//! The structure of the repository: files that import each other in a circle, files that are too long, and what the
//! robot's own binary links.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use testbench::repository;

/// Crates whose files are looked at, by folder.
const CRATES: [&str; 14] = [
    "fixed-kin",
    "runs",
    "plot",
    "estimation",
    "bitstream",
    "model",
    "hdl",
    "driver",
    "links",
    "gap",
    "simulator",
    "ssl",
    "vision",
    "racbot",
];
/// Lines after which a file is more than one idea.
const LONGEST: usize = 800;
/// Half of all files are at most so long.
const MEDIAN: usize = 250;

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

/// Module path of a file below `src`: `a/b.rs` and `a/b/mod.rs` are `[a, b]`; the root is empty.
fn module(file: &Path) -> Vec<String> {
    let mut parts: Vec<String> = file.with_extension("").iter().map(|p| p.to_string_lossy().into_owned()).collect();
    if matches!(parts.last().map(String::as_str), Some("mod" | "lib" | "main")) {
        parts.pop();
    }
    parts
}

/// The text without comments and without its unit tests, which may look at anything.
fn code(text: &str) -> String {
    let text = text.split("#[cfg(test)]").next().unwrap_or_default();
    text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// Paths in the text that begin at the crate or above the file: `a::{b, c::d}` gives `a::b` and `a::c::d`.
fn paths(text: &str) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    for start in ["crate::", "super::"] {
        for (at, _) in text.match_indices(start) {
            let word_before = text[..at].chars().next_back().is_some_and(|c| c.is_alphanumeric() || "_:".contains(c));
            if !word_before {
                tree(&text[at..], &mut Vec::new(), &mut found);
            }
        }
    }
    found
}

/// One path or tree of paths from the start of the text; returns what follows it.
fn tree<'a>(mut text: &'a str, before: &mut Vec<String>, found: &mut Vec<Vec<String>>) -> &'a str {
    let depth = before.len();
    loop {
        let end = text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(text.len());
        let (word, rest) = text.split_at(end);
        if !word.is_empty() {
            before.push(word.to_owned());
        }
        text = rest;
        if let Some(rest) = text.strip_prefix("::") {
            text = rest;
            continue;
        }
        if word.is_empty() && text.starts_with('{') {
            text = &text[1..];
            loop {
                text = tree(text.trim_start(), before, found).trim_start();
                match text.chars().next() {
                    Some(',') => text = &text[1..],
                    Some('}') => {
                        text = &text[1..];
                        break;
                    }
                    _ => break,
                }
                if let Some(rest) = text.trim_start().strip_prefix('}') {
                    text = rest;
                    break;
                }
            }
        } else {
            found.push(before.clone());
            if let Some(rest) = text.strip_prefix(" as ") {
                text = rest.trim_start_matches(|c: char| c.is_alphanumeric() || c == '_');
            }
        }
        before.truncate(depth);
        return text;
    }
}

/// The file that a path leads to, seen from a module: the longest part that names one.
fn target(from: &[String], path: &[String], files: &BTreeMap<Vec<String>, PathBuf>) -> Option<Vec<String>> {
    let mut at = from.to_vec();
    let mut rest = path;
    if rest.first().is_some_and(|p| p == "crate") {
        at.clear();
        rest = &rest[1..];
    }
    while rest.first().is_some_and(|p| p == "super") {
        at.pop();
        rest = &rest[1..];
    }
    at.extend(rest.iter().cloned());
    while !files.contains_key(&at) {
        at.pop()?;
    }
    Some(at)
}

/// Imports between the files of a crate. Those between a module and what stands inside it do not count.
fn imports(src: &Path) -> BTreeMap<Vec<String>, BTreeSet<Vec<String>>> {
    let mut list = Vec::new();
    sources(src, &mut list);
    list.retain(|path| !path.iter().any(|part| part == "tests" || part == "tests.rs"));
    let files: BTreeMap<_, _> = list.into_iter().map(|path| (module(path.strip_prefix(src).unwrap()), path)).collect();
    let mut edges = BTreeMap::new();
    for (from, path) in &files {
        let text = code(&fs::read_to_string(path).unwrap());
        let to: BTreeSet<_> = paths(&text)
            .iter()
            .filter_map(|p| target(from, p, &files))
            .filter(|to| !to.starts_with(from) && !from.starts_with(to))
            .collect();
        edges.insert(from.clone(), to);
    }
    edges
}

/// Everything that can be reached from a file.
fn reach<'a>(from: &'a [String], edges: &'a BTreeMap<Vec<String>, BTreeSet<Vec<String>>>) -> BTreeSet<&'a Vec<String>> {
    let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(at) = open.pop() {
        open.extend(edges.get(at).into_iter().flatten().filter(|to| seen.insert(*to)).map(Vec::as_slice));
    }
    seen
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let (mut circles, mut arrows) = (Vec::new(), 0);
    for folder in CRATES.into_iter().chain(["testbench"]) {
        let edges = imports(&repository().join(folder).join("src"));
        arrows += edges.values().map(BTreeSet::len).sum::<usize>();
        let mut told = BTreeSet::new();
        for file in edges.keys() {
            let all = reach(file, &edges);
            if all.contains(file) && !told.contains(file) {
                let circle: Vec<_> = all.into_iter().filter(|other| reach(other, &edges).contains(file)).collect();
                told.extend(circle.iter().map(|f| (*f).clone()));
                circles
                    .push(circle.iter().map(|f| format!("{folder}::{}", f.join("::"))).collect::<Vec<_>>().join(", "));
            }
        }
    }
    assert!(arrows > 200, "only {arrows} imports seen: the reader of imports is blind");
    assert!(circles.is_empty(), "circles:\n{}", circles.join("\n"));
}

#[test]
fn the_reader_of_imports_sees_trees_and_circles() {
    let text = "use crate::a::{self, b::C, d::{E, F as G}};\nfn f() { super::h::i(); }";
    let words = |path: &str| path.split("::").map(str::to_owned).collect::<Vec<_>>();
    let mut expected: Vec<_> =
        ["crate::a::self", "crate::a::b::C", "crate::a::d::E", "crate::a::d::F", "super::h::i"].map(words).to_vec();
    expected.sort();
    let mut found = paths(text);
    found.sort();
    assert_eq!(found, expected);
    let name = |s: &str| vec![s.to_owned()];
    let edges = BTreeMap::from([(name("a"), BTreeSet::from([name("b")])), (name("b"), BTreeSet::from([name("a")]))]);
    assert!(reach(&name("a"), &edges).contains(&name("a")));
}

#[test]
fn a_file_is_one_idea() {
    let mut lengths = Vec::new();
    for folder in CRATES.into_iter().chain(["testbench"]) {
        let mut list = Vec::new();
        sources(&repository().join(folder).join("src"), &mut list);
        lengths.extend(list.into_iter().map(|path| (fs::read_to_string(&path).unwrap().lines().count(), path)));
    }
    lengths.sort();
    let (longest, path) = lengths.last().unwrap();
    assert!(*longest <= LONGEST, "{}: {longest} lines", path.display());
    assert!(lengths[lengths.len() / 2].0 <= MEDIAN);
}

#[test]
fn the_robots_binary_links_no_simulation() {
    let output = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()))
        .args(["tree", "--package", "racbot", "--no-default-features", "--edges", "normal", "--prefix", "none"])
        .args(["--offline", "--locked"])
        .current_dir(repository())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let linked: BTreeSet<&str> = text.lines().filter_map(|line| line.split(' ').next()).collect();
    assert!(linked.contains("driver") && linked.contains("fixed-kin"), "{linked:?}");
    for none in ["simulator", "gap", "links", "plot", "testbench", "hdl", "rust-hdl-core", "vision"] {
        assert!(!linked.contains(none), "the robot's binary links {none}");
    }
}
