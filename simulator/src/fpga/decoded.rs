//! The circuit decoded from a bitstream, as an FPGA.

use super::pin_level::{PinLevel, forward_to_pin_level};
use super::ports::Ports;
use super::{FpgaError, Kind};
use crate::chip::release;
use crate::circuit::{Circuit, committed, decode};
use bitstream::netlist::Netlist;

/// The bits of a bitstream behind their pins.
#[derive(Debug)]
pub struct Decoded(PinLevel<Ports<Circuit>>);

impl Decoded {
    /// The committed `generated/rac4i65.bit`, decoded.
    ///
    /// # Errors
    /// Frames that make no circuit.
    pub fn new() -> Result<Self, FpgaError> {
        Self::of(&decode(&committed().packets)?)
    }

    /// Another circuit for the same card.
    ///
    /// # Errors
    /// A circuit that does not settle.
    pub fn of(netlist: &Netlist) -> Result<Self, FpgaError> {
        let mut circuit = Circuit::new(netlist)?;
        release(&mut circuit)?;
        Ok(Self(PinLevel::new(Kind::Bitstream, Ports::new(circuit)?)))
    }
}

forward_to_pin_level!(Decoded);
