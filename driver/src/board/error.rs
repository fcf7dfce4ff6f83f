//! What can go wrong between host and card.

use super::state::Standing;
use crate::registers::BusError;

/// What went wrong between host and card.
#[derive(Debug, thiserror::Error)]
pub enum BoardError {
    /// An access over the bus failed.
    #[error(transparent)]
    Bus(#[from] BusError),
    /// Not our design, or not for this board.
    #[error("{register} reads {found:#010x}, expected {expected:#010x}: {hint}")]
    Identity {
        /// Its name in the register map.
        register: &'static str,
        /// What it reads.
        found: u32,
        /// What it should.
        expected: u32,
        /// What that means.
        hint: &'static str,
    },
    /// The card did not take a commit.
    #[error(
        "the card refused a commit of {what}: accepted {accepted} of the words, faults {faults:#04x}; a write was lost or changed on the bus, write again"
    )]
    Commit {
        /// Set points or configuration.
        what: &'static str,
        /// Commits accepted since configuration.
        accepted: u32,
        /// The word of the register `faults`.
        faults: u32,
    },
    /// The card stayed disarmed: what stands came again after it was cleared.
    #[error("the card refused to arm, faults {faults:#04x} ({0}); clear the cause, then arm again", faults = .0.faults)]
    Arm(Standing),
    /// A register does not hold what was written.
    #[error("{register} reads {found:#x} after {written:#x} was written; is the card armed, or the bus broken?")]
    ReadBack {
        /// Its name in the register map.
        register: &'static str,
        /// What it reads.
        found: u32,
        /// What was written.
        written: u32,
    },
    /// The card did not switch off.
    #[error("the card stayed armed after {0} writes that disarm; the watchdog switches off once nobody commits")]
    StillArmed(u32),
    /// The configuration in force is another than was committed.
    #[error("{register} word {index} in force is {found:#x}, committed was {written:#x}; the bus changes words")]
    InForce {
        /// Its name in the register map.
        register: &'static str,
        /// Word of it.
        index: usize,
        /// What it reads.
        found: u32,
        /// What was committed.
        written: u32,
    },
    /// A commit that never acts.
    #[error("the configuration still waits for a control tick after {0} looks; the card's clock or tick stands still")]
    NoTick(u32),
    /// No coherent snapshot.
    #[error("no coherent snapshot in {0} tries; the bus loses or repeats reads")]
    Snapshot(u32),
}
