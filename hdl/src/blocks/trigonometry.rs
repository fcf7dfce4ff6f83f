//! Sine and cosine of a heading, for the pose: two tables of a quarter turn, in block memory.
//!
//! ```text
//!  angle 31:30 quadrant │ 29:22 index │ 21:4 fraction │ 3:0 unused
//!
//!  quadrant │ 0     │ 1      │ 2      │ 3       value = table entry + ½, an odd number of 2⁻¹⁷:
//!  sine     │ T[i]  │ T[~i]  │ −T[i]  │ −T[~i]  {sign, entry ^ sign, 1} is its exact
//!  cosine   │ T[~i] │ −T[i]  │ −T[~i] │ T[i]    negation, no adder needed
//! ```
//!
//! Timing: all outputs two clocks after `load`. The twins are `fixed_kin::pose::{sine, fraction}`.

use crate::primitives::{Literal, Rom};
use fixed_kin::pose::SINE;
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// See the module.
#[derive(LogicBlock)]
pub struct Trigonometry {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// Takes the angle.
    pub load: Signal<In, Bit>,
    /// Heading, 2⁻³² turn.
    pub angle: Signal<In, Bits<32>>,
    /// Sine of the angle's table interval, 18 bits signed: an odd number of 2⁻¹⁷.
    pub sine: Signal<Out, Bits<18>>,
    /// Cosine of the same, 18 bits signed: an odd number of 2⁻¹⁷.
    pub cosine: Signal<Out, Bits<18>>,
    /// Place in the table's interval, from its middle, 18 bits signed.
    pub fraction: Signal<Out, Bits<18>>,

    sines: Rom<16, 8>,
    cosines: Rom<16, 8>,
    held: DFF<Bits<28>>,

    quadrant: Signal<Local, Bits<2>>,
    index: Signal<Local, Bits<8>>,
    sine_entry: Signal<Local, Bits<16>>,
    cosine_entry: Signal<Local, Bits<16>>,
    sine_sign: Signal<Local, Bit>,
    cosine_sign: Signal<Local, Bit>,
    odd: Literal<18, 1>,
    middle: Literal<18, 0x2_0000>,
}

impl Default for Trigonometry {
    fn default() -> Self {
        let table = SINE.map(u32::from);
        Self {
            clock: Signal::default(),
            load: Signal::default(),
            angle: Signal::default(),
            sine: Signal::default(),
            cosine: Signal::default(),
            fraction: Signal::default(),
            sines: Rom::new(&table),
            cosines: Rom::new(&table),
            held: DFF::default(),
            quadrant: Signal::default(),
            index: Signal::default(),
            sine_entry: Signal::default(),
            cosine_entry: Signal::default(),
            sine_sign: Signal::default(),
            cosine_sign: Signal::default(),
            odd: Literal::default(),
            middle: Literal::default(),
        }
    }
}

impl Logic for Trigonometry {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, held);
        clock!(self, clock, sines, cosines);
        if self.load.val() {
            self.held.d.next = self.angle.val().get_bits::<28>(4);
        }
        self.quadrant.next = self.held.q.val().get_bits::<2>(26);
        self.index.next = self.held.q.val().get_bits::<8>(18);
        self.sines.read_address.next = self.index.val();
        self.cosines.read_address.next = !self.index.val();
        if self.quadrant.val().get_bit(0) {
            self.sines.read_address.next = !self.index.val();
            self.cosines.read_address.next = self.index.val();
        }
        self.sine_entry.next = self.sines.read_data.val();
        self.sine_sign.next = self.quadrant.val().get_bit(1);
        if self.sine_sign.val() {
            self.sine_entry.next = !self.sines.read_data.val();
        }
        self.sine.next = (bit_cast::<18, 16>(self.sine_entry.val()) << 1)
            | (bit_cast::<18, 1>(self.sine_sign.val().into()) << 17)
            | self.odd.val();
        self.cosine_entry.next = self.cosines.read_data.val();
        self.cosine_sign.next = self.quadrant.val().get_bit(1) ^ self.quadrant.val().get_bit(0);
        if self.cosine_sign.val() {
            self.cosine_entry.next = !self.cosines.read_data.val();
        }
        self.cosine.next = (bit_cast::<18, 16>(self.cosine_entry.val()) << 1)
            | (bit_cast::<18, 1>(self.cosine_sign.val().into()) << 17)
            | self.odd.val();
        self.fraction.next = self.held.q.val().get_bits::<18>(0) ^ self.middle.val();
    }
}
