//! The emitted Verilog is the netlist that the bits are made of.

use hdl::design::{COMMITTED_VERILOG, NAME};
use measured::Table;
use testbench::equivalence::{Compared, prove};

const TABLE: Table<'_> = Table {
    name: "equivalence",
    title: "The emitted Verilog against the flow's netlist: flip-flops, inputs of memories and pads, in bits",
    command: "cargo test --release -p testbench --test equivalence",
    columns: &["step", "proven equal", "not proven"],
};

#[test]
fn the_netlist_of_the_flow_is_the_emitted_verilog() {
    let both = prove(COMMITTED_VERILOG, COMMITTED_VERILOG, NAME).unwrap_or_else(|error| panic!("{error}"));
    let row = |step: &str, compared: Compared| {
        vec![step.to_owned(), compared.proven.to_string(), compared.unproven.to_string()]
    };
    let [equal, different] = [both.starts.equal, both.starts.different].map(|count| count.to_string());
    TABLE.check(&[
        row("Verilog to its optimised form, memories as boxes", both.text),
        row("that to the cells of the device, block memories as boxes", both.netlist),
        vec!["start values of flip-flops, where the Verilog says one".to_owned(), equal, different],
    ]);
    assert!(both.starts.different == 0 && both.starts.equal > 1_500, "{:?}", both.starts);
    assert_eq!((both.text.unproven, both.netlist.unproven), (0, 0));
    assert!(both.text.proven > 2_000 && both.netlist.proven > 2_000, "{both:?}");
}

/// One operator of a small block turned over: the proof must not close.
#[test]
fn a_block_that_is_not_its_text_is_seen() {
    let block = "rac4i65_core_interrupt";
    let good = prove(COMMITTED_VERILOG, COMMITTED_VERILOG, block).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((good.text.unproven, good.netlist.unproven), (0, 0), "{good:?}");
    let at = COMMITTED_VERILOG.find(&format!("module {block} ")).expect("the block");
    let (before, after) = COMMITTED_VERILOG.split_at(at);
    let broken = before.to_owned() + &after.replacen(" & ", " | ", 1);
    let bad = prove(COMMITTED_VERILOG, &broken, block).unwrap_or_else(|error| panic!("{error}"));
    assert!(bad.text.unproven > 0, "{bad:?}");
    assert!(good.starts.equal > 0 && good.starts.different == 0, "{good:?}");
    // Of another start value, it is seen to begin differently.
    let at = COMMITTED_VERILOG.find("module rac4i65_core_dff_1 ").expect("its flip-flops");
    let (before, after) = COMMITTED_VERILOG.split_at(at);
    let broken = before.to_owned() + &after.replacen("q = 1'h0;", "q = 1'h1;", 1);
    assert_ne!(broken, COMMITTED_VERILOG);
    let bad = prove(COMMITTED_VERILOG, &broken, block).unwrap_or_else(|error| panic!("{error}"));
    assert!(bad.starts.different > 0, "{bad:?}");
}
