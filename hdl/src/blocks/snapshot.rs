//! Which bank of the snapshot is written and which is read, so that a reader never sees a mixture.
//!
//! | event | written from now on | read from now on |
//! |---|---|---|
//! | tick | the bank not held; if none is held, the one that is not the latest | |
//! | end of the tick | | (the written bank is the latest) |
//! | word 0 is read | | the latest, held |
//! | the last word is read | | nothing held |
//!
//! A held bank is never written, however slow its reader is; the program then uses the other one
//! again and again.

use rust_hdl::prelude::*;

/// See the module.
#[derive(LogicBlock, Default)]
pub struct Snapshot {
    /// Clock.
    pub clock: Signal<In, Clock>,
    /// A control tick starts.
    pub tick: Signal<In, Bit>,
    /// A control tick ends.
    pub done: Signal<In, Bit>,
    /// Word 0 is read.
    pub read_first: Signal<In, Bit>,
    /// The last word is read.
    pub read_last: Signal<In, Bit>,
    /// Bank the program writes.
    pub write_bank: Signal<Out, Bit>,
    /// Bank the bus reads, in this clock.
    pub read_bank: Signal<Out, Bit>,

    writing: DFF<Bit>,
    latest: DFF<Bit>,
    held: DFF<Bit>,
    held_bank: DFF<Bit>,
    target: Signal<Local, Bit>,
}

impl Logic for Snapshot {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, writing, latest, held, held_bank);
        self.target.next = !self.latest.q.val();
        // A reader that starts again in the clock of a tick takes the latest bank, not the held one.
        if self.held.q.val() & !self.read_first.val() {
            self.target.next = !self.held_bank.q.val();
        }
        if self.tick.val() {
            self.writing.d.next = self.target.val();
            self.latest.d.next = !self.target.val();
        }
        if self.done.val() {
            self.latest.d.next = self.writing.q.val();
        }
        self.read_bank.next = self.held_bank.q.val();
        if self.read_first.val() {
            self.held.d.next = true;
            self.held_bank.d.next = self.latest.q.val();
            self.read_bank.next = self.latest.q.val();
        }
        if self.read_last.val() {
            self.held.d.next = false;
        }
        self.write_bank.next = self.writing.q.val();
    }
}
