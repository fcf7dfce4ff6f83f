//! The tools that hardware people start with: FuseSoC's targets of `rac4i65.core`, and through them the
//! cocotb test that drives the emitted chip by its bus.

use std::path::Path;
use std::process::{Command, Output};
use testbench::repository;

/// Runs a target in a fresh build folder, on what that folder of generated files holds.
fn fusesoc(target: &str, build: &Path, generated: &Path) -> (Output, String) {
    let output = Command::new("fusesoc")
        .args(["--cores-root", ".", "run", "--build-root"])
        .arg(build)
        .args(["--target", target, "racbot:gateware:rac4i65"])
        .env("RAC4I65_GENERATED", generated)
        .current_dir(repository())
        .output()
        .unwrap_or_else(|error| panic!("fusesoc: {error}; ./test.sh installs it into target/python"));
    let text = [&output.stdout[..], &output.stderr[..]].map(String::from_utf8_lossy).concat();
    (output, text)
}

#[test]
fn fusesoc_lints_the_chip() {
    let scratch = tempfile::tempdir().unwrap();
    let (output, text) = fusesoc("lint", scratch.path(), &repository().join("generated"));
    assert!(output.status.success(), "{text}");
    assert!(text.contains("verilator") && !text.contains("%Warning"), "{text}");
}

#[test]
fn fusesoc_runs_the_cocotb_test() {
    let scratch = tempfile::tempdir().unwrap();
    let (output, text) = fusesoc("sim", scratch.path(), &repository().join("generated"));
    assert!(output.status.success(), "{text}");
    assert!(text.contains("cocotb: 2 tests passed"), "{text}");
}

/// The exit status tells: a chip whose identification is wrong, and a chip that is not there.
#[test]
fn fusesoc_fails_where_the_cocotb_test_does() {
    let scratch = tempfile::tempdir().unwrap();
    let generated = scratch.path().join("generated");
    std::fs::create_dir(&generated).unwrap();
    let (output, text) = fusesoc("sim", &scratch.path().join("none"), &generated);
    assert!(!output.status.success(), "{text}");
    std::fs::copy(repository().join("generated/registers.json"), generated.join("registers.json")).unwrap();
    let chip = std::fs::read_to_string(repository().join("generated/rac4i65.v")).unwrap();
    let spoilt = chip.replace("52414334", "52414335");
    assert_ne!(chip, spoilt);
    std::fs::write(generated.join("rac4i65.v"), spoilt).unwrap();
    let (output, text) = fusesoc("sim", &scratch.path().join("wrong"), &generated);
    assert!(!output.status.success() && text.contains("cocotb: 2 tests ran, 1 failed"), "{text}");
}
