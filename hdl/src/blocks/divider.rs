//! Serial divider: speeds are counts over clocks.
//!
//! ```text
//!   remainder (25), last bit ──► − denominator (24) ──► sign ──► quotient (29) << 1
//! ```
//!
//! `quotient` = `fixed_kin::word::divide(numerator, denominator)` for a numerator of 16 bits; one less where
//! the numerator is negative, because then every bit comes out inverted, and the program adds the one. A step for
//! the bit that must not be there, then 32 for the bits, of which the first three do not fit a word either: where
//! one of these four is set, all that follow are, which is the largest word. `start` is taken while `busy` is low;
//! `quotient` is valid from the clock in which `busy` falls, until the next start. It works while the sequencer goes on.

use crate::primitives::Literal;
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// Clocks that `busy` is high.
pub const DIVISION_STEPS: u32 = 33;

/// See the module.
#[derive(LogicBlock, Default)]
pub struct Divider {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// Takes the request below.
    pub start: Signal<In, Bit>,
    /// Numerator, two's complement; its low 16 bits count.
    pub numerator: Signal<In, Bits<32>>,
    /// Denominator; its low 24 bits count.
    pub denominator: Signal<In, Bits<32>>,
    /// At work; requests are ignored.
    pub busy: Signal<Out, Bit>,
    /// The result as a word, less one where the numerator is negative.
    pub quotient: Signal<Out, Bits<32>>,

    remainder: DFF<Bits<25>>,
    last_bit: DFF<Bit>,
    bits: DFF<Bits<29>>,
    divisor: DFF<Bits<24>>,
    steps: DFF<Bits<6>>,
    working: DFF<Bit>,
    negative: DFF<Bit>,
    overflow: DFF<Bit>,

    sign: Signal<Local, Bit>,
    inverted: Signal<Local, Bits<16>>,
    magnitude: Signal<Local, Bits<16>>,
    running: Signal<Local, Bit>,
    minuend: Signal<Local, Bits<26>>,
    difference: Signal<Local, Bits<26>>,
    goes: Signal<Local, Bit>,
    sets: Signal<Local, Bit>,

    one_step: Literal<6, 1>,
    word_steps: Literal<6, 29>,
    all_steps: Literal<6, { DIVISION_STEPS as u64 }>,
    bit_0: Literal<26, 1>,
    word_bit_0: Literal<29, 1>,
    sign_of_29: Literal<32, 0xE000_0000>,
}

impl Logic for Divider {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, remainder, last_bit, bits, divisor, steps, working, negative, overflow);
        self.running.next = self.working.q.val();
        self.busy.next = self.running.val();

        self.minuend.next = bit_cast::<26, 25>(self.remainder.q.val()) << 1;
        if self.last_bit.q.val() {
            self.minuend.next = (bit_cast::<26, 25>(self.remainder.q.val()) << 1) | self.bit_0.val();
        }
        self.difference.next = self.minuend.val() - bit_cast::<26, 24>(self.divisor.q.val());
        self.goes.next = !self.difference.val().get_bit(25);
        self.sets.next = self.goes.val() | self.overflow.q.val();

        // |n| = (n ^ sign) + sign, on one carry chain.
        self.sign.next = self.numerator.val().get_bit(15);
        self.inverted.next = self.numerator.val().get_bits::<16>(0);
        if self.sign.val() {
            self.inverted.next = !self.numerator.val().get_bits::<16>(0);
        }
        self.magnitude.next = self.inverted.val() + bit_cast::<16, 1>(self.sign.val().into());

        if self.running.val() {
            self.steps.d.next = self.steps.q.val() - self.one_step.val();
            self.working.d.next = self.steps.q.val() != self.one_step.val();
            self.last_bit.d.next = false;
            self.remainder.d.next = self.minuend.val().get_bits::<25>(0);
            self.bits.d.next = self.bits.q.val() << 1;
            if self.goes.val() {
                self.remainder.d.next = self.difference.val().get_bits::<25>(0);
            }
            if self.sets.val() ^ self.negative.q.val() {
                self.bits.d.next = (self.bits.q.val() << 1) | self.word_bit_0.val();
            }
            if self.goes.val() & (self.steps.q.val() > self.word_steps.val()) {
                self.overflow.d.next = true;
            }
        } else if self.start.val() {
            self.remainder.d.next = bit_cast::<25, 15>(self.magnitude.val().get_bits::<15>(1));
            self.last_bit.d.next = self.magnitude.val().get_bit(0);
            self.negative.d.next = self.sign.val();
            self.divisor.d.next = self.denominator.val().get_bits::<24>(0);
            self.overflow.d.next = false;
            self.steps.d.next = self.all_steps.val();
            self.working.d.next = true;
        }

        self.quotient.next = bit_cast::<32, 29>(self.bits.q.val());
        if self.negative.q.val() {
            self.quotient.next = bit_cast::<32, 29>(self.bits.q.val()) | self.sign_of_29.val();
        }
    }
}
