//! PCI configuration space of a device without capabilities.

use driver::pci::{Bar, Ids};

/// Bytes of the configuration space.
const SIZE: usize = 256;
const COMMAND: usize = 0x04;
const BARS: usize = 0x10;
const SUBSYSTEM: usize = 0x2C;
const INTERRUPT: usize = 0x3C;
/// Command bits that exist: I/O, memory, master, parity, SERR.
const COMMAND_BITS: u16 = 0x0147;
/// Bridge device, other; revision 1.
const CLASS: u32 = 0x0680_0001;

/// What a base address register decodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Bytes, a power of two from 4.
    pub bytes: u32,
    /// Memory, not I/O ports.
    pub memory: bool,
}

impl Window {
    /// The six of a Mesa 4I65, by number of the base address register.
    #[must_use]
    pub fn mesa_4i65() -> [Option<Self>; 6] {
        Bar::ALL.map(|bar| Some(Self { bytes: bar.size(), memory: bar.is_memory() }))
    }
}

/// See the module.
#[derive(Clone, Debug)]
pub struct ConfigSpace {
    bytes: [u8; SIZE],
    windows: [Option<Window>; 6],
}

impl ConfigSpace {
    /// After power-up, with these numbers and windows.
    #[must_use]
    pub fn new(ids: Ids, windows: [Option<Window>; 6]) -> Self {
        let mut space = Self { bytes: [0; SIZE], windows };
        space.store(0, u32::from(ids.vendor) | u32::from(ids.device) << 16);
        space.store(0x08, CLASS);
        space.store(SUBSYSTEM, u32::from(ids.subsystem_vendor) | u32::from(ids.subsystem_device) << 16);
        // Interrupt pin A.
        space.store(INTERRUPT, 0x0100);
        space.reset();
        space
    }

    /// A PCI reset: addresses and command are forgotten.
    pub fn reset(&mut self) {
        self.store(COMMAND, 0);
        for (index, window) in self.windows.into_iter().enumerate() {
            self.store(BARS + 4 * index, window.is_some_and(|window| !window.memory).into());
        }
    }

    fn store(&mut self, at: usize, value: u32) {
        self.bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
    }

    fn load(&self, at: usize) -> u32 {
        u32::from_le_bytes(std::array::from_fn(|n| self.bytes[at + n]))
    }

    /// Reads 1, 2 or 4 bytes.
    #[must_use]
    pub fn read(&self, at: usize, size: usize) -> u32 {
        (0..size.min(4)).rev().fold(0, |word, n| word << 8 | u32::from(*self.bytes.get(at + n).unwrap_or(&0xFF)))
    }

    /// Writes 1, 2 or 4 bytes; what is read-only stays.
    pub fn write(&mut self, at: usize, size: usize, value: u32) {
        for n in 0..size.min(4) {
            let (place, byte) = (at + n, (value >> (8 * n)) as u8);
            let mask = match place {
                COMMAND => COMMAND_BITS as u8,
                p if p == COMMAND + 1 => (COMMAND_BITS >> 8) as u8,
                p if p == INTERRUPT => 0xFF,
                p if (BARS..BARS + 24).contains(&p) => {
                    let decoded = self.windows[(p - BARS) / 4].map_or(0, |window| !(window.bytes - 1));
                    (decoded >> (8 * ((p - BARS) % 4))) as u8
                }
                _ => 0,
            };
            if let Some(old) = self.bytes.get_mut(place) {
                *old = *old & !mask | byte & mask;
            }
        }
    }

    /// Number of the window that decodes an address, and the offset in it.
    #[must_use]
    pub fn decode(&self, address: u64, memory: bool) -> Option<(usize, u32)> {
        let enabled = self.load(COMMAND) & if memory { 2 } else { 1 } != 0;
        self.windows.iter().enumerate().find_map(|(index, window)| {
            let window = window.filter(|window| enabled && window.memory == memory)?;
            let base = self.load(BARS + 4 * index) & !(window.bytes - 1);
            let offset = address.checked_sub(base.into())?;
            (base != 0 && offset < u64::from(window.bytes)).then_some((index, offset as u32))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_found_as_firmware_finds_them() {
        let mut space = ConfigSpace::new(Ids::MESA_4I65, Window::mesa_4i65());
        assert_eq!((space.read(0, 2), space.read(2, 2)), (0x10B5, 0x9030));
        assert_eq!((space.read(0x2C, 2), space.read(0x2E, 2)), (0x10B5, 0x3132));
        for bar in Bar::ALL {
            let at = 0x10 + 4 * bar.index();
            space.write(at, 4, u32::MAX);
            let found = space.read(at, 4);
            let flags = if bar.is_memory() { 0xF } else { 0x3 };
            assert_eq!((!(found & !flags)).wrapping_add(1), bar.size());
            assert_eq!(found & 1 == 0, bar.is_memory());
        }
        // The CardBus pointer is none.
        space.write(0x28, 4, u32::MAX);
        assert_eq!(space.read(0x28, 4), 0);
    }

    #[test]
    fn addresses_are_decoded_once_enabled() {
        let mut space = ConfigSpace::new(Ids::MESA_4I65, Window::mesa_4i65());
        space.write(0x24, 4, 0xFEBD_0000);
        space.write(0x14, 4, 0xC100);
        assert_eq!(space.decode(0xFEBD_0804, true), None);
        space.write(4, 2, 3);
        assert_eq!(space.decode(0xFEBD_0804, true), Some((Bar::Memory32.index(), 0x804)));
        assert_eq!(space.decode(0xC154, false), Some((Bar::BridgePorts.index(), 0x54)));
        assert_eq!(space.decode(0xC154, true), None);
        space.reset();
        assert_eq!(space.decode(0xC154, false), None);
    }
}
