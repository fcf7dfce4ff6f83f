//! Clock monitor: notices, by the 50 MHz crystal, that the bus clock has stopped.
//!
//! ```text
//! lclk ─►[toggle]─┊─►[sync 2]─►[last]
//!                 ┊        └──┬───┘
//! synclk ─────────┊──►  change?  ── no, 32 times ──► dead
//!                 ┊              └─ yes, 256 times ─► alive
//! ```
//!
//! Timing: `lclk_dead` rises at most 35 crystal edges (0.7 µs) after the last edge of `lclk`
//! (`fixed_kin::clock_monitor::DEAD_CLOCKS`) and falls after 256 changes (8 µs at 33 MHz) with no
//! gap of 32 crystal clocks. It is high at power-up. The top level forces every enable and the
//! kicker off with it combinationally, since no flip-flop of a dead domain would do so.
//! Limits: `lclk` from 1/32 of the crystal's rate (1.6 MHz) to below it; a dead crystal is not noticed.

use crate::primitives::Literal;
use fixed_kin::clock_monitor::{RECOVERY_TOGGLES, SILENT_CLOCKS};
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// The clock monitor; see the head of this file.
#[derive(LogicBlock, Default)]
pub struct ClockMonitor {
    /// Bus clock, the one that is watched.
    pub lclk: Signal<In, Clock>,
    /// Crystal clock.
    pub synclk: Signal<In, Clock>,
    /// The bus clock has stopped, or has not yet run for long enough. In the crystal's domain.
    pub lclk_dead: Signal<Out, Bit>,
    toggle: DFF<Bit>,
    first: DFF<Bit>,
    second: DFF<Bit>,
    last: DFF<Bit>,
    silent: DFF<Bits<5>>,
    good: DFF<Bits<8>>,
    alive: DFF<Bit>,
    silent_zero: Literal<5, 0>,
    silent_one: Literal<5, 1>,
    silent_limit: Literal<5, { SILENT_CLOCKS as u64 - 1 }>,
    good_zero: Literal<8, 0>,
    good_one: Literal<8, 1>,
    good_limit: Literal<8, { RECOVERY_TOGGLES as u64 - 1 }>,
}

impl Logic for ClockMonitor {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, lclk, toggle);
        dff_setup!(self, synclk, first, second, last, silent, good, alive);
        self.toggle.d.next = !self.toggle.q.val();
        self.first.d.next = self.toggle.q.val();
        self.second.d.next = self.first.q.val();
        self.last.d.next = self.second.q.val();
        if self.second.q.val() ^ self.last.q.val() {
            self.silent.d.next = self.silent_zero.val();
            if self.good.q.val() == self.good_limit.val() {
                self.alive.d.next = true;
            } else {
                self.good.d.next = self.good.q.val() + self.good_one.val();
            }
        } else if self.silent.q.val() == self.silent_limit.val() {
            self.good.d.next = self.good_zero.val();
            self.alive.d.next = false;
        } else {
            self.silent.d.next = self.silent.q.val() + self.silent_one.val();
        }
        self.lclk_dead.next = !self.alive.q.val();
    }
}
