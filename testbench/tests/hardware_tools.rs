//! The tools that hardware people start with: FuseSoC's targets of `rac4i65.core`, and through them the
//! cocotb test that drives the emitted chip by its bus.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().unwrap()
}

/// Runs a target in a fresh build folder.
fn fusesoc(target: &str, build: &Path) -> (Output, String) {
    let root = repository();
    let output = Command::new("fusesoc")
        .args(["--cores-root", ".", "run", "--build-root"])
        .arg(build)
        .args(["--target", target, "racbot:gateware:rac4i65"])
        .env("RAC4I65_GENERATED", root.join("generated"))
        .current_dir(root)
        .output()
        .unwrap_or_else(|error| panic!("fusesoc: {error}; ./test.sh installs it into target/python"));
    let text = [&output.stdout[..], &output.stderr[..]].map(String::from_utf8_lossy).concat();
    (output, text)
}

#[test]
fn fusesoc_lints_the_chip() {
    let scratch = tempfile::tempdir().unwrap();
    let (output, text) = fusesoc("lint", scratch.path());
    assert!(output.status.success(), "{text}");
    assert!(text.contains("verilator") && !text.contains("%Warning"), "{text}");
}

#[test]
fn fusesoc_runs_the_cocotb_test() {
    let scratch = tempfile::tempdir().unwrap();
    let (output, text) = fusesoc("sim", scratch.path());
    assert!(output.status.success(), "{text}");
    // The exit status does not tell: what cocotb found stands in its result file.
    let results = scratch.path().join("racbot_gateware_rac4i65_0.1.0/sim/results.xml");
    let results = std::fs::read_to_string(&results).unwrap_or_else(|error| panic!("{error}: {text}"));
    assert_eq!(results.matches("<testcase ").count(), 2, "{text}");
    assert!(!results.contains("<failure") && !results.contains("<error") && !results.contains("<skipped"), "{text}");
}
