//! The emitted Verilog, flattened, as a circuit without memory: gates, with flip-flops and memories as inputs of the
//! netlist's names.

use super::collisions::{CLAUSES, Clause};
use super::json::{Bit, Cell, Module, indexed};
use super::memories::{Lane, Wanted, lanes};
use super::miter::{Miter, ONE, Side, ZERO};
use super::netlist::{Became, Gates, signal};
use super::verdict::{Equivalence, Starts};
use bitstream::flow::netlist::Signal;
use std::collections::HashMap;

/// What yosys does to the text: flattened, memories kept, operators as gates. No optimisation but of constants.
pub(super) fn script(top: &str) -> String {
    format!(
        "read_verilog text.v; hierarchy -check -top {top}; proc; flatten; tribuf -logic; opt_expr; opt_clean; \
         memory -nomap; opt_clean; memory_map */c:*proc_rom*; techmap; simplemap; dffunmap; opt_clean; \
         setattr -unset src w:* c:*; write_json text.json"
    )
}

/// See the module.
pub(super) struct Text<'a> {
    module: &'a Module,
    gates: &'a Gates,
    /// Names by net.
    names: HashMap<&'a Bit, Vec<String>>,
    /// Flip-flops by every name of their output: what they became, signal of their next state, start value.
    next: HashMap<String, (Became, String, Option<bool>)>,
    /// For each memory with a clause, the signal that says that a read meets a write.
    meets: HashMap<&'static str, String>,
}

/// The signal at a bit.
fn at(bit: &Bit) -> String {
    match bit {
        Bit::Net(net) => format!("w{net}"),
        Bit::Constant(value) => if value == "1" { ONE } else { ZERO }.into(),
    }
}

impl<'a> Text<'a> {
    pub(super) fn new(module: &'a Module, gates: &'a Gates) -> Self {
        let mut names: HashMap<&Bit, Vec<String>> = HashMap::new();
        for (name, bit) in module.names() {
            names.entry(bit).or_default().push(name);
        }
        Self { module, gates, names, next: HashMap::new(), meets: HashMap::new() }
    }

    /// Builds gates, and all points to compare; counts start values and contents.
    pub(super) fn build(&mut self, miter: &mut Miter, found: &mut Equivalence) -> Result<(), String> {
        for (name, cell) in &self.module.cells {
            let pin = |name: &str| cell.connections.get(name).and_then(|bits| bits.first()).map(at).unwrap_or_default();
            let output = pin("Y");
            let rows: (&[&str], &[&str]) = match cell.kind.as_str() {
                "$_NOT_" => (&["A"], &["0"]),
                "$_AND_" => (&["A", "B"], &["11"]),
                "$_OR_" => (&["A", "B"], &["1-", "-1"]),
                "$_XOR_" => (&["A", "B"], &["10", "01"]),
                "$_XNOR_" => (&["A", "B"], &["11", "00"]),
                "$_MUX_" => (&["S", "A", "B"], &["01-", "1-1"]),
                "$_DFF_P_" | "$_TBUF_" | "$mem_v2" => continue,
                kind => return Err(format!("{name}: this proof does not know the cell {kind} of yosys")),
            };
            let inputs: Vec<String> = rows.0.iter().map(|name| pin(name)).collect();
            miter.gate(Side::Text, &inputs.iter().map(String::as_str).collect::<Vec<_>>(), &output, rows.1);
        }
        self.flip_flops(found)?;
        self.memories(miter, found)?;
        self.clauses(miter)?;
        self.points(miter)
    }

    /// A flip-flop of the text shows what a flip-flop of the netlist of one of its names shows; it may be one of several
    /// that have become the same, or a constant.
    fn flip_flops(&mut self, found: &mut Equivalence) -> Result<(), String> {
        let starts = self.module.starts();
        for (name, cell) in self.module.cells.iter().filter(|(_, cell)| cell.kind == "$_DFF_P_") {
            let (output, data) = (&cell.connections["Q"][0], &cell.connections["D"][0]);
            let names = self.names.get(output).map_or(&[][..], Vec::as_slice);
            let Some(became) = names.iter().find_map(|name| self.gates.became(name)) else {
                return Err(format!("{name}: no flip-flop of the netlist has one of its names {names:?}"));
            };
            let held = match became {
                Became::FlipFlop(at) => {
                    let flop = &self.gates.netlist.flip_flops[at];
                    let clock = self.names.get(&cell.connections["C"][0]).is_some_and(|names| {
                        names.iter().any(|name| Some(name.as_str()) == self.gates.clock(flop.clock))
                    });
                    if !clock {
                        found.differ(format!("{name}: another clock"));
                    }
                    flop.initial
                }
                Became::Constant(value) => Some(value),
            };
            let Starts { equal, different, open } = &mut found.starts;
            *match starts.get(output) {
                None => open,
                Some(start) if Some(*start) == held => equal,
                Some(_) => different,
            } += 1;
            names.iter().for_each(|name| {
                self.next.insert(name.clone(), (became, at(data), starts.get(output).copied()));
            });
        }
        Ok(())
    }

    fn memories(&mut self, miter: &mut Miter, found: &mut Equivalence) -> Result<(), String> {
        let module = self.module;
        for (name, cell) in module.cells.iter().filter(|(_, cell)| cell.kind == "$mem_v2") {
            let wanted = Wanted::of(cell).map_err(|what| format!("{name}: {what}"))?;
            let (lanes, said) = match lanes(name, &wanted, &self.gates.netlist) {
                Ok(held) => held,
                Err(what) => {
                    found.differ(what);
                    continue;
                }
            };
            found.memories += 1;
            found.blocks += lanes.len();
            found.contents += said;
            let meets = self.meets(miter, name, cell);
            for lane in &lanes {
                self.lane(miter, found, cell, lane, meets);
            }
        }
        Ok(())
    }

    /// Where a clause says what happens when a read meets a write: an input that says whether one did at the last clock,
    /// and whether one does at the next.
    fn meets(&mut self, miter: &mut Miter, name: &str, cell: &Cell) -> Option<&'static str> {
        let clause = CLAUSES.iter().find(|clause| clause.memory == Some(name))?;
        let memory = clause.memory?;
        miter.input(&format!("met.{memory}"));
        let mut meets = at(&cell.connections["WR_EN"][0]);
        for (read, write) in cell.connections["RD_ADDR"].iter().zip(&cell.connections["WR_ADDR"]) {
            let same = miter.fresh(Side::Text, &[&at(read), &at(write)], &["11", "00"]);
            meets = miter.fresh(Side::Text, &[&meets, &same], &["11"]);
        }
        self.meets.insert(memory, meets);
        Some(memory)
    }

    fn lane(&self, miter: &mut Miter, found: &mut Equivalence, cell: &Cell, lane: &Lane<'_>, meets: Option<&str>) {
        let pin = |name: &str| cell.connections.get(name).map_or(&[][..], Vec::as_slice);
        let name = |what: &str, index: usize| format!("{} {what} {index}", lane.memory.name);
        let clocks = [pin("RD_CLK"), pin("WR_CLK")].concat();
        let clock = self.gates.clock(lane.reader.clock);
        let same =
            |bit: &Bit| self.names.get(bit).is_some_and(|names| names.iter().any(|name| Some(name.as_str()) == clock));
        if !clocks.iter().all(same) {
            found.differ(format!("{}: another clock", lane.memory.name));
        }
        for (index, net) in lane.outputs().enumerate() {
            let text = at(&pin("RD_DATA")[lane.bits.start + index]);
            let Some(net) = net.map(|net| signal(Signal::of(net))) else {
                // Nothing of the netlist reads it: then nothing of the text may depend on it.
                let unread = format!("unread.{text}");
                miter.input(&unread);
                miter.gate(Side::Text, &[&unread], &text, &["1"]);
                continue;
            };
            match meets {
                Some(memory) => {
                    let other = format!("other.{memory}.{}", lane.bits.start + index);
                    miter.input(&other);
                    miter.gate(Side::Text, &[&format!("met.{memory}"), &other, &net], &text, &["11-", "0-1"]);
                }
                None => miter.gate(Side::Text, &[&net], &text, &["1"]),
            }
        }
        for (index, bit) in pin("RD_ADDR").iter().enumerate() {
            miter.point(
                "pins of memories",
                &name("read address", index),
                &at(bit),
                &signal(lane.reader.address[index]),
            );
        }
        let Some(writer) = lane.writer else { return };
        let enables = &pin("WR_EN")[lane.bits.clone()];
        let write = signal(writer.write);
        for (index, (enable, data)) in enables.iter().zip(&pin("WR_DATA")[lane.bits.clone()]).enumerate() {
            miter.point("pins of memories", &name("write enable", index), &at(enable), &write);
            let signals = [&*at(data), &*signal(writer.data[index])];
            miter.guarded("pins of memories", &name("data", index), [&at(enable), &write], signals);
        }
        for (index, bit) in pin("WR_ADDR").iter().enumerate() {
            let signals = [&*at(bit), &*signal(writer.address[index])];
            miter.guarded("pins of memories", &name("write address", index), [&at(&enables[0]), &write], signals);
        }
    }

    /// Assumes the clauses of this clock, and has those of the next proven.
    fn clauses(&self, miter: &mut Miter) -> Result<(), String> {
        let there = |clause: &&Clause| match clause.memory {
            Some(memory) => self.meets.contains_key(memory),
            None => clause.any.iter().all(|(name, _)| self.next.contains_key(*name)),
        };
        let clauses: Vec<&Clause> = CLAUSES.iter().filter(there).collect();
        // A clause is broken while all its literals are 0: rows of the table of "not broken", literal by literal.
        let rows = |clause: &Clause| -> Vec<String> {
            let wanted: Vec<bool> =
                clause.memory.map(|_| false).into_iter().chain(clause.any.iter().map(|any| any.1)).collect();
            let row = |at: usize| {
                (0..wanted.len())
                    .map(|n| {
                        if n != at {
                            '-'
                        } else if wanted[n] {
                            '1'
                        } else {
                            '0'
                        }
                    })
                    .collect()
            };
            (0..wanted.len()).map(row).collect()
        };
        let flop = |name: &str| {
            self.next.get(name).ok_or_else(|| format!("{name}: a clause of a flip-flop that the text does not have"))
        };
        for clause in &clauses {
            let begins = |(name, value): &(&str, bool)| self.next[*name].2 == Some(*value);
            if clause.memory.is_none() && !clause.any.iter().any(begins) {
                return Err(format!("a clause that does not hold at the start: {clause:?}"));
            }
            let mut inputs: Vec<String> = clause.memory.map(|memory| format!("met.{memory}")).into_iter().collect();
            for (name, _) in clause.any {
                inputs.push(self.gates.shows(flop(name)?.0));
            }
            let rows = rows(clause);
            miter.assume(
                &rows.iter().map(String::as_str).collect::<Vec<_>>(),
                &inputs.iter().map(String::as_str).collect::<Vec<_>>(),
            );
        }
        for clause in &clauses {
            let mut inputs: Vec<&str> = clause.memory.map(|memory| self.meets[memory].as_str()).into_iter().collect();
            for (name, _) in clause.any {
                inputs.push(&flop(name)?.1);
            }
            let rows = rows(clause);
            let holds = miter.fresh(Side::Text, &inputs, &rows.iter().map(String::as_str).collect::<Vec<_>>());
            let name = format!("{:?} {:?}", clause.memory, clause.any);
            miter.point("clauses", &name, &holds, ONE);
        }
        Ok(())
    }

    fn points(&self, miter: &mut Miter) -> Result<(), String> {
        let mut flops: Vec<(&str, &Cell)> = self
            .module
            .cells
            .iter()
            .filter(|(_, cell)| cell.kind == "$_DFF_P_")
            .map(|(name, cell)| (name.as_str(), cell))
            .collect();
        flops.sort_by_key(|(name, _)| *name);
        for (_, cell) in flops {
            let (output, data) = (&cell.connections["Q"][0], &cell.connections["D"][0]);
            let name = &self.names[output][0];
            let became = self.next[name].0;
            let shown = self.gates.shows(became);
            miter.gate(Side::Text, &[&shown], &at(output), &["1"]);
            miter.point("flip-flops", name, &at(data), &self.gates.next(became));
        }
        let pad = |name: &str| {
            let pad = self.gates.pads.get(name).map(|pad| &self.gates.netlist.pads[*pad]);
            pad.ok_or_else(|| format!("{name}: a port without a pad"))
        };
        let mut driven: HashMap<&Bit, &Cell> = HashMap::new();
        for cell in self.module.cells.values().filter(|cell| cell.kind == "$_TBUF_") {
            driven.insert(&cell.connections["Y"][0], cell);
        }
        for (port, bits) in &self.module.ports {
            for (index, bit) in bits.bits.iter().enumerate() {
                let name = indexed(port, index, bits.bits.len());
                let pad = pad(&name)?;
                let given = pad.output.map_or_else(|| "nothing".to_owned(), signal);
                if bits.direction == "output" {
                    miter.point("pads", &name, &at(bit), &given);
                    miter.point("pads", &format!("{name} off"), ZERO, &signal(pad.tristate));
                    continue;
                }
                let Some(input) = pad.input.map(|net| signal(Signal::of(net))) else {
                    return Err(format!("{name}: an input that its pad does not read"));
                };
                miter.gate(Side::Text, &[&input], &at(bit), &["1"]);
                if let Some(buffer) = driven.get(bit) {
                    let [data, on] = ["A", "E"].map(|pin| at(&buffer.connections[pin][0]));
                    let off = miter.fresh(Side::Text, &[&on], &["0"]);
                    miter.point("pads", &name, &data, &given);
                    miter.point("pads", &format!("{name} off"), &off, &signal(pad.tristate));
                }
            }
        }
        Ok(())
    }
}
