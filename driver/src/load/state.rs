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
                state.other = Some(format!("{register} reads {found:#010x}"));
            }
            Err(error) if Bridge::new(card).read(GPIO_CONTROL)? == u32::MAX => {
                return Err(LoadError::Gone { error: error.to_string() });
            }
            Err(BoardError::Bus(_)) => {
                state.other = Some("DONE is high, but nothing answers at the registers: another design".to_owned());
            }
            Err(error) => state.other = Some(error.to_string()),
        }
    }
    Ok(state)
}
