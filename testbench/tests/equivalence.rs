//! The emitted Verilog is the netlist that the bits are made of.

use hdl::design::{COMMITTED_VERILOG, NAME};
use measured::Table;
use serde_json::{Value, json};
use testbench::equivalence::{Equivalence, compare, prove};
use testbench::netlist::Netlist;

const TABLE: Table<'_> = Table {
    name: "equivalence",
    title: "The emitted Verilog against the flow's netlist, in bits",
    command: "cargo test --release -p testbench --test equivalence",
    columns: &["what", "proven equal", "not proven"],
};

fn netlist() -> Value {
    let netlist = Netlist::of(COMMITTED_VERILOG, NAME).unwrap_or_else(|error| panic!("{error}"));
    serde_json::from_str(&netlist.json()).expect("the JSON of yosys")
}

fn compared(netlist: &Value) -> Equivalence {
    compare(COMMITTED_VERILOG, &netlist.to_string(), NAME).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_netlist_of_the_flow_is_the_emitted_verilog() {
    let found = prove(COMMITTED_VERILOG, NAME).unwrap_or_else(|error| panic!("{error}"));
    assert!(found.holds(), "{:?} {:?}", found.starts, found.differences);
    let rows = [
        ("next states of flip-flops of the Verilog", found.flip_flops),
        ("their start values", found.starts.equal),
        ("pads: levels and enables", found.pads),
        ("pins of block memories: addresses, data, write enables", found.pins),
        ("start values of memories", found.contents),
        ("what holds after a read met a write (clauses, not bits)", found.clauses),
    ];
    TABLE.check(&rows.map(|(what, proven)| vec![what.to_owned(), proven.to_string(), "0".to_owned()]));
    let blocks = netlist()["modules"][NAME]["cells"].as_object().expect("cells").clone();
    let blocks =
        blocks.values().filter(|cell| cell["type"].as_str().is_some_and(|kind| kind.starts_with("RAMB4"))).count();
    assert_eq!(found.blocks, blocks, "a block memory that no memory of the text has");
    assert!(found.flip_flops > 2_000 && found.pads > 100, "{found:?}");
    assert_eq!(found.starts.equal, found.flip_flops, "flip-flops without a start value: {:?}", found.starts);
}

/// One operator of a small block turned over, or a start value: the proof must not hold.
#[test]
fn a_block_that_is_not_its_text_is_seen() {
    let block = "rac4i65_core_interrupt";
    let netlist = Netlist::of(COMMITTED_VERILOG, block).unwrap_or_else(|error| panic!("{error}")).json();
    let against = |text: &str| compare(text, &netlist, block).unwrap_or_else(|error| panic!("{error}"));
    let good = against(COMMITTED_VERILOG);
    assert!(good.holds() && good.starts.equal > 0, "{good:?}");
    let broken = |module: &str, from: &str, to: &str| {
        let at = COMMITTED_VERILOG.find(&format!("module {module} ")).expect("the block");
        let (before, after) = COMMITTED_VERILOG.split_at(at);
        assert!(after.contains(from), "{from}");
        before.to_owned() + &after.replacen(from, to, 1)
    };
    let bad = against(&broken(block, " & ", " | "));
    assert!(!bad.differences.is_empty() && bad.starts == good.starts, "{bad:?}");
    let bad = against(&broken("rac4i65_core_dff_1", "q = 1'h0;", "q = 1'h1;"));
    assert!(bad.differences.is_empty() && bad.starts.different > 0, "{bad:?}");
}

/// A block memory that is joined, set or filled otherwise than its memory: none of these may be proven.
#[test]
fn a_memory_that_is_mapped_wrongly_is_seen() {
    let good = netlist();
    let low = "core.sequencer.memory.mem.0.0";
    let high = "core.sequencer.memory.mem.0.1";
    type Mutant = (&'static str, fn(&mut Value));
    let cells = |netlist: &'_ mut Value| netlist["modules"][NAME]["cells"].take();
    let mutants: [Mutant; 9] = [
        ("lanes of the output swapped", |cells| {
            let low = cells["core.sequencer.memory.mem.0.0"]["connections"]["DOB"].take();
            let high = std::mem::replace(&mut cells["core.sequencer.memory.mem.0.1"]["connections"]["DOB"], low);
            cells["core.sequencer.memory.mem.0.0"]["connections"]["DOB"] = high;
        }),
        ("lanes of the input swapped", |cells| {
            let low = cells["core.sequencer.mirror.mem.0.0"]["connections"]["DIA"].take();
            let high = std::mem::replace(&mut cells["core.sequencer.mirror.mem.0.1"]["connections"]["DIA"], low);
            cells["core.sequencer.mirror.mem.0.0"]["connections"]["DIA"] = high;
        }),
        ("two address bits of the reading port swapped", |cells| {
            cells["core.imu.words.mem.0.0"]["connections"]["ADDRB"].as_array_mut().expect("pins").swap(0, 1);
        }),
        ("an address bit of the writing port at 0", |cells| {
            cells["core.sequencer.memory.mem.0.1"]["connections"]["ADDRA"][7] = json!("0");
        }),
        ("one bit of the program's contents", |cells| {
            let row = &mut cells["core.sequencer.rom.mem.0.1"]["parameters"]["INIT_03"];
            let mut bits = row.as_str().expect("bits").to_owned().into_bytes();
            bits[100] ^= 1;
            *row = json!(String::from_utf8(bits).expect("digits"));
        }),
        ("written at every clock", |cells| {
            cells["core.radio.memory.mem.0.0"]["connections"]["WE"] = json!(["1"]);
        }),
        ("the reading port writes", |cells| {
            cells["core.imu.words.mem.0.0"]["connections"]["WEB"] = json!(["1"]);
        }),
        ("never enabled", |cells| {
            cells["core.trigonometry.sines.mem.0.0"]["connections"]["EN"] = json!(["0"]);
        }),
        ("always reset", |cells| {
            cells["core.sequencer.mirror.mem.0.0"]["connections"]["RSTB"] = json!(["1"]);
        }),
    ];
    for (what, mutant) in mutants {
        let mut netlist = good.clone();
        let mut own = cells(&mut netlist);
        assert!(own[low].is_object() && own[high].is_object());
        mutant(&mut own);
        netlist["modules"][NAME]["cells"] = own;
        assert_ne!(netlist, good, "{what}");
        let found = compared(&netlist);
        assert!(!found.differences.is_empty(), "{what}: {found:?}");
        println!("{what}: {}", found.differences[0]);
    }
}

/// A mirror of the program's memory that does not say when the bus reads what is written in the same clock: text and
/// netlist are alike, but what the block gives then would count.
#[test]
fn a_read_that_meets_a_write_must_not_count() {
    let hits = "bus_hits_d = memory_write_enable & (memory_write_address == bus_address);";
    assert_eq!(COMMITTED_VERILOG.matches(hits).count(), 1);
    let text = COMMITTED_VERILOG.replace(hits, &hits.replace("memory_write_enable", "storing_q"));
    let found = prove(&text, NAME).unwrap_or_else(|error| panic!("{error}"));
    assert!(found.differences.iter().any(|what| what.starts_with("clauses")), "{:?}", found.differences);
}
