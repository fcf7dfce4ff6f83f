//! Registers that are memory and nothing else: the table of registers says all about them.

use crate::registers::{REGISTERS, Register};

/// Words of the window up to the last plain register.
const WORDS: usize = {
    let (mut words, mut i) = (0, 0);
    while i < REGISTERS.len() {
        if REGISTERS[i].kept() != 0 {
            words = REGISTERS[i].word_address() as usize + 1;
        }
        i += 1;
    }
    words
};

/// What stands in them, by word address; zero where no plain register stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plain([u32; WORDS]);

impl Plain {
    /// After configuration of the FPGA.
    pub(super) fn new() -> Self {
        let mut words = [0; WORDS];
        for register in REGISTERS.iter().filter(|register| register.kept() != 0) {
            words[usize::from(register.word_address())] = register.reset;
        }
        Self(words)
    }

    /// What stands in a plain register.
    #[inline]
    pub(super) fn of(&self, register: &Register) -> u32 {
        self.0[usize::from(register.word_address())]
    }

    /// Reads a register; nothing where it is not plain.
    pub(super) fn read(&self, register: &Register) -> Option<u32> {
        (register.kept() != 0).then(|| self.of(register))
    }

    /// Writes a register; `false` where it is not plain.
    pub(super) fn write(&mut self, register: &Register, data: u32) -> bool {
        let kept = register.kept();
        if kept != 0 {
            self.0[usize::from(register.word_address())] = data & kept;
        }
        kept != 0
    }
}
