//! Why a card could not be loaded.

use super::clock::ClockError;
use crate::board::BoardError;
use crate::pci::PciError;
use std::time::Duration;

/// See the module.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// An access the system refused.
    #[error(transparent)]
    Pci(#[from] PciError),
    /// No card behind the bus.
    #[error("the card does not answer: its bridge reads all ones ({when}); is it seated, powered, still there?")]
    Absent {
        /// When that was seen.
        when: &'static str,
    },
    /// The card went away.
    #[error("the card is gone: {error}")]
    Gone {
        /// What failed first.
        error: String,
    },
    /// DONE or INIT stayed high while PROGRAM was low.
    #[error(
        "the FPGA did not clear: {line} stays high while PROGRAM is low; PROGRAM does not reach it, or its power is bad"
    )]
    NotCleared {
        /// `DONE` or `INIT`.
        line: &'static str,
    },
    /// INIT did not rise.
    #[error("INIT stayed low for {} ms after PROGRAM was released; the FPGA is not powered, or something holds INIT", .waited.as_millis())]
    StuckInit {
        /// Time waited.
        waited: Duration,
    },
    /// INIT is low after the last byte.
    #[error(
        "the FPGA found a CRC error (INIT fell) although the file's own CRC is right; bytes were lost or changed on the bus"
    )]
    Crc,
    /// DONE did not rise.
    #[error("DONE stayed low for {} ms after the last byte and INIT high: the FPGA saw no complete bitstream; bytes were lost, or DONE is held low", .waited.as_millis())]
    NotDone {
        /// Time waited.
        waited: Duration,
    },
    /// Loaded, but the registers do not answer as they should.
    #[error("loaded, but {0}")]
    Verify(#[from] BoardError),
    /// A design without our registers.
    #[error(
        "loaded, DONE is high, but nothing answers at the registers: {file} holds a valid bitstream of another design{kind}, not of the gateware in generated/; load one that was made from it"
    )]
    Foreign {
        /// What the file says of its design.
        file: String,
        /// What else is known of it, in brackets, or nothing.
        kind: String,
    },
    /// Another build.
    #[error(
        "loaded, but the design answers with hash {found:08x}, expected {expected:08x}: the file was made from other Verilog; build it from generated/, or name its hash with --hash"
    )]
    OtherDesign {
        /// Its hash.
        found: u32,
        /// The hash wanted.
        expected: u32,
    },
    /// What was wrong with measuring LCLK.
    #[error(transparent)]
    Clock(#[from] ClockError),
    /// After several tries.
    #[error("{error} (tries: {tries}; the FPGA is clear, its outputs off)")]
    Tried {
        /// The last failure.
        error: Box<LoadError>,
        /// How often.
        tries: u32,
    },
    /// Failed, and the FPGA could not be cleared.
    #[error("{error}; and the FPGA could not be cleared ({still}): cut the motors' power")]
    Unsafe {
        /// What went wrong first, before the card could be brought to a safe state.
        error: Box<LoadError>,
        /// Why clearing failed.
        still: String,
    },
}

impl LoadError {
    /// Whether another try may go better.
    pub(super) fn may_pass(&self) -> bool {
        matches!(
            self,
            Self::NotCleared { .. } | Self::StuckInit { .. } | Self::Crc | Self::NotDone { .. } | Self::Verify(_)
        )
    }

    pub(super) fn after(self, tries: u32) -> Self {
        Self::Tried { error: Box::new(self), tries }
    }

    /// The failure itself, without what was done about it.
    #[must_use]
    pub fn cause(&self) -> &Self {
        match self {
            Self::Tried { error, .. } | Self::Unsafe { error, .. } => error.cause(),
            _ => self,
        }
    }
}
