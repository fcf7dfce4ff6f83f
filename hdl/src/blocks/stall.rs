//! Stall detector of one axis: driven, but the wheel does not move. Finds cut encoder wires.
//!
//! ```text
//! step, up ─►[net −3 … 3, from zero at `window`]─► leaves that range ─► moved ─┐
//! compare > threshold at every `load`, enabled all the time ─► driven ─────────┴─ at `window`:
//!
//!  driven │ moved │ at the end of a window      one line cut: the other toggles, net stays −1 … 1
//!    1    │   0   │ stalled                     both cut: no counts at all
//!  others         │ nothing                     wheel blocked: as both cut
//! ```
//!
//! Timing: `window` is a control tick every `stall_window` ticks, so a stall shows one to two windows after
//! the wheel is driven. `stalled` is sticky. Serves `stall`, `stall_window`, `stall_compare`; the
//! twin is `fixed_kin::stall::Stall`.

use crate::primitives::Literal;
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// See the module.
#[derive(LogicBlock, Default)]
pub struct Stall {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// Outputs may be on.
    pub enable: Signal<In, Bit>,
    /// Strobe: an edge of the encoder is counted.
    pub step: Signal<In, Bit>,
    /// Its direction, true = up.
    pub up: Signal<In, Bit>,
    /// Strobe: a new compare value goes to the PWM generator.
    pub load: Signal<In, Bit>,
    /// That value.
    pub compare: Signal<In, Bits<13>>,
    /// Compare values above this drive the wheel.
    pub threshold: Signal<In, Bits<13>>,
    /// Strobe: a window ends and the next begins.
    pub window: Signal<In, Bit>,
    /// Clears the sticky stall, unless a new one comes at the same clock.
    pub clear: Signal<In, Bit>,
    /// Sticky: the wheel was driven through a window and did not move.
    pub stalled: Signal<Out, Bit>,

    net: DFF<Bits<3>>,
    moved: DFF<Bit>,
    driven: DFF<Bit>,
    sticky: DFF<Bit>,

    higher: Signal<Local, Bits<3>>,
    lower: Signal<Local, Bits<3>>,
    highest: Signal<Local, Bit>,
    lowest: Signal<Local, Bit>,
    idles: Signal<Local, Bit>,

    zero: Literal<3, 0>,
    one: Literal<3, 1>,
    three: Literal<3, 3>,
    minus_one: Literal<3, 7>,
    minus_three: Literal<3, 5>,
}

// The comparison as the carry chain computes it: one `>`, then an inverter.
#[expect(clippy::nonminimal_bool)]
impl Logic for Stall {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, net, moved, driven, sticky);
        // Both sums begin at the register, so that no carry chain stands behind the window's.
        self.higher.next = self.net.q.val() + self.one.val();
        self.lower.next = self.net.q.val() - self.one.val();
        if self.window.val() {
            self.higher.next = self.one.val();
            self.lower.next = self.minus_one.val();
        }
        self.highest.next = self.net.q.val() == self.three.val();
        self.lowest.next = self.net.q.val() == self.minus_three.val();
        if self.window.val() {
            self.net.d.next = self.zero.val();
        }
        if self.step.val() {
            if self.up.val() {
                if self.window.val() | !self.highest.val() {
                    self.net.d.next = self.higher.val();
                }
                if self.highest.val() {
                    self.moved.d.next = true;
                }
            } else {
                if self.window.val() | !self.lowest.val() {
                    self.net.d.next = self.lower.val();
                }
                if self.lowest.val() {
                    self.moved.d.next = true;
                }
            }
        }
        self.idles.next = self.load.val() & !(self.compare.val() > self.threshold.val());
        if self.idles.val() {
            self.driven.d.next = false;
        }
        if self.clear.val() {
            self.sticky.d.next = false;
        }
        if self.window.val() {
            self.moved.d.next = false;
            self.driven.d.next = !self.idles.val();
            if self.enable.val() & self.driven.q.val() & !self.moved.q.val() {
                self.sticky.d.next = true;
            }
        }
        if !self.enable.val() {
            self.driven.d.next = false;
        }
        self.stalled.next = self.sticky.q.val();
    }
}
