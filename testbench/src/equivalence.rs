//! The emitted Verilog against the netlist that the flow makes bits of: the same circuit, for every input and every state.
//!
//! ```text
//! Verilog ──► flattened, operators as gates ──┐  cut at flip-flops and     ┌─► abc: equal for all values?
//! Verilog ──► the flow's synthesis ──► cells ─┴─ block memories, by name ──┘
//! ```
//!
//! Induction over clocks. Both circuits begin alike: start values of flip-flops and contents of memories are compared bit by
//! bit. If they agree before a clock (every flip-flop of the text with what its name has become in the netlist, every memory
//! with its blocks) they agree after it, because every next state, every pin of a block and every pad is the same
//! function of the same values: proven one clock at a time, without unrolling. What a block does with its pins is in
//! `memories`, and what happens where a read meets a write in `collisions`.
//!
//! Taken as it is: how yosys reads Verilog and writes operators as gates, and abc's `cec`.

mod collisions;
mod json;
mod memories;
mod miter;
mod netlist;
mod text;
mod verdict;

pub use verdict::{Equivalence, Starts};

use crate::netlist::Netlist;
use json::Module;
use miter::Miter;
use netlist::Gates;
use simulator::cosim::{CosimError, folder};
use text::Text;

/// Proves `top` of `text` equal to what the flow makes of it.
///
/// # Errors
/// A tool that is missing or fails, cells that the proof does not know, files that cannot be written.
pub fn prove(text: &str, top: &str) -> Result<Equivalence, CosimError> {
    compare(text, &Netlist::of(text, top)?.json(), top)
}

/// Compares `top` of `text` with a netlist of it, in the JSON of yosys.
///
/// # Errors
/// As [`prove`].
pub fn compare(text: &str, netlist: &str, top: &str) -> Result<Equivalence, CosimError> {
    let script = text::script(top);
    let cached = folder::cached(&format!("equivalence-{top}"), &[text, &script], |folder| {
        folder::write(&folder.join("text.v"), text)?;
        folder::must("yosys", &["-q", "-p", &script], folder, top).map(|_| ())
    })?;
    let file = cached.join("text.json");
    let json = std::fs::read_to_string(&file).map_err(CosimError::file("read", &file))?;
    let folder = folder::fresh(&folder::root(), &format!("equivalence-{top}"))?;
    let unknown = |what: String| CosimError::Tool {
        tool: "the proof of equivalence".into(),
        what: top.to_owned(),
        folder: folder.clone(),
        output: what,
    };
    let mut found = Equivalence::default();
    let mut miter = Miter::new();
    let module = Module::parse(&json, top).map_err(unknown)?;
    let gates = Gates::of(netlist, top).map_err(unknown)?;
    gates.build(&mut miter).map_err(unknown)?;
    Text::new(&module, &gates).build(&mut miter, &mut found).map_err(unknown)?;
    // Without its blocks a memory of the text is joined to nothing.
    if found.differences.is_empty() {
        found.differences = miter.prove(&folder)?;
    }
    let count = |kind| miter.counts.get(kind).copied().unwrap_or(0);
    (found.flip_flops, found.pins) = (count("flip-flops"), count("pins of memories"));
    (found.pads, found.clauses) = (count("pads"), count("clauses"));
    std::fs::remove_dir_all(&folder).map_err(CosimError::file("remove", &folder))?;
    Ok(found)
}
