//! Elements with a clock.

use super::{Line, Logic, Simulator};

/// A clock and an edge: the elements that have not seen their inputs yet.
#[derive(Clone, Debug, Default)]
pub(super) struct Domain {
    pub(super) waiting: Vec<u32>,
    /// Its edge has come and is not yet worked off.
    pub(super) fired: bool,
}

/// A flip-flop or latch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flop {
    pub(super) data: Line,
    pub(super) enable: Line,
    pub(super) reset: Line,
    pub(super) reverse: Line,
    /// The clock of a latch.
    pub(super) gate: Line,
    pub(super) latch: bool,
    pub(super) synchronous: bool,
    pub(super) init: bool,
    pub(super) domain: Option<u32>,
    pub(super) output: u32,
}

/// A shift register; the element of logic that shows it holds its bits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shift {
    pub(super) data: Line,
    pub(super) enable: Line,
    pub(super) domain: Option<u32>,
    pub(super) shown: u32,
}

/// The write port of a RAM of 16 bits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ram {
    pub(super) address: [Line; 4],
    pub(super) data: Line,
    pub(super) enables: [Line; 2],
    pub(super) domain: Option<u32>,
    pub(super) shown: u32,
}

/// A port of a block memory.
#[derive(Clone, Debug)]
pub(super) struct Port {
    pub(super) memory: u32,
    /// The other port.
    pub(super) other: u32,
    pub(super) width: u32,
    pub(super) enable: Line,
    pub(super) write: Line,
    pub(super) reset: Line,
    pub(super) address: Vec<Line>,
    pub(super) data: Vec<Line>,
    pub(super) output: Vec<Option<u32>>,
    pub(super) domain: Option<u32>,
}

/// An element with a clock.
#[derive(Clone, Debug)]
pub(super) enum Clocked {
    Flop(Flop),
    Shift(Shift),
    Ram(Ram),
    Port(Port),
}

impl Clocked {
    pub(super) fn domain(&self) -> Option<u32> {
        match self {
            Self::Flop(flop) => flop.domain,
            Self::Shift(shift) => shift.domain,
            Self::Ram(ram) => ram.domain,
            Self::Port(port) => port.domain,
        }
    }
}

/// What an edge changes.
enum Effect {
    Net(u32, bool),
    /// New bits of an element of logic.
    Bits(u32, u16),
    /// Address, width and word that a port writes; the port that reads the same memory.
    Memory {
        memory: u32,
        address: usize,
        width: u32,
        word: u32,
        other: u32,
    },
}

impl Simulator {
    /// All elements of the clocks that have risen sample, then change.
    pub(super) fn fire(&mut self) {
        let mut effects = Vec::new();
        let mut again = Vec::new();
        for domain in std::mem::take(&mut self.fired) {
            let waiting = std::mem::take(&mut self.domains[domain as usize].waiting);
            self.domains[domain as usize].fired = false;
            for element in waiting {
                self.marked[element as usize] = false;
                self.sample(element, &mut effects, &mut again);
            }
        }
        for effect in effects {
            match effect {
                Effect::Net(net, level) => self.change(net, level),
                Effect::Bits(element, bits) => {
                    if let Logic::Table { table, .. } = &mut self.logic[element as usize] {
                        *table = bits;
                    }
                    self.wait(element);
                }
                Effect::Memory { memory, address, width, word, other } => {
                    let bits = &mut self.memories[memory as usize][address..address + width as usize];
                    bits.iter_mut().enumerate().for_each(|(n, bit)| *bit = word >> n & 1 == 1);
                    self.mark(other);
                }
            }
        }
        again.into_iter().for_each(|element| self.mark(element));
    }

    fn sample(&self, element: u32, effects: &mut Vec<Effect>, again: &mut Vec<u32>) {
        let bits = |shown: u32| if let Logic::Table { table, .. } = self.logic[shown as usize] { table } else { 0 };
        match &self.clocked[element as usize] {
            Clocked::Flop(flop) => {
                let level = if self.value(flop.reset) {
                    flop.init
                } else if self.value(flop.reverse) {
                    !flop.init
                } else if self.value(flop.enable) {
                    self.value(flop.data)
                } else {
                    return;
                };
                if self.values[flop.output as usize] != level {
                    effects.push(Effect::Net(flop.output, level));
                }
            }
            Clocked::Shift(shift) => {
                if self.value(shift.enable) {
                    let next = bits(shift.shown) << 1 | u16::from(self.value(shift.data));
                    effects.push(Effect::Bits(shift.shown, next));
                    again.push(element);
                }
            }
            Clocked::Ram(ram) => {
                if ram.enables.iter().all(|enable| self.value(*enable)) {
                    let at = self.index(&ram.address);
                    let next = bits(ram.shown) & !(1 << at) | u16::from(self.value(ram.data)) << at;
                    effects.push(Effect::Bits(ram.shown, next));
                }
            }
            Clocked::Port(port) => self.sample_port(port, effects),
        }
    }

    fn sample_port(&self, port: &Port, effects: &mut Vec<Effect>) {
        if !self.value(port.enable) {
            return;
        }
        let number = |lines: &[Line]| {
            lines.iter().enumerate().fold(0_u32, |word, (n, line)| word | u32::from(self.value(*line)) << n)
        };
        // The upper address pins choose a word; those below are its own bits.
        let address = number(&port.address) as usize & !(port.width as usize - 1);
        let write = self.value(port.write);
        let stored = &self.memories[port.memory as usize];
        let data = number(&port.data);
        for (bit, net) in port.output.iter().enumerate() {
            let Some(net) = net else { continue };
            let level = match (self.value(port.reset), write) {
                (true, _) => false,
                (_, true) => data >> bit & 1 == 1,
                _ => stored[address + bit],
            };
            if self.values[*net as usize] != level {
                effects.push(Effect::Net(*net, level));
            }
        }
        if write {
            let (memory, width, other) = (port.memory, port.width, port.other);
            effects.push(Effect::Memory { memory, address, width, word: data, other });
        }
    }

    /// What a latch shows, or a flip-flop whose set or reset does not wait for the clock: net and level.
    pub(super) fn without_clock(&self, element: u32) -> (u32, bool) {
        let Clocked::Flop(flop) = &self.clocked[element as usize] else { return (0, self.values[0]) };
        let open = flop.latch && self.value(flop.gate);
        let at_once = !flop.synchronous || open;
        let level = if at_once && self.value(flop.reset) {
            flop.init
        } else if at_once && self.value(flop.reverse) {
            !flop.init
        } else if open && self.value(flop.enable) {
            self.value(flop.data)
        } else {
            self.values[flop.output as usize]
        };
        (flop.output, level)
    }
}
