//! A chip that is made of the bits of a bitstream: decoded, then simulated behind the card's pins.
//!
//! ```text
//! .bit ──► packets ──► frames ──► circuit ──► levels ──► pads P1..P208 ──► ports by hdl::board
//! ```
//!
//! It has the ports of the committed design, because the card's wires have them: whatever design is loaded, the local
//! bus arrives at the same pins and the motors hang on the same connector. What the design does not drive is
//! pulled up.

mod bus;

use crate::chip::Chip;
use crate::cosim::{Change, Layout};
use crate::error::FpgaError;
use bitstream::configuration::Configuration;
use bitstream::container::Bitstream;
use bitstream::container::packets::Packets;
use bitstream::device::Device;
use bitstream::netlist::{Netlist, extract};
use bitstream::simulation::Simulator;
use hdl::board::{Board, LCLK_PIN, SYNCLK_PIN};
use hdl::design::{COMMITTED_VERILOG, NAME};
use hdl::emit::ports::{Direction, Ports};
use std::collections::{BTreeSet, VecDeque};

/// Period of the local bus clock, ps.
pub const LCLK_PS: u64 = 30_000;
/// Period of the crystal oscillator, ps.
pub const SYNCLK_PS: u64 = 20_000;
/// Faults of a bitstream that are named.
const NAMED: usize = 3;

/// The circuit that the packets of a bitstream make.
///
/// # Errors
/// Frames that are no configuration of the device, or a configuration that is no circuit, with the first faults.
pub fn decode(packets: &Packets) -> Result<Netlist, FpgaError> {
    let device = Device::xc2s200();
    let configuration =
        Configuration::from_packets(device, packets).map_err(|error| FpgaError::NoCircuit(error.to_string()))?;
    extract(device, &configuration).map_err(|faults| {
        let named: Vec<String> = faults.iter().take(NAMED).map(ToString::to_string).collect();
        let more = if faults.len() > NAMED { format!("; and {} more", faults.len() - NAMED) } else { String::new() };
        FpgaError::NoCircuit(named.join("; ") + &more)
    })
}

/// The committed bitstream.
///
/// # Panics
/// When the committed file is damaged; a test looks.
#[must_use]
pub fn committed() -> Bitstream {
    Bitstream::parse(hdl::design::COMMITTED_BITSTREAM).unwrap_or_else(|fault| panic!("generated/rac4i65.bit: {fault}"))
}

/// A pad and the bit of a column that it is.
#[derive(Clone, Copy, Debug)]
struct Wire {
    pad: usize,
    bit: u32,
}

/// See the module.
#[derive(Clone, Debug)]
pub struct Circuit {
    layout: Layout,
    simulator: Simulator,
    /// Pads of the input columns, of the output columns, and which output column a pad belongs to.
    inputs: Vec<Vec<Wire>>,
    outputs: Vec<Vec<Wire>>,
    column_of: Vec<Option<usize>>,
    /// Output columns that are tri-state, with the input columns of level and drive.
    shared: Vec<Option<(usize, usize)>>,
    levels: Vec<u32>,
    values: Vec<u32>,
    scheduled: VecDeque<Change>,
    recorded: Vec<bool>,
    last: Vec<u32>,
    changes: Vec<Change>,
    clock: u64,
    bus: bus::Pins,
}

impl Circuit {
    /// A chip just configured with this circuit, its clocks as on the card.
    ///
    /// # Errors
    /// A circuit that does not settle.
    pub fn new(netlist: &Netlist) -> Result<Self, FpgaError> {
        Self::with_periods(netlist, [LCLK_PS, SYNCLK_PS])
    }

    /// The same with other periods of LCLK and SYNCLK, ps.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_periods(netlist: &Netlist, periods: [u64; 2]) -> Result<Self, FpgaError> {
        let ports = Ports::parse(COMMITTED_VERILOG, NAME, &["lclk", "synclk"])
            .map_err(|error| FpgaError::Emit(error.to_string()))?;
        let layout = Layout::of(&ports);
        let board = Board::mesa_4i65_7i30();
        let mut simulator = Simulator::new(netlist)?;
        for (pin, period) in [LCLK_PIN, SYNCLK_PIN].into_iter().zip(periods) {
            if let Some(pad) = simulator.pad(pin) {
                simulator.clock(pad, period, period);
            }
        }
        let wires = |simulator: &Simulator, port: &str| -> Vec<Wire> {
            let bits = board.port(port).into_iter().zip(0..);
            bits.filter_map(|(bit, n)| Some(Wire { pad: simulator.pad(bit.place.pin())?, bit: n })).collect()
        };
        let mut inputs = Vec::new();
        let mut levels = Vec::new();
        for column in &layout.inputs {
            inputs.push(wires(&simulator, &column.name));
            levels.push(if column.name.ends_with(".drive") { 0 } else { u32::MAX >> (32 - column.width) });
        }
        let outputs: Vec<Vec<Wire>> = layout.outputs.iter().map(|column| wires(&simulator, &column.name)).collect();
        let mut column_of = vec![None; netlist.pads.len()];
        for (column, wires) in outputs.iter().enumerate() {
            wires.iter().for_each(|wire| column_of[wire.pad] = Some(column));
        }
        let tristate = |name: &str| ports.list.iter().any(|p| p.name == name && p.direction == Direction::InOut);
        let shared = layout.outputs.iter().map(|column| {
            let name = &column.name;
            tristate(name).then(|| Some((layout.input(name).ok()?, layout.input(&format!("{name}.drive")).ok()?)))?
        });
        let shared = shared.collect();
        let values = layout.outputs.iter().map(|column| u32::MAX >> (32 - column.width)).collect();
        let bus = bus::Pins::of(&layout, periods[0])?;
        let (recorded, last) = (vec![false; layout.outputs.len()], vec![0; layout.outputs.len()]);
        let (scheduled, changes) = (VecDeque::new(), Vec::new());
        let mut circuit = Self {
            layout,
            simulator,
            inputs,
            outputs,
            column_of,
            shared,
            levels,
            values,
            scheduled,
            recorded,
            last,
            changes,
            clock: 0,
            bus,
        };
        circuit.idle();
        circuit.settle()?;
        Ok(circuit)
    }

    fn put(&mut self, column: usize, value: u32) {
        self.levels[column] = value;
        for wire in &self.inputs[column] {
            self.simulator.set(wire.pad, value >> wire.bit & 1 == 1);
        }
    }

    fn settle(&mut self) -> Result<(), FpgaError> {
        Ok(self.simulator.settle()?)
    }

    /// Levels of the output columns whose pads moved.
    fn look(&mut self) {
        let mut columns = BTreeSet::new();
        let column_of = &self.column_of;
        self.simulator.take_moved(|pad| columns.extend(column_of[pad]));
        for column in columns {
            let pulled = u32::MAX >> (32 - self.layout.outputs[column].width);
            self.values[column] = self.outputs[column].iter().fold(pulled, |value, wire| {
                let level = self.simulator.driven(wire.pad).unwrap_or(true);
                value & !(1 << wire.bit) | u32::from(level) << wire.bit
            });
        }
    }

    /// A column as it stands at the pins: on a tri-state bus what the chip drives, else what the outside drives, else 0,
    /// as compiled Verilog has a bus that floats.
    fn output(&self, column: usize) -> u32 {
        let Some((level, drive)) = self.shared[column] else { return self.values[column] };
        let driving = self.outputs[column].iter().any(|wire| self.simulator.driven(wire.pad).is_some());
        match (driving, self.levels[drive] == 1) {
            (true, _) => self.values[column],
            (false, true) => self.levels[level],
            (false, false) => 0,
        }
    }

    /// Applies what is due and lets it settle; the main clock is low.
    fn before_edge(&mut self) -> Result<(), FpgaError> {
        while let Some(change) = self.scheduled.front().copied().filter(|change| change.clock <= self.clock) {
            self.scheduled.pop_front();
            self.put(change.port, change.value);
        }
        self.settle()?;
        let edge = (self.clock + 1) * self.bus.period;
        Ok(self.simulator.advance(edge - 1)?)
    }

    fn edge(&mut self) -> Result<(), FpgaError> {
        self.simulator.advance((self.clock + 1) * self.bus.period)?;
        if self.recorded.iter().any(|recorded| *recorded) {
            self.look();
            for column in 0..self.recorded.len() {
                let value = if self.recorded[column] { self.output(column) } else { continue };
                if value != self.last[column] {
                    self.last[column] = value;
                    self.changes.push(Change { clock: self.clock, port: column, value });
                }
            }
        }
        self.clock += 1;
        Ok(())
    }

    fn step(&mut self) -> Result<(), FpgaError> {
        self.before_edge()?;
        self.edge()
    }

    /// Goes on from the present state over a stimulus: one row of inputs a clock, as
    /// [`Session::run_batch`](crate::cosim::Session::run_batch) has them; hands out the clock and the row of
    /// outputs after each, and stops where that says false.
    ///
    /// # Errors
    /// A circuit that does not settle.
    pub fn batch(&mut self, stimulus: &[u32], mut row: impl FnMut(usize, &[u32]) -> bool) -> Result<(), FpgaError> {
        let mut out = vec![0; self.layout.outputs.len()];
        for (number, inputs) in stimulus.chunks_exact(self.layout.inputs.len()).enumerate() {
            for (column, value) in inputs.iter().enumerate() {
                if self.levels[column] != *value {
                    self.put(column, *value);
                }
            }
            self.step()?;
            self.look();
            (0..out.len()).for_each(|column| out[column] = self.output(column));
            if !row(number, &out) {
                break;
            }
        }
        Ok(())
    }
}

impl Chip for Circuit {
    fn layout(&self) -> &Layout {
        &self.layout
    }

    fn clock(&self) -> u64 {
        self.clock
    }

    fn set(&mut self, column: usize, value: u32) -> Result<(), FpgaError> {
        self.put(column, value);
        Ok(())
    }

    fn get(&mut self, columns: &[usize]) -> Result<Vec<u32>, FpgaError> {
        self.settle()?;
        self.look();
        Ok(columns.iter().map(|column| self.output(*column)).collect())
    }

    fn schedule(&mut self, changes: &[Change]) -> Result<(), FpgaError> {
        self.scheduled.extend(changes);
        self.scheduled.make_contiguous().sort_by_key(|change| change.clock);
        Ok(())
    }

    fn run(&mut self, clocks: u64) -> Result<(), FpgaError> {
        (0..clocks).try_for_each(|_| self.step())
    }

    fn record(&mut self, columns: &[usize]) -> Result<(), FpgaError> {
        self.look();
        self.recorded.fill(false);
        for column in columns {
            self.recorded[*column] = true;
            self.last[*column] = self.output(*column);
        }
        Ok(())
    }

    fn take_recorded(&mut self) -> Result<Vec<Change>, FpgaError> {
        Ok(std::mem::take(&mut self.changes))
    }

    fn read(&mut self, offset: u16, words: &mut [u32]) -> Result<(), FpgaError> {
        self.bus_read(offset.into(), words)
    }

    fn write(&mut self, offset: u16, data: u32) -> Result<(), FpgaError> {
        self.bus_write(offset.into(), data)
    }
}
