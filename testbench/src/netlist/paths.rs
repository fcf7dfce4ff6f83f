//! The longest paths of a Spartan-II netlist, counted in lookup tables and carry chains.
//!
//! | through | counts |
//! |---|---|
//! | LUT1 to LUT4 | one level |
//! | MUXCY from S or DI | one carry chain, one bit |
//! | MUXCY from CI | one more bit of the same chain |
//! | XORCY, MUXF5, MUXF6, INV, buffers | nothing: inside the slice, or absorbed by place and route |
//!
//! A path begins at the output of a flip-flop, a memory or an input pin and ends at an input of one.
//! There are no wire delays here: no open tool knows those of this family.

use serde_json::Value;
use std::collections::HashMap;
use std::fmt;

/// From a flip-flop or pin through LUTs and carry to the next.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Path {
    /// Lookup tables in a row.
    pub levels: u32,
    /// Carry chains entered.
    pub chains: u32,
    /// Bits run along them.
    pub bits: u32,
    /// Where it begins.
    pub from: String,
    /// Where it ends.
    pub to: String,
}

impl fmt::Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { levels, chains, bits, from, to } = self;
        write!(f, "{levels} LUT levels, {chains} carry chains of {bits} bits in all: {from} -> {to}")
    }
}

/// The longest paths by different measures.
#[derive(Clone, Debug)]
pub struct Paths {
    /// Most LUT levels.
    pub by_levels: Path,
    /// Most carry chains.
    pub by_chains: Path,
    /// Most LUT levels and carry chains together, a chain bit as a sixteenth of a level: the likely
    /// slowest one.
    pub slowest: Path,
    /// The slowest path into every register, slowest first.
    pub per_register: Vec<Path>,
    /// Combinational loops would make all this void.
    pub loops: usize,
}

/// What a path costs so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Cost {
    levels: u32,
    chains: u32,
    bits: u32,
    from: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Measure {
    Levels,
    Chains,
    Time,
}

impl Measure {
    fn key(self, cost: Cost) -> (u32, u32, u32) {
        let Cost { levels, chains, bits, .. } = cost;
        match self {
            Self::Levels => (levels, chains, bits),
            Self::Chains => (chains, levels, bits),
            Self::Time => (16 * (levels + chains) + bits, levels, chains),
        }
    }
}

/// A way through a cell.
struct Arc {
    from: usize,
    add: Cost,
}

struct Graph {
    /// Ways into a net, for nets that cells compute.
    arcs: HashMap<usize, Vec<Arc>>,
    /// Nets that paths end at, with the name of what takes them.
    ends: Vec<(usize, String)>,
    names: HashMap<usize, String>,
}

impl Paths {
    /// Of a module in yosys' JSON.
    pub(super) fn of(module: &Value) -> Self {
        let graph = Graph::of(module);
        let (by_levels, _, _) = graph.longest(Measure::Levels);
        let (by_chains, _, _) = graph.longest(Measure::Chains);
        let (slowest, per_register, loops) = graph.longest(Measure::Time);
        Self { by_levels, by_chains, slowest, per_register, loops }
    }
}

/// Bits of a port; constants are none.
fn bits(connection: &Value) -> impl Iterator<Item = usize> + '_ {
    connection.as_array().into_iter().flatten().filter_map(|bit| bit.as_u64().map(|bit| bit as usize))
}

impl Graph {
    fn of(module: &Value) -> Self {
        let mut graph = Self { arcs: HashMap::new(), ends: Vec::new(), names: names(module) };
        for (name, cell) in module["cells"].as_object().into_iter().flatten() {
            let kind = cell["type"].as_str().unwrap_or("");
            let port = |name: &str| bits(&cell["connections"][name]).next();
            let inputs: &[&str] = match kind {
                _ if kind.starts_with("LUT") => &["I0", "I1", "I2", "I3"],
                "MUXCY" => &["CI", "DI", "S"],
                "XORCY" => &["CI", "LI"],
                "MUXF5" | "MUXF6" => &["I0", "I1", "S"],
                "INV" | "BUFG" | "IBUF" => &["I"],
                _ => {
                    graph.end(name, cell);
                    continue;
                }
            };
            let Some(output) = port("O") else { continue };
            if kind == "IBUF" {
                continue;
            }
            for input in inputs {
                let add = match (kind, *input) {
                    ("MUXCY", "CI") => Cost { bits: 1, ..Cost::default() },
                    ("MUXCY", _) => Cost { chains: 1, bits: 1, ..Cost::default() },
                    _ => Cost { levels: u32::from(kind.starts_with("LUT")), ..Cost::default() },
                };
                graph.arcs.entry(output).or_default().extend(port(input).map(|from| Arc { from, add }));
            }
        }
        graph
    }

    /// A cell that paths end at: register, memory, output buffer.
    fn end(&mut self, name: &str, cell: &Value) {
        let kind = cell["type"].as_str().unwrap_or("");
        let output = ["Q", "IO", "O", "DO", "DOB"].iter().find_map(|port| bits(&cell["connections"][*port]).next());
        let named = output.and_then(|net| self.names.get(&net)).cloned().unwrap_or_else(|| name.to_owned());
        for (port, connection) in cell["connections"].as_object().into_iter().flatten() {
            let input = cell["port_directions"][port] == "input";
            let clock = port == "C" || port.starts_with("CLK");
            if input && !clock {
                self.ends.extend(bits(connection).map(|net| (net, format!("{named} ({kind}.{port})"))));
            }
        }
    }

    fn longest(&self, measure: Measure) -> (Path, Vec<Path>, usize) {
        let mut known: HashMap<usize, Cost> = HashMap::new();
        let mut loops = 0;
        let mut paths: HashMap<&str, Path> = HashMap::new();
        let mut longest: Option<(Cost, Path)> = None;
        for (net, end) in &self.ends {
            let cost = self.cost(*net, measure, &mut known, &mut loops);
            let name = |net: usize| self.names.get(&net).cloned().unwrap_or_else(|| format!("net {net}"));
            let path = || Path {
                levels: cost.levels,
                chains: cost.chains,
                bits: cost.bits,
                from: name(cost.from),
                to: end.clone(),
            };
            if longest.as_ref().is_none_or(|(best, _)| measure.key(*best) < measure.key(cost)) {
                longest = Some((cost, path()));
            }
            let register = end.split('[').next().unwrap_or(end);
            let value = |p: &Path| 16 * (p.levels + p.chains) + p.bits;
            match paths.get(register) {
                Some(best) if value(best) >= value(&path()) => {}
                _ => drop(paths.insert(register, path())),
            }
        }
        let mut paths: Vec<Path> = paths.into_values().collect();
        paths.sort_by_key(|p| (std::cmp::Reverse(16 * (p.levels + p.chains) + p.bits), p.to.clone()));
        (longest.map(|(_, path)| path).unwrap_or_default(), paths, loops)
    }

    /// The costliest way to a net, without recursion: paths are as long as a carry chain.
    fn cost(&self, net: usize, measure: Measure, known: &mut HashMap<usize, Cost>, loops: &mut usize) -> Cost {
        let mut stack = vec![(net, false)];
        let mut open = std::collections::HashSet::new();
        while let Some((net, ready)) = stack.pop() {
            if known.contains_key(&net) {
                continue;
            }
            let arcs = self.arcs.get(&net).map_or(&[][..], Vec::as_slice);
            if ready || arcs.is_empty() {
                let arrive = |arc: &Arc| {
                    let Cost { levels, chains, bits, from } = known.get(&arc.from).copied().unwrap_or_default();
                    let Cost { levels: l, chains: c, bits: b, .. } = arc.add;
                    Cost { levels: levels + l, chains: chains + c, bits: bits + b, from }
                };
                let start = Cost { from: net, ..Cost::default() };
                let worst = arcs.iter().map(arrive).max_by_key(|cost| measure.key(*cost)).unwrap_or(start);
                open.remove(&net);
                known.insert(net, worst);
            } else if !open.insert(net) {
                *loops += 1;
                known.insert(net, Cost { from: net, ..Cost::default() });
            } else {
                stack.push((net, true));
                stack.extend(arcs.iter().filter(|arc| !known.contains_key(&arc.from)).map(|arc| (arc.from, false)));
            }
        }
        known.get(&net).copied().unwrap_or_default()
    }
}

/// The best name of every net: public ones before those that yosys made.
fn names(module: &Value) -> HashMap<usize, String> {
    let mut names: HashMap<usize, String> = HashMap::new();
    for (name, net) in module["netnames"].as_object().into_iter().flatten() {
        let hidden = net["hide_name"] == 1;
        let wide = net["bits"].as_array().map_or(0, Vec::len) > 1;
        for (index, bit) in net["bits"].as_array().into_iter().flatten().enumerate() {
            let Some(bit) = bit.as_u64().map(|bit| bit as usize) else { continue };
            let name = if wide { format!("{name}[{index}]") } else { name.clone() };
            let better =
                |old: &String| !hidden && (old.starts_with('$') || name.ends_with(".q") || name.contains(".q["));
            if names.get(&bit).is_none_or(better) {
                names.insert(bit, name);
            }
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn cell(kind: &str, connections: &Value, inputs: &[&str]) -> Value {
        let directions: serde_json::Map<_, _> =
            inputs.iter().map(|port| ((*port).to_owned(), json!("input"))).collect();
        json!({"type": kind, "connections": connections, "port_directions": directions})
    }

    /// q → LUT → chain of two bits → XORCY → LUT → d, and a loop of two LUTs if asked for.
    fn module(looped: bool) -> Value {
        let back = if looped { 8 } else { 2 };
        json!({
            "netnames": {"a.q": {"bits": [2], "hide_name": 0}, "b.q": {"bits": [9], "hide_name": 0}},
            "cells": {
                "lut1": cell("LUT2", &json!({"I0": [2], "I1": [back], "O": [3]}), &["I0", "I1"]),
                "cy1": cell("MUXCY", &json!({"CI": ["0"], "DI": [2], "S": [3], "O": [4]}), &["CI", "DI", "S"]),
                "cy2": cell("MUXCY", &json!({"CI": [4], "DI": [2], "S": [2], "O": [5]}), &["CI", "DI", "S"]),
                "xor": cell("XORCY", &json!({"CI": [5], "LI": [2], "O": [6]}), &["CI", "LI"]),
                "lut2": cell("LUT1", &json!({"I0": [6], "O": [8]}), &["I0"]),
                "ff": cell("FDRE", &json!({"C": [1], "D": [8], "Q": [9]}), &["C", "D"]),
            }
        })
    }

    #[test]
    fn levels_chains_and_bits_are_counted() {
        let paths = Paths::of(&module(false));
        let expected = Path { levels: 2, chains: 1, bits: 2, from: "a.q".into(), to: "b.q (FDRE.D)".into() };
        assert_eq!((&paths.slowest, &paths.by_levels, paths.loops), (&expected, &expected, 0));
        assert_eq!(paths.per_register, [expected]);
    }

    #[test]
    fn a_loop_is_noticed() {
        assert!(Paths::of(&module(true)).loops > 0);
    }
}
