//! What a card is doing, without changing it.

use super::LoadError;
use crate::board::{Board, BoardError, Identity, Status};
use crate::pci::{PciCard, RegisterWindow};
use crate::plx9030::{Bridge, DONE, GPIO_CONTROL, INIT, LOCAL_SPACE_DESCRIPTORS, PROGRAM, READY_ENABLE};
use crate::registers::Registers;
use fixed_kin::registers::{BOARD_4I65, FAULTS};

/// See the module.
#[derive(Clone, Debug, PartialEq)]
pub struct CardState {
    /// The FPGA is configured.
    pub done: bool,
    /// No CRC error, not being cleared.
    pub init: bool,
    /// The FPGA is not held clear.
    pub program: bool,
    /// Spaces in which the bridge waits for READY#.
    pub ready_enabled: [bool; 4],
    /// Our design, if it is one.
    pub identity: Option<Identity>,
    /// Why it is not ours.
    pub other: Option<String>,
    /// Live status of our design.
    pub status: Option<Status>,
    /// Its fault register.
    pub faults: Option<u32>,
}

/// Reads the state of a card: bridge lines, and the identification where the FPGA is configured.
///
/// # Errors
/// [`LoadError::Absent`] where nobody answers.
pub fn inspect<C: PciCard>(card: &mut C) -> Result<CardState, LoadError> {
    let mut bridge = Bridge::new(card);
    let lines = bridge.read(GPIO_CONTROL)?;
    if lines == u32::MAX {
        return Err(LoadError::Absent { when: "at the first look" });
    }
    let mut ready_enabled = [false; 4];
    for (enabled, register) in ready_enabled.iter_mut().zip(LOCAL_SPACE_DESCRIPTORS) {
        *enabled = bridge.read(register)? & READY_ENABLE != 0;
    }
    let mut state = CardState {
        done: lines & DONE != 0,
        init: lines & INIT != 0,
        program: lines & PROGRAM != 0,
        ready_enabled,
        identity: None,
        other: None,
        status: None,
        faults: None,
    };
    // A blank FPGA answers nobody; do not ask it.
    if state.done {
        let mut board = Board::new(RegisterWindow::new(&mut *card));
        match board.identify_as(BOARD_4I65) {
            Ok(identity) => {
                state.identity = Some(identity);
                state.status = Some(board.status()?);
                state.faults = Some(board.bus.read(FAULTS.offset).map_err(BoardError::from)?);
            }
            Err(BoardError::Identity { register, found, .. }) => {
                let kind = foreign(card).unwrap_or_else(|| "another design".to_owned());
                state.other = Some(format!("{kind}; {register} reads {found:#010x}"));
            }
            Err(error) if Bridge::new(card).read(GPIO_CONTROL)? == u32::MAX => {
                return Err(LoadError::Gone { error: error.to_string() });
            }
            Err(BoardError::Bus(_)) => {
                let kind = foreign(card).unwrap_or_else(|| "another design".to_owned());
                state.other = Some(format!("DONE is high, but nothing answers at the registers: {kind}"));
            }
            Err(error) => state.other = Some(error.to_string()),
        }
    }
    Ok(state)
}

/// Where a HostMot2 design of the card's maker has its cookie and its name.
const HOSTMOT2: u16 = 0x100;
/// What the maker's own firmware answers at its first register.
const HOSTMOT2_COOKIE: u32 = 0x55AA_CAFE;

/// What a design that is not ours is, as far as it or the access path to the card says.
pub(super) fn foreign<C: PciCard>(card: &mut C) -> Option<String> {
    if let Some(remark) = card.remark() {
        return Some(remark);
    }
    let mut words = [0; 3];
    RegisterWindow::new(card).read_block(HOSTMOT2, &mut words).ok()?;
    let name: Vec<u8> = words[1..].iter().flat_map(|word| word.to_le_bytes()).collect();
    let name = std::str::from_utf8(&name).ok().filter(|name| name.chars().all(|letter| letter.is_ascii_graphic()))?;
    (words[0] == HOSTMOT2_COOKIE).then(|| format!("a {name} design of the card's maker"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pci::{Bar, PciError};
    use std::time::Duration;

    /// A card whose window reads these words, and of which this is known.
    struct Words([u32; 3], Option<&'static str>);

    impl PciCard for Words {
        fn read32(&mut self, _: Bar, offset: u32) -> Result<u32, PciError> {
            let at = (offset as usize).wrapping_sub(usize::from(HOSTMOT2)) / 4;
            Ok(self.0.get(at).copied().unwrap_or_default())
        }
        fn write32(&mut self, _: Bar, _: u32, _: u32) -> Result<(), PciError> {
            Ok(())
        }
        fn write8(&mut self, _: Bar, _: u32, _: u8) -> Result<(), PciError> {
            Ok(())
        }
        fn has(&self, _: Bar) -> bool {
            true
        }
        fn now(&mut self) -> Duration {
            Duration::ZERO
        }
        fn sleep(&mut self, _: Duration) {}
        fn remark(&self) -> Option<String> {
            self.1.map(str::to_owned)
        }
    }

    #[test]
    fn the_makers_designs_are_known_by_cookie_and_name() {
        let [host, mot2] = [*b"HOST", *b"MOT2"].map(u32::from_le_bytes);
        let makers = foreign(&mut Words([HOSTMOT2_COOKIE, host, mot2], None));
        assert_eq!(makers.as_deref(), Some("a HOSTMOT2 design of the card's maker"));
        assert_eq!(foreign(&mut Words([HOSTMOT2_COOKIE, host, 0], None)), None);
        assert_eq!(foreign(&mut Words([1, host, mot2], None)), None);
        assert_eq!(foreign(&mut Words([0; 3], Some("no circuit"))).as_deref(), Some("no circuit"));
    }
}
