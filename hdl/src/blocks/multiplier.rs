//! Serial multiplier, one for all axes: the device has none.
//!
//! ```text
//!      ┌─────────── p (32) ───────────┐┌────────── lo (32) ──────────┐
//!      │ partial product, >> 2 a step ││ product bits → | ← operand  │
//!      └──────────────────────────────┘└─────────────────────────────┘
//!          ▲ ± 0, a, 2a on one 32-bit carry chain, by the low bits of lo
//! ```
//!
//! `result` = `fixed_kin::word::multiply(a, b, scale)`; scale 0–4 take 9, 12, 12, 7, 8 steps.
//! Radix-4 Booth recoding; half an LSB is the start value of `p`, so rounding costs nothing.
//! `start` is taken while `busy` is low; `result` is valid from the clock in which `busy` falls.

use crate::primitives::Literal;
use fixed_kin::word::{Scale, WORD_MAX, WORD_MIN};
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// The scales in the order of the port `scale`.
pub const SCALES: [Scale; 5] = [Scale::COEFFICIENT, Scale::FINE, Scale::WIDE, Scale::PERIOD, Scale::COUNTS];

const fn half(scale: Scale) -> u64 {
    1 << (scale.fraction_bits() - 1)
}

/// See the module.
#[derive(LogicBlock, Default)]
pub struct Multiplier {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// Takes the request below.
    pub start: Signal<In, Bit>,
    /// Scale, index into [`SCALES`].
    pub scale: Signal<In, Bits<3>>,
    /// Multiplicand, a word.
    pub a: Signal<In, Bits<32>>,
    /// Multiplier, as wide as the scale says.
    pub b: Signal<In, Bits<32>>,
    /// At work; requests are ignored.
    pub busy: Signal<Out, Bit>,
    /// The result as a word.
    pub result: Signal<Out, Bits<32>>,

    p: DFF<Bits<32>>,
    lo: DFF<Bits<32>>,
    operand: DFF<Bits<32>>,
    steps: DFF<Bits<4>>,
    working: DFF<Bit>,
    negate: DFF<Bit>,
    twice: DFF<Bit>,
    nothing: DFF<Bit>,
    guard_8: DFF<Bit>,

    addend: Signal<Local, Bits<32>>,
    left: Signal<Local, Bits<32>>,
    raw_sum: Signal<Local, Bits<32>>,
    sum: Signal<Local, Bits<32>>,
    digit: Signal<Local, Bits<3>>,
    shifted: Signal<Local, Bits<32>>,
    top: Signal<Local, Bits<11>>,
    running: Signal<Local, Bit>,
    fits: Signal<Local, Bit>,
    sign: Signal<Local, Bits<1>>,

    top_5: Signal<Local, Bits<5>>,

    zero: Literal<32, 0>,
    digit_zero: Literal<3, 0>,
    digit_plus_two: Literal<3, 3>,
    digit_minus_two: Literal<3, 4>,
    digit_minus_zero: Literal<3, 7>,
    one_step: Literal<4, 1>,
    steps_coefficient: Literal<4, { Scale::COEFFICIENT.digits() as u64 }>,
    steps_gain: Literal<4, { Scale::FINE.digits() as u64 }>,
    steps_period: Literal<4, { Scale::PERIOD.digits() as u64 }>,
    half_coefficient: Literal<32, { half(Scale::COEFFICIENT) }>,
    half_fine: Literal<32, { half(Scale::FINE) }>,
    half_wide: Literal<32, { half(Scale::WIDE) }>,
    steps_counts: Literal<4, { Scale::COUNTS.digits() as u64 }>,
    half_counts: Literal<32, { half(Scale::COUNTS) }>,
    half_period: Literal<32, { half(Scale::PERIOD) }>,
    word_max: Literal<32, { WORD_MAX as u64 }>,
    word_min: Literal<32, { WORD_MIN as u32 as u64 }>,
    eleven_clear: Literal<11, 0>,
    eleven_set: Literal<11, 0x7FF>,
    five_clear: Literal<5, 0>,
    five_set: Literal<5, 0x1F>,
}

impl Logic for Multiplier {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, p, lo, operand, steps, working, negate, twice, nothing, guard_8);

        self.running.next = self.working.q.val();
        self.busy.next = self.running.val();

        // The next Booth digit, two bits of the operand and the one that went before, a clock ahead.
        self.digit.next = self.lo.q.val().get_bits::<3>(1);
        if !self.running.val() {
            self.digit.next = bit_cast::<3, 2>(self.b.val().get_bits::<2>(0)) << 1;
        }
        self.negate.d.next = self.digit.val().get_bit(2);
        self.twice.d.next =
            (self.digit.val() == self.digit_plus_two.val()) | (self.digit.val() == self.digit_minus_two.val());
        self.nothing.d.next =
            (self.digit.val() == self.digit_zero.val()) | (self.digit.val() == self.digit_minus_zero.val());
        self.addend.next = self.operand.q.val();
        if self.twice.q.val() {
            self.addend.next = self.operand.q.val() << 1;
        }
        if self.nothing.q.val() {
            self.addend.next = self.zero.val();
        }
        // p − a = ¬(¬p + a), as in the sequencer: one carry chain for both ways.
        self.left.next = self.p.q.val();
        if self.negate.q.val() {
            self.left.next = !self.p.q.val();
        }
        self.raw_sum.next = self.left.val() + self.addend.val();
        self.sum.next = self.raw_sum.val();
        if self.negate.q.val() {
            self.sum.next = !self.raw_sum.val();
        }
        self.shifted.next = self.sum.val() >> 2;
        self.sign.next = self.sum.val().get_bits::<1>(31);

        if self.running.val() {
            self.steps.d.next = self.steps.q.val() - self.one_step.val();
            self.working.d.next = self.steps.q.val() != self.one_step.val();
            self.p.d.next = self.shifted.val()
                | (bit_cast::<32, 1>(self.sign.val()) << 30)
                | (bit_cast::<32, 1>(self.sign.val()) << 31);
            self.lo.d.next = (self.lo.q.val() >> 2) | (bit_cast::<32, 2>(self.sum.val().get_bits::<2>(0)) << 30);
        } else if self.start.val() {
            self.working.d.next = true;
            self.operand.d.next = self.a.val();
            self.lo.d.next = self.b.val();
            self.guard_8.d.next = false;
            match self.scale.val().index() {
                0 => {
                    self.p.d.next = self.half_coefficient.val();
                    self.steps.d.next = self.steps_coefficient.val();
                }
                1 => {
                    self.p.d.next = self.half_fine.val();
                    self.steps.d.next = self.steps_gain.val();
                }
                2 => {
                    self.p.d.next = self.half_wide.val();
                    self.steps.d.next = self.steps_gain.val();
                    self.guard_8.d.next = true;
                }
                3 => {
                    self.p.d.next = self.half_period.val();
                    self.steps.d.next = self.steps_period.val();
                }
                _ => {
                    self.p.d.next = self.half_counts.val();
                    self.steps.d.next = self.steps_counts.val();
                    self.guard_8.d.next = true;
                }
            }
        }

        // The product is p followed by the top 2 or 8 bits of lo.
        self.top.next = self.p.q.val().get_bits::<11>(21);
        self.top_5.next = self.p.q.val().get_bits::<5>(27);
        if self.guard_8.q.val() {
            self.fits.next = (self.top.val() == self.eleven_clear.val()) | (self.top.val() == self.eleven_set.val());
            self.result.next = (self.p.q.val() << 8) | bit_cast::<32, 8>(self.lo.q.val().get_bits::<8>(24));
        } else {
            self.fits.next = (self.top_5.val() == self.five_clear.val()) | (self.top_5.val() == self.five_set.val());
            self.result.next = (self.p.q.val() << 2) | bit_cast::<32, 2>(self.lo.q.val().get_bits::<2>(30));
        }
        if !self.fits.val() {
            self.result.next = self.word_max.val();
            if self.p.q.val().get_bit(31) {
                self.result.next = self.word_min.val();
            }
        }
    }
}
