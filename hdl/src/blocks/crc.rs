//! Bit-serial cyclic redundancy check, lowest bit first.
//!
//! ```text
//!          ┌──────────┬────── taps ───┐
//!  bit ─►(xor)◄─ 0 ◄─ 1 ◄─ … ◄─ N−1 ◄─┘        state >> 1, with the taps flipped where the xor is 1
//! ```
//!
//! `clear` fills the register with ones. What stands in it after a whole undamaged frame, its own CRC
//! included, is a constant of the polynomial (`fixed_kin::radio::CRC_RESIDUE`; 0 where the CRC is sent as it is).

use crate::primitives::Literal;
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// See the module; `TAPS` are in the order of the line.
#[derive(LogicBlock, Default)]
pub struct Crc<const N: usize, const TAPS: u64> {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// Begin anew; before `shift`.
    pub clear: Signal<In, Bit>,
    /// Take `line`.
    pub shift: Signal<In, Bit>,
    /// The next bit of the line.
    pub line: Signal<In, Bit>,
    /// Remainder of the bits so far.
    pub state: Signal<Out, Bits<N>>,

    register: DFF<Bits<N>>,
    feedback: Signal<Local, Bit>,
    taps: Literal<N, TAPS>,
    zero: Literal<N, 0>,
}

impl<const N: usize, const TAPS: u64> Logic for Crc<N, TAPS> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, register);
        self.feedback.next = self.register.q.val().get_bit(0) ^ self.line.val();
        if self.shift.val() {
            self.register.d.next = self.register.q.val() >> 1;
            if self.feedback.val() {
                self.register.d.next = (self.register.q.val() >> 1) ^ self.taps.val();
            }
        }
        if self.clear.val() {
            self.register.d.next = !self.zero.val();
        }
        self.state.next = self.register.q.val();
    }
}
