//! From a netlist to what runs: elements in levels, readers of every net, clocks.

use super::clocked::{Clocked, Domain, Flop, Port, Ram, Shift};
use super::dll::Loop;
use super::{Line, Logic, Pad, Simulator, Unsettled};
use crate::netlist::{CellKind, MemoryPort, Netlist, PadUse, Signal};
use std::collections::HashMap;

/// What a change of a net reaches.
#[derive(Clone, Copy, Debug)]
pub(super) enum Target {
    Logic(u32),
    Clocked(u32),
    Clock { domain: u32, rising: bool },
    Loop(u32),
    Pad(u32),
}

struct Builder {
    names: Vec<String>,
    /// The net that is always 0.
    zero: u32,
    initial: Vec<bool>,
    logic: Vec<Logic>,
    clocked: Vec<Clocked>,
    domains: Vec<Domain>,
    domain_of: HashMap<u32, u32>,
    memories: Vec<Vec<bool>>,
    loops: Vec<Loop>,
    pads: Vec<Pad>,
    /// Net and what reads it.
    reads: Vec<(u32, Target)>,
}

/// Tables of multiplexers (select, zero, one), of an exclusive or, an and, a wire, and a clock buffer (input, enable).
const MUX: u16 = 0xE4E4;
const XOR: u16 = 0x6666;
const AND: u16 = 0x8888;
const WIRE: u16 = 0xAAAA;
const ENABLED: u16 = 0x8888;
const ENABLED_HIGH: u16 = 0xBBBB;
/// A pad: data out, 1 while off, level outside.
const PAD: u16 = 0xE2E2;

pub(super) fn build(netlist: &Netlist) -> Result<Simulator, Unsettled> {
    let mut builder = Builder {
        names: netlist.nets.clone(),
        zero: netlist.nets.len() as u32,
        initial: vec![false; netlist.nets.len() + 1],
        logic: Vec::new(),
        clocked: Vec::new(),
        domains: Vec::new(),
        domain_of: HashMap::new(),
        memories: Vec::new(),
        loops: Vec::new(),
        pads: Vec::new(),
        reads: Vec::new(),
    };
    builder.names.push("0".into());
    netlist.cells.iter().for_each(|cell| builder.cell(&cell.kind));
    netlist.pads.iter().for_each(|pad| builder.pad(pad));
    builder.finish(netlist.pads.iter().map(|pad| pad.pin).collect())
}

impl Builder {
    fn line(&self, signal: Signal) -> Line {
        match signal {
            Signal::Zero => Line(2 * self.zero),
            Signal::One => Line(2 * self.zero + 1),
            Signal::Net(net) => Line(2 * net.0),
            Signal::Not(net) => Line(2 * net.0 + 1),
        }
    }

    fn read(&mut self, line: Line, target: Target) {
        if line.0 >> 1 != self.zero {
            self.reads.push((line.0 >> 1, target));
        }
    }

    fn table(&mut self, table: u16, signals: &[Signal], output: u32) -> u32 {
        let mut inputs = [Line(2 * self.zero); 4];
        for (input, signal) in inputs.iter_mut().zip(signals) {
            *input = self.line(*signal);
        }
        self.table_of(table, inputs, output)
    }

    fn table_of(&mut self, table: u16, inputs: [Line; 4], output: u32) -> u32 {
        let element = self.logic.len() as u32;
        inputs.into_iter().for_each(|input| self.read(input, Target::Logic(element)));
        self.logic.push(Logic::Table { table, inputs, output });
        element
    }

    /// The clock of an element; none if it never moves.
    fn domain(&mut self, clock: Signal) -> Option<u32> {
        let line = self.line(clock);
        if line.0 >> 1 == self.zero {
            return None;
        }
        if let Some(domain) = self.domain_of.get(&line.0) {
            return Some(*domain);
        }
        let domain = self.domains.len() as u32;
        self.domains.push(Domain::default());
        self.domain_of.insert(line.0, domain);
        self.read(line, Target::Clock { domain, rising: line.0 & 1 == 0 });
        Some(domain)
    }

    fn clocked(&mut self, element: Clocked, reads: &[Signal]) -> u32 {
        let index = self.clocked.len() as u32;
        for signal in reads {
            self.read(self.line(*signal), Target::Clocked(index));
        }
        self.clocked.push(element);
        index
    }

    fn cell(&mut self, kind: &CellKind) {
        match kind {
            CellKind::Lut { table, inputs, output } => {
                self.table(*table, inputs, output.0);
            }
            CellKind::Alias { input, output } => {
                self.table(WIRE, &[*input], output.0);
            }
            CellKind::Mux { select, one, zero, output, .. } => {
                self.table(MUX, &[*select, *zero, *one], output.0);
            }
            CellKind::Xor { inputs, output } => {
                self.table(XOR, inputs, output.0);
            }
            CellKind::And { inputs, output } => {
                self.table(AND, inputs, output.0);
            }
            CellKind::ClockBuffer { input, enable, idle, output } => {
                self.table(if *idle { ENABLED_HIGH } else { ENABLED }, &[*input, *enable], output.0);
            }
            CellKind::Bus { drivers, output } => {
                let drivers: Vec<(Line, Line)> =
                    drivers.iter().map(|(data, off)| (self.line(*data), self.line(*off))).collect();
                let element = self.logic.len() as u32;
                for (data, off) in &drivers {
                    self.read(*data, Target::Logic(element));
                    self.read(*off, Target::Logic(element));
                }
                self.logic.push(Logic::Bus { drivers, output: output.0 });
            }
            CellKind::FlipFlop(flop) => {
                self.initial[flop.output.0 as usize] = flop.init;
                let [data, enable, reset, reverse] =
                    [flop.data, flop.enable, flop.reset, flop.reverse].map(|signal| self.line(signal));
                let gate = self.line(flop.clock);
                let domain = if flop.latch { None } else { self.domain(flop.clock) };
                let (synchronous, latch, init, output) = (flop.synchronous, flop.latch, flop.init, flop.output.0);
                let element = Flop { data, enable, reset, reverse, gate, latch, synchronous, init, domain, output };
                let reads = [flop.data, flop.enable, flop.reset, flop.reverse];
                let index = self.clocked(Clocked::Flop(element), if latch { &[] } else { &reads });
                let level = self.logic.len() as u32;
                if latch {
                    reads.iter().chain([&flop.clock]).for_each(|signal| {
                        self.read(self.line(*signal), Target::Logic(level));
                    });
                    self.logic.push(Logic::Level { element: index });
                } else if !synchronous && [flop.reset, flop.reverse] != [Signal::Zero; 2] {
                    self.read(reset, Target::Logic(level));
                    self.read(reverse, Target::Logic(level));
                    self.logic.push(Logic::Level { element: index });
                }
            }
            CellKind::Shift { init, address, data, clock, enable, output } => {
                let shown = self.table(*init, address, output.0);
                let domain = self.domain(*clock);
                let element = Shift { data: self.line(*data), enable: self.line(*enable), domain, shown };
                self.clocked(Clocked::Shift(element), &[*data, *enable]);
            }
            CellKind::Ram { init, write_address, read_address, data, clock, enables, output } => {
                let shown = self.table(*init, read_address, output.0);
                let domain = self.domain(*clock);
                let element = Ram {
                    address: write_address.map(|signal| self.line(signal)),
                    data: self.line(*data),
                    enables: enables.map(|signal| self.line(signal)),
                    domain,
                    shown,
                };
                let reads = [&write_address[..], &[*data], enables].concat();
                self.clocked(Clocked::Ram(element), &reads);
            }
            CellKind::BlockRam(memory) => {
                let number = self.memories.len() as u32;
                self.memories.push(memory.contents.clone());
                let first = self.clocked.len() as u32;
                for (side, port) in memory.ports.iter().enumerate() {
                    let MemoryPort { width, clock, enable, write, reset, address, data, output } = port;
                    let element = Port {
                        memory: number,
                        other: first + 1 - side as u32,
                        width: width.bits() as u32,
                        enable: self.line(*enable),
                        write: self.line(*write),
                        reset: self.line(*reset),
                        address: address.iter().map(|signal| self.line(*signal)).collect(),
                        data: data.iter().map(|signal| self.line(*signal)).collect(),
                        output: output.iter().map(|net| net.map(|net| net.0)).collect(),
                        domain: self.domain(*clock),
                    };
                    let reads = [&[*enable, *write, *reset][..], address, data].concat();
                    self.clocked(Clocked::Port(element), &reads);
                }
            }
            CellKind::Dll(found) => {
                let index = self.loops.len() as u32;
                let clock = self.line(found.clock);
                self.read(clock, Target::Loop(index));
                let outputs = found.outputs.iter().map(|(name, net)| (*name, net.0)).collect();
                let divide = u64::from(found.setting.divide_count) + 1;
                self.loops.push(Loop::new(self.line(found.reset), divide, outputs));
            }
        }
    }

    fn pad(&mut self, pad: &PadUse) {
        let index = self.pads.len() as u32;
        let outside = match (pad.input, pad.output) {
            (Some(input), None) => input.0,
            (input, output) => {
                self.names.push(format!("{}_outside", pad.name));
                self.initial.push(true);
                let outside = self.names.len() as u32 - 1;
                if let (Some(input), Some((data, off))) = (input, output) {
                    let lines = [self.line(data), self.line(off), Line(2 * outside), Line(2 * self.zero)];
                    self.table_of(PAD, lines, input.0);
                }
                outside
            }
        };
        self.initial[outside as usize] = true;
        let output = pad.output.map(|(data, off)| {
            let lines = (self.line(data), self.line(off));
            self.read(lines.0, Target::Pad(index));
            self.read(lines.1, Target::Pad(index));
            lines
        });
        self.pads.push(Pad { outside, output, moved: false });
    }

    /// Levels: an element stands above all elements that it reads; elements of loops above all others.
    fn levels(&self, first: &[u32], targets: &[Target]) -> Vec<u32> {
        let outputs: Vec<u32> = self.logic.iter().map(|logic| self.output(logic)).collect();
        let mut maker = vec![false; self.names.len()];
        outputs.iter().for_each(|net| maker[*net as usize] = true);
        let mut waits = vec![0_u32; self.logic.len()];
        let readers = |net: u32| {
            targets[first[net as usize] as usize..first[net as usize + 1] as usize]
                .iter()
                .filter_map(|target| if let Target::Logic(element) = target { Some(*element as usize) } else { None })
        };
        (0..self.names.len() as u32).filter(|net| maker[*net as usize]).for_each(|net| {
            readers(net).for_each(|element| waits[element] += 1);
        });
        let mut levels = vec![0_u32; self.logic.len()];
        let mut order: Vec<usize> = (0..waits.len()).filter(|element| waits[*element] == 0).collect();
        let mut next = 0;
        while next < order.len() {
            let element = order[next];
            next += 1;
            for reader in readers(outputs[element]) {
                levels[reader] = levels[reader].max(levels[element] + 1);
                waits[reader] -= 1;
                if waits[reader] == 0 {
                    order.push(reader);
                }
            }
        }
        let top = levels.iter().copied().max().unwrap_or(0) + 1;
        for (level, waits) in levels.iter_mut().zip(&waits) {
            if *waits > 0 {
                *level = top;
            }
        }
        levels
    }

    fn output(&self, logic: &Logic) -> u32 {
        match logic {
            Logic::Table { output, .. } | Logic::Bus { output, .. } => *output,
            Logic::Level { element } => match &self.clocked[*element as usize] {
                Clocked::Flop(flop) => flop.output,
                _ => self.zero,
            },
        }
    }

    fn finish(mut self, pins: Vec<Option<u8>>) -> Result<Simulator, Unsettled> {
        self.reads.sort_by_key(|(net, _)| *net);
        let mut first = vec![0_u32; self.names.len() + 1];
        self.reads.iter().for_each(|(net, _)| first[*net as usize + 1] += 1);
        for net in 0..self.names.len() {
            first[net + 1] += first[net];
        }
        let targets: Vec<Target> = self.reads.iter().map(|(_, target)| *target).collect();
        let levels = self.levels(&first, &targets);
        let top = levels.iter().copied().max().unwrap_or(0) as usize + 1;
        let mut simulator = Simulator {
            names: self.names,
            values: self.initial,
            first,
            targets,
            queued: vec![false; self.logic.len()],
            levels,
            logic: self.logic,
            waiting: vec![Vec::new(); top],
            busy: vec![0; top.div_ceil(64)],
            marked: vec![false; self.clocked.len()],
            clocked: self.clocked,
            domains: self.domains,
            fired: Vec::new(),
            memories: self.memories,
            loops: self.loops,
            pads: self.pads,
            pins,
            moved: Vec::new(),
            generators: Vec::new(),
            events: std::collections::BinaryHeap::new(),
            now: 0,
        };
        // Whatever clocks do while the first levels spread is no edge.
        for element in 0..simulator.logic.len() as u32 {
            simulator.wait(element);
        }
        simulator.domains.iter_mut().for_each(|domain| domain.fired = true);
        simulator.settle()?;
        simulator.domains.iter_mut().for_each(|domain| domain.fired = false);
        for element in 0..simulator.clocked.len() as u32 {
            simulator.mark(element);
        }
        for pad in 0..simulator.pads.len() as u32 {
            if !simulator.pads[pad as usize].moved {
                simulator.pads[pad as usize].moved = true;
                simulator.moved.push(pad);
            }
        }
        Ok(simulator)
    }
}
