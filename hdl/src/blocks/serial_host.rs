//! A host on a serial line in place of the PCI bridge: frames in, cycles of the local bus out.
//!
//! ```text
//! rx ─► bits ─► frame, CRC ─► ADS#, BLAST#, LAD ─► core
//! tx ◄─ bits ◄─ reply, CRC ◄─ READY#, LAD ◄───────┘
//!
//! request   'R' address(2)         crc     word address, lowest byte first
//!           'W' address(2) data(4) crc
//! reply     'r' data(4) crc      'w' crc      'e' crc: wrong CRC or address, nothing was done
//! ```
//!
//! Line: 8 bits, no parity, one stop bit, `CLOCKS_PER_BIT` clocks a bit (1 Mbaud at 33 MHz). The CRC has
//! eight bits, polynomial x⁸ + x² + x + 1 in the order of the line, started with ones
//! (`fixed_kin::serial_host`). A frame that stops for `FRAME_TIMEOUT` clocks is forgotten; bytes that
//! come before the reply is out are not heard. One request, one reply: a host that gets none asks
//! again, since every access may be made twice without harm but a kick, which the lock-out bounds.

use super::crc::Crc;
use super::serial_receiver::SerialReceiver;
use crate::primitives::Literal;
use fixed_kin::serial_host::{CLOCKS_PER_BIT, FRAME_TIMEOUT};
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// See the module.
#[derive(LogicBlock, Default)]
pub struct SerialHost {
    /// Clock, that of the core's bus.
    pub clock: Signal<In, Clock>,
    /// Line from the host, idle high.
    pub rx: Signal<In, Bit>,
    /// Line to the host.
    pub tx: Signal<Out, Bit>,
    /// Address strobe to the core.
    pub ads_n: Signal<Out, Bit>,
    /// Burst last to the core.
    pub blast_n: Signal<Out, Bit>,
    /// High for a write.
    pub lw_r: Signal<Out, Bit>,
    /// Address, then data.
    pub to_core: Signal<Out, Bits<32>>,
    /// Data of the core.
    pub from_core: Signal<In, Bits<32>>,
    /// The core's answer.
    pub ready_n: Signal<In, Bit>,

    receiver: SerialReceiver<{ CLOCKS_PER_BIT as u64 / 2 - 1 }, { CLOCKS_PER_BIT as u64 - 1 }>,
    rx_check: Crc<8, 0xE0>,
    tx_check: Crc<8, 0xE0>,

    silence: DFF<Bits<14>>,
    position: DFF<Bits<3>>,
    is_write: DFF<Bit>,
    address: DFF<Bits<16>>,
    data: DFF<Bits<32>>,
    calling: DFF<Bit>,
    waiting: DFF<Bit>,
    replying: DFF<Bit>,
    failed: DFF<Bit>,
    tx_clocks: DFF<Bits<6>>,
    tx_bit: DFF<Bits<4>>,
    tx_position: DFF<Bits<3>>,
    tx_byte: DFF<Bits<8>>,
    tx_low: DFF<Bit>,

    byte_done: Signal<Local, Bit>,
    heard: Signal<Local, Bits<8>>,
    at_start: Signal<Local, Bit>,
    good: Signal<Local, Bit>,
    reads: Signal<Local, Bit>,
    writes: Signal<Local, Bit>,
    frame_done: Signal<Local, Bit>,
    tx_tick: Signal<Local, Bit>,
    tx_last: Signal<Local, Bit>,
    tx_sends_crc: Signal<Local, Bit>,
    answers: Signal<Local, Bit>,
    next_tx_byte: Signal<Local, Bits<8>>,
    tx_after: Signal<Local, Bits<3>>,
    following: Signal<Local, Bits<3>>,

    whole_bit: Literal<6, { CLOCKS_PER_BIT as u64 - 1 }>,
    no_clocks: Literal<6, 0>,
    one_clock: Literal<6, 1>,
    no_bits: Literal<4, 0>,
    one_bit: Literal<4, 1>,
    stop_bit: Literal<4, 9>,
    no_byte: Literal<8, 0>,
    silent: Literal<14, { FRAME_TIMEOUT as u64 }>,
    no_silence: Literal<14, 0>,
    one_silence: Literal<14, 1>,
    start: Literal<3, 0>,
    one_position: Literal<3, 1>,
    at_crc_of_read: Literal<3, 3>,
    at_crc_of_write: Literal<3, 7>,
    read_letter: Literal<8, { b'R' as u64 }>,
    write_letter: Literal<8, { b'W' as u64 }>,
    read_reply: Literal<8, { b'r' as u64 }>,
    write_reply: Literal<8, { b'w' as u64 }>,
    error_reply: Literal<8, { b'e' as u64 }>,
    one_byte: Literal<3, 1>,
    five_bytes: Literal<3, 5>,
    no_high: Literal<2, 0>,
}

impl Logic for SerialHost {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, receiver, rx_check, tx_check);
        dff_setup!(self, clock, silence, position, is_write, address, data, calling, waiting, replying, failed);
        dff_setup!(self, clock, tx_clocks, tx_bit, tx_position, tx_byte, tx_low);

        // Line to bytes.
        self.at_start.next = self.position.q.val() == self.start.val();
        self.receiver.rx.next = self.rx.val();
        self.receiver.enable.next = !self.replying.q.val() & !self.waiting.q.val() & !self.calling.q.val();
        self.rx_check.clear.next = self.receiver.start.val() & self.at_start.val();
        self.rx_check.shift.next = self.receiver.data_bit.val();
        self.rx_check.line.next = self.receiver.level.val();
        self.byte_done.next = self.receiver.byte_done.val();
        self.heard.next = self.receiver.value.val();

        // Bytes to a frame.
        self.reads.next = self.at_start.val() & (self.heard.val() == self.read_letter.val());
        self.writes.next = self.at_start.val() & (self.heard.val() == self.write_letter.val());
        self.good.next = (self.rx_check.state.val() == self.no_byte.val())
            & (self.address.q.val().get_bits::<2>(14) == self.no_high.val());
        self.frame_done.next = self.byte_done.val()
            & ((self.is_write.q.val() & (self.position.q.val() == self.at_crc_of_write.val()))
                | (!self.is_write.q.val() & (self.position.q.val() == self.at_crc_of_read.val())));
        if self.byte_done.val() {
            if self.at_start.val() {
                self.is_write.d.next = self.writes.val();
                if self.reads.val() | self.writes.val() {
                    self.position.d.next = self.one_position.val();
                }
            } else {
                self.position.d.next = self.position.q.val() + self.one_position.val();
                if self.frame_done.val() {
                    self.position.d.next = self.start.val();
                } else if self.position.q.val() < self.at_crc_of_read.val() {
                    self.address.d.next = (self.address.q.val() >> 8) | (bit_cast::<16, 8>(self.heard.val()) << 8);
                } else {
                    self.data.d.next = (self.data.q.val() >> 8) | (bit_cast::<32, 8>(self.heard.val()) << 24);
                }
            }
        }
        self.silence.d.next = self.silence.q.val() + self.one_silence.val();
        if self.receiver.hearing.val() | self.at_start.val() {
            self.silence.d.next = self.no_silence.val();
        }
        if self.silence.q.val() == self.silent.val() {
            self.position.d.next = self.start.val();
        }

        // A frame to a cycle of the bus.
        self.calling.d.next = self.frame_done.val() & self.good.val();
        self.ads_n.next = !self.calling.q.val();
        self.blast_n.next = !self.waiting.q.val();
        self.lw_r.next = self.is_write.q.val();
        self.to_core.next = self.data.q.val();
        if self.calling.q.val() {
            self.to_core.next = bit_cast::<32, 16>(self.address.q.val()) << 2;
            self.waiting.d.next = true;
        }
        if self.waiting.q.val() & !self.ready_n.val() {
            self.waiting.d.next = false;
            if !self.is_write.q.val() {
                self.data.d.next = self.from_core.val();
            }
        }

        // The reply.
        self.tx_tick.next = self.replying.q.val() & (self.tx_clocks.q.val() == self.no_clocks.val());
        self.tx_after.next = self.one_byte.val();
        if !self.failed.q.val() & !self.is_write.q.val() {
            self.tx_after.next = self.five_bytes.val();
        }
        self.tx_sends_crc.next = self.tx_position.q.val() == self.tx_after.val();
        self.tx_last.next = self.tx_sends_crc.val() & (self.tx_bit.q.val() == self.stop_bit.val());
        self.next_tx_byte.next = self.data.q.val().get_bits::<8>(0);
        self.following.next = self.tx_position.q.val() + self.one_position.val();
        if self.following.val() == self.tx_after.val() {
            self.next_tx_byte.next = self.tx_check.state.val();
        }
        self.tx_check.line.next = self.tx_byte.q.val().get_bit(0);
        self.tx_check.shift.next = false;
        if self.replying.q.val() {
            self.tx_clocks.d.next = self.tx_clocks.q.val() - self.one_clock.val();
        }
        if self.tx_tick.val() {
            self.tx_clocks.d.next = self.whole_bit.val();
            self.tx_bit.d.next = self.tx_bit.q.val() + self.one_bit.val();
            if self.tx_bit.q.val() == self.no_bits.val() {
                self.tx_low.d.next = true;
            } else if self.tx_bit.q.val() == self.stop_bit.val() {
                self.tx_low.d.next = false;
                self.tx_bit.d.next = self.no_bits.val();
                self.tx_position.d.next = self.following.val();
                self.tx_byte.d.next = self.next_tx_byte.val();
                self.data.d.next = self.data.q.val() >> 8;
                if self.tx_last.val() {
                    self.replying.d.next = false;
                }
            } else {
                self.tx_low.d.next = !self.tx_byte.q.val().get_bit(0);
                self.tx_byte.d.next = self.tx_byte.q.val() >> 1;
                self.tx_check.shift.next = true;
            }
        }
        self.answers.next = (self.waiting.q.val() & !self.ready_n.val()) | (self.frame_done.val() & !self.good.val());
        self.tx_check.clear.next = self.answers.val();
        if self.answers.val() {
            self.replying.d.next = true;
            self.failed.d.next = self.frame_done.val();
            self.tx_position.d.next = self.start.val();
            self.tx_bit.d.next = self.no_bits.val();
            self.tx_clocks.d.next = self.whole_bit.val();
            self.tx_byte.d.next = self.read_reply.val();
            if self.is_write.q.val() {
                self.tx_byte.d.next = self.write_reply.val();
            }
            if self.frame_done.val() {
                self.tx_byte.d.next = self.error_reply.val();
            }
        }
        self.tx.next = !self.tx_low.q.val();
    }
}
