//! Runs a decoded circuit, clock by clock: what a configured device does at its pads.
//!
//! Two values, no delays within the logic. A change spreads through the logic in the order of its levels, so every
//! element is computed once; what does not change costs nothing. At a clock's rising edge all elements of the clock
//! sample what stood before it. Time is in ps and counts only for clocks and delay-locked loops.
//!
//! ```text
//! set pads ─► settle: levels in order ─► clock edge? ─► sample all, then change all ─► settle again
//! ```

mod build;
mod clocked;
mod dll;

use crate::netlist::Netlist;
use build::Target;
use clocked::{Clocked, Domain};
use dll::Loop;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Rounds of elements after which a circuit counts as one that does not settle, in units of its size.
const ROUNDS: usize = 64;

/// A circuit that does not settle: a loop of logic that oscillates.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the circuit does not settle: a loop of logic through {net} oscillates")]
pub struct Unsettled {
    /// A net that still changes.
    pub net: String,
}

/// A net with an inverter or without: the net's number twice, plus 1 for the inverter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Line(u32);

/// An element of logic.
#[derive(Clone, Debug)]
enum Logic {
    /// A table of up to four inputs; also what a RAM or a shift register shows.
    Table { table: u16, inputs: [Line; 4], output: u32 },
    /// A bus of three-state buffers: what each drives, and 1 while it is off.
    Bus { drivers: Vec<(Line, Line)>, output: u32 },
    /// What acts on a flip-flop or latch without its clock: index into the clocked elements.
    Level { element: u32 },
}

/// A clock that comes from outside.
#[derive(Clone, Copy, Debug)]
struct Generator {
    pad: u32,
    /// Times high and low.
    halves: [u64; 2],
    next: u64,
    level: bool,
}

/// A pad: net of the level outside, of what comes in, and what goes out with 1 while the driver is off.
#[derive(Clone, Debug)]
struct Pad {
    outside: u32,
    output: Option<(Line, Line)>,
    moved: bool,
}

/// A circuit with its present state.
#[derive(Clone, Debug)]
pub struct Simulator {
    names: Vec<String>,
    values: Vec<bool>,
    /// What a change of a net reaches: targets of net n stand at first[n]..first[n + 1].
    first: Vec<u32>,
    targets: Vec<Target>,
    logic: Vec<Logic>,
    levels: Vec<u32>,
    queued: Vec<bool>,
    /// Elements that wait, by level, and levels that are not empty.
    waiting: Vec<Vec<u32>>,
    busy: Vec<u64>,
    clocked: Vec<Clocked>,
    marked: Vec<bool>,
    domains: Vec<Domain>,
    fired: Vec<u32>,
    memories: Vec<Vec<bool>>,
    loops: Vec<Loop>,
    pads: Vec<Pad>,
    pins: Vec<Option<u8>>,
    moved: Vec<u32>,
    generators: Vec<Generator>,
    /// Changes that a delay-locked loop will make: time, net, level.
    events: BinaryHeap<Reverse<(u64, u32, bool)>>,
    now: u64,
}

impl Simulator {
    /// A circuit just configured; all pads see 1, as the pull-ups of the device and the card have it.
    ///
    /// # Errors
    /// See [`Unsettled`].
    pub fn new(netlist: &Netlist) -> Result<Self, Unsettled> {
        build::build(netlist)
    }

    /// The pad on a pin of the package; none if the circuit does not use it.
    #[must_use]
    pub fn pad(&self, pin: u8) -> Option<usize> {
        self.pins.iter().position(|found| *found == Some(pin))
    }

    /// The level that the world outside gives a pad, from the next [`Self::settle`] on.
    pub fn set(&mut self, pad: usize, level: bool) {
        self.change(self.pads[pad].outside, level);
    }

    /// What the device drives at a pad; none while it does not.
    #[must_use]
    pub fn driven(&self, pad: usize) -> Option<bool> {
        let (data, off) = self.pads[pad].output?;
        (!self.value(off)).then(|| self.value(data))
    }

    /// Pads whose output or output enable changed since the last call, each once.
    pub fn take_moved(&mut self, mut pad: impl FnMut(usize)) {
        while let Some(index) = self.moved.pop() {
            self.pads[index as usize].moved = false;
            pad(index as usize);
        }
    }

    /// A clock at a pad: low now, its first rising edge at `first`, half a period high.
    pub fn clock(&mut self, pad: usize, period: u64, first: u64) {
        self.set(pad, false);
        let high = period / 2;
        self.generators.push(Generator { pad: pad as u32, halves: [high, period - high], next: first, level: false });
    }

    /// The time, in ps since configuration.
    #[must_use]
    pub fn now(&self) -> u64 {
        self.now
    }

    /// Lets time pass: all edges up to and at `until`.
    ///
    /// # Errors
    /// See [`Unsettled`].
    pub fn advance(&mut self, until: u64) -> Result<(), Unsettled> {
        loop {
            let clocks = self.generators.iter().map(|generator| generator.next);
            let events = self.events.peek().map(|Reverse((time, ..))| *time);
            let Some(time) = clocks.chain(events).min().filter(|time| *time <= until) else { break };
            self.now = time;
            for index in 0..self.generators.len() {
                let generator = &mut self.generators[index];
                if generator.next != time {
                    continue;
                }
                generator.level = !generator.level;
                generator.next = time + generator.halves[usize::from(!generator.level)];
                let (pad, level) = (generator.pad as usize, generator.level);
                self.set(pad, level);
            }
            while let Some(Reverse((at, net, level))) = self.events.peek().copied().filter(|event| event.0.0 <= time) {
                debug_assert_eq!(at, time);
                self.events.pop();
                self.change(net, level);
            }
            self.settle()?;
        }
        self.now = until;
        Ok(())
    }

    fn value(&self, line: Line) -> bool {
        self.values[(line.0 >> 1) as usize] ^ (line.0 & 1 == 1)
    }

    fn index(&self, inputs: &[Line; 4]) -> u32 {
        inputs.iter().enumerate().fold(0, |index, (n, input)| index | u32::from(self.value(*input)) << n)
    }

    /// A net takes a level, and whatever reads it waits to be computed.
    fn change(&mut self, net: u32, level: bool) {
        let value = &mut self.values[net as usize];
        if *value == level {
            return;
        }
        *value = level;
        for at in self.first[net as usize]..self.first[net as usize + 1] {
            match self.targets[at as usize] {
                Target::Logic(element) => self.wait(element),
                Target::Clocked(element) => self.mark(element),
                Target::Clock { domain, rising } => {
                    if rising == level && !self.domains[domain as usize].fired {
                        self.domains[domain as usize].fired = true;
                        self.fired.push(domain);
                    }
                }
                Target::Loop(index) => {
                    if level {
                        self.loop_edge(index as usize);
                    }
                }
                Target::Pad(pad) => {
                    let found = &mut self.pads[pad as usize];
                    if !found.moved {
                        found.moved = true;
                        self.moved.push(pad);
                    }
                }
            }
        }
    }

    fn wait(&mut self, element: u32) {
        if !self.queued[element as usize] {
            self.queued[element as usize] = true;
            let level = self.levels[element as usize] as usize;
            self.waiting[level].push(element);
            self.busy[level / 64] |= 1 << (level % 64);
        }
    }

    /// A clocked element has inputs that its clock has not seen.
    fn mark(&mut self, element: u32) {
        if !self.marked[element as usize] {
            self.marked[element as usize] = true;
            let domain = self.clocked[element as usize].domain();
            if let Some(domain) = domain {
                self.domains[domain as usize].waiting.push(element);
            }
        }
    }

    /// Lets all changes spread, clock edges among them.
    ///
    /// # Errors
    /// See [`Unsettled`].
    pub fn settle(&mut self) -> Result<(), Unsettled> {
        let mut left = ROUNDS * (self.logic.len() + self.clocked.len() + 1);
        loop {
            while let Some(word) = self.busy.iter().position(|word| *word != 0) {
                let level = 64 * word + self.busy[word].trailing_zeros() as usize;
                let Some(element) = self.waiting[level].pop() else {
                    self.busy[word] &= !(1 << (level % 64));
                    continue;
                };
                self.queued[element as usize] = false;
                let output = self.compute(element);
                left -= 1;
                if left == 0 {
                    return Err(Unsettled { net: self.names[output as usize].clone() });
                }
            }
            if self.fired.is_empty() {
                return Ok(());
            }
            self.fire();
        }
    }

    /// Computes an element; its output.
    fn compute(&mut self, element: u32) -> u32 {
        let (output, level) = match &self.logic[element as usize] {
            Logic::Table { table, inputs, output } => (*output, table >> self.index(inputs) & 1 == 1),
            Logic::Bus { drivers, output } => {
                (*output, drivers.iter().all(|(data, off)| self.value(*off) || self.value(*data)))
            }
            Logic::Level { element } => {
                let (output, level) = self.without_clock(*element);
                (output, level)
            }
        };
        self.change(output, level);
        output
    }
}
