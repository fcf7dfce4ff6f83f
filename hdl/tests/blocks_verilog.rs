//! The emitted Verilog of the blocks: no latches, no narrowing, nothing the tools object to.

use hdl::blocks::clock_monitor::ClockMonitor;
use hdl::blocks::encoder::Encoder;
use hdl::blocks::kicker::Kicker;
use hdl::blocks::pwm::Pwm;
use hdl::blocks::safety::Safety;
use rust_hdl::prelude::*;
use std::path::PathBuf;
use std::process::Command;

fn emit<B: Block>(name: &str, mut block: B) -> PathBuf {
    block.connect_all();
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("blocks_verilog");
    std::fs::create_dir_all(&folder).expect("scratch folder");
    let file = folder.join(format!("{name}.v"));
    std::fs::write(&file, generate_verilog(&block)).expect("scratch file");
    file
}

/// Whether a tool was content, and what it printed.
fn run(tool: &str, arguments: &[&str]) -> (bool, String) {
    let output = Command::new(tool).args(arguments).output();
    let output = output.unwrap_or_else(|error| panic!("{tool}: {error}; install the Debian package {tool}"));
    let text = [output.stdout, output.stderr].concat();
    (output.status.success(), String::from_utf8_lossy(&text).into_owned())
}

fn check<B: Block>(name: &str, block: B, luts: usize, flip_flops: usize) {
    let file = emit(name, block);
    let file = file.to_str().expect("a path in text");
    let script =
        format!("read_verilog {file}; synth_xilinx -family xcv -top top -flatten; stat; select -assert-none t:LD*");
    let (ok, log) = run("yosys", &["-p", &script]);
    assert!(ok, "{name}: {log}");
    assert!(!log.contains("Latch inferred"), "{name}: {log}");
    let cells = |is: fn(&str) -> bool| -> usize {
        let stat = log.rsplit("Printing statistics").next().unwrap_or("");
        let words = stat.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
        words.filter(|w| w.len() == 2 && is(w[0])).filter_map(|w| w[1].parse::<usize>().ok()).sum()
    };
    let (used_luts, used_ffs) = (cells(|c| c.starts_with("LUT")), cells(|c| c.starts_with("FD")));
    println!("{name}: {used_luts} LUT and {} inverters, {used_ffs} FF", cells(|c| c == "INV"));
    assert!((1..=luts).contains(&used_luts), "{name}: {used_luts} LUT of {luts}");
    assert!((1..=flip_flops).contains(&used_ffs), "{name}: {used_ffs} FF of {flip_flops}");

    let mut lint = vec!["--lint-only", "-Wall", "--top-module", "top"];
    lint.extend(["-Wno-DECLFILENAME", "-Wno-UNUSEDPARAM", "-Wno-UNUSEDSIGNAL", file]);
    let (ok, log) = run("verilator", &lint);
    assert!(ok && !log.contains("%Warning"), "{name}: {log}");
}

#[test]
fn encoder() {
    check("encoder", Encoder::default(), 100, 120);
}

#[test]
fn safety() {
    check("safety", Safety::default(), 150, 90);
}

#[test]
fn pwm() {
    check("pwm", Pwm::default(), 90, 70);
}

#[test]
fn kicker() {
    check("kicker", Kicker::default(), 200, 120);
}

#[test]
fn clock_monitor() {
    check("clock_monitor", ClockMonitor::default(), 30, 25);
}
