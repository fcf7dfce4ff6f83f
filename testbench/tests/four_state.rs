//! The emitted chip in four states under Icarus: what is not defined from configuration on shows as x.

use std::path::Path;
use std::process::Command;

/// Two dozen control ticks, and every word of the map many times.
const CLOCKS: u32 = 24_000;

#[test]
fn nothing_unknown_reaches_a_pin_or_the_bus() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let folder = tempfile::tempdir().unwrap();
    let compiled = folder.path().join("bench.vvp");
    let tool = |command: &mut Command| {
        let output = command.output().unwrap_or_else(|error| panic!("{error}; install the Debian package iverilog"));
        let text = [&output.stdout[..], &output.stderr[..]].map(String::from_utf8_lossy).concat();
        assert!(output.status.success(), "{text}");
        text
    };
    tool(Command::new("iverilog").args(["-g2001", "-s", "bench", "-o"]).args([
        &compiled,
        &root.join("testbench/four_state/bench.v"),
        &root.join("generated/rac4i65.v"),
    ]));
    for seed in [1, 2] {
        let run = [format!("+clocks={}", CLOCKS / 2), format!("+seed={seed}")];
        let text = tool(Command::new("vvp").arg("-N").arg(&compiled).args(run));
        assert!(text.trim_end().ends_with("nothing unknown"), "seed {seed}: {text}");
        print!("{text}");
    }
}
