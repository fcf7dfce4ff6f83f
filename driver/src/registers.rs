//! The register bus: aligned 32-bit reads and writes, and a recorder that wraps any of them.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "a block has at most as many words as the window"
)]

use std::fmt::Display;

/// A failed transfer: the card is gone, or the simulation behind it is.
#[derive(Debug, thiserror::Error)]
#[error("{action} of register {offset:#06x} failed: {cause}")]
pub struct BusError {
    /// `read` or `write`.
    pub action: &'static str,
    /// Byte offset.
    pub offset: u16,
    /// What the bus says.
    pub cause: String,
}

impl BusError {
    /// A failed read.
    pub fn read(offset: u16, cause: impl Display) -> Self {
        Self { action: "read", offset, cause: cause.to_string() }
    }

    /// A failed write.
    pub fn write(offset: u16, cause: impl Display) -> Self {
        Self { action: "write", offset, cause: cause.to_string() }
    }
}

/// Aligned 32-bit access to the register window (BAR 5), by byte offset.
pub trait Registers {
    /// Reads a word.
    ///
    /// # Errors
    /// [`BusError`] where the bus does not answer.
    fn read(&mut self, offset: u16) -> Result<u32, BusError>;

    /// Writes a word.
    ///
    /// # Errors
    /// [`BusError`] where the bus does not answer.
    fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError>;

    /// Reads consecutive words; buses that can burst do.
    ///
    /// # Errors
    /// [`BusError`] where the bus does not answer.
    fn read_block(&mut self, offset: u16, words: &mut [u32]) -> Result<(), BusError> {
        for (index, word) in words.iter_mut().enumerate() {
            *word = self.read(offset + 4 * index as u16)?;
        }
        Ok(())
    }
}

macro_rules! forward {
    ($($bus:ty),*) => {$(
        impl<R: Registers + ?Sized> Registers for $bus {
            fn read(&mut self, offset: u16) -> Result<u32, BusError> {
                (**self).read(offset)
            }
            fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError> {
                (**self).write(offset, data)
            }
            fn read_block(&mut self, offset: u16, words: &mut [u32]) -> Result<(), BusError> {
                (**self).read_block(offset, words)
            }
        }
    )*};
}
forward!(&mut R, Box<R>);

impl Registers for fixed_kin::card::Card {
    fn read(&mut self, offset: u16) -> Result<u32, BusError> {
        Ok(Self::read(self, offset))
    }
    fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError> {
        Self::write(self, offset, data);
        Ok(())
    }
    fn read_block(&mut self, offset: u16, words: &mut [u32]) -> Result<(), BusError> {
        Self::read_block(self, offset, words);
        Ok(())
    }
}

/// One word over the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transfer {
    /// Offset and what was read.
    Read(u16, u32),
    /// Offset and what was written.
    Write(u16, u32),
}

/// Notes every transfer of the bus inside.
#[derive(Debug)]
pub struct Recorder<R> {
    /// Carries out what is recorded.
    pub inner: R,
    /// What went over it since this was last emptied.
    pub transfers: Vec<Transfer>,
}

impl<R> Recorder<R> {
    /// Wraps a bus.
    pub fn new(inner: R) -> Self {
        Self { inner, transfers: Vec::new() }
    }
}

impl<R: Registers> Registers for Recorder<R> {
    fn read(&mut self, offset: u16) -> Result<u32, BusError> {
        let data = self.inner.read(offset)?;
        self.transfers.push(Transfer::Read(offset, data));
        Ok(data)
    }
    fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError> {
        self.inner.write(offset, data)?;
        self.transfers.push(Transfer::Write(offset, data));
        Ok(())
    }
}
