//! The emitted Verilog of every block and of the whole: the lint gate, and what it takes of the
//! device (yosys, Virtex family, to which the Spartan-II belongs), mapped for area: without wide multiplexers.

use hdl::blocks::clock_monitor::ClockMonitor;
use hdl::blocks::commit::Commit;
use hdl::blocks::core::Core;
use hdl::blocks::decoder::Decoder;
use hdl::blocks::divider::Divider;
use hdl::blocks::encoder::Encoder;
use hdl::blocks::imu_spi::ImuSpi;
use hdl::blocks::interrupt::Interrupt;
use hdl::blocks::kicker::Kicker;
use hdl::blocks::local_bus::LocalBus;
use hdl::blocks::multiplier::Multiplier;
use hdl::blocks::pwm::Pwm;
use hdl::blocks::radio::Radio;
use hdl::blocks::register_file::RegisterFile;
use hdl::blocks::safety::Safety;
use hdl::blocks::sequencer::Sequencer;
use hdl::blocks::serial_host::SerialHost;
use hdl::blocks::snapshot::Snapshot;
use hdl::blocks::snapshot_address::SnapshotAddress;
use hdl::blocks::stall::Stall;
use hdl::blocks::timebase::Timebase;
use hdl::blocks::trigonometry::Trigonometry;
use hdl::emit::blocks::resources;
use hdl::emit::verilog::emit;
use hdl::program::control_tick;
use rust_hdl::prelude::Block;
use simulator::cosim::lint;
use std::path::PathBuf;
use std::process::Command;

/// Whether a tool was content, and what it printed.
fn run(tool: &str, arguments: &[&str]) -> (bool, String) {
    let output = Command::new(tool).args(arguments).output();
    let output = output.unwrap_or_else(|error| panic!("{tool}: {error}; install the Debian package {tool}"));
    let text = [output.stdout, output.stderr].concat();
    (output.status.success(), String::from_utf8_lossy(&text).into_owned())
}

fn check<B: Block>(name: &str, mut block: B, luts: usize, flip_flops: usize) {
    block.connect_all();
    let top = format!("block_{name}");
    let verilog = emit(&block, &top);
    let findings = lint::gate(&top, &verilog, &top).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert!(findings.iter().all(|finding| !finding.is_fatal()));

    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("resources");
    std::fs::create_dir_all(&folder).expect("scratch folder");
    let file = folder.join(format!("{name}.v"));
    std::fs::write(&file, verilog).expect("scratch file");
    let file = file.to_str().expect("a path in text");
    let script = format!(
        "read_verilog {file}; synth_xilinx -family xcv -top {top} -flatten -nowidelut; stat; select -assert-none t:LD*"
    );
    let (ok, log) = run("yosys", &["-p", &script]);
    assert!(ok, "{name}: {log}");
    assert!(!log.contains("Latch inferred"), "{name}: {log}");
    let cells = |is: fn(&str) -> bool| -> usize {
        let stat = log.rsplit("Printing statistics").next().unwrap_or("");
        let words = stat.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
        words.filter(|w| w.len() == 2 && is(w[0])).filter_map(|w| w[1].parse::<usize>().ok()).sum()
    };
    let (used_luts, used_ffs) = (cells(|c| c.starts_with("LUT")), cells(|c| c.starts_with("FD")));
    let (inverters, memories) = (cells(|c| c == "INV"), cells(|c| c.starts_with("RAMB4")));
    println!("{name},{used_luts},{inverters},{used_ffs},{memories}");
    // Another yosys may map a little differently; flip-flops and memories are the design's own.
    let [stated_luts, _, stated_ffs, stated_memories] = resources(name).unwrap_or_else(|| panic!("{name}: not stated"));
    assert_eq!((used_ffs, memories), (stated_ffs, stated_memories), "{name}: correct hdl/src/emit/resources.csv");
    assert!(20 * used_luts.abs_diff(stated_luts) <= stated_luts + 20, "{name}: {used_luts} LUT, {stated_luts} stated");
    assert!((1..=luts).contains(&used_luts), "{name}: {used_luts} LUT of {luts}");
    assert!((0..=flip_flops).contains(&used_ffs), "{name}: {used_ffs} FF of {flip_flops}");
}

#[test]
fn imu_spi() {
    check("imu_spi", ImuSpi::default(), 120, 90);
}

#[test]
fn encoder() {
    check("encoder", Encoder::default(), 100, 150);
    check("stall", Stall::default(), 40, 10);
}

#[test]
fn safety() {
    check("safety", Safety::default(), 180, 100);
    check("interrupt", Interrupt::default(), 15, 8);
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

#[test]
fn arithmetic() {
    check("multiplier", Multiplier::default(), 330, 120);
    check("divider", Divider::default(), 130, 130);
    check("trigonometry", Trigonometry::default(), 60, 35);
    check("sequencer", Sequencer::new(&control_tick()), 1_200, 450);
}

#[test]
fn bus_and_registers() {
    check("local_bus", LocalBus::default(), 150, 130);
    check("decoder", Decoder::default(), 60, 20);
    check("commit", Commit::default(), 200, 100);
    check("snapshot", Snapshot::default(), 10, 8);
    check("snapshot_address", SnapshotAddress::default(), 8, 0);
    check("serial_host", SerialHost::default(), 300, 170);
    check("radio", Radio::default(), 300, 330);
    check("timebase", Timebase::default(), 180, 130);
    check("register_file", RegisterFile::new(0), 420, 320);
}

/// 66 % of the 4704 lookup tables and flip-flops of the XC2S200.
#[test]
fn the_whole_core_fits_the_device() {
    check("core", Core::new(0), 3_104, 3_104);
}
