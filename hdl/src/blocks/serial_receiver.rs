//! Receiver of an asynchronous serial line: 8 bits, no parity, one stop bit, idle high.
//!
//! ```text
//!  rx ~~~~\____/ 0 \/ 1 \/ … \/ 7 \/~~~~    every bit is looked at once, in its middle
//!         start ▲    ▲    ▲         ▲ stop
//! ```
//!
//! Two flip-flops synchronise the line. A start bit that is gone in its middle was a spike; a low stop
//! bit is `broken`, no byte. `byte_done` and `data_bit` are strobes. Serves no register. The twin is
//! `fixed_kin::serial::Receiver`; the radio and the open board's serial host have one each.

use crate::primitives::Literal;
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// See the module; `HALF` and `WHOLE` are the clocks of half a bit and of a bit, each less one.
#[derive(LogicBlock, Default)]
pub struct SerialReceiver<const HALF: u64, const WHOLE: u64> {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// Received bits, from a pin: asynchronous, high at rest.
    pub rx: Signal<In, Bit>,
    /// A new byte may begin.
    pub enable: Signal<In, Bit>,
    /// The line behind the synchroniser.
    pub level: Signal<Out, Bit>,
    /// A byte is on its way.
    pub hearing: Signal<Out, Bit>,
    /// A bit's time has passed, also while nothing is heard.
    pub bit_time: Signal<Out, Bit>,
    /// A start bit begins.
    pub start: Signal<Out, Bit>,
    /// A data bit is read: it is `level`.
    pub data_bit: Signal<Out, Bit>,
    /// `value` is a whole byte.
    pub byte_done: Signal<Out, Bit>,
    /// A stop bit was low.
    pub broken: Signal<Out, Bit>,
    /// The last byte.
    pub value: Signal<Out, Bits<8>>,

    low_1: DFF<Bit>,
    low_2: DFF<Bit>,
    hears: DFF<Bit>,
    clocks: DFF<Bits<9>>,
    bits: DFF<Bits<4>>,
    shift: DFF<Bits<8>>,

    high: Signal<Local, Bit>,
    due: Signal<Local, Bit>,
    sampling: Signal<Local, Bit>,
    starts: Signal<Local, Bit>,
    first: Signal<Local, Bit>,
    stop: Signal<Local, Bit>,

    half_bit: Literal<9, HALF>,
    whole_bit: Literal<9, WHOLE>,
    no_clocks: Literal<9, 0>,
    one_clock: Literal<9, 1>,
    no_bits: Literal<4, 0>,
    one_bit: Literal<4, 1>,
    stop_bit: Literal<4, 9>,
    top_bit: Literal<8, 0x80>,
}

impl<const HALF: u64, const WHOLE: u64> Logic for SerialReceiver<HALF, WHOLE> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, low_1, low_2, hears, clocks, bits, shift);

        // Inverted before the first flip-flop, so that power-up is the idle line.
        self.low_1.d.next = !self.rx.val();
        self.low_2.d.next = self.low_1.q.val();
        self.high.next = !self.low_2.q.val();
        self.starts.next = self.low_2.q.val() & self.enable.val() & !self.hears.q.val();
        self.due.next = self.clocks.q.val() == self.no_clocks.val();
        self.sampling.next = self.hears.q.val() & self.due.val();
        self.first.next = self.bits.q.val() == self.no_bits.val();
        self.stop.next = self.bits.q.val() == self.stop_bit.val();
        self.clocks.d.next = self.clocks.q.val() - self.one_clock.val();
        if self.due.val() {
            self.clocks.d.next = self.whole_bit.val();
        }
        if self.sampling.val() {
            self.bits.d.next = self.bits.q.val() + self.one_bit.val();
            if self.first.val() {
                self.hears.d.next = self.low_2.q.val();
            } else if self.stop.val() {
                self.hears.d.next = false;
            } else {
                self.shift.d.next = self.shift.q.val() >> 1;
                if self.high.val() {
                    self.shift.d.next = (self.shift.q.val() >> 1) | self.top_bit.val();
                }
            }
        }
        if self.starts.val() {
            self.hears.d.next = true;
            self.clocks.d.next = self.half_bit.val();
            self.bits.d.next = self.no_bits.val();
        }

        self.bit_time.next = self.due.val();
        self.level.next = self.high.val();
        self.hearing.next = self.hears.q.val();
        self.start.next = self.starts.val();
        self.data_bit.next = self.sampling.val() & !self.first.val() & !self.stop.val();
        self.byte_done.next = self.sampling.val() & self.stop.val() & self.high.val();
        self.broken.next = self.sampling.val() & self.stop.val() & self.low_2.q.val();
        self.value.next = self.shift.q.val();
    }
}
