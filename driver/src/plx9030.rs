//! The bridge on the card, a PLX PCI9030: the registers that loading needs.
//!
//! Offsets and bits as code written against the bridge's data book has them: LinuxCNC `hm2_pci` and
//! `bfload`, U-Boot's `plx9030.c`, CERN's `plx9030_layout.h`; the roles of the GPIO lines: Mesa 4I65
//! manual 1.4, page 9.

use crate::pci::{Bar, PciCard, PciError};

/// Bus region descriptors of the four local address spaces.
pub const LOCAL_SPACE_DESCRIPTORS: [u32; 4] = [0x28, 0x2C, 0x30, 0x34];
/// Bit of a descriptor: the bridge waits for READY#.
pub const READY_ENABLE: u32 = 1 << 1;
/// Interrupt control and status.
pub const INTERRUPT_CONTROL: u32 = 0x4C;
/// General-purpose lines, which the card uses to configure its FPGA.
pub const GPIO_CONTROL: u32 = 0x54;

/// DONE of the FPGA: high once it is configured. Input.
pub const DONE: u32 = 1 << 11;
/// INIT of the FPGA: high when it is ready for a bitstream, low after a CRC error. Input.
pub const INIT: u32 = 1 << 14;
/// The card's status LED: low is lit. Output.
pub const LED: u32 = 1 << 17;
/// WRITE of the FPGA, low while a bitstream is sent. Output.
pub const WRITE: u32 = 1 << 23;
/// PROGRAM of the FPGA: low clears it. Output.
pub const PROGRAM: u32 = 1 << 26;

/// The bridge's registers on a card.
#[derive(Debug)]
pub struct Bridge<'a, C> {
    card: &'a mut C,
    bar: Bar,
}

impl<'a, C: PciCard> Bridge<'a, C> {
    /// Registers in memory, or through ports where memory cannot be reached.
    pub fn new(card: &'a mut C) -> Self {
        let bar = if card.has(Bar::Bridge) { Bar::Bridge } else { Bar::BridgePorts };
        Self { card, bar }
    }

    /// Reads a register.
    ///
    /// # Errors
    /// [`PciError`] where the system refuses the access.
    pub fn read(&mut self, register: u32) -> Result<u32, PciError> {
        self.card.read32(self.bar, register)
    }

    /// Writes a register.
    ///
    /// # Errors
    /// [`PciError`] where the system refuses the access.
    pub fn write(&mut self, register: u32, data: u32) -> Result<(), PciError> {
        self.card.write32(self.bar, register, data)
    }

    /// Sets and clears lines and leaves the others, whose directions the card's EEPROM has set.
    ///
    /// # Errors
    /// [`PciError`] where the system refuses the access.
    pub fn set_lines(&mut self, high: u32, low: u32) -> Result<(), PciError> {
        let lines = self.read(GPIO_CONTROL)?;
        self.write(GPIO_CONTROL, (lines | high) & !low)
    }

    /// Makes the bridge wait for READY# in all spaces, as the design on the FPGA needs; old EEPROMs leave it off.
    /// Returns how many spaces had it off.
    ///
    /// # Errors
    /// [`PciError`] where the system refuses the access.
    pub fn enable_ready(&mut self) -> Result<u32, PciError> {
        let mut changed = 0;
        for register in LOCAL_SPACE_DESCRIPTORS {
            let descriptor = self.read(register)?;
            if descriptor & READY_ENABLE == 0 {
                self.write(register, descriptor | READY_ENABLE)?;
                changed += 1;
            }
        }
        Ok(changed)
    }
}
