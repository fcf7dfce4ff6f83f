//! Two circuits without memory, of the same inputs, compared point by point: BLIF, and `cec` of abc.
//!
//! `cec` proves each pair of outputs equal for all values of the inputs, or gives values for which they differ.

use simulator::cosim::{CosimError, folder};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::Path;

/// The constants, in either circuit.
pub(super) const ZERO: &str = "zero";
pub(super) const ONE: &str = "one";

/// Which circuit.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Side {
    Text,
    Netlist,
}

/// See the module.
#[derive(Debug)]
pub(super) struct Miter {
    inputs: BTreeSet<String>,
    /// Gates of the text, of the netlist.
    gates: [String; 2],
    /// What is compared: kind and name, signal of the text, signal of the netlist.
    points: Vec<(String, [String; 2])>,
    /// Points by kind.
    pub(super) counts: BTreeMap<&'static str, usize>,
    made: usize,
    /// Under which condition on the inputs all is compared.
    assumed: String,
}

impl Miter {
    pub(super) fn new() -> Self {
        let constants = format!(".names {ZERO}\n.names {ONE}\n1\n");
        Self {
            inputs: BTreeSet::new(),
            gates: [constants.clone(), constants],
            points: Vec::new(),
            counts: BTreeMap::new(),
            made: 0,
            assumed: ONE.into(),
        }
    }

    /// An input of both circuits.
    pub(super) fn input(&mut self, name: &str) {
        self.inputs.insert(name.to_owned());
    }

    /// A gate: rows of its table for which it is 1, inputs first to last, `-` for any.
    pub(super) fn gate(&mut self, side: Side, inputs: &[&str], output: &str, rows: &[&str]) {
        let text = &mut self.gates[side as usize];
        writeln!(text, ".names {} {output}", inputs.join(" ")).expect("memory");
        rows.iter().for_each(|row| writeln!(text, "{row} 1").expect("memory"));
    }

    /// A gate with an output of its own.
    pub(super) fn fresh(&mut self, side: Side, inputs: &[&str], rows: &[&str]) -> String {
        self.made += 1;
        let output = format!("made{}", self.made);
        self.gate(side, inputs, &output, rows);
        output
    }

    /// Restricts all inputs to those for which this signal of them, built in both circuits, is 1.
    pub(super) fn assume(&mut self, rows: &[&str], inputs: &[&str]) {
        let old = std::mem::take(&mut self.assumed);
        self.made += 1;
        let (clause, both) = (format!("clause{}", self.made), format!("assumed{}", self.made));
        for side in [Side::Text, Side::Netlist] {
            self.gate(side, inputs, &clause, rows);
            self.gate(side, &[&clause, &old], &both, &["11"]);
        }
        self.assumed = both;
    }

    /// Two signals that must be equal.
    pub(super) fn point(&mut self, kind: &'static str, name: &str, text: &str, netlist: &str) {
        *self.counts.entry(kind).or_default() += 1;
        let assumed = self.assumed.clone();
        let signals = [(Side::Text, text), (Side::Netlist, netlist)].map(|(side, signal)| {
            if assumed == ONE { signal.to_owned() } else { self.fresh(side, &[signal, &assumed], &["11"]) }
        });
        self.points.push((format!("{kind} {name}"), signals));
    }

    /// Two signals that must be equal while their guards are 1.
    pub(super) fn guarded(&mut self, kind: &'static str, name: &str, guards: [&str; 2], signals: [&str; 2]) {
        let text = self.fresh(Side::Text, &[guards[0], signals[0]], &["11"]);
        let netlist = self.fresh(Side::Netlist, &[guards[1], signals[1]], &["11"]);
        self.point(kind, name, &text, &netlist);
    }

    /// Proves all points; the names of those that differ.
    pub(super) fn prove(&self, folder: &Path) -> Result<Vec<String>, CosimError> {
        for (side, file) in ["text.blif", "netlist.blif"].into_iter().enumerate() {
            let inputs: Vec<&str> = self.inputs.iter().map(String::as_str).collect();
            let outputs: Vec<String> = (0..self.points.len()).map(|point| format!("p{point}")).collect();
            let mut text = format!(".model top\n.inputs {}\n.outputs {}\n", inputs.join(" "), outputs.join(" "));
            text += &self.gates[side];
            for (point, (_, signals)) in self.points.iter().enumerate() {
                writeln!(text, ".names {} p{point}\n1 1", signals[side]).expect("memory");
            }
            folder::write(&folder.join(file), &(text + ".end\n"))?;
        }
        let said = folder::must("yosys-abc", &["-c", "cec text.blif netlist.blif"], folder, "equivalence")?;
        let said = folder::both(&said);
        if said.contains("Networks are equivalent") {
            return Ok(Vec::new());
        }
        let named = said.split_whitespace().filter_map(|word| {
            let at: usize = word.trim_matches(['\'', '"', '.', ',', ':']).strip_prefix('p')?.parse().ok()?;
            Some(self.points.get(at)?.0.clone())
        });
        let named: BTreeSet<String> = named.collect();
        let last = said.lines().map(str::trim).rfind(|line| !line.is_empty()).unwrap_or_default().to_owned();
        Ok(if named.is_empty() { vec![last] } else { named.into_iter().collect() })
    }
}
