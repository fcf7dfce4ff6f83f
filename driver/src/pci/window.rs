//! The registers of a loaded FPGA, through the card's register window.

use super::{Bar, PciCard};
use crate::registers::{BusError, Registers};
use fixed_kin::registers::{COOKIE, COOKIE_VALUE};

/// [`Registers`] over the 32-bit local bus of a card.
///
/// A card that is gone reads all ones. All ones may also be a count of −1, so such a word is believed
/// only if the cookie still reads right; else it is a [`BusError`].
#[derive(Debug)]
pub struct RegisterWindow<C> {
    /// The card, for what registers cannot do.
    pub card: C,
    bar: Bar,
}

impl<C: PciCard> RegisterWindow<C> {
    /// The window of this card: memory, or I/O ports where memory cannot be reached.
    ///
    /// Ports reach only the first 256 bytes; no control without memory.
    pub fn new(card: C) -> Self {
        let bar = if card.has(Bar::Memory32) { Bar::Memory32 } else { Bar::Ports32 };
        Self { card, bar }
    }

    /// Gives the card back.
    pub fn into_card(self) -> C {
        self.card
    }
}

impl<C: PciCard> Registers for RegisterWindow<C> {
    fn read(&mut self, offset: u16) -> Result<u32, BusError> {
        let fail = |error: super::PciError| BusError::read(offset, error.cause);
        let data = self.card.read32(self.bar, offset.into()).map_err(fail)?;
        if data == u32::MAX {
            let cookie = self.card.read32(self.bar, COOKIE.offset.into()).map_err(fail)?;
            if cookie != COOKIE_VALUE {
                return Err(BusError::read(
                    offset,
                    format!("it reads all ones and the cookie {cookie:#010x}: the card is gone or has lost its design"),
                ));
            }
        }
        Ok(data)
    }

    fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError> {
        self.card.write32(self.bar, offset.into(), data).map_err(|error| BusError::write(offset, error.cause))
    }
}

#[cfg(test)]
mod tests {
    use super::super::PciError;
    use super::*;
    use fixed_kin::card::{Card, Pins};
    use fixed_kin::registers::{FAULTS, SNAPSHOT_SEQUENCE};
    use std::time::Duration;

    /// A loaded card that can be pulled out.
    struct Loaded {
        card: Card,
        gone: bool,
    }

    impl PciCard for Loaded {
        fn read32(&mut self, bar: Bar, offset: u32) -> Result<u32, PciError> {
            assert_eq!(bar, Bar::Memory32);
            Ok(if self.gone { u32::MAX } else { self.card.read(offset as u16) })
        }
        fn write32(&mut self, _: Bar, offset: u32, data: u32) -> Result<(), PciError> {
            self.card.write(offset as u16, data);
            Ok(())
        }
        fn write8(&mut self, bar: Bar, offset: u32, _: u8) -> Result<(), PciError> {
            Err(PciError::write(bar, offset, "no bytes here"))
        }
        fn has(&self, bar: Bar) -> bool {
            bar.is_memory()
        }
        fn now(&mut self) -> Duration {
            Duration::ZERO
        }
        fn sleep(&mut self, _: Duration) {}
    }

    #[test]
    fn a_card_that_is_gone_is_an_error_and_not_a_count() {
        let mut window = RegisterWindow::new(Loaded { card: Card::new(0), gone: false });
        window.card.card.tick(&Pins::default());
        assert_eq!(window.read(SNAPSHOT_SEQUENCE.offset).unwrap(), 1);
        window.card.gone = true;
        let message = window.read(FAULTS.offset).unwrap_err().to_string();
        assert!(message.contains("0x003c") && message.contains("the card is gone"), "{message}");
    }
}
