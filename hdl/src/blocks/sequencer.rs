//! The sequencer: runs the program of `hdl::program` once per control tick.
//!
//! ```text
//!   fetch                read                 execute                 finish
//!   ┌─────────┐ instr  ┌────────┐   word    ┌──────────────┐ total ┌──────────┐
//!   │ program │──────► │ memory │ ────────► │ acc ± word   │─────► │ saturate │──► acc
//!   └─────────┘        │ inputs │ ─┐        │ × ÷ (serial) │       │ store    │──► memory
//!     ▲ pc             └────────┘  └──────► │ load ► acc   │       └──────────┘
//!                        ▲ address          └──────────────┘
//! ```
//!
//! One instruction a clock; a taken branch kills the instruction after it. With every instruction the program
//! memory holds the input port of the one behind it, so that a flip-flop chooses the input. A sum stands in `total` after its
//! clock and in the accumulator one clock later, saturated or cut; a store writes in its second clock what the
//! accumulator then holds. What this asks of a program, its assembler knows. Multiplication and division
//! run beside the program, until their result is asked for; the program takes every product before it
//! starts the next. A second copy of the memory, written together with the first, serves the bus,
//! which may also write where the program does not write in the same clock. A bus that reads a word in the
//! clock in which it is written gets the new one; the program never does that, which its assembler checks.
//!
//! `tick` starts the program and is ignored while it runs; `done` is high in the clock of its last
//! instruction.

use crate::blocks::divider::Divider;
use crate::blocks::multiplier::Multiplier;
use crate::blocks::snapshot_address::SnapshotAddress;
use crate::primitives::{Literal, Memory, Rom};
use crate::program;
use fixed_kin::AXES;
use fixed_kin::word::{WORD_MAX, WORD_MIN};
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// See the module.
#[derive(LogicBlock, Default)]
pub struct Sequencer {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// Start of a control tick.
    pub tick: Signal<In, Bit>,
    /// The program is at work.
    pub running: Signal<Out, Bit>,
    /// Last instruction of the program.
    pub done: Signal<Out, Bit>,
    /// Bank of the configuration in force.
    pub configuration_bank: Signal<In, Bit>,
    /// Bank of the set points in force.
    pub set_point_bank: Signal<In, Bit>,
    /// Bank the snapshot is written to, 0 to 2.
    pub snapshot_bank: Signal<In, Bits<2>>,

    /// Input port that the instruction being read may ask for, an `InputPort`.
    pub input_port: Signal<Out, Bits<5>>,
    /// The axis the program is at.
    pub axis: Signal<Out, Bits<2>>,
    /// What stands at that port, in the same clock.
    pub input_data: Signal<In, Bits<32>>,
    /// The program writes an output port.
    pub output_strobe: Signal<Out, Bit>,
    /// Which one, an `OutputPort`.
    pub output_port: Signal<Out, Bits<2>>,
    /// The word for the port.
    pub output_data: Signal<Out, Bits<32>>,

    /// Memory address that the bus reads, banks included.
    pub bus_address: Signal<In, Bits<8>>,
    /// What stands there after the last clock.
    pub bus_read_data: Signal<Out, Bits<32>>,
    /// Memory address that the bus writes, banks included.
    pub bus_write_address: Signal<In, Bits<8>>,
    /// High for the one clock in which the bus writes to that address.
    pub bus_write: Signal<In, Bit>,
    /// What it writes.
    pub bus_write_data: Signal<In, Bits<32>>,
    /// The bus may not write in the next clock.
    pub bus_blocked: Signal<Out, Bit>,

    rom: Rom<24, 9>,
    memory: Memory<32, 8>,
    mirror: Memory<32, 8>,
    multiplier: Multiplier,
    divider: Divider,
    place: SnapshotAddress,

    active: DFF<Bit>,
    pc: DFF<Bits<9>>,
    instruction: DFF<Bits<16>>,
    port: DFF<Bits<5>>,
    nothing: DFF<Bit>,
    subtracts: DFF<Bit>,
    waits_for_quotient: DFF<Bit>,
    waits_for_product: DFF<Bit>,
    halts: DFF<Bit>,
    stores: DFF<Bit>,
    jumps: DFF<Bit>,
    jumps_by_zero: DFF<Bit>,
    jumps_by_bit: DFF<Bit>,
    jumps_by_sign: DFF<Bit>,
    jumps_by_axis: DFF<Bit>,
    jumps_if_not: DFF<Bit>,
    input_word: DFF<Bits<32>>,
    total: DFF<Bits<32>>,
    total_negated: DFF<Bit>,
    finishing: DFF<Bit>,
    saturates: DFF<Bit>,
    cuts_16: DFF<Bit>,
    cuts_24: DFF<Bit>,
    storing: DFF<Bit>,
    store_address: DFF<Bits<8>>,
    valid: DFF<Bit>,
    accumulator: DFF<Bits<32>>,
    axis_number: DFF<Bits<2>>,

    pc_next: Signal<Local, Bits<9>>,
    goes_on: Signal<Local, Bit>,
    read_stores: Signal<Local, Bit>,
    stall: Signal<Local, Bit>,
    branch: Signal<Local, Bit>,
    read_instruction: Signal<Local, Bits<16>>,
    read_op: Signal<Local, Bits<5>>,
    read_subtracts: Signal<Local, Bit>,
    read_jumps: Signal<Local, Bit>,
    read_waits_for_quotient: Signal<Local, Bit>,
    read_waits_for_product: Signal<Local, Bit>,
    read_halts: Signal<Local, Bit>,
    read_jumps_by_zero: Signal<Local, Bit>,
    read_jumps_by_bit: Signal<Local, Bit>,
    read_jumps_by_sign: Signal<Local, Bit>,
    read_jumps_by_axis: Signal<Local, Bit>,
    read_jumps_if_not: Signal<Local, Bit>,
    read_address: Signal<Local, Bits<8>>,
    read_bank: Signal<Local, Bits<8>>,
    write_address: Signal<Local, Bits<8>>,
    bus_hits: DFF<Bit>,
    bus_written: DFF<Bits<32>>,
    op: Signal<Local, Bits<5>>,
    word: Signal<Local, Bits<32>>,
    subtracting: Signal<Local, Bit>,
    left: Signal<Local, Bits<32>>,
    sum: Signal<Local, Bits<32>>,
    sum_top: Signal<Local, Bits<3>>,
    saturated: Signal<Local, Bits<32>>,
    low_16: Signal<Local, Bits<32>>,
    immediate: Signal<Local, Bits<32>>,

    zero: Literal<32, 0>,
    one_pc: Literal<9, 1>,
    no_bank: Literal<8, 0>,
    first_axis: Literal<2, 0>,
    last_axis: Literal<2, { AXES as u64 - 1 }>,
    one_axis: Literal<2, 1>,
    word_max: Literal<32, { WORD_MAX as u64 }>,
    word_min: Literal<32, { WORD_MIN as u32 as u64 }>,
    three_clear: Literal<3, 0>,
    three_set: Literal<3, 7>,
    mask_24: Literal<32, 0xFF_FFFF>,
    sign_of_16: Literal<32, 0xFFFF_0000>,
    sign_of_8: Literal<32, 0xFFFF_FF00>,
    configuration_region: Literal<8, 0x40>,
    set_point_region: Literal<8, 0x08>,
    region_0: Literal<2, 0>,
    region_set_points: Literal<5, 0x10>,
    region_3: Literal<2, 3>,
}

impl Sequencer {
    /// A sequencer with this program; the memory starts with the program's constants.
    #[must_use]
    pub fn new(program: &[u16]) -> Self {
        let port = |at: usize| program.get(at).map_or(0, |word| u32::from(*word & 0x1F));
        let words: Vec<u32> =
            program.iter().enumerate().map(|(at, word)| port(at + 1) << 16 | u32::from(*word)).collect();
        let initial = program::layout::initial_memory();
        Self { rom: Rom::new(&words), memory: Memory::new(&initial), mirror: Memory::new(&initial), ..Self::default() }
    }
}

impl Logic for Sequencer {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, active, pc, instruction, subtracts, valid, accumulator, axis_number);
        dff_setup!(self, clock, port, nothing, waits_for_quotient, waits_for_product, halts, stores);
        dff_setup!(self, clock, jumps, jumps_by_zero, jumps_by_bit, jumps_by_sign, jumps_by_axis, jumps_if_not);
        dff_setup!(self, clock, bus_hits, bus_written, input_word, total, total_negated);
        dff_setup!(self, clock, finishing, saturates, cuts_16, cuts_24, storing, store_address);
        clock!(self, clock, rom, memory, mirror, multiplier, divider);

        // Read stage: the instruction at pc, its word is there one clock later.
        self.read_instruction.next = self.rom.read_data.val().get_bits::<16>(0);
        self.read_address.next = self.read_instruction.val().get_bits::<8>(0);
        if self.read_instruction.val().get_bit(10) {
            self.read_address.next =
                self.read_instruction.val().get_bits::<8>(0) | bit_cast::<8, 2>(self.axis_number.q.val());
        }
        self.read_bank.next = self.no_bank.val();
        if self.configuration_bank.val() & (self.read_address.val().get_bits::<2>(6) == self.region_0.val()) {
            self.read_bank.next = self.configuration_region.val();
        }
        if self.set_point_bank.val() & (self.read_address.val().get_bits::<5>(3) == self.region_set_points.val()) {
            self.read_bank.next = self.set_point_region.val();
        }
        self.memory.read_address.next = self.read_address.val() | self.read_bank.val();

        // Execute stage.
        self.op.next = self.instruction.q.val().get_bits::<5>(11);
        self.word.next = self.memory.read_data.val();
        self.finishing.d.next = false;
        self.saturates.d.next = false;
        self.cuts_16.d.next = false;
        self.cuts_24.d.next = false;
        self.stall.next = (self.waits_for_quotient.q.val() & self.divider.busy.val())
            | (self.waits_for_product.q.val() & self.multiplier.busy.val());
        self.done.next = self.halts.q.val();
        self.output_strobe.next = false;
        self.multiplier.start.next = false;
        self.divider.start.next = false;
        // Decoded a clock ahead, so that it does not stand before the carry chain, nor before the next address.
        self.read_op.next = self.read_instruction.val().get_bits::<5>(11);
        self.read_subtracts.next = false;
        self.read_jumps.next = false;
        self.read_jumps_by_zero.next = false;
        self.read_jumps_by_bit.next = false;
        self.read_waits_for_quotient.next = false;
        self.read_waits_for_product.next = false;
        self.read_halts.next = false;
        self.read_stores.next = false;
        self.read_jumps_by_sign.next = false;
        self.read_jumps_by_axis.next = false;
        self.read_jumps_if_not.next = false;
        match self.read_op.val().index() {
            4 => {
                self.read_subtracts.next = true;
            } // Subtract
            6 => {
                self.read_subtracts.next = true;
            } // Subtract16
            7 => {
                self.read_subtracts.next = true;
            } // Subtract24
            8 => {
                self.read_subtracts.next = true;
            } // Compare
            11 => {
                self.read_stores.next = true;
            } // Store
            14 => {
                self.read_jumps.next = true;
            } // Jump
            15 => {
                self.read_jumps_by_zero.next = true;
            } // JumpZero
            16 => {
                self.read_jumps_by_bit.next = true;
            } // JumpClear
            17 => {
                self.read_jumps_by_sign.next = true;
            } // JumpNegative
            18 => {
                self.read_jumps_by_sign.next = true;
                self.read_jumps_if_not.next = true;
            } // JumpNotNegative
            19 => {
                self.read_jumps_by_axis.next = true;
            } // NextAxis
            20 => {
                self.read_halts.next = true;
            } // Halt
            22 => {
                self.read_waits_for_quotient.next = true;
            } // Quotient
            23 => {
                self.read_waits_for_product.next = true;
            } // Product
            _ => {
                self.read_subtracts.next = false;
            }
        }
        // Seen a clock late: the accumulator must have stood for as long.
        self.nothing.d.next = self.accumulator.q.val() == self.zero.val();
        self.branch.next = self.jumps.q.val()
            | (self.jumps_by_zero.q.val() & self.nothing.q.val())
            | (self.jumps_by_bit.q.val() & !self.accumulator.q.val().get_bit(0))
            | (self.jumps_by_sign.q.val() & (self.accumulator.q.val().get_bit(31) != self.jumps_if_not.q.val()))
            | (self.jumps_by_axis.q.val() & (self.axis_number.q.val() != self.last_axis.val()));
        self.subtracting.next = self.subtracts.q.val();
        // a − b = ¬(¬a + b): both ways share one carry chain, with no second one to negate b.
        self.left.next = self.accumulator.q.val();
        if self.subtracting.val() {
            self.left.next = !self.accumulator.q.val();
        }
        self.total.d.next = self.left.val() + self.word.val();
        self.total_negated.d.next = self.subtracting.val();
        self.input_word.d.next = self.input_data.val();

        // Finish stage: the sum of the clock before.
        self.sum.next = self.total.q.val();
        if self.total_negated.q.val() {
            self.sum.next = !self.total.q.val();
        }
        self.sum_top.next = self.sum.val().get_bits::<3>(29);
        self.saturated.next = self.sum.val();
        if (self.sum_top.val() != self.three_clear.val()) & (self.sum_top.val() != self.three_set.val()) {
            self.saturated.next = self.word_max.val();
            if self.sum.val().get_bit(31) {
                self.saturated.next = self.word_min.val();
            }
        }
        self.low_16.next = bit_cast::<32, 16>(self.sum.val().get_bits::<16>(0));
        if self.sum.val().get_bit(15) {
            self.low_16.next = bit_cast::<32, 16>(self.sum.val().get_bits::<16>(0)) | self.sign_of_16.val();
        }
        self.immediate.next = bit_cast::<32, 8>(self.instruction.q.val().get_bits::<8>(0));
        if self.instruction.q.val().get_bit(7) {
            self.immediate.next = bit_cast::<32, 8>(self.instruction.q.val().get_bits::<8>(0)) | self.sign_of_8.val();
        }

        if self.finishing.q.val() {
            self.accumulator.d.next = self.sum.val();
        }
        if self.saturates.q.val() {
            self.accumulator.d.next = self.saturated.val();
        }
        if self.cuts_16.q.val() {
            self.accumulator.d.next = self.low_16.val();
        }
        if self.cuts_24.q.val() {
            self.accumulator.d.next = self.sum.val() & self.mask_24.val();
        }

        self.multiplier.a.next = self.word.val();
        self.multiplier.b.next = self.accumulator.q.val();
        self.multiplier.scale.next = self.op.val().get_bits::<3>(0);
        self.divider.numerator.next = self.accumulator.q.val();
        self.divider.denominator.next = self.word.val();

        if self.valid.q.val() {
            if self.op.val().get_bit(4) & self.op.val().get_bit(3) {
                self.multiplier.start.next = true;
            } else {
                match self.op.val().index() {
                    1 => {
                        self.accumulator.d.next = self.word.val();
                    } // Load
                    2 => {
                        self.accumulator.d.next = self.immediate.val();
                    } // Immediate
                    3 => {
                        self.saturates.d.next = true;
                    } // Add
                    4 => {
                        self.saturates.d.next = true;
                    } // Subtract
                    5 => {
                        self.finishing.d.next = true;
                    } // AddWrapping
                    6 => {
                        self.cuts_16.d.next = true;
                    } // Subtract16
                    7 => {
                        self.cuts_24.d.next = true;
                    } // Subtract24
                    9 => {
                        if self.sum.val().get_bit(31) == self.instruction.q.val().get_bit(9) {
                            self.accumulator.d.next = self.word.val();
                        }
                    } // LoadIf
                    10 => {
                        self.accumulator.d.next = self.accumulator.q.val() ^ self.word.val();
                    } // Xor
                    12 => {
                        self.accumulator.d.next = self.input_word.q.val();
                    } // Input
                    13 => {
                        self.output_strobe.next = true;
                    } // Output
                    19 => {
                        if self.axis_number.q.val() == self.last_axis.val() {
                            self.axis_number.d.next = self.first_axis.val();
                        } else {
                            self.axis_number.d.next = self.axis_number.q.val() + self.one_axis.val();
                        }
                    } // NextAxis
                    21 => {
                        self.divider.start.next = true;
                    } // Divide
                    22 => {
                        self.accumulator.d.next = self.divider.quotient.val();
                    } // Quotient
                    23 => {
                        self.accumulator.d.next = self.multiplier.result.val();
                    } // Product
                    _ => {
                        self.output_strobe.next = false;
                    } // Nop, Compare, Store, jumps, Halt
                }
            }
        }

        // Pipe control.
        if !self.stall.val() {
            self.port.d.next = self.rom.read_data.val().get_bits::<5>(16);
        }
        self.goes_on.next = self.active.q.val() & !self.stall.val();
        if self.goes_on.val() {
            self.instruction.d.next = self.read_instruction.val();
            self.subtracts.d.next = self.read_subtracts.val();
            self.jumps.d.next = self.read_jumps.val();
            self.jumps_by_zero.d.next = self.read_jumps_by_zero.val();
            self.jumps_by_bit.d.next = self.read_jumps_by_bit.val();
            self.jumps_by_sign.d.next = self.read_jumps_by_sign.val();
            self.waits_for_quotient.d.next = self.read_waits_for_quotient.val();
            self.waits_for_product.d.next = self.read_waits_for_product.val();
            self.halts.d.next = self.read_halts.val();
            self.stores.d.next = self.read_stores.val();
            self.jumps_by_axis.d.next = self.read_jumps_by_axis.val();
            self.jumps_if_not.d.next = self.read_jumps_if_not.val();
            self.valid.d.next = true;
        }
        self.pc_next.next = self.pc.q.val();
        if self.goes_on.val() {
            self.pc_next.next = self.pc.q.val() + self.one_pc.val();
        }
        // The last instruction leads to the first, where the program waits for the next tick.
        if self.branch.val() | self.done.val() {
            self.pc_next.next = self.instruction.q.val().get_bits::<9>(0);
            // What was read after it is killed.
            self.valid.d.next = false;
            self.jumps.d.next = false;
            self.jumps_by_zero.d.next = false;
            self.jumps_by_bit.d.next = false;
            self.jumps_by_sign.d.next = false;
            self.jumps_by_axis.d.next = false;
            self.waits_for_quotient.d.next = false;
            self.waits_for_product.d.next = false;
            self.halts.d.next = false;
            self.stores.d.next = false;
        }
        if self.done.val() {
            self.active.d.next = false;
        }
        if self.tick.val() & !self.active.q.val() {
            self.active.d.next = true;
        }
        self.pc.d.next = self.pc_next.val();
        self.rom.read_address.next = self.pc_next.val();
        self.running.next = self.active.q.val();

        // The write port: the program first, then the bus.
        self.write_address.next = self.instruction.q.val().get_bits::<8>(0);
        if self.instruction.q.val().get_bit(10) {
            self.write_address.next =
                self.instruction.q.val().get_bits::<8>(0) | bit_cast::<8, 2>(self.axis_number.q.val());
        }
        self.place.word.next = self.write_address.val().get_bits::<5>(0);
        self.place.bank.next = self.snapshot_bank.val();
        self.store_address.d.next = self.write_address.val();
        if self.write_address.val().get_bits::<2>(6) == self.region_3.val() {
            self.store_address.d.next = self.place.address.val();
        }
        self.memory.write_address.next = self.bus_write_address.val();
        self.memory.write_data.next = self.bus_write_data.val();
        if self.storing.q.val() {
            self.memory.write_address.next = self.store_address.q.val();
            self.memory.write_data.next = self.accumulator.q.val();
        }
        self.memory.write_enable.next = self.storing.q.val() | self.bus_write.val();
        self.mirror.write_address.next = self.memory.write_address.val();
        self.mirror.write_data.next = self.memory.write_data.val();
        self.mirror.write_enable.next = self.memory.write_enable.val();
        self.mirror.read_address.next = self.bus_address.val();
        // A block memory shows nothing certain where one port reads what the other writes.
        self.bus_hits.d.next =
            self.memory.write_enable.val() & (self.memory.write_address.val() == self.bus_address.val());
        self.bus_written.d.next = self.memory.write_data.val();
        self.bus_read_data.next = self.mirror.read_data.val();
        if self.bus_hits.q.val() {
            self.bus_read_data.next = self.bus_written.q.val();
        }
        self.storing.d.next = self.stores.q.val();
        self.bus_blocked.next = self.stores.q.val();

        self.input_port.next = self.port.q.val();
        self.axis.next = self.axis_number.q.val();
        self.output_port.next = self.instruction.q.val().get_bits::<2>(0);
        self.output_data.next = self.accumulator.q.val();
    }
}
