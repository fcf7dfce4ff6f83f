//! The sensor's serial port, level by level: modes 0 and 3, addresses that count up in a burst.

use super::VirtualImu;

/// A sensor behind its four lines.
#[derive(Clone, Debug)]
pub struct SpiPins {
    /// What answers the bus.
    pub sensor: VirtualImu,
    sclk: bool,
    selected: bool,
    bits: u32,
    heard: u16,
    sending: u8,
    miso: bool,
}

impl SpiPins {
    /// Lines at rest.
    #[must_use]
    pub fn new(sensor: VirtualImu) -> Self {
        Self { sensor, sclk: true, selected: false, bits: 0, heard: 0, sending: 0xFF, miso: true }
    }

    /// The levels that the card drives now; the level of the sensor's line then, which is pulled up.
    pub fn see(&mut self, cs_n: bool, sclk: bool, mosi: bool) -> bool {
        if cs_n {
            if self.selected && self.bits == 16 && self.heard & 0x8000 == 0 {
                self.sensor.access(self.heard);
            }
            (self.selected, self.miso) = (false, true);
        } else {
            if !self.selected {
                (self.selected, self.bits, self.heard) = (true, 0, 0);
            }
            match (self.sclk, sclk) {
                (false, true) => self.read(mosi),
                (true, false) => self.miso = self.bits < 8 || self.sending & 0x80 != 0,
                _ => {}
            }
        }
        self.sclk = sclk;
        self.miso
    }

    fn read(&mut self, mosi: bool) {
        self.bits += 1;
        self.sending <<= 1;
        if self.bits <= 16 {
            self.heard = self.heard << 1 | u16::from(mosi);
        }
        if self.bits.is_multiple_of(8) {
            let command = if self.bits == 8 { self.heard as u8 } else { (self.heard >> 8) as u8 };
            let register = (command & 0x7F).wrapping_add((self.bits / 8 - 1) as u8);
            self.sending = if command & 0x80 != 0 { self.sensor.byte(register) } else { 0 };
        }
    }
}
