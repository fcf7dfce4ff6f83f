//! Which bank of the snapshot is written and which is read: a reader never sees a mixture, and never an
//! older tick than the last finished one.
//!
//! | event | written from now on | read from now on |
//! |---|---|---|
//! | tick | the bank that is neither the latest nor held | |
//! | end of the tick | | (the written bank is the latest) |
//! | word 0 is read | | the latest, held |
//! | the last word is read | | nothing held |
//!
//! Three banks, numbered 0 to 2, so that there is always one to write: a held bank is never written, however
//! slow its reader is, and the latest stays whole until the next one is. So word 0 is of the tick whose program
//! ended last: at most one control period and one run of the program old.

use crate::primitives::Literal;
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// See the module.
#[derive(LogicBlock, Default)]
pub struct Snapshot {
    /// All state changes at its rising edge.
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
    pub write_bank: Signal<Out, Bits<2>>,
    /// Bank the bus reads, in this clock.
    pub read_bank: Signal<Out, Bits<2>>,

    writing: DFF<Bits<2>>,
    latest: DFF<Bits<2>>,
    held: DFF<Bit>,
    held_bank: DFF<Bits<2>>,
    kept: Signal<Local, Bits<2>>,
    target: Signal<Local, Bits<2>>,
    first_bank: Literal<2, 0>,
    second_bank: Literal<2, 1>,
}

impl Logic for Snapshot {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, writing, latest, held, held_bank);
        self.kept.next = self.latest.q.val();
        if self.held.q.val() {
            self.kept.next = self.held_bank.q.val();
        }
        // Of two different banks of 0, 1 and 2 the third is the complement of their exclusive or.
        self.target.next = !(self.latest.q.val() ^ self.kept.val());
        if self.latest.q.val() == self.kept.val() {
            self.target.next = self.first_bank.val();
            if self.latest.q.val() == self.first_bank.val() {
                self.target.next = self.second_bank.val();
            }
        }
        if self.tick.val() {
            self.writing.d.next = self.target.val();
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
