//! Serial divider: speeds are counts over clocks.
//!
//! ```text
//!   remainder (25) << 1 − denominator (24)  ──► sign ──► quotient (32) << 1
//! ```
//!
//! `quotient` = `fixed_kin::word::divide(numerator, denominator)` for |numerator| < 2²⁴: one step to
//! see an overflow, 32 for the bits, one to clip and one for the sign. `start` is taken while `busy` is low; `quotient` is valid from
//! the clock in which `busy` falls, until the next start. It works while the sequencer goes on.

use crate::primitives::Literal;
use fixed_kin::word::WORD_MAX;
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// Clocks that `busy` is high.
pub const DIVISION_STEPS: u32 = 35;

/// See the module.
#[derive(LogicBlock, Default)]
pub struct Divider {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// Takes the request below.
    pub start: Signal<In, Bit>,
    /// Numerator, two's complement, |n| < 2²⁴.
    pub numerator: Signal<In, Bits<32>>,
    /// Denominator; its low 24 bits count.
    pub denominator: Signal<In, Bits<32>>,
    /// At work; requests are ignored.
    pub busy: Signal<Out, Bit>,
    /// The result as a word.
    pub quotient: Signal<Out, Bits<32>>,

    remainder: DFF<Bits<25>>,
    bits: DFF<Bits<32>>,
    divisor: DFF<Bits<25>>,
    steps: DFF<Bits<6>>,
    negative: DFF<Bit>,
    overflow: DFF<Bit>,
    checking: DFF<Bit>,

    running: Signal<Local, Bit>,
    minuend: Signal<Local, Bits<25>>,
    difference: Signal<Local, Bits<26>>,
    magnitude: Signal<Local, Bits<25>>,
    bits_top: Signal<Local, Bits<3>>,
    clipped: Signal<Local, Bits<32>>,

    no_steps: Literal<6, 0>,
    one_step: Literal<6, 1>,
    two_steps: Literal<6, 2>,
    all_steps: Literal<6, { DIVISION_STEPS as u64 }>,
    zero_25: Literal<25, 0>,
    zero: Literal<32, 0>,
    one: Literal<32, 1>,
    three_clear: Literal<3, 0>,
    word_max: Literal<32, { WORD_MAX as u64 }>,
}

impl Logic for Divider {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, remainder, bits, divisor, steps, negative, overflow, checking);
        self.running.next = self.steps.q.val() != self.no_steps.val();
        self.busy.next = self.running.val();

        self.minuend.next = self.remainder.q.val() << 1;
        if self.checking.q.val() {
            self.minuend.next = self.remainder.q.val();
        }
        self.difference.next = bit_cast::<26, 25>(self.minuend.val()) - bit_cast::<26, 25>(self.divisor.q.val());
        self.magnitude.next = self.numerator.val().get_bits::<25>(0);
        if self.numerator.val().get_bit(31) {
            self.magnitude.next = self.zero_25.val() - self.numerator.val().get_bits::<25>(0);
        }

        self.bits_top.next = self.bits.q.val().get_bits::<3>(29);
        self.clipped.next = self.bits.q.val();
        if self.overflow.q.val() | (self.bits_top.val() != self.three_clear.val()) {
            self.clipped.next = self.word_max.val();
        }
        if self.running.val() {
            self.steps.d.next = self.steps.q.val() - self.one_step.val();
            self.checking.d.next = false;
            if self.steps.q.val() == self.two_steps.val() {
                self.bits.d.next = self.clipped.val();
            } else if self.steps.q.val() == self.one_step.val() {
                if self.negative.q.val() {
                    self.bits.d.next = self.zero.val() - self.bits.q.val();
                }
            } else if self.checking.q.val() {
                self.overflow.d.next = !self.difference.val().get_bit(25);
            } else if self.difference.val().get_bit(25) {
                self.remainder.d.next = self.minuend.val();
                self.bits.d.next = self.bits.q.val() << 1;
            } else {
                self.remainder.d.next = self.difference.val().get_bits::<25>(0);
                self.bits.d.next = (self.bits.q.val() << 1) | self.one.val();
            }
        } else if self.start.val() {
            self.remainder.d.next = self.magnitude.val();
            self.divisor.d.next = bit_cast::<25, 24>(self.denominator.val().get_bits::<24>(0));
            self.bits.d.next = self.zero.val();
            self.negative.d.next = self.numerator.val().get_bit(31);
            self.overflow.d.next = false;
            self.checking.d.next = true;
            self.steps.d.next = self.all_steps.val();
        }

        self.quotient.next = self.bits.q.val();
    }
}
