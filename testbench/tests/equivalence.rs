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

/// What the flow maps by rules of its own: counters of every shape that it looks for, comparisons each way, short sums.
#[test]
fn loaded_counters_comparisons_and_short_sums_are_their_text() {
    let mut ports = vec!["input clock".to_owned(), "input [13:0] word".into(), "input load".into()];
    let mut body = String::new();
    // Registers inside, so that their names stay when ports get their buffers.
    let register = |ports: &mut Vec<String>, name: &str, width: usize| {
        ports.push(format!("output [{0}:0] {name}_out", width - 1));
        format!("reg [{0}:0] {name} = 0; assign {name}_out = {name};\n", width - 1)
    };
    // What is loaded with ones is set by its flip-flops, and bit 0 of such a counter only turns.
    let (mut bits, mut turning) = (0, 0);
    for width in [7, 11] {
        for (sign, way) in [('+', "up"), ('-', "down")] {
            for (what, filled) in [(format!("word[{}:0]", width - 1), "word"), (format!("~{width}'d0"), "ones")] {
                for (test, side) in [("load", "high"), ("!load", "low")] {
                    let name = format!("{way}_{filled}_{side}_{width}");
                    body += &register(&mut ports, &name, width);
                    body += &format!("always @(posedge clock) {name} <= {test} ? {what} : {name} {sign} 1'd1;\n");
                    bits += width;
                    turning += usize::from(filled == "ones");
                }
            }
        }
    }
    for (at, test) in ["<", "<=", ">", ">="].into_iter().enumerate() {
        body += &register(&mut ports, &format!("compared_{at}"), 3);
        body += &format!(
            "always @(posedge clock) compared_{at} <= {{up_word_low_11 {test} word, word {test} 14'd1234, word[3:0] {test} word[7:4]}};\n"
        );
    }
    body += &register(&mut ports, "short", 3);
    body += "always @(posedge clock) short <= load ? word[2:0] - word[5:3] : word[2:0] + 1'd1;\n";
    let text = format!("module rules({});\n{body}endmodule\n", ports.join(", "));
    let netlist = Netlist::of(&text, "rules").unwrap_or_else(|error| panic!("{error}"));
    let found = compare(&text, &netlist.json(), "rules").unwrap_or_else(|error| panic!("{error}"));
    assert!(found.holds() && found.flip_flops == bits + 15, "{found:?}");
    let wrong = text.replace("word >= 14'd1234", "word > 14'd1234");
    assert_ne!(wrong, text);
    let bad = compare(&wrong, &netlist.json(), "rules").unwrap_or_else(|error| panic!("{error}"));
    assert!(!bad.differences.is_empty(), "{bad:?}");
    // A counter's bit is one table and its sum; the rest is what compares and adds shortly.
    let tables: usize = netlist.cells.iter().filter(|(cell, _)| cell.starts_with("LUT")).map(|(_, used)| used).sum();
    assert!(tables <= bits + 80, "{tables} tables for {bits} bits: {:?}", netlist.cells);
    assert_eq!(netlist.cells["XORCY"], bits - turning, "a counter that is not on a carry chain");
}

/// Sums that the flow maps by rules of its own, each with a register behind it: a plain counter up and down, whose bit 0 needs no chain;
/// a sum that turns into a difference; one whose second operand is stored; and a comparison whose answer is called late.
#[test]
fn plain_counters_turned_sums_and_late_answers_are_their_text() {
    const WIDTH: usize = 16;
    let text = format!(
        "module sums(input clock, input turn, input [{0}:0] word, output [{0}:0] up_out, down_out, turned_out, total_out, output late_out);\n\
         reg [{0}:0] a = 0, b = 0, c = 0, d = 0, up = 5, down = 9, turned = 0, total = 0; reg late = 0;\n\
         assign up_out = up; assign down_out = down; assign turned_out = turned; assign total_out = total; assign late_out = late;\n\
         wire [{0}:0] left = turn ? ~a : a; wire [{0}:0] sum = left + b;\n\
         always @(posedge clock) begin\n\
         a <= word; b <= a; c <= b; d <= c; up <= up + 1'd1; down <= down - 1'd1; turned <= turn ? ~sum : sum; total <= (turn ? ~c : c) + d;\n\
         late <= (a >= d) & turn;\nend\nendmodule\n",
        WIDTH - 1
    );
    let netlist = Netlist::of(&text, "sums").unwrap_or_else(|error| panic!("{error}"));
    let against = |text: &str| compare(text, &netlist.json(), "sums").unwrap_or_else(|error| panic!("{error}"));
    let found = against(&text);
    assert!(found.holds() && found.flip_flops == 8 * WIDTH + 1, "{found:?}");
    let wrong = [("~sum : sum", "~sum : left"), ("~c : c", "c : c"), ("up + 1'd1", "up + 2'd3"), ("a >= d", "a > d")];
    for (from, to) in wrong {
        assert!(text.contains(from), "{from}");
        assert!(!against(&text.replace(from, to)).differences.is_empty(), "{to}");
    }
    let used = |cell: &str| netlist.cells.get(cell).copied().unwrap_or(0);
    assert_eq!(used("XORCY"), 2 * WIDTH + 2 * (WIDTH - 1), "{:?}", netlist.cells);
    // A table a bit of each sum and of the comparison, and the one after it; what has one input is a wire to the flow.
    assert_eq!(used("LUT2") + used("LUT3") + used("LUT4"), 3 * WIDTH + 1, "{:?}", netlist.cells);
    assert_eq!(used("VCC") + used("GND"), 0, "what was not to be known is still there: {:?}", netlist.cells);
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
