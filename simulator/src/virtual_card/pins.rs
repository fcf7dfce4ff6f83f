//! A chip with pins behind the virtual card, compiled Verilog or the circuit of a bitstream: from its pins to the
//! motors, from the wheels to its pins.
//!
//! Time goes in slices of a thousand clocks. The duty of a slice is the share of it in which an axis is
//! enabled and its PWM pin high; the wheels then turn for as long, and their edges are played in the slice
//! after. So encoders lag by a slice, far less than a control tick.

use super::live::Live;
use super::machine::Machine;
use crate::chip::{Chip, release};
use crate::circuit::Circuit;
use crate::cosim::{Change, Session, Verilated};
use crate::error::FpgaError;
use crate::fpga::edges::{Motion, lines};
use bitstream::netlist::Netlist;
use fixed_kin::AXES;
use hdl::design::{COMMITTED_VERILOG, NAME};
use hdl::emit::ports::Ports;

/// Clocks of a slice.
const SLICE: u64 = 1_000;

/// See the module.
#[derive(Debug)]
pub struct PinsLive<C> {
    chip: C,
    encoder_a: usize,
    encoder_b: usize,
    pins: Pins,
    /// Clock at which the slice began.
    slice: u64,
    positions: [f64; AXES],
    levels: [u32; AXES],
    kicks: u32,
}

/// Outputs: their columns and levels.
#[derive(Clone, Copy, Debug, Default)]
struct Pins {
    columns: [usize; 4],
    levels: [u32; 4],
}

const OUTPUTS: [&str; 4] = ["pwm", "dir", "enable_n", "kicker_trigger_n"];
const PWM: usize = 0;
const DIR: usize = 1;
const ENABLE_N: usize = 2;
const TRIGGER_N: usize = 3;

impl PinsLive<Session> {
    /// The committed Verilog, compiled once per content.
    ///
    /// # Errors
    /// A missing Verilator, by the name of its package, or a compilation that fails.
    pub fn compiled() -> Result<Self, FpgaError> {
        let ports = Ports::parse(COMMITTED_VERILOG, NAME, &["lclk", "synclk"])
            .map_err(|error| FpgaError::Emit(error.to_string()))?;
        Self::new(Verilated::build(NAME, COMMITTED_VERILOG, NAME, &ports)?.start()?)
    }
}

impl PinsLive<Circuit> {
    /// A decoded circuit.
    ///
    /// # Errors
    /// A circuit that does not settle.
    pub fn decoded(netlist: &Netlist) -> Result<Self, FpgaError> {
        Self::new(Circuit::new(netlist)?)
    }
}

impl<C: Chip> PinsLive<C> {
    /// A chip just configured, its emergency stop closed.
    ///
    /// # Errors
    /// A simulation that fails.
    pub fn new(mut chip: C) -> Result<Self, FpgaError> {
        let (encoder_a, encoder_b) = (chip.layout().input("encoder_a")?, chip.layout().input("encoder_b")?);
        release(&mut chip)?;
        let mut columns = [0; 4];
        for (column, name) in columns.iter_mut().zip(OUTPUTS) {
            *column = chip.layout().output(name)?;
        }
        chip.run(1)?;
        let levels = chip.get(&columns)?;
        chip.record(&columns)?;
        let pins = Pins { columns, levels: std::array::from_fn(|n| levels[n]) };
        let slice = chip.clock();
        Ok(Self { chip, encoder_a, encoder_b, pins, slice, positions: [0.0; AXES], levels: [0; AXES], kicks: 0 })
    }

    /// Mean duty of each axis over the slice that has just ended.
    fn duties(&mut self) -> Result<[f64; AXES], FpgaError> {
        let (end, mut from) = (self.chip.clock(), self.slice);
        let mut high = [0.0; AXES];
        let mut changes = self.chip.take_recorded()?;
        changes.push(Change { clock: end, port: usize::MAX, value: 0 });
        for change in changes {
            let clocks = change.clock.clamp(from, end) - from;
            from += clocks;
            for (axis, high) in high.iter_mut().enumerate() {
                let bit = |pin: usize| self.pins.levels[pin] >> axis & 1 == 1;
                if bit(PWM) && !bit(ENABLE_N) {
                    *high += if bit(DIR) { -(clocks as f64) } else { clocks as f64 };
                }
            }
            if let Some(pin) = self.pins.columns.iter().position(|column| *column == change.port) {
                self.kicks += u32::from(pin == TRIGGER_N && change.value & 1 == 0 && self.pins.levels[pin] & 1 == 1);
                self.pins.levels[pin] = change.value;
            }
        }
        let clocks = (end - self.slice).max(1) as f64;
        Ok(high.map(|high| high / clocks))
    }

    /// Plays the motion of the wheels in the slice to come.
    fn turn(&mut self, to: &[f64; AXES]) -> Result<(), FpgaError> {
        let mut edges: Vec<(u64, usize, u32)> = Vec::new();
        for (axis, (&from, &to)) in self.positions.iter().zip(to).enumerate() {
            let motion = Motion::new(from, to, SLICE as u32, 0);
            edges.extend(motion.edges().map(|edge| (self.slice + u64::from(edge.clock) + 1, axis, lines(edge.count))));
        }
        edges.sort_unstable();
        let mut changes = Vec::with_capacity(2 * edges.len());
        for (clock, axis, level) in edges {
            self.levels[axis] = level;
            let word = |n: u32| self.levels.iter().enumerate().fold(0, |word, (i, level)| word | (level >> n & 1) << i);
            changes.push(Change { clock, port: self.encoder_a, value: word(0) });
            changes.push(Change { clock, port: self.encoder_b, value: word(1) });
        }
        self.positions = *to;
        self.chip.schedule(&changes)
    }
}

impl<C: Chip> Live for PinsLive<C> {
    fn run_to(&mut self, clock: u64, clock_hz: f64, machine: &mut Machine) -> Result<(), FpgaError> {
        while self.slice + SLICE <= clock {
            let end = (self.slice + SLICE).max(self.chip.clock());
            self.chip.run(end - self.chip.clock())?;
            let duties = self.duties()?;
            machine.step(&duties, (end - self.slice) as f64 / clock_hz);
            self.slice = end;
            self.turn(&machine.positions())?;
        }
        if clock > self.chip.clock() {
            self.chip.run(clock - self.chip.clock())?;
        }
        Ok(())
    }

    fn read(&mut self, offset: u16) -> Result<u32, FpgaError> {
        let mut word = [0];
        self.chip.read(offset, &mut word)?;
        Ok(word[0])
    }

    fn write(&mut self, offset: u16, data: u32) -> Result<(), FpgaError> {
        self.chip.write(offset, data)
    }

    fn kicks(&self) -> u32 {
        self.kicks
    }
}
