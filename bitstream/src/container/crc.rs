//! The CRC inside a Virtex or Spartan-II bitstream.

use super::registers;

/// Polynomial x¹⁶ + x¹⁵ + x² + 1, reflected.
const POLYNOMIAL: u16 = 0xA001;
/// Bits of a register address.
const ADDRESS_BITS: u32 = 4;

/// 16 bits over every register write but those of the CRC register itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Crc(pub u16);

impl Crc {
    /// A write of a word to a configuration register: data, then address, lowest bit first.
    pub fn write(&mut self, register: u32, data: u32) {
        self.shift(data, u32::BITS);
        self.shift(register, ADDRESS_BITS);
    }

    /// A write to any register, with what it does to the CRC itself: a check or a reset leaves zero.
    pub fn update(&mut self, register: u32, data: u32) {
        if register == registers::CRC || (register == registers::COMMAND && data == registers::RESET_CRC) {
            self.0 = 0;
        } else {
            self.write(register, data);
        }
    }

    fn shift(&mut self, bits: u32, count: u32) {
        for n in 0..count {
            let feedback = (self.0 ^ (bits >> n) as u16) & 1;
            self.0 = self.0 >> 1 ^ if feedback == 1 { POLYNOMIAL } else { 0 };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::container::registers::{COMMAND, CONTROL, FRAME_DATA};

    /// The end of the bitstreams that Xilinx's tools make for this device: last frame, start, control,
    /// and the CRC word 38FE that stands after them in every file looked at.
    #[test]
    fn the_tail_of_real_bitstreams() {
        let mut crc = Crc::default();
        crc.write(COMMAND, 3);
        for _ in 0..18 {
            crc.write(FRAME_DATA, 0);
        }
        crc.write(COMMAND, 5);
        crc.write(CONTROL, 0);
        assert_eq!(crc.0, 0x38FE);
    }
}
