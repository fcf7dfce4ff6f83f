//! The emitted Verilog against the netlist that the flow makes bits of, by yosys' induction: same flip-flops, same
//! memories, same pads, for every input and every state in which they agree.
//!
//! ```text
//! Verilog ──► flattened ══ proven ══ optimised ──► block memories ══ proven ══ netlist ──► bits
//!             (memories as boxes)    (as boxes)    (as boxes)                   of the flow
//! ```
//!
//! A memory counts as the same box on both sides: what goes in is proven, what comes out is assumed. How a memory of the
//! text becomes block memories only simulation says. Induction says nothing of the beginning: the start value of every
//! flip-flop of the netlist is compared with what the text says, bit by bit.

use bitstream::flow::synthesis;
use simulator::cosim::{CosimError, folder};
use std::collections::HashMap;
use std::fmt::Write;
use std::path::Path;

/// Points that were compared: flip-flops, inputs of memories, pads; in bits.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Compared {
    /// Proven equal.
    pub proven: usize,
    /// Not.
    pub unproven: usize,
}

/// Start values of the netlist's flip-flops.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Starts {
    /// As the text says.
    pub equal: usize,
    /// Not so.
    pub different: usize,
    /// The text leaves it open: that none of these reaches a pin undefined, simulation with four states shows.
    pub open: usize,
}

/// Both proofs: the text against its optimised form, and that against the netlist.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Equivalence {
    /// Verilog, flattened and no more, against what synthesis makes of it before it maps anything.
    pub text: Compared,
    /// With block memories, against the cells of the device.
    pub netlist: Compared,
    /// How both begin.
    pub starts: Starts,
}

/// Pads without their delay and drive.
const PADS: &str = "module IBUF(output O, input I); assign O = I; endmodule
module OBUF(output O, input I); assign O = I; endmodule
module BUFG(output O, input I); assign O = I; endmodule
";
const CELLS: &str = "gate/t:FD* gate/t:LUT* gate/t:MUX* gate/t:XORCY gate/t:INV %u %u %u %u";
/// Flip-flops of the same input and start value are one: three times, for chains of them.
const MERGE: &str = "opt_merge\nopt_clean\nopt_merge\nopt_clean\nopt_merge\nopt_clean";

/// Proves `top` of `text` equal to what the flow makes of `synthesised`, which is the same text but in a test of this proof.
///
/// # Errors
/// A yosys that is missing or fails, files that cannot be written.
pub fn prove(text: &str, synthesised: &str, top: &str) -> Result<Equivalence, CosimError> {
    let stages = format!(
        "read_verilog synthesised.v\nsynth_xilinx -family xcv -top {top} -flatten -run begin:map_memory\n\
         write_rtlil optimised.il\nsynth_xilinx -family xcv -top {top} -flatten -run map_memory:fine\n\
         write_rtlil memories.il\ndesign -reset\nread_verilog text.v\nhierarchy -check -top {top}\nproc\nflatten\n\
         tribuf -logic\nopt_expr\nopt_clean\nmemory -nomap\nopt_clean\nwrite_rtlil text.il\n"
    );
    let flow = synthesis::script(top).replace("design.v", "synthesised.v") + "; write_rtlil netlist.il";
    let head = |gold: &str, gate: &str| {
        format!("read_rtlil {gold}\nrename {top} gold\nread_rtlil {gate}\nrename {top} gate\n")
    };
    let compare = |memories: &str, log: &str| {
        format!(
            "select -set keep t:$dff %co1:+[Q] t:{memories} %co1 %u t:{memories} %ci1 %u o:* i:* %u %u w:* %i\n\
             rename -hide w:* @keep %d\ncd ..\nequiv_make gold gate eq\ncd eq\nopt_clean\nequiv_simple\n\
             equiv_induct -seq 1\nequiv_induct -seq 3\ntee -o {log} equiv_status\n"
        )
    };
    let boxes = "delete A:blackbox A:whitebox %u\n";
    let first = head("text.pads.il", "optimised.pads.il")
        + &format!("{boxes}memory_map */c:*proc_rom*\ncd gate\ndffunmap\ncd ..\ncd gold\n{MERGE}\ndffunmap\n")
        + &compare("$mem*", "first.log");
    let second = head("memories.pads.il", "netlist.pads.il")
        + &format!("techmap -map pads.v gate\ntechmap -autoproc -map +/xilinx/cells_sim.v {CELLS}\n{boxes}")
        + "cd gate\nopt_clean\ncd ..\ncd gold\ndffunmap\n"
        + &compare("RAMB4*", "second.log");
    let content = [text, synthesised, &stages, &flow, &first, &second, PADS];
    let folder = folder::cached(&format!("equivalence-{top}"), &content, |folder| {
        for (name, content) in [
            ("text.v", text),
            ("synthesised.v", synthesised),
            ("pads.v", PADS),
            ("stages.ys", &stages),
            ("first.ys", &first),
            ("second.ys", &second),
        ] {
            folder::write(&folder.join(name), content)?;
        }
        let yosys = |script: &str| folder::must("yosys", &["-q", "-p", script], folder, top).map(|_| ());
        yosys("script stages.ys")?;
        yosys(&flow)?;
        for name in ["text", "optimised", "memories", "netlist"] {
            let text = read(&folder.join(format!("{name}.il")))?;
            folder::write(&folder.join(format!("{name}.pads.il")), &without_three_state(&text, top))?;
        }
        std::thread::scope(|scope| {
            let first = scope.spawn(|| yosys("script first.ys"));
            yosys("script second.ys").and(first.join().expect("no panic of its own"))
        })
    })?;
    let status = |name: &str| read(&folder.join(name)).map(|log| compared(&log));
    let starts = starts(&read(&folder.join("text.il"))?, &read(&folder.join("netlist.il"))?);
    Ok(Equivalence { text: status("first.log")?, netlist: status("second.log")?, starts })
}

fn read(path: &Path) -> Result<String, CosimError> {
    std::fs::read_to_string(path).map_err(CosimError::file("read", path))
}

/// What `equiv_status` counted.
fn compared(log: &str) -> Compared {
    let line = log.lines().find(|line| line.contains("Of those cells")).unwrap_or_default();
    let mut numbers = line.split_whitespace().filter_map(|word| word.parse().ok());
    Compared { proven: numbers.next().unwrap_or(0), unproven: numbers.next().unwrap_or(usize::MAX) }
}

/// A bit of a wire of RTLIL, as `\\name [3]`; a wire of one bit has no index.
fn bit(signal: &str) -> Option<(&str, usize)> {
    match signal.split_once(' ') {
        None => Some((signal, 0)),
        Some((name, index)) => Some((name, index.strip_prefix('[')?.strip_suffix(']')?.parse().ok()?)),
    }
}

/// Compares the start values of the flip-flops of a netlist with those of the wires of the text, both in RTLIL.
fn starts(text: &str, netlist: &str) -> Starts {
    let mut said: HashMap<(&str, usize), char> = HashMap::new();
    let mut pending = None;
    for line in text.lines() {
        if let Some(value) = line.strip_prefix("  attribute \\init ") {
            pending = value.split_once('\'').map(|value| value.1);
        } else if let Some(wire) = line.strip_prefix("  wire ") {
            let name = wire.rsplit(' ').next().unwrap_or_default();
            let bits = pending.take().into_iter().flat_map(|bits| bits.chars().rev().enumerate());
            said.extend(bits.filter(|(_, value)| *value != 'x').map(|(index, value)| ((name, index), value)));
        }
    }
    let mut starts = Starts::default();
    let mut value = None;
    for line in netlist.lines() {
        if let Some(parameter) = line.strip_prefix("    parameter \\INIT 1'") {
            value = parameter.chars().next();
        } else if line.starts_with("  cell ") {
            value = None;
        } else if let (Some(own), Some(output)) = (value, line.strip_prefix("    connect \\Q ")) {
            match bit(output).and_then(|bit| said.get(&bit)) {
                Some(text) if *text == own => starts.equal += 1,
                Some(_) => starts.different += 1,
                None => starts.open += 1,
            }
        }
    }
    starts
}

/// The same design with two outputs in place of the buffers of an inout port `lad`: what they would drive and whether they
/// are off. No proof takes a line of three states.
fn without_three_state(design: &str, top: &str) -> String {
    let mut out: Vec<String> = Vec::new();
    let mut joined = Vec::new();
    let mut lines = design.lines();
    let mut inside = false;
    while let Some(line) = lines.next() {
        inside |= line == format!("module \\{top}");
        let buffer = ["  cell \\IOBUF ", "  cell $tribuf "].iter().position(|cell| line.starts_with(cell));
        if let Some(kind) = buffer.filter(|_| inside) {
            while out.last().is_some_and(|line| line.starts_with("  attribute")) {
                out.pop();
            }
            let pins: HashMap<&str, &str> = lines
                .by_ref()
                .take_while(|line| *line != "  end")
                .filter_map(|line| line.trim().strip_prefix("connect \\")?.split_once(' '))
                .collect();
            if kind == 0 {
                let bit = pins["IO"].trim_start_matches("\\lad ");
                joined.push(format!("  connect {} \\lad {bit}", pins["O"]));
                joined.push(format!("  connect \\pad_out {bit} {}", pins["I"]));
                joined.push(format!("  connect \\pad_off {bit} {}", pins["T"]));
            } else {
                let mut not = String::from("  cell $not $pad_off\n    parameter \\A_SIGNED 0\n");
                not += "    parameter \\A_WIDTH 1\n    parameter \\Y_WIDTH 1\n";
                write!(not, "    connect \\A {}\n    connect \\Y \\pad_off_1\n  end", pins["EN"]).expect("memory");
                out.push(not);
                joined.push(format!("  connect \\pad_out {}", pins["A"]));
                joined.push(format!("  connect \\pad_off {{{} }}", " \\pad_off_1".repeat(32)));
            }
            continue;
        }
        if inside && line == "end" {
            out.append(&mut joined);
            inside = false;
        }
        if inside && line.starts_with("  wire width 32 inout ") && line.ends_with(" \\lad") {
            out.push(
                "  wire width 32 output 901 \\pad_out\n  wire width 32 output 902 \\pad_off\n  wire \\pad_off_1".into(),
            );
            out.push(line.replace("inout", "input"));
            continue;
        }
        out.push(line.into());
    }
    out.join("\n") + "\n"
}
