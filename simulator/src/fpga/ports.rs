//! Any chip with the card's ports behind the seam of [`super::pin_level`].

use super::FpgaError;
use super::pin_level::{self, Lines};
use crate::chip::Chip;
use crate::cosim::Change;

/// A chip and the columns of its encoders.
#[derive(Debug)]
pub(super) struct Ports<C> {
    chip: C,
    a: usize,
    b: usize,
}

impl<C: Chip> Ports<C> {
    pub(super) fn new(chip: C) -> Result<Self, FpgaError> {
        let (a, b) = (chip.layout().input("encoder_a")?, chip.layout().input("encoder_b")?);
        Ok(Self { chip, a, b })
    }
}

impl<C: Chip> pin_level::Chip for Ports<C> {
    fn clock(&self) -> u64 {
        self.chip.clock()
    }

    fn schedule(&mut self, lines: &[Lines]) -> Result<(), FpgaError> {
        let changes: Vec<_> = lines
            .iter()
            .flat_map(|lines| [(self.a, lines.a), (self.b, lines.b)].map(|(port, value)| (lines.clock, port, value)))
            .map(|(clock, port, value)| Change { clock, port, value })
            .collect();
        self.chip.schedule(&changes)
    }

    fn run(&mut self, clocks: u64) -> Result<(), FpgaError> {
        self.chip.run(clocks)
    }

    fn read(&mut self, offset: u16, words: &mut [u32]) -> Result<(), FpgaError> {
        self.chip.read(offset, words)
    }

    fn write(&mut self, offset: u16, data: u32) -> Result<(), FpgaError> {
        self.chip.write(offset, data)
    }
}
