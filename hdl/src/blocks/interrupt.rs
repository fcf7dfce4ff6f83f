//! Interrupt to the bridge: the end of a control tick, and disarming.
//!
//! ```text
//!  done ──────────► status 0 ─┐ & enable 0
//!  armed falls ───► status 1 ─┴ & enable 1 ─► or ─► flip-flop ─► int_n (low = interrupt)
//! ```
//!
//! A level: low one clock after an enabled status is set, until it is cleared by writing ones to
//! `interrupt_status`; an event at the clock of the clearing wins. Nothing is enabled after
//! configuration. Serves `interrupt_enable`, `interrupt_status`; the twin is `fixed_kin::interrupt::Interrupt`.

use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// See the module.
#[derive(LogicBlock, Default)]
pub struct Interrupt {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// Strobe: a control tick has ended.
    pub done: Signal<In, Bit>,
    /// Level: the outputs may be on.
    pub armed: Signal<In, Bit>,
    /// Enabled causes.
    pub enable: Signal<In, Bits<2>>,
    /// Causes to clear.
    pub clear: Signal<In, Bits<2>>,
    /// The line to the bridge, low = interrupt.
    pub int_n: Signal<Out, Bit>,
    /// Causes, whether enabled or not.
    pub status: Signal<Out, Bits<2>>,

    was_armed: DFF<Bit>,
    causes: DFF<Bits<2>>,
    low: DFF<Bit>,
    disarms: Signal<Local, Bit>,
    events: Signal<Local, Bits<2>>,
}

impl Logic for Interrupt {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, was_armed, causes, low);
        self.was_armed.d.next = self.armed.val();
        self.disarms.next = self.was_armed.q.val() & !self.armed.val();
        self.events.next =
            bit_cast::<2, 1>(self.done.val().into()) | (bit_cast::<2, 1>(self.disarms.val().into()) << 1);
        self.causes.d.next = (self.causes.q.val() & !self.clear.val()) | self.events.val();
        self.low.d.next = (self.causes.q.val() & self.enable.val()).any();
        self.int_n.next = !self.low.q.val();
        self.status.next = self.causes.q.val();
    }
}
