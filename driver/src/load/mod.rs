//! Loading the FPGA over PCI, and making sure that the right design runs.
//!
//! ```text
//!  identify ── right design? ── yes ─► disarm, keep
//!      │ no
//!      ▼
//!  READY# on ► PROGRAM low ► DONE, INIT low? ► PROGRAM high ► INIT high? ► WRITE low
//!      ► every byte, one 8-bit write each, nothing between ► INIT high, DONE high? ► WRITE high
//!      ► cookie, board, map, hash ► clock measured
//!      any failure ► PROGRAM low: the FPGA is clear, its pins float, every output is off
//! ```
//!
//! Sequence: LinuxCNC `hm2_pci.c` and `bfload.c`, Mesa 4I65 manual 1.4, page 9. Unlike there, time-outs are
//! times, a time-out is an error, and the last look at INIT counts.

mod clock;
mod error;
mod sequence;
mod state;

pub use clock::{ClockError, measure_clock};
pub use error::LoadError;
pub use state::{CardState, inspect};

use crate::bitstream::Bitstream;
use crate::board::{Board, BoardError, Identity};
use crate::pci::{PciCard, RegisterWindow};
use fixed_kin::registers::BOARD_4I65;
use std::time::Duration;

/// How to load.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Load even where the right design runs already.
    pub force: bool,
    /// Hash that the design must answer with; `None` takes any.
    pub content_hash: Option<u32>,
    /// Tries before giving up.
    pub tries: u32,
    /// Time over which the clock is measured.
    pub clock_time: Duration,
}

impl Default for Options {
    /// The committed design, three tries.
    fn default() -> Self {
        Self {
            force: false,
            content_hash: Some(crate::design::content_hash()),
            tries: 3,
            clock_time: Duration::from_millis(50),
        }
    }
}

/// A card that runs the right design, disarmed.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// Whether it ran already and was kept.
    pub kept: bool,
    /// Tries it took, 0 where it was kept.
    pub tries: u32,
    /// Time the bytes took.
    pub transfer: Duration,
    /// Local address spaces whose READY# was off.
    pub ready_enabled: u32,
    /// What the design says of itself.
    pub identity: Identity,
    /// Measured clock of the local bus, Hz.
    pub clock_hz: f64,
}

/// Loads a bitstream, unless the right design runs already; `progress` hears the bytes sent.
///
/// # Errors
/// [`LoadError`]; the FPGA is then clear and every output off, as far as the card still listens. Before the
/// first byte is sent the bitstream has been checked: a [`Bitstream`] cannot be a damaged one.
pub fn load<C: PciCard>(
    card: &mut C,
    bitstream: &Bitstream,
    options: &Options,
    mut progress: impl FnMut(usize),
) -> Result<Loaded, LoadError> {
    let state = inspect(card)?;
    if !options.force
        && let Some(identity) = state.identity
        && options.content_hash.is_none_or(|hash| hash == identity.content_hash)
    {
        Board::new(RegisterWindow::new(&mut *card)).disarm()?;
        let clock_hz = measure_clock(card, options.clock_time)?;
        return Ok(Loaded { kept: true, tries: 0, transfer: Duration::ZERO, ready_enabled: 0, identity, clock_hz });
    }
    let mut tries = 0;
    loop {
        tries += 1;
        match attempt(card, bitstream, options, &mut progress) {
            Ok(loaded) => return Ok(Loaded { tries, ..loaded }),
            Err(error) => {
                let safe = sequence::clear(card);
                if tries >= options.tries || !error.may_pass() {
                    return Err(match safe {
                        Ok(()) => error.after(tries),
                        Err(still) => {
                            LoadError::Unsafe { error: Box::new(error.after(tries)), still: still.to_string() }
                        }
                    });
                }
            }
        }
    }
}

fn attempt<C: PciCard>(
    card: &mut C,
    bitstream: &Bitstream,
    options: &Options,
    progress: &mut impl FnMut(usize),
) -> Result<Loaded, LoadError> {
    let ready_enabled = sequence::prepare(card)?;
    let begun = card.now();
    sequence::send(card, bitstream.lanes(), progress)?;
    let transfer = card.now().saturating_sub(begun);
    sequence::finish(card)?;
    let identity = match Board::new(RegisterWindow::new(&mut *card)).identify_as(BOARD_4I65) {
        // A card that is gone reads all ones at its bridge as well.
        Err(BoardError::Bus(_)) if sequence::configured(card)? => {
            return Err(foreign_design(card, bitstream));
        }
        // The maker's designs answer at our registers as well, with other words.
        Err(BoardError::Identity { .. }) if state::foreign(card).is_some() => {
            return Err(foreign_design(card, bitstream));
        }
        other => other?,
    };
    if let Some(expected) = options.content_hash
        && identity.content_hash != expected
    {
        return Err(LoadError::OtherDesign { found: identity.content_hash, expected });
    }
    let clock_hz = measure_clock(card, options.clock_time)?;
    Ok(Loaded { kept: false, tries: 1, transfer, ready_enabled, identity, clock_hz })
}

fn foreign_design<C: PciCard>(card: &mut C, bitstream: &Bitstream) -> LoadError {
    let kind = state::foreign(card).map_or_else(String::new, |kind| format!(" ({kind})"));
    LoadError::Foreign { file: described(bitstream), kind }
}

/// What a file says of its design.
fn described(bitstream: &Bitstream) -> String {
    match &bitstream.header {
        Some(header) => format!("the file ({}, {} {})", header.design, header.date, header.time),
        None => "the file".to_owned(),
    }
}

#[cfg(test)]
mod tests;
