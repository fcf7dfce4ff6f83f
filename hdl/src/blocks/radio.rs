//! Radio input: frames on a serial line in, writes to the core out, for a robot without a PC.
//!
//! ```text
//!  rx ─► receiver ─┬─► head, robot, length, sequence ─┐
//!                  ├─► CRC-32 ────────────────────────┴─► silence: all right? ─no──► dropped + 1
//!                  └─► memory, 5 bytes a write                    │ yes: accepted + 1
//!                        └───────────► word by word ◄─────────────┘
//!                                      offer, address, data ─► the core's write path, as the host's
//! ```
//!
//! Frames are those of `fixed_kin::radio`. Nothing of a frame reaches the core before all of it is here,
//! its CRC is right and a silence has followed. After anything wrong the block is deaf until the next
//! silence, so it never takes the middle of a frame for its beginning; while the core takes the words, too.
//! A sequence number must differ from the last one taken and, while armed, be ahead of it.
//!
//! Who commands is chosen by a strap, read once `STRAP_CLOCKS` after configuration: high or open = the
//! host on the bus, low = the radio; and by the register `radio`, locked while armed. Frames are counted
//! either way. Serves `radio`; the twin is `fixed_kin::radio::Radio`.

use super::crc::Crc;
use super::serial_receiver::SerialReceiver;
use crate::primitives::{Literal, Memory, Preset};
use fixed_kin::radio::{CLOCKS_PER_BIT, CRC_BYTES, CRC_RESIDUE, CRC_TAPS, GAP_BYTES, HEAD, STRAP_CLOCKS, WRITE_BYTES};
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// The radio at the rate of its line.
pub type Radio = RadioAt<{ CLOCKS_PER_BIT as u64 / 2 - 1 }, { CLOCKS_PER_BIT as u64 - 1 }>;

/// See the module; `HALF` and `WHOLE` as for the receiver.
#[derive(LogicBlock, Default)]
pub struct RadioAt<const HALF: u64, const WHOLE: u64> {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// The line, idle high.
    pub rx: Signal<In, Bit>,
    /// Strap: high or open = the host commands, low = the radio.
    pub host_select: Signal<In, Bit>,
    /// Strap: number of the robot.
    pub robot: Signal<In, Bits<4>>,
    /// Outputs may be on.
    pub armed: Signal<In, Bit>,
    /// The core takes the word that is offered.
    pub taken: Signal<In, Bit>,
    /// `radio` is written.
    pub select_write: Signal<In, Bit>,
    /// Bit 0 of the word written: 1 lets the radio command.
    pub select: Signal<In, Bit>,
    /// A word is offered to the core; holds until taken.
    pub offer: Signal<Out, Bit>,
    /// Its word address.
    pub address: Signal<Out, Bits<14>>,
    /// What is written there.
    pub data: Signal<Out, Bits<32>>,
    /// The radio commands.
    pub selected: Signal<Out, Bit>,
    /// Frames taken, wrapping.
    pub accepted: Signal<Out, Bits<8>>,
    /// Frames that did nothing, wrapping.
    pub dropped: Signal<Out, Bits<8>>,

    receiver: SerialReceiver<HALF, WHOLE>,
    check: Crc<32, { CRC_TAPS as u64 }>,
    memory: Memory<8, 9>,

    low_1: DFF<Bit>,
    low_2: DFF<Bit>,
    robot_1: DFF<Bits<4>>,
    robot_number: DFF<Bits<4>>,
    settling: DFF<Bits<4>>,
    steady: DFF<Bit>,
    commands: DFF<Bit>,

    quiet: DFF<Bits<5>>,
    listening: DFF<Bit>,
    stage: DFF<Bits<3>>,
    inner: DFF<Bits<3>>,
    count: DFF<Bits<7>>,
    total: DFF<Bits<7>>,
    number: DFF<Bits<8>>,
    last_number: Preset<8, 0xFF>,
    pointer: DFF<Bits<9>>,
    playing: DFF<Bit>,
    offering: DFF<Bit>,
    code: DFF<Bits<8>>,
    word: DFF<Bits<32>>,
    accepted_count: DFF<Bits<8>>,
    dropped_count: DFF<Bits<8>>,
    ahead: DFF<Bits<8>>,
    check_right: DFF<Bit>,

    settled: Signal<Local, Bit>,
    silent: Signal<Local, Bit>,
    boundary: Signal<Local, Bit>,
    fresh: Signal<Local, Bit>,
    whole: Signal<Local, Bit>,
    accepts: Signal<Local, Bit>,
    refuses: Signal<Local, Bit>,
    heard: Signal<Local, Bit>,
    value: Signal<Local, Bits<8>>,
    length_fits: Signal<Local, Bit>,
    last_write: Signal<Local, Bit>,
    page: Signal<Local, Bits<14>>,
    high_page: Signal<Local, Bit>,

    gap: Literal<5, { GAP_BYTES as u64 * 10 }>,
    no_quiet: Literal<5, 0>,
    one_quiet: Literal<5, 1>,
    strap_end: Literal<4, { STRAP_CLOCKS as u64 }>,
    strap_last: Literal<4, { STRAP_CLOCKS as u64 - 1 }>,
    strap_first: Literal<4, { STRAP_CLOCKS as u64 / 2 }>,
    one_strap: Literal<4, 1>,
    head: Literal<8, { HEAD as u64 }>,
    no_robot: Literal<4, 0>,
    no_byte: Literal<8, 0>,
    residue: Literal<32, { CRC_RESIDUE as u64 }>,
    at_head: Literal<3, 0>,
    at_robot: Literal<3, 1>,
    at_length: Literal<3, 2>,
    at_sequence: Literal<3, 3>,
    at_payload: Literal<3, 4>,
    at_crc: Literal<3, 5>,
    at_end: Literal<3, 6>,
    first_inner: Literal<3, 0>,
    one_inner: Literal<3, 1>,
    last_of_write: Literal<3, { WRITE_BYTES as u64 - 1 }>,
    last_of_crc: Literal<3, { CRC_BYTES as u64 - 1 }>,
    all_gathered: Literal<3, { WRITE_BYTES as u64 }>,
    one_write: Literal<7, 1>,
    first_byte: Literal<9, 0>,
    one_byte: Literal<9, 1>,
    one_frame: Literal<8, 1>,
    page_bit_0: Literal<14, 0x40>,
    page_bit_1: Literal<14, 0x80>,
    page_bit_2: Literal<14, 0x100>,
}

impl<const HALF: u64, const WHOLE: u64> Logic for RadioAt<HALF, WHOLE> {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, receiver, check, memory);
        dff_setup!(self, clock, low_1, low_2, robot_1, robot_number, settling, steady, commands);
        dff_setup!(self, clock, quiet, listening, stage, inner, count, total, number, last_number);
        dff_setup!(
            self,
            clock,
            pointer,
            playing,
            offering,
            code,
            word,
            accepted_count,
            dropped_count,
            ahead,
            check_right
        );

        // Straps. Inverted before the first flip-flop, so that power-up means "the host commands".
        self.low_1.d.next = !self.host_select.val();
        self.low_2.d.next = self.low_1.q.val();
        self.robot_1.d.next = self.robot.val();
        self.settled.next = self.settling.q.val() == self.strap_end.val();
        if !self.settled.val() {
            self.settling.d.next = self.settling.q.val() + self.one_strap.val();
            self.steady.d.next =
                self.low_2.q.val() & (self.steady.q.val() | (self.settling.q.val() == self.strap_first.val()));
            if self.settling.q.val() == self.strap_last.val() {
                self.commands.d.next = self.steady.q.val() & self.low_2.q.val();
                self.robot_number.d.next = self.robot_1.q.val();
            }
        }
        if self.select_write.val() & !self.armed.val() {
            self.commands.d.next = self.select.val();
        }

        // Bytes and silences.
        self.receiver.rx.next = self.rx.val();
        self.receiver.enable.next = true;
        self.heard.next = self.receiver.byte_done.val() & self.listening.q.val();
        self.value.next = self.receiver.value.val();
        self.silent.next = self.quiet.q.val() == self.gap.val();
        if !self.receiver.level.val() | self.receiver.hearing.val() {
            self.quiet.d.next = self.no_quiet.val();
        } else if self.receiver.bit_time.val() & !self.silent.val() {
            self.quiet.d.next = self.quiet.q.val() + self.one_quiet.val();
        }
        self.check.clear.next = self.silent.val();
        self.check.shift.next = self.receiver.data_bit.val();
        self.check.line.next = self.receiver.level.val();

        // Words to the core.
        self.memory.read_address.next = self.pointer.q.val();
        self.last_write.next = self.count.q.val() == self.total.q.val();
        if self.playing.q.val() {
            if self.offering.q.val() {
                if self.taken.val() {
                    self.offering.d.next = false;
                    self.count.d.next = self.count.q.val() + self.one_write.val();
                    self.playing.d.next = !self.last_write.val();
                }
            } else {
                if self.inner.q.val() != self.first_inner.val() {
                    self.code.d.next = self.word.q.val().get_bits::<8>(0);
                    self.word.d.next =
                        (self.word.q.val() >> 8) | (bit_cast::<32, 8>(self.memory.read_data.val()) << 24);
                }
                if self.inner.q.val() == self.all_gathered.val() {
                    self.inner.d.next = self.first_inner.val();
                    self.offering.d.next = true;
                } else {
                    self.inner.d.next = self.inner.q.val() + self.one_inner.val();
                    self.pointer.d.next = self.pointer.q.val() + self.one_byte.val();
                }
            }
        }

        // Bytes to a frame.
        self.memory.write_address.next = self.pointer.q.val();
        self.memory.write_data.next = self.value.val();
        self.memory.write_enable.next = false;
        self.length_fits.next = (self.value.val() != self.no_byte.val())
            & !self.value.val().get_bit(7)
            & !(self.value.val().get_bit(6) & self.value.val().get_bit(5));
        self.refuses.next = self.receiver.broken.val() & self.listening.q.val();
        if self.heard.val() {
            match self.stage.q.val().index() {
                0 => {
                    self.stage.d.next = self.at_robot.val();
                    self.refuses.next = self.value.val() != self.head.val();
                } // Head
                1 => {
                    self.stage.d.next = self.at_length.val();
                    if (self.value.val().get_bits::<4>(0) != self.robot_number.q.val())
                        | (self.value.val().get_bits::<4>(4) != self.no_robot.val())
                    {
                        self.stage.d.next = self.at_head.val();
                        self.listening.d.next = false;
                    }
                } // Robot
                2 => {
                    self.stage.d.next = self.at_sequence.val();
                    self.refuses.next = !self.length_fits.val();
                    self.total.d.next = self.value.val().get_bits::<7>(0);
                    self.count.d.next = self.one_write.val();
                    self.pointer.d.next = self.first_byte.val();
                    self.inner.d.next = self.first_inner.val();
                } // Length
                3 => {
                    self.stage.d.next = self.at_payload.val();
                    self.number.d.next = self.value.val();
                } // Sequence
                4 => {
                    self.memory.write_enable.next = true;
                    self.pointer.d.next = self.pointer.q.val() + self.one_byte.val();
                    self.inner.d.next = self.inner.q.val() + self.one_inner.val();
                    if self.inner.q.val() == self.last_of_write.val() {
                        self.inner.d.next = self.first_inner.val();
                        self.count.d.next = self.count.q.val() + self.one_write.val();
                        if self.last_write.val() {
                            self.stage.d.next = self.at_crc.val();
                        }
                    }
                } // Payload
                5 => {
                    self.inner.d.next = self.inner.q.val() + self.one_inner.val();
                    if self.inner.q.val() == self.last_of_crc.val() {
                        self.stage.d.next = self.at_end.val();
                        self.inner.d.next = self.first_inner.val();
                    }
                } // Crc
                _ => {
                    self.refuses.next = true;
                } // Done
            }
        }

        // A silence: what came before it is a frame, or it is none.
        self.boundary.next = self.silent.val()
            & !self.playing.q.val()
            & (!self.listening.q.val() | (self.stage.q.val() != self.at_head.val()));
        // Number and CRC stand for longer than a silence takes: what a clock ago was said of them still holds.
        self.ahead.d.next = self.number.q.val() - self.last_number.q.val();
        self.check_right.d.next = self.check.state.val() == self.residue.val();
        self.fresh.next =
            (self.ahead.q.val() != self.no_byte.val()) & !(self.armed.val() & self.ahead.q.val().get_bit(7));
        self.whole.next = (self.stage.q.val() == self.at_end.val()) & self.check_right.q.val();
        self.accepts.next = false;
        if self.boundary.val() {
            self.listening.d.next = true;
            self.stage.d.next = self.at_head.val();
            if self.listening.q.val() {
                self.accepts.next = self.whole.val() & self.fresh.val();
                self.refuses.next = !(self.whole.val() & self.fresh.val());
            }
        }
        if self.accepts.val() {
            self.accepted_count.d.next = self.accepted_count.q.val() + self.one_frame.val();
            self.last_number.d.next = self.number.q.val();
            if self.commands.q.val() {
                self.listening.d.next = false;
                self.playing.d.next = true;
                self.count.d.next = self.one_write.val();
                self.pointer.d.next = self.first_byte.val();
            }
        }
        if self.refuses.val() {
            self.dropped_count.d.next = self.dropped_count.q.val() + self.one_frame.val();
            self.stage.d.next = self.at_head.val();
            if !self.boundary.val() {
                self.listening.d.next = false;
            }
        }

        // Pages 0, 4, 6 and 7 of the map; the last one only reads.
        self.page.next = bit_cast::<14, 6>(self.code.q.val().get_bits::<6>(0));
        self.high_page.next = self.code.q.val().get_bit(6) | self.code.q.val().get_bit(7);
        self.address.next = self.page.val();
        if self.high_page.val() {
            self.address.next = self.page.val() | self.page_bit_2.val();
            if self.code.q.val().get_bit(7) {
                self.address.next = self.page.val() | self.page_bit_2.val() | self.page_bit_1.val();
                if self.code.q.val().get_bit(6) {
                    self.address.next =
                        self.page.val() | self.page_bit_2.val() | self.page_bit_1.val() | self.page_bit_0.val();
                }
            }
        }
        self.offer.next = self.offering.q.val();
        self.data.next = self.word.q.val();
        self.selected.next = self.commands.q.val();
        self.accepted.next = self.accepted_count.q.val();
        self.dropped.next = self.dropped_count.q.val();
    }
}
