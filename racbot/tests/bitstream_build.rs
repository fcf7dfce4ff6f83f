//! The committed bitstream is what the printed command makes of the committed gateware, byte for byte, and its figures.
#![cfg(feature = "simulation")]

use assert_cmd::Command;
use bitstream::container::Bitstream;
use bitstream::device::Device;
use bitstream::flow::SLICES;
use bitstream::report::Decoded;
use hdl::design::COMMITTED_BITSTREAM;
use measured::Table;
use serde_json::Value;
use simulator::circuit::committed;
use simulator::gateware;
use std::path::Path;

const COMMAND: &str = "cargo test --release -p racbot --test bitstream_build";
/// Most of the period that a path between registers may take, %: the target of the gateware.
const MOST_PERCENT: i64 = 60;
const RESOURCES: Table<'_> = Table {
    name: "bitstream-resources",
    title: "What the design takes of the XC2S200",
    command: COMMAND,
    columns: &["part", "used", "of"],
};
const TIMING: Table<'_> = Table {
    name: "bitstream-timing",
    title: "The slowest path of each clock under the conservative model, ns",
    command: COMMAND,
    columns: &["clock", "between", "period", "slowest path", "of it in wires", "slack", "from", "to"],
};
const PROOF: Table<'_> = Table {
    name: "bitstream-proof",
    title: "The decoded bits against the netlist of yosys, for all values",
    command: COMMAND,
    columns: &["what", "proven", "not proven"],
};

#[test]
fn the_committed_file_is_of_this_gateware_and_makes_a_circuit() {
    let file = committed();
    let advice = "run racbot bitstream build --force";
    assert_eq!(file.header.as_ref().unwrap().design, gateware::header_name(), "{advice}");
    let report = Decoded::new(Device::xc2s200(), &file).unwrap().report;
    assert_eq!((report.faults.as_slice(), report.unexplained, report.absent), (&[][..], 0, 0));
    assert_eq!(report.pads.len(), hdl::board::Board::mesa_4i65_7i30().assignments.len(), "{advice}");
}

#[test]
fn the_printed_command_makes_the_committed_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let page = std::fs::read_to_string(repository.join("docs/book/src/bitstream.md")).unwrap();
    let printed: Vec<&str> = page.lines().filter_map(|line| line.strip_prefix("racbot bitstream build ")).collect();
    assert_eq!(printed, ["--out mine.bit --floor-plan floor-plan.svg"]);
    let mut racbot = Command::cargo_bin("racbot").unwrap();
    racbot.current_dir(&folder).args(["--json", "bitstream", "build"]).args(printed[0].split(' '));
    let output = racbot.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let built: Value = serde_json::from_slice(&output.stdout).unwrap();

    let file = std::fs::read(folder.path().join("mine.bit")).unwrap();
    assert_eq!(built["bytes"], file.len());
    let [old, new] = [COMMITTED_BITSTREAM, &file].map(|bytes| Bitstream::parse(bytes).unwrap().header);
    assert_eq!(old, new);
    assert!(
        COMMITTED_BITSTREAM == file,
        "generated/rac4i65.bit is not what the flow makes; run racbot bitstream build --force"
    );
    let plan = std::fs::read_to_string(folder.path().join("floor-plan.svg")).unwrap();
    let kept = repository.join("docs/pictures/floor-plan.svg");
    if std::env::var_os("RACBOT_MEASURED").is_some_and(|value| value == "write") {
        std::fs::write(&kept, &plan).unwrap();
    }
    assert!(std::fs::read_to_string(&kept).is_ok_and(|text| text == plan), "{}", kept.display());

    let rows = [
        ("slices", "slices", SLICES),
        ("tables of four inputs", "tables", 2 * SLICES),
        ("flip-flops", "flip_flops", 2 * SLICES),
        ("bits of carry", "carries", 2 * SLICES),
        ("block memories", "memories", 14),
        ("pads", "pads", 144),
    ];
    RESOURCES.check(&rows.map(|(part, key, of)| vec![part.to_owned(), built["used"][key].to_string(), of.to_string()]));
    let clocks = built["clocks"].as_array().unwrap();
    TIMING.check(&clocks.iter().flat_map(paths).collect::<Vec<_>>());
    let proof = &built["proof"];
    for gap in ["differences", "unobservable"] {
        assert_eq!(proof[gap].as_array().map(Vec::len), Some(0), "{}", proof[gap]);
    }
    let rows = [
        ("flip-flops", "flip_flops"),
        ("block memories", "memories"),
        ("pads", "pads"),
        ("functions", "functions"),
        ("rows of their tables", "rows"),
    ];
    PROOF.check(&rows.map(|(what, key)| vec![what.to_owned(), proof[key].to_string(), "0".to_owned()]));
}

/// Rows of the paths that are told of a clock: the slowest between registers, and the one with the least slack of all.
fn paths(clock: &Value) -> Vec<Vec<String>> {
    let ps = |value: &Value| value.as_i64().unwrap();
    let ns = |ps: i64| format!("{:.2}", ps as f64 / 1_000.0);
    let (port, period) = (clock["port"].as_str().unwrap(), ps(&clock["period_ps"]));
    let (inside, worst) = (&clock["slowest_inside"], &clock["worst"][0]);
    assert!(ps(&worst["slack_ps"]) > 0, "{port} is too slow: {worst}");
    assert!(100 * ps(&inside["delay_ps"]) <= MOST_PERCENT * period, "{port}: {inside}");
    let row = |between: &str, path: &Value| {
        let steps = path["steps"].as_array().unwrap();
        let names: Vec<&str> = steps.iter().map(|step| step["net"].as_str().unwrap()).collect();
        let last = names.iter().rev().find(|name| !name.starts_with('$'));
        let figures =
            [period, ps(&path["delay_ps"]), steps.iter().map(|step| ps(&step["wire_ps"])).sum(), ps(&path["slack_ps"])];
        let ends = [names[0], last.unwrap_or(&"")].map(str::to_owned);
        [port, between].map(str::to_owned).into_iter().chain(figures.map(ns)).chain(ends).collect()
    };
    vec![row("registers and memories", inside), row("pads, and all by slack", worst)]
}
