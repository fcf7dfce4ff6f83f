//! Delay-locked loops, ideal: their outputs follow the measured period of the clock, and they lock after four.

use super::{Line, Simulator};
use std::cmp::Reverse;

/// Periods until a loop says that it has locked.
const LOCK: u32 = 4;

/// A delay-locked loop that has to see edges before it locks.
#[derive(Clone, Debug)]
pub(super) struct Loop {
    reset: Line,
    divide: u64,
    /// Name of the pin and net of the outputs in use.
    outputs: Vec<(&'static str, u32)>,
    /// Time of the last edge, edges since reset, edges since the divided clock rose.
    last: Option<u64>,
    edges: u32,
    count: u64,
}

impl Loop {
    pub(super) fn new(reset: Line, divide: u64, outputs: Vec<(&'static str, u32)>) -> Self {
        Self { reset, divide: divide.max(2), outputs, last: None, edges: 0, count: 0 }
    }
}

impl Simulator {
    /// The clock of a loop has risen: the edges of its outputs up to the next one.
    pub(super) fn loop_edge(&mut self, index: usize) {
        let (now, reset) = (self.now, self.value(self.loops[index].reset));
        let found = &mut self.loops[index];
        let period = found.last.replace(now).map(|last| now - last);
        found.edges = if reset { 0 } else { found.edges.saturating_add(1) };
        let mut edges: Vec<(u64, u32, bool)> = Vec::new();
        let locked = found.edges >= LOCK;
        if let Some(period) = period.filter(|_| !reset) {
            let at = |eighths: u64| now + eighths * period / 8;
            for (name, net) in &found.outputs {
                let mut toggle = |rises: &[u64], falls: &[u64]| {
                    edges.extend(rises.iter().map(|eighth| (at(*eighth), *net, true)));
                    edges.extend(falls.iter().map(|eighth| (at(*eighth), *net, false)));
                };
                match *name {
                    "CLK0" => toggle(&[0], &[4]),
                    "CLK90" => toggle(&[2], &[6]),
                    "CLK180" => toggle(&[4], &[0]),
                    "CLK270" => toggle(&[6], &[2]),
                    "CLK2X" => toggle(&[0, 4], &[2, 6]),
                    "CLK2X90" => toggle(&[1, 5], &[3, 7]),
                    "CLKDV" if found.count == 0 => toggle(&[0], &[]),
                    "CLKDV" if found.count == found.divide.div_ceil(2) => toggle(&[], &[0]),
                    _ => {}
                }
            }
            found.count = (found.count + 1) % found.divide;
        }
        let lock = found.outputs.iter().filter(|(name, _)| *name == "LOCKED").map(|(_, net)| (now, *net, locked));
        edges.extend(lock);
        // Edges of this very moment wait until the levels before them have settled.
        self.events.extend(edges.into_iter().map(Reverse));
    }
}
