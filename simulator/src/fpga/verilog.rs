//! The emitted Verilog, compiled by Verilator, as an FPGA.

use super::pin_level::{PinLevel, forward_to_pin_level};
use super::{FpgaError, Kind};
use crate::chip::release;
use crate::cosim::{Session, Verilated};
use hdl::design::{COMMITTED_VERILOG, NAME};
use hdl::emit::ports::Ports;

/// The committed `generated/rac4i65.v` behind its pins.
#[derive(Debug)]
pub struct Verilog(PinLevel<super::ports::Ports<Session>>);

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
        release(&mut session)?;
        Ok(Self(PinLevel::new(Kind::Verilog, super::ports::Ports::new(session)?)))
    }
}

forward_to_pin_level!(Verilog);
