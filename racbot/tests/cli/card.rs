//! Commands on a card: the built-in one, and what is said where there is none.

use super::racbot;
use std::fs;
use tempfile::tempdir;

const COMMITTED: &[u8] = include_bytes!("../../../generated/rac4i65.bit");

#[test]
fn the_built_in_card_loads_the_committed_file() {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("a.bit"), COMMITTED).unwrap();
    let loaded = racbot(folder.path(), &["load", "a.bit", "--card", "virtual"]).done().fits_80_columns();
    for part in ["a.bit", "2 CRC words right", "try 1", "the committed gateware", "MHz measured"] {
        assert!(loaded.stdout.contains(part), "no {part} in {}", loaded.stdout);
    }
    let json = racbot(folder.path(), &["load", "--card", "virtual", "--json"]).done().json();
    assert_eq!((&json["kept"], &json["tries"], &json["axes"]), (&false.into(), &1.into(), &4.into()));
    let clock = json["clock_hz"].as_f64().unwrap();
    assert!((clock / 33_333_333.0 - 1.0).abs() < 1e-4, "{clock}");
    let info = racbot(folder.path(), &["info", "--card", "virtual"]).done().fits_80_columns();
    assert!(info.stdout.contains("not configured"), "{}", info.stdout);
}

#[test]
fn a_file_is_checked_without_a_card() {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("a.bit"), COMMITTED).unwrap();
    racbot(folder.path(), &["load", "a.bit", "--check"]).done().fits_80_columns();
    let mut bytes = fs::read(folder.path().join("a.bit")).unwrap();
    bytes[90_000] ^= 1;
    fs::write(folder.path().join("b.bit"), &bytes).unwrap();
    for more in [&["--check"][..], &["--card", "virtual"]] {
        let arguments = [&["load", "b.bit"], more].concat();
        racbot(folder.path(), &arguments).refused(1, &["b.bit: the CRC word at byte 0x28c17 does not match"]);
    }
    racbot(folder.path(), &["load", "c.bit", "--check"]).refused(1, &["c.bit: No such file"]);
}

#[test]
fn another_hash_is_refused_and_named() {
    let folder = tempdir().unwrap();
    racbot(folder.path(), &["load", "--card", "virtual", "--hash", "0000beef"])
        .refused(1, &["virtual: loaded, but the design answers with hash", "expected 0000beef", "outputs off"]);
    racbot(folder.path(), &["load", "--card", "virtual", "--hash", "beer"]).refused(2, &["'beer' is no hash"]);
}

#[test]
fn where_no_card_is_that_is_said() {
    let folder = tempdir().unwrap();
    racbot(folder.path(), &["info", "--card", "ffff:ff:1f.7"])
        .refused(1, &["no PCI device in slot ffff:ff:1f.7", "the built-in one is --card virtual"]);
    racbot(folder.path(), &["load"]).refused(2, &["which FILE is to be loaded?"]);
    racbot(folder.path(), &["load", "--check"]).refused(2, &["--check needs a FILE"]);
}
