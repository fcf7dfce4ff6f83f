//! The emitted Verilog, compiled by Verilator, as an FPGA.

use super::pin_level::{Chip, Lines, PinLevel, forward_to_pin_level};
use super::{FpgaError, Kind};
use crate::cosim::{Change, Session, Verilated};
use hdl::design::{COMMITTED_VERILOG, NAME};
use hdl::emit::ports::Ports;

/// The committed `generated/rac4i65.v` behind its pins.
#[derive(Debug)]
pub struct Verilog(PinLevel<Compiled>);

#[derive(Debug)]
struct Compiled {
    session: Session,
    a: usize,
    b: usize,
}

impl Verilog {
    /// Compiles the chip, once per content, and powers it up.
    ///
    /// # Errors
    /// A missing Verilator, by the name of its package, or a compilation that fails.
    pub fn new() -> Result<Self, FpgaError> {
        Self::of(NAME, COMMITTED_VERILOG)
    }

    /// As [`Self::new`], with another text that describes the same chip, its netlist for instance.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of(name: &str, verilog: &str) -> Result<Self, FpgaError> {
        let ports = Ports::parse(COMMITTED_VERILOG, NAME, &["lclk", "synclk"])
            .map_err(|error| FpgaError::Emit(error.to_string()))?;
        let mut session = Verilated::build(name, verilog, NAME, &ports)?.start()?;
        let (a, b) = (session.layout().input("encoder_a")?, session.layout().input("encoder_b")?);
        session.set_port("emergency_stop", 0)?;
        session.set_port("host_select", 1)?;
        session.set_port("radio_rx", 1)?;
        Ok(Self(PinLevel::new(Kind::Verilog, Compiled { session, a, b })))
    }
}

impl Chip for Compiled {
    fn clock(&self) -> u64 {
        self.session.clock()
    }

    fn schedule(&mut self, lines: &[Lines]) -> Result<(), FpgaError> {
        let changes: Vec<_> = lines
            .iter()
            .flat_map(|lines| [(self.a, lines.a), (self.b, lines.b)].map(|(port, value)| (lines.clock, port, value)))
            .map(|(clock, port, value)| Change { clock, port, value })
            .collect();
        Ok(self.session.schedule(&changes)?)
    }

    fn run(&mut self, clocks: u64) -> Result<(), FpgaError> {
        Ok(self.session.run(clocks)?)
    }

    fn read(&mut self, offset: u16, words: &mut [u32]) -> Result<(), FpgaError> {
        words.copy_from_slice(&self.session.bus_burst_read(offset.into(), words.len() as u32)?);
        Ok(())
    }

    fn write(&mut self, offset: u16, data: u32) -> Result<(), FpgaError> {
        Ok(self.session.bus_write(offset.into(), data)?)
    }
}

forward_to_pin_level!(Verilog);
