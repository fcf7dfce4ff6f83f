//! Documents point at what exists: every relative link, picture and included table; and every measured table is shown.

use std::fs;
use std::path::{Path, PathBuf};
use testbench::repository;

/// Markdown files below a folder, but for build output.
fn documents(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() && name != "target" && !name.starts_with('.') && name != "out" {
            documents(&path, found);
        } else if name.ends_with(".md") {
            found.push(path);
        }
    }
}

/// Text between two marks, for every occurrence.
fn between<'a>(text: &'a str, open: &str, close: char) -> Vec<&'a str> {
    text.split(open).skip(1).filter_map(|rest| rest.split(close).next()).collect()
}

/// Where links of a document lead, relative to it; code is no link.
fn targets(text: &str) -> Vec<String> {
    let prose: String = text.split("```").step_by(2).collect();
    let links = between(&prose, "](", ')').into_iter().filter(|link| !link.contains("://") && !link.starts_with('#'));
    let included = between(text, "{{#include ", '}');
    links.map(|link| link.split('#').next().unwrap_or_default()).chain(included).map(str::to_owned).collect()
}

#[test]
fn every_link_leads_somewhere() {
    let mut files = Vec::new();
    documents(&repository(), &mut files);
    assert!(files.len() > 10, "{files:?}");
    let mut broken = Vec::new();
    for file in &files {
        for target in targets(&fs::read_to_string(file).unwrap()) {
            if !file.parent().unwrap().join(&target).exists() {
                broken.push(format!("{}: {target}", file.strip_prefix(repository()).unwrap().display()));
            }
        }
    }
    assert!(broken.is_empty(), "links that lead nowhere:\n{}", broken.join("\n"));
}

#[test]
fn every_page_of_the_book_is_in_its_summary() {
    let pages = repository().join("docs/book/src");
    let summary = fs::read_to_string(pages.join("SUMMARY.md")).unwrap();
    for page in fs::read_dir(&pages).unwrap() {
        let name = page.unwrap().file_name().to_string_lossy().into_owned();
        if name.ends_with(".md") && name != "SUMMARY.md" {
            assert!(summary.contains(&format!("({name})")), "{name} is in no chapter list");
        }
    }
}

#[test]
fn every_measured_table_is_shown() {
    let mut files = Vec::new();
    documents(&repository(), &mut files);
    let texts: String = files
        .iter()
        .filter(|file| !file.starts_with(repository().join("docs/measured")))
        .map(|file| fs::read_to_string(file).unwrap())
        .collect();
    for table in fs::read_dir(repository().join("docs/measured")).unwrap() {
        let name = table.unwrap().file_name().to_string_lossy().into_owned();
        assert!(texts.contains(&format!("measured/{name}")), "docs/measured/{name} is shown nowhere");
    }
}

/// A newcomer's first minutes; the rest belongs into the book.
#[test]
fn the_readme_is_short() {
    let words = fs::read_to_string(repository().join("README.md")).unwrap().split_whitespace().count();
    assert!(words <= 1_200, "{words} words");
}

#[test]
fn links_are_found_outside_of_code_only() {
    let text = "a [b](c.md#d) ![e](f.svg) [g](https://h) [i](#j)\n```\n[k](l)\n```\n{{#include m.md}}";
    assert_eq!(targets(text), ["c.md", "f.svg", "m.md"]);
}
