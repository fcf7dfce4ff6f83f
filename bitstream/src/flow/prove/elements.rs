//! Flip-flops, memories and pads, pin by pin.

use super::Prover;
use crate::device::Device;
use crate::element::{Driver, InputBuffer, Pull};
use crate::flow::constraints::{Constraints, PadConstraint, Pull as Held};
use crate::flow::netlist::{FlipFlop, MemoryPort, Net, Netlist, Signal};
use crate::netlist::{self, CellKind, PadUse};

const ZERO: Signal = Signal::Constant(false);

impl Prover<'_> {
    pub(super) fn flip_flop(&mut self, name: &str, gold: &FlipFlop, gate: &netlist::FlipFlop, netlist: &Netlist) {
        let never = matches!(gold.reset, Signal::Constant(false) | Signal::Open);
        let initial = gold.initial.unwrap_or(gold.reset_value);
        let (reset, reverse) = match (never, initial == gold.reset_value) {
            (true, _) => (ZERO, ZERO),
            (_, true) => (gold.reset, ZERO),
            (_, false) => (ZERO, gold.reset),
        };
        let mut equal = self.same(&format!("{name}: data"), gate.data, gold.data);
        equal &= self.same(&format!("{name}: enable"), gate.enable, gold.enable);
        equal &= self.same(&format!("{name}: reset"), gate.reset, reset);
        equal &= self.same(&format!("{name}: reverse"), gate.reverse, reverse);
        let settings = [
            (gate.init == initial, "initial value"),
            (!gate.latch, "latch"),
            (never || gate.synchronous != gold.asynchronous, "kind of reset"),
            (self.clocked(gate.clock, gold.clock, gold.falling, netlist), "clock"),
        ];
        for (_, what) in settings.into_iter().filter(|(same, _)| !same) {
            self.differ(format!("{name}: another {what}"));
            equal = false;
        }
        self.proof.flip_flops += usize::from(equal);
    }

    fn clocked(&self, gate: netlist::Signal, gold: Net, falling: bool, netlist: &Netlist) -> bool {
        let rising = match gate {
            netlist::Signal::Net(id) if !falling => netlist::Signal::Net(id),
            netlist::Signal::Not(id) if falling => netlist::Signal::Net(id),
            _ => return false,
        };
        let buffer = netlist.clock_buffers.iter().find(|(_, to)| *to == gold);
        buffer.is_some_and(|(from, _)| self.gate.clock(rising) == Some(*from))
    }

    pub(super) fn memories(&mut self, gold: &Netlist, gate: &netlist::Netlist) {
        for cell in &gate.cells {
            let CellKind::BlockRam(found) = &cell.kind else { continue };
            let outputs = || found.ports.iter().flat_map(|port| port.output.iter().flatten());
            let net = outputs().find_map(|id| self.gate.names.get(id)).copied();
            let memory = gold.memories.iter().find(|memory| {
                let mut nets = memory.ports.iter().flatten().flat_map(|port| port.output.iter().flatten());
                nets.any(|other| Some(*other) == net)
            });
            let Some(memory) = memory else {
                self.differ(format!("{}: a memory that the netlist does not have", cell.place));
                continue;
            };
            let name = format!("{} at {}", memory.name, cell.place);
            let before = self.proof.differences.len();
            let bit = |at: usize| memory.contents[at / 64] >> (at % 64) & 1 == 1;
            if (0..4_096).any(|at| found.contents.get(at).copied() != Some(bit(at))) {
                self.differ(format!("{name}: other contents"));
            }
            for ((port, side), own) in found.ports.iter().zip(['A', 'B']).zip(&memory.ports) {
                self.memory_port(&format!("{name} port {side}"), port, own.as_ref(), gold);
            }
            self.proof.memories += usize::from(self.proof.differences.len() == before);
        }
        // Pins of memories may read nets that no pad had asked for.
        while let Some(id) = self.todo.pop() {
            self.net(id, gold, gate);
        }
    }

    fn memory_port(&mut self, name: &str, gate: &netlist::MemoryPort, gold: Option<&MemoryPort>, netlist: &Netlist) {
        let Some(gold) = gold else {
            self.same(&format!("{name}: write"), gate.write, ZERO);
            return;
        };
        if gate.width.bits() != gold.width {
            self.differ(format!("{name}: another width"));
            return;
        }
        if !self.clocked(gate.clock, gold.clock, false, netlist) {
            self.differ(format!("{name}: another clock"));
        }
        self.same(&format!("{name}: enable"), gate.enable, gold.enable);
        self.same(&format!("{name}: reset"), gate.reset, gold.reset);
        self.same(&format!("{name}: write"), gate.write, gold.write);
        let first = 12 - gold.address.len();
        for (bit, (gate, gold)) in gate.address[first..].iter().zip(&gold.address).enumerate() {
            if *gold != Signal::Open {
                self.same(&format!("{name}: address {bit}"), *gate, *gold);
            }
        }
        if gold.write == ZERO {
            return;
        }
        for (bit, (gate, gold)) in gate.data.iter().zip(&gold.data).enumerate() {
            if *gold != Signal::Open {
                self.same(&format!("{name}: data {bit}"), *gate, *gold);
            }
        }
    }

    pub(super) fn pads(&mut self, device: &Device, gold: &Netlist, constraints: &Constraints, gate: &netlist::Netlist) {
        for pad in &gold.pads {
            let Some(constraint) = constraints.pads.get(&pad.port) else { continue };
            let name = format!("{} at P{}", pad.port, constraint.pin);
            let found = gate.pads.iter().find(|found| found.pin == Some(constraint.pin));
            let before = self.proof.differences.len();
            match (pad.output, found.and_then(|found| found.output)) {
                (None, None) => {}
                (Some(output), Some((o, t))) => {
                    self.same(&format!("{name}: output"), o, output);
                    self.same(&format!("{name}: output enable"), t, pad.tristate);
                }
                (None, Some(_)) => self.differ(format!("{name}: an input that drives")),
                (Some(_), None) => self.differ(format!("{name}: an output that does not drive")),
            }
            if let Some(what) =
                found.and_then(|found| electrics(device, pad.input.is_some(), pad.output, constraint, found))
            {
                self.differ(format!("{name}: {what}"));
            }
            self.proof.pads += usize::from(self.proof.differences.len() == before);
        }
        for found in gate.pads.iter().filter(|found| found.output.is_some()) {
            if !constraints.pads.values().any(|pad| Some(pad.pin) == found.pin) {
                self.differ(format!("{}: drives, and is no pad of the design", found.name));
            }
        }
    }
}

/// What is wrong with a pad's electrics.
fn electrics(
    device: &Device,
    reads: bool,
    output: Option<Signal>,
    constraint: &PadConstraint,
    found: &PadUse,
) -> Option<&'static str> {
    let io = found.io?;
    let name = format!("{}.{}", constraint.standard, constraint.drive);
    let standard = device.standard(&name).or_else(|| device.standard(&constraint.standard))?;
    let pull = match constraint.pull {
        Held::None => Pull::None,
        Held::Up => Pull::Up,
        Held::Down => Pull::Down,
        Held::Keeper => Pull::Keeper,
    };
    if output.is_some() && io.driver != Driver::of(standard, constraint.fast) {
        Some("another standard, drive or slew rate")
    } else if output.is_none() && io.driver.is_on() {
        Some("an input with a driver")
    } else if io.pull != pull {
        Some("another pull")
    } else if reads != (io.input == InputBuffer::Cmos) {
        Some("another input buffer")
    } else if io.vref || io.delay_i || io.registered_output || io.registered_tristate {
        Some("a setting that the design does not have")
    } else {
        None
    }
}
