//! The committed bitstream is what the flow makes of the committed gateware, byte for byte, and its figures.

use bitstream::container::Bitstream;
use bitstream::device::Device;
use bitstream::flow::{Progress, SLICES, floorplan};
use bitstream::report::Decoded;
use hdl::design::{COMMITTED_BITSTREAM, COMMITTED_VERILOG, NAME};
use measured::Table;
use simulator::circuit::committed;
use simulator::gateware::{self, SEED};
use std::path::Path;
use testbench::netlist::Netlist;

const COMMAND: &str = "cargo test --release -p testbench --test bitstream_build";
/// Most of the period that a path between registers may take, %: the target of the gateware.
const MOST_PERCENT: u32 = 60;
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
fn the_flow_makes_the_committed_bytes() {
    let netlist = Netlist::of(COMMITTED_VERILOG, NAME).unwrap_or_else(|error| panic!("{error}"));
    let (built, file) = gateware::bitstream(&netlist.json(), SEED, &mut Progress::silent()).unwrap();
    let used = &built.resources;
    let rows = [
        ("slices", used.slices, SLICES),
        ("tables of four inputs", used.tables, 2 * SLICES),
        ("flip-flops", used.flip_flops, 2 * SLICES),
        ("bits of carry", used.carries, 2 * SLICES),
        ("block memories", used.memories, 14),
        ("pads", used.pads, 144),
    ];
    RESOURCES.check(&rows.map(|(part, used, of)| vec![part.to_owned(), used.to_string(), of.to_string()]));
    let ns = |ps: i64| format!("{:.2}", ps as f64 / 1_000.0);
    let name = |net| match net {
        Some(net) => built.logic.nets[bitstream::flow::netlist::Net::index(net)].clone(),
        None => "(carry)".to_owned(),
    };
    let mut rows = Vec::new();
    for domain in &built.timing.domains {
        let inside = domain.inside.as_ref().expect("paths between registers");
        assert!(domain.worst[0].slack() > 0, "{} is too slow: {:?}", domain.port, domain.worst[0]);
        assert!(100 * inside.delay <= MOST_PERCENT * domain.period, "{}: {inside:?}", domain.port);
        for (what, path) in domain.told() {
            let wires = path.steps.iter().map(|step| i64::from(step.wire)).sum();
            let last = path.steps.iter().rev().map(|step| name(step.net)).find(|name| !name.starts_with('$'));
            rows.push(vec![
                domain.port.clone(),
                what.to_owned(),
                ns(domain.period.into()),
                ns(path.delay.into()),
                ns(wires),
                ns(path.slack()),
                name(path.steps[0].net),
                last.unwrap_or_default(),
            ]);
        }
    }
    TIMING.check(&rows);
    let proof = &built.proof;
    assert_eq!((proof.differences.as_slice(), proof.unobservable.as_slice()), (&[][..], &[][..]));
    let rows = [
        ("flip-flops", proof.flip_flops as u64),
        ("block memories", proof.memories as u64),
        ("pads", proof.pads as u64),
        ("functions", proof.functions as u64),
        ("rows of their tables", proof.rows),
    ];
    PROOF.check(&rows.map(|(what, proven)| vec![what.to_owned(), proven.to_string(), "0".to_owned()]));
    let plan = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/pictures/floor-plan.svg");
    if std::env::var_os("RACBOT_MEASURED").is_some_and(|value| value == "write") {
        std::fs::write(&plan, floorplan::svg(&built)).unwrap();
    }
    assert!(std::fs::read_to_string(&plan).is_ok_and(|text| text == floorplan::svg(&built)), "{}", plan.display());
    let old = Bitstream::parse(COMMITTED_BITSTREAM).unwrap();
    let new = Bitstream::parse(&file).unwrap();
    assert_eq!(old.header, new.header);
    assert!(
        COMMITTED_BITSTREAM == file,
        "generated/rac4i65.bit is not what the flow makes; run racbot bitstream build --force"
    );
}
