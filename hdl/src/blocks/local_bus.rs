//! The card's side of the PLX PCI 9030's multiplexed local bus: target only, 32 bit, bursts.
//!
//! Serves every register; holds none itself.
//!
//! ```text
//!              single read                     single write
//! clock   0   1   2   3   4   5           0   1   2   3   4
//! ADS#    \___/~~~~~~~~~~~~~~~~~~~        \___/~~~~~~~~~~~~~
//! LAD     <adr>-<   card drives >-        <adr><   data    >-
//! BLAST#  ~~~~\_______________/~~~        ~~~~\___________/~
//! READY#  ~~~~~~~~~~~~~~~~\___/~~~        ~~~~~~~~~~~~\___/~
//! read    ____/~~~\_______________        __________________
//! data    ------------<rd>--------        ------------------    read_data, write_data
//! write   ________________________        ________/~~~\_____
//! ```
//!
//! | | clocks a word, READY# in the last | |
//! |---|---|---|
//! | read | 4 | `read_data` holds two clocks after `read` |
//! | write | 3 | |
//! | write while `write_busy` | up to 66 | `write` comes in the first clock without it |
//! | write into a core that stays busy | 66 | answered without effect, `overrun` for a clock |
//!
//! ADS# starts a cycle whatever went on before. BLAST# at any clock of a word makes that word the
//! last. A burst also ends at the end of the window, so that a master that vanished is not waited
//! for with the bus driven. One `read` or `write` a word, never ahead: a read that has an effect
//! (a snapshot) must not happen for a word that nobody asked for. A write that ADS# aborts may or
//! may not have happened; it was not answered.

use fixed_kin::local_bus::{LAST_ADDRESS, OFFER_CLOCKS};
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// The block; its bit-true twin is [`fixed_kin::local_bus::LocalBus`].
#[derive(LogicBlock)]
pub struct LocalBus {
    /// LCLK of the bridge, 33 MHz; all state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// Address strobe, active low.
    pub ads_n: Signal<In, Bit>,
    /// Burst last, active low.
    pub blast_n: Signal<In, Bit>,
    /// High for a write.
    pub lw_r: Signal<In, Bit>,
    /// The bus, as seen.
    pub lad_in: Signal<In, Bits<32>>,
    /// The bus, as driven.
    pub lad_out: Signal<Out, Bits<32>>,
    /// High while the card, not the bridge, drives LAD.
    pub lad_drive: Signal<Out, Bit>,
    /// Ready, active low.
    pub ready_n: Signal<Out, Bit>,
    /// Word address; holds from the strobe to READY#.
    pub address: Signal<Out, Bits<14>>,
    /// Fetch the word at `address`.
    pub read: Signal<Out, Bit>,
    /// The word, two clocks after `read`.
    pub read_data: Signal<In, Bits<32>>,
    /// Take `write_data` to `address`.
    pub write: Signal<Out, Bit>,
    /// The word to take.
    pub write_data: Signal<Out, Bits<32>>,
    /// Nothing can be taken in this clock; must not depend on `write` in the same clock.
    pub write_busy: Signal<In, Bit>,
    /// A write was answered without effect.
    pub overrun: Signal<Out, Bit>,
    /// `address` is used in this clock, or will be as soon as the core is free.
    pub claims: Signal<Out, Bit>,
    // The phases, one flip-flop each; none set is the idle bus.
    fetch: DFF<Bit>,
    pending: DFF<Bit>,
    take: DFF<Bit>,
    collect: DFF<Bit>,
    offer: DFF<Bit>,
    answer: DFF<Bit>,
    writing: DFF<Bit>,
    last: DFF<Bit>,
    drive: DFF<Bit>,
    // `fetch` or `offer`, without a table between.
    claiming: DFF<Bit>,
    word: DFF<Bits<14>>,
    held: DFF<Bits<6>>,
    to_host: DFF<Bits<32>>,
    from_host: DFF<Bits<32>>,
    next_word: Signal<Local, Bits<14>>,
    next_held: Signal<Local, Bits<6>>,
    expired: Signal<Local, Bit>,
    ends: Signal<Local, Bit>,
    one_word: Constant<Bits<14>>,
    one_held: Constant<Bits<6>>,
    held_none: Constant<Bits<6>>,
    held_limit: Constant<Bits<6>>,
    last_word: Constant<Bits<14>>,
}

impl Default for LocalBus {
    fn default() -> Self {
        Self {
            clock: Signal::default(),
            ads_n: Signal::default(),
            blast_n: Signal::default(),
            lw_r: Signal::default(),
            lad_in: Signal::default(),
            lad_out: Signal::default(),
            lad_drive: Signal::default(),
            ready_n: Signal::default(),
            address: Signal::default(),
            read: Signal::default(),
            read_data: Signal::default(),
            write: Signal::default(),
            write_data: Signal::default(),
            write_busy: Signal::default(),
            overrun: Signal::default(),
            claims: Signal::default(),
            fetch: DFF::default(),
            pending: DFF::default(),
            take: DFF::default(),
            collect: DFF::default(),
            offer: DFF::default(),
            answer: DFF::default(),
            writing: DFF::default(),
            last: DFF::default(),
            drive: DFF::default(),
            claiming: DFF::default(),
            word: DFF::default(),
            held: DFF::default(),
            to_host: DFF::default(),
            from_host: DFF::default(),
            next_word: Signal::default(),
            next_held: Signal::default(),
            expired: Signal::default(),
            ends: Signal::default(),
            one_word: Constant::new(1_u8.to_bits()),
            one_held: Constant::new(1_u8.to_bits()),
            held_none: Constant::new(0_u8.to_bits()),
            held_limit: Constant::new(u64::from(OFFER_CLOCKS - 1).to_bits()),
            last_word: Constant::new(u64::from(LAST_ADDRESS).to_bits()),
        }
    }
}

impl Logic for LocalBus {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(
            self, clock, fetch, pending, take, collect, offer, answer, writing, last, drive, claiming, word, held,
            to_host, from_host
        );
        self.next_word.next = self.word.q.val() + self.one_word.val();
        self.next_held.next = self.held.q.val() + self.one_held.val();
        self.expired.next = self.held.q.val() == self.held_limit.val();
        self.ends.next = self.last.q.val() | !self.blast_n.val() | (self.word.q.val() == self.last_word.val());

        self.fetch.d.next = false;
        self.pending.d.next = self.fetch.q.val();
        self.take.d.next = self.pending.q.val();
        self.collect.d.next = false;
        self.offer.d.next = self.collect.q.val();
        self.claiming.d.next = self.collect.q.val();
        self.answer.d.next = self.take.q.val();
        self.last.d.next = (self.last.q.val() | !self.blast_n.val()) & !self.answer.q.val();
        if self.fetch.q.val() {
            self.drive.d.next = true;
        }
        if self.take.q.val() {
            self.to_host.d.next = self.read_data.val();
        }
        if self.collect.q.val() {
            self.from_host.d.next = self.lad_in.val();
        }
        if self.offer.q.val() {
            if self.write_busy.val() & !self.expired.val() {
                self.offer.d.next = true;
                self.claiming.d.next = true;
                self.held.d.next = self.next_held.val();
            } else {
                self.answer.d.next = true;
                self.held.d.next = self.held_none.val();
            }
        }
        if self.answer.q.val() {
            if self.ends.val() {
                self.drive.d.next = false;
            } else {
                self.word.d.next = self.next_word.val();
                self.fetch.d.next = !self.writing.q.val();
                self.claiming.d.next = !self.writing.q.val();
                self.collect.d.next = self.writing.q.val();
            }
        }
        if !self.ads_n.val() {
            self.word.d.next = self.lad_in.val().get_bits::<14>(2);
            self.writing.d.next = self.lw_r.val();
            self.fetch.d.next = !self.lw_r.val();
            self.claiming.d.next = !self.lw_r.val();
            self.pending.d.next = false;
            self.take.d.next = false;
            self.collect.d.next = self.lw_r.val();
            self.offer.d.next = false;
            self.answer.d.next = false;
            self.drive.d.next = false;
            self.last.d.next = false;
            self.held.d.next = self.held_none.val();
        }

        self.lad_out.next = self.to_host.q.val();
        self.lad_drive.next = self.drive.q.val();
        self.ready_n.next = !self.answer.q.val();
        self.address.next = self.word.q.val();
        self.read.next = self.fetch.q.val();
        self.write.next = self.offer.q.val() & !self.write_busy.val();
        self.write_data.next = self.from_host.q.val();
        self.claims.next = self.claiming.q.val();
        self.overrun.next = self.offer.q.val() & self.write_busy.val() & self.expired.val();
    }
}
