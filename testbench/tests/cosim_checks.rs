//! The checks can fail: circuits that are known to be wrong are caught, each by the check that is
//! there for it.

use hdl::sim::cycle;
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;
use simulator::cosim::{CosimError, Ports, Verilated, icarus, lint};

/// Signed subtraction with a widening cast: right in rust-hdl's simulation, one bit short in its
/// Verilog.
#[derive(LogicBlock, Default)]
struct LostSign {
    clock: Signal<In, Clock>,
    x: Signal<In, Signed<16>>,
    y: Signal<In, Signed<16>>,
    difference: Signal<Out, Bits<17>>,
    held: DFF<Bits<17>>,
}

impl Logic for LostSign {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, held);
        self.held.d.next =
            unsigned_cast(signed_bit_cast::<17, 16>(self.x.val()) - signed_bit_cast::<17, 16>(self.y.val()));
        self.difference.next = self.held.q.val();
    }
}

/// A sum compared before it is stored: 16 bits wide in the simulation, 32 in the Verilog.
#[derive(LogicBlock, Default)]
struct LostWrap {
    clock: Signal<In, Clock>,
    a: Signal<In, Bits<16>>,
    wraps: Signal<Out, Bit>,
    held: DFF<Bit>,
}

impl Logic for LostWrap {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, held);
        self.held.d.next = (self.a.val() + 1) == 0;
        self.wraps.next = self.held.q.val();
    }
}

/// The same with the sum in a signal of its own, as it should be.
#[derive(LogicBlock, Default)]
struct KeptWrap {
    clock: Signal<In, Clock>,
    a: Signal<In, Bits<16>>,
    wraps: Signal<Out, Bit>,
    held: DFF<Bit>,
    sum: Signal<Local, Bits<16>>,
}

impl Logic for KeptWrap {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, held);
        self.sum.next = self.a.val() + 1;
        self.held.d.next = self.sum.val() == 0;
        self.wraps.next = self.held.q.val();
    }
}

const VALUES: [u32; 4] = [0, 0xFFFF, 1, 0xFFFF];

fn verilog<B: Block + Default>() -> (String, Ports) {
    let mut block = B::default();
    block.connect_all();
    (generate_verilog(&block), Ports::of(&block).unwrap())
}

fn findings(error: &CosimError) -> &[String] {
    let CosimError::Lint { findings, .. } = error else {
        panic!("not a lint error: {error}");
    };
    findings
}

#[test]
fn a_lost_sign_is_caught_by_the_gate() {
    let (text, _) = verilog::<LostSign>();
    let error = lint::gate("lost_sign", &text, "top").unwrap_err();
    assert!(findings(&error).iter().all(|f| f.contains("WIDTH") && f.contains("generates 16 bits")), "{error}");
}

#[test]
fn a_lost_wrap_is_caught_by_both_simulators_and_by_our_own_rule() {
    let simulation = VALUES.map(|a| {
        let mut block = LostWrap::default();
        block.connect_all();
        block.a.next = u64::from(a).into();
        cycle(&mut block, |b, level| b.clock.next = level.into());
        u32::from(block.wraps.val())
    });
    assert_eq!(simulation, [0, 1, 0, 1]);
    let (text, ports) = verilog::<LostWrap>();
    assert!(lint::verilator("lost_wrap", &text, "top").unwrap().iter().all(|f| !f.is_fatal()));
    let error = lint::gate("lost_wrap", &text, "top").unwrap_err();
    assert!(findings(&error).iter().all(|f| f.contains("COMPARED")), "{error}");
    let compiled = Verilated::build("lost_wrap", &text, "top", &ports).unwrap().run(&VALUES).unwrap();
    assert_ne!(compiled, simulation);
    assert_eq!(compiled, icarus::run("lost_wrap", &text, "top", &ports, &VALUES).unwrap());

    let (text, ports) = verilog::<KeptWrap>();
    lint::gate("kept_wrap", &text, "top").unwrap();
    let compiled = Verilated::build("kept_wrap", &text, "top", &ports).unwrap().run(&VALUES).unwrap();
    assert_eq!(compiled, simulation);
    assert_eq!(icarus::run("kept_wrap", &text, "top", &ports, &VALUES).unwrap(), simulation);
}

#[test]
fn arithmetic_in_comparisons_is_found_whatever_its_form() {
    let found = |text| lint::compared_arithmetic(text).len();
    for wrong in ["(a + 32'h1) == b", "b != (~a)", "((a - b)) < c", "c >= (a << 2)", "(x * y) >> 3", "q >> (a + b)"] {
        assert_eq!(found(wrong), 1, "{wrong}");
    }
    for right in
        ["(a) == b", "q <= a + b;", "x[(a + b)] == c", "(a & b) < (c | d)", "(a << 2) + (b)", "y = ((a) & 8'hff) >> 2"]
    {
        assert_eq!(found(right), 0, "{right}");
    }
}

#[test]
fn latches_undriven_nets_double_drivers_and_loops_do_not_pass() {
    let cases = [
        ("a latch", "LATCH", "always @(*) if (a) y = b; else if (b) y = 1'b0;"),
        ("no driver", "UNDRIVEN", "wire n; always @(*) y = n;"),
        ("two drivers", "MULTIDRIVEN", "always @(posedge a) y <= b; always @(posedge b) y <= a;"),
        ("a loop", "UNOPTFLAT", "wire [1:0] n; assign n = {n[0] ^ a, n[1] ^ b}; always @(*) y = n[0];"),
        ("a case without default", "CASEINCOMPLETE", "always @(posedge a) case (b) 1'b0: y <= 1'b1; endcase"),
        ("a missing port", "PINMISSING", "wire n; inner i (.a(a), .b(n)); always @(*) y = n;"),
    ];
    for (what, kind, body) in cases {
        let text = format!(
            "module top (input wire a, input wire b, output reg y);\n{body}\nendmodule\n\
             module inner (input wire a, output wire b, input wire c);\nassign b = a & c;\nendmodule\n"
        );
        let Err(error) = lint::gate("broken", &text, "top") else {
            panic!("{what} passed");
        };
        assert!(findings(&error).iter().any(|f| f.contains(kind)), "{what}: {error}");
    }
}

#[test]
fn nonsense_is_reported_by_every_tool() {
    let text = "module top (input wire a, output wire y);\nassign y = a +;\nendmodule\n";
    let ports = Ports::parse(text, "top", &[]).unwrap();
    let findings = lint::verilator("nonsense", text, "top").unwrap();
    assert!(findings.iter().any(|f| f.kind == "ERROR" && f.line == 2), "{findings:?}");
    assert!(!lint::yosys("nonsense", text, "top").unwrap().is_empty());
    let message = Verilated::build("nonsense", text, "top", &ports).unwrap_err().to_string();
    assert!(message.contains("verilator failed on nonsense"), "{message}");
    let message = icarus::run("nonsense", text, "top", &ports, &[1]).unwrap_err().to_string();
    assert!(message.contains("iverilog failed on nonsense"), "{message}");
}

#[test]
fn icarus_shows_what_was_never_driven() {
    let text =
        "module top (input wire clock, input wire a, output reg y);\nalways @(posedge clock) y <= y ^ a;\nendmodule\n";
    let ports = Ports::parse(text, "top", &["clock"]).unwrap();
    let error = icarus::run("no_initial", text, "top", &ports, &[0, 1]).unwrap_err();
    assert!(matches!(error, CosimError::Unknown { step: 0, .. }), "{error}");
}

#[test]
fn a_tristate_bus_has_two_sides() {
    let text = "module top (input wire clock, inout wire [7:0] lad, input wire drive, output reg [7:0] seen);\n\
                initial seen = 0;\nassign lad = drive ? 8'h5a : 8'bz;\nalways @(posedge clock) seen <= lad;\nendmodule\n";
    let ports = Ports::parse(text, "top", &["clock"]).unwrap();
    // lad, lad.drive, drive -> lad, seen
    let stimulus = [0x11, 1, 0, 0x22, 0, 1, 0x33, 1, 0];
    let expected = [0x11, 0x11, 0x5a, 0x5a, 0x33, 0x33];
    let compiled = Verilated::build("tristate", text, "top", &ports).unwrap();
    assert_eq!(compiled.run(&stimulus).unwrap(), expected);
    assert_eq!(icarus::run("tristate", text, "top", &ports, &stimulus).unwrap(), expected);
}

#[test]
fn a_bus_without_answer_is_an_error_not_a_wait() {
    let text = "module top (input wire lclk, input wire ads_n, input wire blast_n, input wire lw_r,\n\
                inout wire [31:0] lad, output wire ready_n);\nassign lad = 32'bz;\n\
                assign ready_n = ads_n | blast_n | lw_r | lclk | 1'b1;\nendmodule\n";
    let ports = Ports::parse(text, "top", &["lclk"]).unwrap();
    let mut session = Verilated::build("mute", text, "top", &ports).unwrap().start().unwrap();
    let message = session.bus_read(0x100).unwrap_err().to_string();
    assert!(message.contains("read of 1 at 0x0100") && message.contains("READY#"), "{message}");
}
