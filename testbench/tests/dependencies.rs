//! What others' crates may be, by `deny.toml`: licences, second versions, sources, and the oldest toolchain. Without network
//! and without cargo-deny.

use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::process::Command;
use testbench::repository;

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    version: String,
    license: Option<String>,
    source: Option<String>,
    rust_version: Option<String>,
}

#[derive(Deserialize)]
struct Deny {
    licenses: Licenses,
    bans: Bans,
}

#[derive(Deserialize)]
struct Licenses {
    allow: Vec<String>,
}

#[derive(Deserialize)]
struct Bans {
    skip: Vec<Skip>,
}

#[derive(Deserialize)]
#[serde(rename = "crate")]
struct Skip {
    #[serde(rename = "crate")]
    name: String,
}

fn packages() -> Vec<Package> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--locked"])
        .current_dir(repository())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice::<Metadata>(&output.stdout).unwrap().packages
}

fn deny() -> Deny {
    toml::from_str(&fs::read_to_string(repository().join("deny.toml")).unwrap()).unwrap()
}

/// Whether an SPDX expression can be met with the licences of a list: OR, AND, brackets, and the old `/` for OR.
fn is_allowed(expression: &str, allow: &[String]) -> bool {
    let spaced = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let (met, rest) = either(&words, allow);
    assert!(rest.is_empty(), "{expression}: no SPDX expression");
    met
}

fn either<'a, 'w>(words: &'a [&'w str], allow: &[String]) -> (bool, &'a [&'w str]) {
    let (mut met, mut rest) = both(words, allow);
    while let ["OR", more @ ..] = rest {
        let (other, after) = both(more, allow);
        (met, rest) = (met | other, after);
    }
    (met, rest)
}

fn both<'a, 'w>(words: &'a [&'w str], allow: &[String]) -> (bool, &'a [&'w str]) {
    let (mut met, mut rest) = one(words, allow);
    while let ["AND", more @ ..] = rest {
        let (other, after) = one(more, allow);
        (met, rest) = (met & other, after);
    }
    (met, rest)
}

fn one<'a, 'w>(words: &'a [&'w str], allow: &[String]) -> (bool, &'a [&'w str]) {
    match words {
        ["(", inner @ ..] => {
            let (met, rest) = either(inner, allow);
            (met, rest.strip_prefix(&[")"]).expect("a closing bracket"))
        }
        [name, "WITH", exception, rest @ ..] => (allow.contains(&format!("{name} WITH {exception}")), rest),
        [name, rest @ ..] => (allow.iter().any(|a| a == name), rest),
        [] => panic!("no licence where one should stand"),
    }
}

#[test]
fn every_licence_permits_what_ours_promises() {
    let allow = deny().licenses.allow;
    let refused: Vec<String> = packages()
        .into_iter()
        .filter(|package| package.source.is_some())
        .filter(|package| !package.license.as_ref().is_some_and(|license| is_allowed(license, &allow)))
        .map(|package| format!("{} {}: {:?}", package.name, package.version, package.license))
        .collect();
    assert!(refused.is_empty(), "licences that deny.toml does not allow:\n{}", refused.join("\n"));
}

#[test]
fn a_second_version_of_a_crate_has_its_reason() {
    let skip: BTreeSet<String> = deny().bans.skip.into_iter().map(|skip| skip.name).collect();
    let mut versions: BTreeMap<String, Vec<String>> = BTreeMap::new();
    packages().into_iter().for_each(|package| versions.entry(package.name).or_default().push(package.version));
    let has_reason = |name: &str, version: &str| {
        let mut parts = version.split('.');
        let (major, minor) = (parts.next().unwrap(), parts.next().unwrap());
        [name.to_owned(), format!("{name}@{major}"), format!("{name}@{major}.{minor}")].iter().any(|s| skip.contains(s))
    };
    let without: Vec<_> = versions
        .iter()
        .filter(|(name, all)| all.iter().filter(|version| !has_reason(name, version)).count() > 1)
        .collect();
    assert!(without.is_empty(), "{without:?}: agree on one version, or give the reason in deny.toml");
    for entry in &skip {
        let name = entry.split('@').next().unwrap();
        assert!(
            versions.get(name).is_some_and(|all| all.len() > 1),
            "{entry} in deny.toml has no second version any more"
        );
    }
}

/// Nothing comes from a git repository or from another registry.
#[test]
fn every_crate_comes_from_crates_io() {
    for package in packages() {
        let source = package.source.unwrap_or_default();
        assert!(source.is_empty() || source.ends_with("/crates.io-index"), "{} comes from {source}", package.name);
    }
}

/// `rust-version` is no older than any dependency's, and rust-toolchain.toml asks for nothing older.
#[test]
fn the_oldest_toolchain_is_stated_right() {
    let number = |text: &str| -> (u32, u32) {
        let mut parts = text.split('.').map(|part| part.parse().unwrap());
        (parts.next().unwrap(), parts.next().unwrap_or(0))
    };
    let read = |file: &str| fs::read_to_string(repository().join(file)).unwrap().parse::<toml::Table>().unwrap();
    let manifest = read("Cargo.toml");
    let ours = number(manifest["workspace"]["package"]["rust-version"].as_str().unwrap());
    for package in packages() {
        if let Some(needs) = &package.rust_version {
            assert!(
                number(needs) <= ours,
                "{} {} needs Rust {needs}: raise rust-version",
                package.name,
                package.version
            );
        }
    }
    let toolchain = read("rust-toolchain.toml");
    let channel = toolchain["toolchain"]["channel"].as_str().unwrap();
    assert!(
        channel == "stable" || number(channel) >= ours,
        "rust-toolchain.toml pins {channel}, older than rust-version"
    );
}

#[test]
fn expressions_of_licences_are_understood() {
    let allow = ["MIT", "Zlib", "Apache-2.0 WITH LLVM-exception"].map(str::to_owned);
    for (expression, met) in [
        ("MIT", true),
        ("GPL-3.0", false),
        ("GPL-3.0 OR MIT", true),
        ("GPL-3.0/MIT", true),
        ("MIT AND GPL-3.0", false),
        ("(MIT OR GPL-3.0) AND Zlib", true),
        ("(MIT OR GPL-3.0) AND IJG", false),
        ("GPL-3.0 OR MIT AND Zlib", true),
        ("Apache-2.0 WITH LLVM-exception", true),
        ("Apache-2.0", false),
    ] {
        assert_eq!(is_allowed(expression, &allow), met, "{expression}");
    }
}
