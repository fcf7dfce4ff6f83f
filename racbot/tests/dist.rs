//! The files of dist/ are understood by the programs that read them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn dist(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../dist").join(name)
}

/// Whether a program can be run; CI has to have all of them.
fn is_there(program: &str) -> bool {
    let there = Command::new(program).arg("--version").output().is_ok();
    assert!(there || std::env::var("CI").as_deref() != Ok("true"), "{program} is missing: install systemd and udev");
    if !there {
        eprintln!("NOT RUN: {program} is missing");
    }
    there
}

/// What systemd says of a unit, with the command's real place in it.
fn verified(text: &str, name: &str) -> (bool, String) {
    let folder = tempfile::tempdir().unwrap();
    let binary = env!("CARGO_BIN_EXE_racbot");
    let there = |text: &str| text.replace("/usr/local/bin/racbot", binary);
    for unit in ["racbot-load.service", "racbot-drive@.service"] {
        fs::write(folder.path().join(unit), there(&fs::read_to_string(dist(unit)).unwrap())).unwrap();
    }
    let path = folder.path().join(name);
    fs::write(&path, there(text)).unwrap();
    let output = Command::new("systemd-analyze").args(["verify", "--man=no"]).arg(&path).output().unwrap();
    (output.status.success(), String::from_utf8_lossy(&output.stderr).into_owned())
}

/// The lines about our unit; other units of the machine are not our concern.
fn about<'a>(said: &'a str, unit: &str) -> Vec<&'a str> {
    said.lines().filter(|line| line.contains(unit)).collect()
}

#[test]
fn systemd_understands_the_units_and_a_broken_one_is_noticed() {
    if !is_there("systemd-analyze") {
        return;
    }
    for unit in ["racbot-load.service", "racbot-drive@.service"] {
        let text = fs::read_to_string(dist(unit)).unwrap();
        let (good, said) = verified(&text, unit);
        assert!(good && about(&said, unit).is_empty(), "{said}");
        let broken = text.replace("NoNewPrivileges=yes", "NoNewPrivileges=perhaps");
        assert_ne!(broken, text);
        let (_, said) = verified(&broken, unit);
        assert!(about(&said, unit).iter().any(|line| line.contains("perhaps")), "{said}");
    }
}

/// What udev says of a rule, by reading all rules for a device that every machine has.
fn read_by_udev(text: &str, name: &str) -> String {
    let folder = Path::new("/run/udev/rules.d");
    fs::create_dir_all(folder).unwrap();
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    let output = Command::new("udevadm").args(["test", "/sys/devices/virtual/mem/null"]).output().unwrap();
    fs::remove_file(&path).unwrap();
    String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout)
}

#[test]
fn udev_understands_the_rule_and_a_broken_one_is_noticed() {
    let root = fs::metadata("/proc/self").is_ok_and(|m| std::os::unix::fs::MetadataExt::uid(&m) == 0);
    if !root {
        assert_ne!(std::env::var("CI").as_deref(), Ok("true"), "udev rules are read from /run by root only");
        eprintln!("NOT RUN: udev rules are read from /run by root only");
        return;
    }
    if !is_there("udevadm") {
        return;
    }
    let text = fs::read_to_string(dist("60-racbot.rules")).unwrap();
    let said = read_by_udev(&text, "60-racbot-dist-test.rules");
    assert!(said.contains("Reading rules file: /run/udev/rules.d/60-racbot-dist-test.rules"), "{said}");
    let complaint = "60-racbot-dist-test.rules:";
    let complaints: Vec<&str> = said.lines().filter(|line| line.contains(complaint)).collect();
    assert!(complaints.is_empty(), "{complaints:?}");
    let broken = text.replace("ATTR{vendor}==", "ATRR{vendor}==");
    assert_ne!(broken, text);
    let said = read_by_udev(&broken, "60-racbot-dist-test.rules");
    assert!(said.lines().any(|line| line.contains(complaint)), "{said}");
}

/// The rule's ids are those that the driver looks for.
#[test]
fn the_rule_matches_the_card_that_the_driver_finds() {
    let ids = driver::pci::Ids::MESA_4I65;
    let text = fs::read_to_string(dist("60-racbot.rules")).unwrap();
    for (attribute, id) in [
        ("vendor", ids.vendor),
        ("device", ids.device),
        ("subsystem_vendor", ids.subsystem_vendor),
        ("subsystem_device", ids.subsystem_device),
    ] {
        assert!(text.contains(&format!("ATTR{{{attribute}}}==\"0x{id:04x}\"")), "{attribute}");
    }
}
