//! Reads a 6-axis inertial sensor over SPI at every control tick; between, the host reaches its registers.
//!
//! ```text
//!  tick ─► burst ─┬─► command ─► shift ─► MOSI          cs_n ~~\___________________________/~~
//!                 │              ▲    │                 sclk ~~~~\_/~\_/~\_ … _/~\_/~~~~~~~   mode 3
//!  host ─► access ┘       MISO ──┘    ├─► value                __/~\_/~\_/~ … ~\_/~\______   mode 0
//!                                     ▼                 mosi   |1 r6 … r0 | 0 …
//!  data ready ─► age ─► word 0,  words 1–7 ─► bank ─►   miso   |    …     | 14 bytes
//! ```
//!
//! | | halves of a clock of the line | clocks with `half` = 0, 1, 2, 3 |
//! |---|---|---|
//! | burst: command and 14 bytes | 242 | 242, 484, 726, 968 |
//! | access: command and 1 byte | 34 | 34, 68, 102, 136 |
//!
//! Most significant bit first; both sides read at the rising edge, in mode 0 as in mode 3. A burst begins one
//! clock after the tick and asks for nothing back, so that a sensor that is dead, absent or stuck lasts as long
//! as a good one: less than the shortest period. Seven words of two bytes go into the memory as they come,
//! into the bank that the tick's snapshot has; word 0 is the clocks from the last rise of the data-ready line to
//! the tick, 65535 where there was none or the sensor is not read. While `enable` is set an access does nothing;
//! `enable` waits for an access that is on its way. MISO is read and never driven. Serves `imu_control`,
//! `imu_access`, `snapshot_imu`. The twin is `fixed_kin::imu_spi::ImuSpi`.

use crate::primitives::{Literal, Memory};
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// See the module.
#[derive(LogicBlock, Default)]
pub struct ImuSpi {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// A control tick.
    pub tick: Signal<In, Bit>,
    /// Bank of the snapshot that the tick before this clock began, 0 to 2.
    pub bank: Signal<In, Bits<2>>,
    /// Read the sensor at every tick.
    pub enable: Signal<In, Bit>,
    /// The line's clock rests high (mode 3), not low (mode 0).
    pub idle_high: Signal<In, Bit>,
    /// Half a period of the line's clock in clocks, less one.
    pub half: Signal<In, Bits<2>>,
    /// First register of a burst.
    pub first: Signal<In, Bits<7>>,
    /// The host asks for an access.
    pub access: Signal<In, Bit>,
    /// Its 16 bits: read flag, register, data.
    pub command: Signal<In, Bits<16>>,
    /// Line from the sensor.
    pub miso: Signal<In, Bit>,
    /// Data-ready line of the sensor.
    pub ready: Signal<In, Bit>,
    /// Bank that `read_word` addresses.
    pub read_bank: Signal<In, Bits<2>>,
    /// Word in the bank, from 0.
    pub read_word: Signal<In, Bits<3>>,
    /// Chip select.
    pub cs_n: Signal<Out, Bit>,
    /// Clock of the line.
    pub sclk: Signal<Out, Bit>,
    /// Line to the sensor.
    pub mosi: Signal<Out, Bit>,
    /// A burst or an access is on its way.
    pub busy: Signal<Out, Bit>,
    /// A burst is.
    pub reading: Signal<Out, Bit>,
    /// The byte that the last access read.
    pub value: Signal<Out, Bits<8>>,
    /// The word at `read_word` of the last clock.
    pub read_data: Signal<Out, Bits<16>>,

    words: Memory<16, 8>,
    live: DFF<Bit>,
    starts: DFF<Bit>,
    run: DFF<Bit>,
    burst: DFF<Bit>,
    halves: DFF<Bits<8>>,
    phase: DFF<Bits<2>>,
    shift: DFF<Bits<16>>,
    clock_high: DFF<Bit>,
    mosi_high: DFF<Bit>,
    ready_1: DFF<Bit>,
    ready_2: DFF<Bit>,
    ready_3: DFF<Bit>,
    left: DFF<Bits<16>>,

    edge_now: Signal<Local, Bit>,
    begins_burst: Signal<Local, Bit>,
    begins_access: Signal<Local, Bit>,
    low_half: Signal<Local, Bit>,
    data_phase: Signal<Local, Bit>,
    word_done: Signal<Local, Bit>,
    place: Signal<Local, Bits<8>>,

    no_phase: Literal<2, 0>,
    one_phase: Literal<2, 1>,
    burst_start: Literal<8, 14>,
    access_start: Literal<8, 222>,
    one_half: Literal<8, 1>,
    last_high: Literal<8, 254>,
    trail: Literal<8, 255>,
    word_end: Literal<5, 30>,
    no_slot: Literal<3, 0>,
    read_flag: Literal<16, 0x8000>,
    bit_0: Literal<16, 1>,
    never: Literal<16, 0>,
    now: Literal<16, 0xFFFF>,
}

impl Logic for ImuSpi {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, live, starts, run, burst, halves, phase, shift, clock_high, mosi_high);
        dff_setup!(self, clock, ready_1, ready_2, ready_3, left);
        clock!(self, clock, words);

        // Age of the data, counted down so that the start value is "none".
        self.ready_1.d.next = self.ready.val();
        self.ready_2.d.next = self.ready_1.q.val();
        self.ready_3.d.next = self.ready_2.q.val();
        if self.left.q.val() != self.never.val() {
            self.left.d.next = self.left.q.val() - self.bit_0.val();
        }
        if self.ready_2.q.val() & !self.ready_3.q.val() {
            self.left.d.next = self.now.val();
        }
        if !self.live.q.val() {
            self.left.d.next = self.never.val();
        }

        // Halves of the line's clock: lead, low and high for every bit, trail.
        self.live.d.next = self.enable.val() & (self.live.q.val() | !self.run.q.val());
        self.starts.d.next = self.tick.val();
        self.begins_burst.next = self.starts.q.val() & self.live.q.val() & !self.run.q.val();
        self.begins_access.next = self.access.val() & !self.enable.val() & !self.live.q.val() & !self.run.q.val();
        self.edge_now.next = self.run.q.val() & (self.phase.q.val() == self.half.val());
        self.low_half.next = self.halves.q.val().get_bit(0);
        self.data_phase.next = self.burst.q.val() & (self.halves.q.val().get_bits::<3>(5) != self.no_slot.val());
        self.word_done.next =
            self.edge_now.val() & self.data_phase.val() & (self.halves.q.val().get_bits::<5>(0) == self.word_end.val());
        self.phase.d.next = self.no_phase.val();
        if self.run.q.val() & !self.edge_now.val() {
            self.phase.d.next = self.phase.q.val() + self.one_phase.val();
        }
        if !self.run.q.val() {
            self.clock_high.d.next = self.idle_high.val();
        }
        if self.edge_now.val() {
            self.halves.d.next = self.halves.q.val() + self.one_half.val();
            if self.low_half.val() {
                if self.halves.q.val() == self.trail.val() {
                    self.run.d.next = false;
                    self.burst.d.next = false;
                } else {
                    self.clock_high.d.next = true;
                    self.shift.d.next = self.shift.q.val() << 1;
                    if self.miso.val() {
                        self.shift.d.next = (self.shift.q.val() << 1) | self.bit_0.val();
                    }
                }
            } else {
                self.clock_high.d.next = (self.halves.q.val() == self.last_high.val()) & self.idle_high.val();
                self.mosi_high.d.next = self.shift.q.val().get_bit(15) & !self.data_phase.val();
            }
        }
        if self.begins_burst.val() {
            self.run.d.next = true;
            self.burst.d.next = true;
            self.halves.d.next = self.burst_start.val();
            self.shift.d.next = (bit_cast::<16, 7>(self.first.val()) << 8) | self.read_flag.val();
        }
        if self.begins_access.val() {
            self.run.d.next = true;
            self.halves.d.next = self.access_start.val();
            self.shift.d.next = self.command.val();
        }

        // The memory: the age first, then the words as they come.
        self.place.next = bit_cast::<8, 2>(self.bank.val()) << 3;
        self.words.write_address.next = self.place.val();
        self.words.write_data.next = !self.left.q.val();
        if !self.starts.q.val() {
            self.words.write_address.next = self.place.val() | bit_cast::<8, 3>(self.halves.q.val().get_bits::<3>(5));
            self.words.write_data.next = self.shift.q.val();
        }
        self.words.write_enable.next = self.starts.q.val() | self.word_done.val();
        self.words.read_address.next =
            bit_cast::<8, 3>(self.read_word.val()) | (bit_cast::<8, 2>(self.read_bank.val()) << 3);
        self.read_data.next = self.words.read_data.val();

        self.cs_n.next = !self.run.q.val();
        self.sclk.next = self.clock_high.q.val();
        self.mosi.next = self.mosi_high.q.val();
        self.busy.next = self.run.q.val();
        self.reading.next = self.burst.q.val();
        self.value.next = self.shift.q.val().get_bits::<8>(0);
    }
}
