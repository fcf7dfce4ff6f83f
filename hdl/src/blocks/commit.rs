//! Staged writes and their commit: banks flip at a control tick, or nothing changes.
//!
//! ```text
//!  staged write ──► sum = rotate(sum, 1) ^ data ^ address      words of this group + 1
//!  commit       ──► sum and number of words right? ──yes──► pending ──tick──► bank = !bank
//!                                                  └──no───► fault
//! ```
//!
//! Serves `commit_set_points`, `commit_configuration`, `commits`; the twin is
//! `fixed_kin::commit::Commit`. Any commit starts a new sum. A staged write while a commit of its
//! group is pending takes that commit back: newer values are on their way, and a tick must not see
//! half of them.

use crate::primitives::{Literal, Preset};
use fixed_kin::control::{CONFIGURATION_WORDS, SET_POINT_WORDS};
use fixed_kin::registers::CHECKSUM_SEED;
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// See the module.
#[derive(LogicBlock, Default)]
pub struct Commit {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// High for the clock in which a word goes to the staging memory of the set points.
    pub stage_set_point: Signal<In, Bit>,
    /// A word of the configuration is staged.
    pub stage_configuration: Signal<In, Bit>,
    /// Strobe: commits the set points if `checksum` and the number of staged words are right.
    pub commit_set_points: Signal<In, Bit>,
    /// Strobe: commits the configuration under the same condition.
    pub commit_configuration: Signal<In, Bit>,
    /// Word address of the write.
    pub address: Signal<In, Bits<14>>,
    /// The word that is staged.
    pub data: Signal<In, Bits<32>>,
    /// Checksum over the staged writes, read with a commit's strobe.
    pub checksum: Signal<In, Bits<32>>,
    /// A control tick starts.
    pub tick: Signal<In, Bit>,

    /// Bank of the set points in force.
    pub set_point_bank: Signal<Out, Bit>,
    /// Bank of the configuration in force.
    pub configuration_bank: Signal<Out, Bit>,
    /// A commit of set points waits for the tick.
    pub set_points_pending: Signal<Out, Bit>,
    /// A commit of the configuration waits for the tick.
    pub configuration_pending: Signal<Out, Bit>,
    /// A right commit of set points, in the clock after it.
    pub pet: Signal<Out, Bit>,
    /// A wrong commit, in the clock after it.
    pub fault: Signal<Out, Bit>,
    /// Right commits, wrapping.
    pub accepted: Signal<Out, Bits<16>>,
    /// Wrong commits, wrapping.
    pub rejected: Signal<Out, Bits<16>>,

    sum: Preset<32, { CHECKSUM_SEED as u64 }>,
    sum_right: DFF<Bit>,
    set_points_come: DFF<Bit>,
    configuration_comes: DFF<Bit>,
    set_points: DFF<Bits<6>>,
    configuration: DFF<Bits<6>>,
    set_point_bank_now: DFF<Bit>,
    configuration_bank_now: DFF<Bit>,
    set_points_wait: DFF<Bit>,
    configuration_waits: DFF<Bit>,
    accepted_count: DFF<Bits<16>>,
    rejected_count: DFF<Bits<16>>,

    next_sum: Signal<Local, Bits<32>>,
    right: Signal<Local, Bit>,
    committing: Signal<Local, Bit>,

    seed: Literal<32, { CHECKSUM_SEED as u64 }>,
    none: Literal<6, 0>,
    one: Literal<6, 1>,
    full: Literal<6, 63>,
    all_set_points: Literal<6, { SET_POINT_WORDS as u64 }>,
    all_configuration: Literal<6, { CONFIGURATION_WORDS as u64 }>,
    one_count: Literal<16, 1>,
}

impl Logic for Commit {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(
            self,
            clock,
            sum,
            sum_right,
            set_points_come,
            configuration_comes,
            set_points,
            configuration,
            set_point_bank_now,
            configuration_bank_now,
            set_points_wait,
            configuration_waits,
            accepted_count,
            rejected_count
        );

        self.next_sum.next = ((self.sum.q.val() << 1) | (self.sum.q.val() >> 31))
            ^ self.data.val()
            ^ bit_cast::<32, 14>(self.address.val());
        // The checksum is compared in the clock of the commit, which counts in the next.
        self.sum_right.d.next = self.checksum.val() == self.sum.q.val();
        self.set_points_come.d.next = self.commit_set_points.val();
        self.configuration_comes.d.next = self.commit_configuration.val();
        self.committing.next = self.set_points_come.q.val() | self.configuration_comes.q.val();
        self.right.next = false;
        if self.set_points_come.q.val() {
            self.right.next = self.sum_right.q.val()
                & (self.set_points.q.val() == self.all_set_points.val())
                & (self.configuration.q.val() == self.none.val());
        }
        if self.configuration_comes.q.val() {
            self.right.next = self.sum_right.q.val()
                & (self.configuration.q.val() == self.all_configuration.val())
                & (self.set_points.q.val() == self.none.val());
        }
        self.pet.next = self.set_points_come.q.val() & self.right.val();
        self.fault.next = self.committing.val() & !self.right.val();

        if self.tick.val() {
            if self.set_points_wait.q.val() & !self.stage_set_point.val() {
                self.set_point_bank_now.d.next = !self.set_point_bank_now.q.val();
                self.set_points_wait.d.next = false;
            }
            if self.configuration_waits.q.val() & !self.stage_configuration.val() {
                self.configuration_bank_now.d.next = !self.configuration_bank_now.q.val();
                self.configuration_waits.d.next = false;
            }
        }
        if self.committing.val() {
            self.sum.d.next = self.seed.val();
            self.set_points.d.next = self.none.val();
            self.configuration.d.next = self.none.val();
            if self.right.val() {
                self.accepted_count.d.next = self.accepted_count.q.val() + self.one_count.val();
                if self.set_points_come.q.val() {
                    self.set_points_wait.d.next = true;
                } else {
                    self.configuration_waits.d.next = true;
                }
            } else {
                self.rejected_count.d.next = self.rejected_count.q.val() + self.one_count.val();
            }
        }
        if self.stage_set_point.val() {
            self.sum.d.next = self.next_sum.val();
            if self.set_points.q.val() != self.full.val() {
                self.set_points.d.next = self.set_points.q.val() + self.one.val();
            }
            self.set_points_wait.d.next = false;
        }
        if self.stage_configuration.val() {
            self.sum.d.next = self.next_sum.val();
            if self.configuration.q.val() != self.full.val() {
                self.configuration.d.next = self.configuration.q.val() + self.one.val();
            }
            self.configuration_waits.d.next = false;
        }

        self.set_point_bank.next = self.set_point_bank_now.q.val();
        self.configuration_bank.next = self.configuration_bank_now.q.val();
        self.set_points_pending.next = self.set_points_wait.q.val();
        self.configuration_pending.next = self.configuration_waits.q.val();
        self.accepted.next = self.accepted_count.q.val();
        self.rejected.next = self.rejected_count.q.val();
    }
}
