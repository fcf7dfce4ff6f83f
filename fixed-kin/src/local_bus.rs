//! Bit-true twin of the local bus block: the card's side of the PLX PCI 9030's multiplexed bus.
//!
//! One [`LocalBus::clock`] is one rising edge of LCLK; the outputs are those that hold until the
//! next edge. No input panics, and no sequence of inputs stops it: see [`READ_CLOCKS`] and
//! [`WRITE_CLOCKS_MAX`].
//!
//! | phase | read | write |
//! |---|---|---|
//! | ADS# low | address taken | address taken |
//! | 1 | `read` strobe | data taken |
//! | 2 | | `write` strobe, here or in the first later clock without `write_busy` |
//! | 3 | `read_data` taken | READY# |
//! | 4 | READY# | |

/// Address bits: words of the 64 KiB window.
pub const ADDRESS_BITS: u32 = 14;

/// Last word of the window; a burst ends there, so that a master that vanished in a burst does not
/// leave the block driving the bus for ever.
pub const LAST_ADDRESS: u32 = (1 << ADDRESS_BITS) - 1;

/// Clocks from the `read` strobe to the clock in which `read_data` must hold.
pub const READ_LATENCY: u32 = 2;

/// Clocks a word of a read takes; READY# is low in the last of them.
pub const READ_CLOCKS: u32 = 4;

/// Clocks a word of a write takes without `write_busy`; READY# is low in the last of them.
pub const WRITE_CLOCKS: u32 = 3;

/// Clocks a write is offered to a busy core before it is answered without effect (`overrun`).
pub const OFFER_CLOCKS: u32 = 64;

/// Most clocks a word of a write takes.
pub const WRITE_CLOCKS_MAX: u32 = WRITE_CLOCKS + OFFER_CLOCKS - 1;

/// What the block sees at an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inputs {
    /// Address strobe, active low.
    pub ads_n: bool,
    /// Burst last, active low.
    pub blast_n: bool,
    /// High for a write, looked at with ADS#.
    pub lw_r: bool,
    /// The multiplexed bus.
    pub lad: u32,
    /// Data for the strobe two clocks ago.
    pub read_data: u32,
    /// The core cannot take a write in this clock.
    pub write_busy: bool,
}

impl Default for Inputs {
    /// An idle bus.
    fn default() -> Self {
        Self { ads_n: true, blast_n: true, lw_r: false, lad: 0, read_data: 0, write_busy: false }
    }
}

/// What the block shows after an edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// Data for the bus.
    pub lad: u32,
    /// Whether the block drives the bus.
    pub lad_drive: bool,
    /// Ready, active low.
    pub ready_n: bool,
    /// Word address, 14 bits; holds from the strobe to READY#.
    pub address: u32,
    /// Fetch the word at `address`: one clock a word.
    pub read: bool,
    /// Take `write_data` to `address`: one clock a word.
    pub write: bool,
    /// Data for the core.
    pub write_data: u32,
    /// A write was answered without effect, because the core stayed busy: one clock.
    pub overrun: bool,
    /// `address` is used in this clock, or will be as soon as the core is free.
    pub claims: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Phase {
    #[default]
    Idle,
    Fetch,
    Wait,
    Take,
    Collect,
    Offer,
    Answer,
}

/// Where it is between two clocks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LocalBus {
    phase: Phase,
    writing: bool,
    last: bool,
    drive: bool,
    address: u32,
    held: u32,
    to_host: u32,
    from_host: u32,
}

impl LocalBus {
    /// The block as configured: bus idle, nothing driven.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// A rising edge of the clock, with what the block sees before it.
    pub fn clock(&mut self, inputs: &Inputs) {
        let phase = self.phase;
        if phase == Phase::Take {
            self.to_host = inputs.read_data;
        }
        if phase == Phase::Collect {
            self.from_host = inputs.lad;
        }
        if !inputs.ads_n {
            self.address = (inputs.lad >> 2) & LAST_ADDRESS;
            self.writing = inputs.lw_r;
            self.drive = false;
            self.last = false;
            self.held = 0;
            self.phase = self.first_phase();
            return;
        }
        let last = self.last || !inputs.blast_n;
        self.last = last && phase != Phase::Answer;
        self.phase = match phase {
            Phase::Idle => Phase::Idle,
            Phase::Fetch => {
                self.drive = true;
                Phase::Wait
            }
            Phase::Wait => Phase::Take,
            Phase::Collect => Phase::Offer,
            Phase::Offer if inputs.write_busy && self.held < OFFER_CLOCKS - 1 => {
                self.held += 1;
                Phase::Offer
            }
            Phase::Take | Phase::Offer => {
                self.held = 0;
                Phase::Answer
            }
            Phase::Answer if last || self.address == LAST_ADDRESS => {
                self.drive = false;
                Phase::Idle
            }
            Phase::Answer => {
                self.address += 1;
                self.first_phase()
            }
        };
    }

    fn first_phase(&self) -> Phase {
        if self.writing { Phase::Collect } else { Phase::Fetch }
    }

    /// The outputs until the next edge; `write` and `overrun` follow `write_busy` at once.
    #[must_use]
    pub fn outputs(&self, write_busy: bool) -> Outputs {
        let offer = self.phase == Phase::Offer;
        Outputs {
            lad: self.to_host,
            lad_drive: self.drive,
            ready_n: self.phase != Phase::Answer,
            address: self.address,
            read: self.phase == Phase::Fetch,
            write: offer && !write_busy,
            write_data: self.from_host,
            overrun: offer && write_busy && self.held == OFFER_CLOCKS - 1,
            claims: offer || self.phase == Phase::Fetch,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clocks_to_ready(bus: &mut LocalBus, inputs: &Inputs) -> u32 {
        bus.clock(&Inputs { ads_n: false, ..*inputs });
        let mut clocks = 1;
        while bus.outputs(inputs.write_busy).ready_n {
            bus.clock(inputs);
            clocks += 1;
            assert!(clocks <= WRITE_CLOCKS_MAX, "no READY#");
        }
        clocks
    }

    #[test]
    fn latencies_are_as_stated() {
        let single = Inputs { blast_n: false, ..Inputs::default() };
        let write = Inputs { lw_r: true, ..single };
        let stuck = Inputs { write_busy: true, ..write };
        assert_eq!(clocks_to_ready(&mut LocalBus::new(), &single), READ_CLOCKS);
        assert_eq!(clocks_to_ready(&mut LocalBus::new(), &write), WRITE_CLOCKS);
        assert_eq!(clocks_to_ready(&mut LocalBus::new(), &stuck), WRITE_CLOCKS_MAX);
    }

    #[test]
    fn a_read_gives_the_word_that_stood_two_clocks_after_it_was_asked_for() {
        let mut bus = LocalBus::new();
        bus.clock(&Inputs { ads_n: false, ..Inputs::default() });
        let mut asked = None;
        for clock in 1..READ_CLOCKS {
            if bus.outputs(false).read {
                asked = Some(clock);
            }
            bus.clock(&Inputs { read_data: 0x100 + clock, blast_n: false, ..Inputs::default() });
        }
        let given = bus.outputs(false);
        assert!(!given.ready_n && given.lad_drive);
        assert_eq!(given.lad, 0x100 + asked.unwrap() + 2);
    }

    #[test]
    fn a_burst_without_end_ends_with_the_window() {
        let mut bus = LocalBus::new();
        bus.clock(&Inputs { ads_n: false, ..Inputs::default() });
        for _ in 0..(LAST_ADDRESS + 1) * READ_CLOCKS {
            assert_ne!(bus.outputs(false).address, LAST_ADDRESS + 1);
            bus.clock(&Inputs::default());
        }
        assert!(!bus.outputs(false).lad_drive);
        assert!(bus.outputs(false).ready_n);
    }
}
