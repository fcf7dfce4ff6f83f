//! The PLX PCI9030 as far as the card uses it: its registers, and lines to the FPGA.

use driver::plx9030::{
    DONE, GPIO_CONTROL, INIT, INTERRUPT_CONTROL, LED, LOCAL_SPACE_DESCRIPTORS, PROGRAM, READY_ENABLE, WRITE,
};

/// Bytes of the register file.
const SIZE: usize = 0x80;
/// The inputs of GPIO: data bits nobody can write.
const INPUTS: u32 = DONE | INIT;
/// Data bit of a line; its direction is the bit below, 1 = output.
const fn direction(data: u32) -> u32 {
    data >> 1
}
/// GPIO control as the EEPROM sets it: three outputs, PROGRAM, WRITE and LED high.
const GPIO_DEFAULT: u32 = direction(LED) | direction(WRITE) | direction(PROGRAM) | LED | WRITE | PROGRAM;

/// What the EEPROM on the card says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Eeprom {
    /// READY# enabled in all local spaces; old cards left the factory without.
    pub ready_enabled: bool,
}

impl Default for Eeprom {
    fn default() -> Self {
        Self { ready_enabled: true }
    }
}

/// See the module.
#[derive(Clone, Debug)]
pub struct Bridge {
    eeprom: Eeprom,
    registers: [u8; SIZE],
}

impl Bridge {
    /// A bridge that has read its EEPROM.
    #[must_use]
    pub fn new(eeprom: Eeprom) -> Self {
        let mut bridge = Self { eeprom, registers: [0; SIZE] };
        bridge.reset();
        bridge
    }

    /// A PCI reset: the EEPROM is read again. The FPGA does not notice but for its lines.
    pub fn reset(&mut self) {
        self.registers = [0; SIZE];
        self.store(GPIO_CONTROL, GPIO_DEFAULT);
        self.store(INTERRUPT_CONTROL, 0);
        for register in LOCAL_SPACE_DESCRIPTORS {
            // Bus width and wait states as CERN's cards have them; only READY# matters here.
            self.store(register, 0x0080_0000 | if self.eeprom.ready_enabled { READY_ENABLE } else { 0 });
        }
    }

    fn store(&mut self, register: u32, value: u32) {
        self.registers[register as usize..register as usize + 4].copy_from_slice(&value.to_le_bytes());
    }

    fn load(&self, register: u32) -> u32 {
        let at = register as usize;
        u32::from_le_bytes(std::array::from_fn(|n| self.registers[at + n]))
    }

    /// Reads 1, 2 or 4 bytes, with the inputs as the FPGA drives them.
    #[must_use]
    pub fn read(&self, offset: u32, size: u32, done: bool, init: bool) -> u32 {
        let mut bridge = self.registers;
        let mut gpio = self.load(GPIO_CONTROL) & !INPUTS;
        gpio |= if done { DONE } else { 0 } | if init { INIT } else { 0 };
        bridge[GPIO_CONTROL as usize..GPIO_CONTROL as usize + 4].copy_from_slice(&gpio.to_le_bytes());
        (0..size).rev().fold(0, |word, n| word << 8 | u32::from(*bridge.get((offset + n) as usize).unwrap_or(&0)))
    }

    /// Writes 1, 2 or 4 bytes.
    pub fn write(&mut self, offset: u32, size: u32, data: u32) {
        for n in 0..size.min(4) {
            if let Some(byte) = self.registers.get_mut((offset + n) as usize) {
                *byte = (data >> (8 * n)) as u8;
            }
        }
    }

    /// Level of an output line; a line that is no output is pulled up.
    fn level(&self, line: u32) -> bool {
        let gpio = self.load(GPIO_CONTROL);
        gpio & direction(line) == 0 || gpio & line != 0
    }

    /// Level of the line PROGRAM: low clears the FPGA.
    #[must_use]
    pub fn program(&self) -> bool {
        self.level(PROGRAM)
    }

    /// Level of the line WRITE: low takes bytes.
    #[must_use]
    pub fn write_line(&self) -> bool {
        self.level(WRITE)
    }

    /// The status LED is lit.
    #[must_use]
    pub fn led(&self) -> bool {
        !self.level(LED)
    }

    /// Whether the bridge waits for READY# in a local space, 0 to 3.
    #[must_use]
    pub fn waits(&self, space: usize) -> bool {
        self.load(LOCAL_SPACE_DESCRIPTORS[space]) & READY_ENABLE != 0
    }
}
