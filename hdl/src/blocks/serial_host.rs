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

use crate::primitives::Literal;
use fixed_kin::serial_host::{CLOCKS_PER_BIT, FRAME_TIMEOUT};
use rust_hdl::prelude::*;

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

    line_1: DFF<Bit>,
    line_2: DFF<Bit>,
    hearing: DFF<Bit>,
    rx_clocks: DFF<Bits<6>>,
    rx_bit: DFF<Bits<4>>,
    rx_byte: DFF<Bits<8>>,
    rx_crc: DFF<Bits<8>>,
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
    tx_crc: DFF<Bits<8>>,
    tx_low: DFF<Bit>,

    level: Signal<Local, Bit>,
    sampling: Signal<Local, Bit>,
    byte_done: Signal<Local, Bit>,
    heard: Signal<Local, Bits<8>>,
    rx_feedback: Signal<Local, Bit>,
    next_rx_crc: Signal<Local, Bits<8>>,
    good: Signal<Local, Bit>,
    reads: Signal<Local, Bit>,
    writes: Signal<Local, Bit>,
    frame_done: Signal<Local, Bit>,
    tx_tick: Signal<Local, Bit>,
    tx_last: Signal<Local, Bit>,
    tx_sends_crc: Signal<Local, Bit>,
    tx_feedback: Signal<Local, Bit>,
    next_tx_crc: Signal<Local, Bits<8>>,
    next_tx_byte: Signal<Local, Bits<8>>,
    tx_after: Signal<Local, Bits<3>>,
    following: Signal<Local, Bits<3>>,

    half_bit: Literal<6, { CLOCKS_PER_BIT as u64 / 2 - 1 }>,
    whole_bit: Literal<6, { CLOCKS_PER_BIT as u64 - 1 }>,
    no_clocks: Literal<6, 0>,
    one_clock: Literal<6, 1>,
    no_bits: Literal<4, 0>,
    one_bit: Literal<4, 1>,
    stop_bit: Literal<4, 9>,
    no_byte: Literal<8, 0>,
    all_ones: Literal<8, 0xFF>,
    crc_taps: Literal<8, 0xE0>,
    top_bit: Literal<8, 0x80>,
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
        dff_setup!(self, clock, line_1, line_2, hearing, rx_clocks, rx_bit, rx_byte, rx_crc, silence, position);
        dff_setup!(self, clock, is_write, address, data, calling, waiting, replying, failed);
        dff_setup!(self, clock, tx_clocks, tx_bit, tx_position, tx_byte, tx_crc, tx_low);

        // Line to bits. Inverted before the first flip-flop, so that power-up is the idle line.
        self.line_1.d.next = !self.rx.val();
        self.line_2.d.next = self.line_1.q.val();
        self.level.next = !self.line_2.q.val();
        self.sampling.next = self.hearing.q.val() & (self.rx_clocks.q.val() == self.no_clocks.val());
        self.byte_done.next = self.sampling.val() & (self.rx_bit.q.val() == self.stop_bit.val()) & self.level.val();
        self.heard.next = self.rx_byte.q.val();
        self.rx_feedback.next = self.rx_crc.q.val().get_bit(0) ^ self.level.val();
        self.next_rx_crc.next = self.rx_crc.q.val() >> 1;
        if self.rx_feedback.val() {
            self.next_rx_crc.next = (self.rx_crc.q.val() >> 1) ^ self.crc_taps.val();
        }
        if self.hearing.q.val() {
            self.rx_clocks.d.next = self.rx_clocks.q.val() - self.one_clock.val();
            if self.sampling.val() {
                self.rx_clocks.d.next = self.whole_bit.val();
                self.rx_bit.d.next = self.rx_bit.q.val() + self.one_bit.val();
                if self.rx_bit.q.val() == self.no_bits.val() {
                    // A start bit that is gone in its middle was a spike.
                    self.hearing.d.next = !self.level.val();
                } else if self.rx_bit.q.val() == self.stop_bit.val() {
                    self.hearing.d.next = false;
                } else {
                    self.rx_byte.d.next = self.rx_byte.q.val() >> 1;
                    if self.level.val() {
                        self.rx_byte.d.next = (self.rx_byte.q.val() >> 1) | self.top_bit.val();
                    }
                    self.rx_crc.d.next = self.next_rx_crc.val();
                }
            }
        } else if !self.level.val() & !self.replying.q.val() & !self.waiting.q.val() & !self.calling.q.val() {
            self.hearing.d.next = true;
            self.rx_clocks.d.next = self.half_bit.val();
            self.rx_bit.d.next = self.no_bits.val();
            if self.position.q.val() == self.start.val() {
                self.rx_crc.d.next = self.all_ones.val();
            }
        }

        // Bytes to a frame.
        self.reads.next = (self.position.q.val() == self.start.val()) & (self.heard.val() == self.read_letter.val());
        self.writes.next = (self.position.q.val() == self.start.val()) & (self.heard.val() == self.write_letter.val());
        self.good.next = (self.rx_crc.q.val() == self.no_byte.val())
            & (self.address.q.val().get_bits::<2>(14) == self.no_high.val());
        self.frame_done.next = self.byte_done.val()
            & ((self.is_write.q.val() & (self.position.q.val() == self.at_crc_of_write.val()))
                | (!self.is_write.q.val() & (self.position.q.val() == self.at_crc_of_read.val())));
        if self.byte_done.val() {
            if self.position.q.val() == self.start.val() {
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
        if self.hearing.q.val() | (self.position.q.val() == self.start.val()) {
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
        self.tx_feedback.next = self.tx_crc.q.val().get_bit(0) ^ self.tx_byte.q.val().get_bit(0);
        self.next_tx_crc.next = self.tx_crc.q.val() >> 1;
        if self.tx_feedback.val() {
            self.next_tx_crc.next = (self.tx_crc.q.val() >> 1) ^ self.crc_taps.val();
        }
        self.next_tx_byte.next = self.data.q.val().get_bits::<8>(0);
        self.following.next = self.tx_position.q.val() + self.one_position.val();
        if self.following.val() == self.tx_after.val() {
            self.next_tx_byte.next = self.tx_crc.q.val();
        }
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
                self.tx_crc.d.next = self.next_tx_crc.val();
            }
        }
        if (self.waiting.q.val() & !self.ready_n.val()) | (self.frame_done.val() & !self.good.val()) {
            self.replying.d.next = true;
            self.failed.d.next = self.frame_done.val();
            self.tx_position.d.next = self.start.val();
            self.tx_bit.d.next = self.no_bits.val();
            self.tx_clocks.d.next = self.whole_bit.val();
            self.tx_crc.d.next = self.all_ones.val();
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
