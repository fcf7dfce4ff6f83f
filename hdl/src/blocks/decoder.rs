//! Where an access of the bus goes: from the word address, a clock later, and the banks.
//!
//! | page (byte offset) | to | words |
//! |---|---|---|
//! | 000 | register file | 64 |
//! | 400, 500 | configuration: staged bank, bank in force | 52 |
//! | 600, 640 | set points: staged bank, bank in force | 4 |
//! | 770, 790 | index positions, integrators | 4 |
//! | 800 | snapshot: bank the reader holds; the last 8 stand in the reader of the inertial sensor | 24, 8 |
//!
//! Anything else is reserved: reads zero, writes nothing.

use crate::blocks::snapshot_address::SnapshotAddress;
use crate::primitives::Literal;
use fixed_kin::AXES;
use fixed_kin::control::{CONFIGURATION_WORDS, SET_POINT_WORDS};
use fixed_kin::registers::{
    ACTIVE_CONFIGURATION, ACTIVE_SET_POINTS, CONFIGURATION, INDEX_POSITION, INTEGRALS, Register, SET_POINTS,
    SNAPSHOT_IMU, SNAPSHOT_SEQUENCE, SNAPSHOT_SEQUENCE_END, SNAPSHOT_WORDS,
};
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// Page of 64 words that a register stands in.
const fn page(register: &Register) -> u64 {
    (register.offset / 256) as u64
}

/// Word inside its page.
const fn index(register: &Register) -> u64 {
    (register.offset / 4 % 64) as u64
}

/// See the module.
#[derive(LogicBlock, Default)]
pub struct Decoder {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// Word address; what follows from it is there in the next clock, and means that clock's banks.
    pub address: Signal<In, Bits<14>>,
    /// The bus reads the address in this clock.
    pub read: Signal<In, Bit>,
    /// Bank of the configuration in force.
    pub configuration_bank: Signal<In, Bit>,
    /// Bank of the set points in force.
    pub set_point_bank: Signal<In, Bit>,
    /// Bank of the snapshot to read.
    pub snapshot_bank: Signal<In, Bits<2>>,
    /// `address` is in the register file, in the same clock.
    pub at_registers: Signal<Out, Bit>,
    /// In the register file.
    pub in_registers: Signal<Out, Bit>,
    /// In the memory, at `memory_address`.
    pub in_memory: Signal<Out, Bit>,
    /// A word of the inertial sensor.
    pub in_imu: Signal<Out, Bit>,
    /// Address in the sequencer's memory.
    pub memory_address: Signal<Out, Bits<8>>,
    /// The same of a word that a write would stage, with less in its way; anything where none would.
    pub staging_address: Signal<Out, Bits<8>>,
    /// A write would stage a set point.
    pub stages_set_point: Signal<Out, Bit>,
    /// A write would stage a word of the configuration.
    pub stages_configuration: Signal<Out, Bit>,
    /// Word address, less its page.
    pub word: Signal<Out, Bits<6>>,
    /// The same with the page, of a word that a write would stage; anything where none would.
    pub staging_word: Signal<Out, Bits<14>>,
    /// First word of the snapshot is read.
    pub snapshot_first: Signal<Out, Bit>,
    /// Last word of the snapshot is read.
    pub snapshot_last: Signal<Out, Bit>,

    // The pages, one flip-flop each.
    registers: DFF<Bit>,
    configuration: DFF<Bit>,
    active: DFF<Bit>,
    set_points: DFF<Bit>,
    state: DFF<Bit>,
    snapshot: DFF<Bit>,
    offset: DFF<Bits<6>>,
    reads_first: DFF<Bit>,
    reads_last: DFF<Bit>,

    page: Signal<Local, Bits<8>>,
    coming: Signal<Local, Bits<6>>,
    index: Signal<Local, Bits<6>>,
    wide: Signal<Local, Bits<8>>,
    set_point: Signal<Local, Bits<8>>,
    staged_set_point: Signal<Local, Bits<8>>,
    staged_configuration: Signal<Local, Bits<8>>,
    base: Signal<Local, Bits<8>>,
    bank: Signal<Local, Bits<8>>,

    place: SnapshotAddress,

    no_bank: Literal<8, 0>,
    configuration_1: Literal<8, 0x40>,
    at_set_points: Literal<8, 0x80>,
    set_points_1: Literal<8, 0x08>,
    page_registers: Literal<8, 0>,
    page_configuration: Literal<8, { page(&CONFIGURATION) }>,
    page_active: Literal<8, { page(&ACTIVE_CONFIGURATION) }>,
    page_set_points: Literal<8, { page(&SET_POINTS) }>,
    page_state: Literal<8, { page(&INTEGRALS) }>,
    page_snapshot: Literal<8, { page(&SNAPSHOT_SEQUENCE) }>,
    at_page_configuration: Literal<14, { page(&CONFIGURATION) << 6 }>,
    at_page_set_points: Literal<14, { page(&SET_POINTS) << 6 }>,
    configuration_end: Literal<6, { CONFIGURATION_WORDS as u64 }>,
    set_points_end: Literal<6, { SET_POINT_WORDS as u64 }>,
    active_start: Literal<6, { index(&ACTIVE_SET_POINTS) }>,
    active_end: Literal<6, { index(&ACTIVE_SET_POINTS) + SET_POINT_WORDS as u64 }>,
    index_start: Literal<6, { index(&INDEX_POSITION) }>,
    index_end: Literal<6, { index(&INDEX_POSITION) + AXES as u64 }>,
    integrals_start: Literal<6, { index(&INTEGRALS) }>,
    integrals_end: Literal<6, { index(&INTEGRALS) + AXES as u64 }>,
    snapshot_end: Literal<6, { SNAPSHOT_WORDS as u64 }>,
    first: Literal<6, 0>,
    imu_row: Literal<3, { index(&SNAPSHOT_IMU) / 8 }>,
    last: Literal<6, { index(&SNAPSHOT_SEQUENCE_END) }>,
}

impl Logic for Decoder {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(
            self,
            clock,
            registers,
            configuration,
            active,
            set_points,
            state,
            snapshot,
            offset,
            reads_first,
            reads_last
        );
        self.page.next = self.address.val().get_bits::<8>(6);
        self.coming.next = self.address.val().get_bits::<6>(0);
        self.at_registers.next = self.page.val() == self.page_registers.val();
        self.registers.d.next = self.page.val() == self.page_registers.val();
        self.configuration.d.next = self.page.val() == self.page_configuration.val();
        self.active.d.next = self.page.val() == self.page_active.val();
        self.set_points.d.next = self.page.val() == self.page_set_points.val();
        self.state.d.next = self.page.val() == self.page_state.val();
        self.snapshot.d.next = self.page.val() == self.page_snapshot.val();
        self.offset.d.next = self.coming.val();
        self.reads_first.d.next =
            self.read.val() & (self.page.val() == self.page_snapshot.val()) & (self.coming.val() == self.first.val());
        self.reads_last.d.next =
            self.read.val() & (self.page.val() == self.page_snapshot.val()) & (self.coming.val() == self.last.val());

        self.index.next = self.offset.q.val();
        self.word.next = self.index.val();
        self.wide.next = bit_cast::<8, 6>(self.index.val());
        self.place.word.next = self.index.val().get_bits::<5>(0);
        self.place.bank.next = self.snapshot_bank.val();
        self.set_point.next = bit_cast::<8, 2>(self.index.val().get_bits::<2>(0)) | self.at_set_points.val();

        self.in_registers.next = self.registers.q.val();
        self.in_memory.next = false;
        self.in_imu.next = false;
        self.stages_set_point.next = false;
        self.stages_configuration.next = false;
        self.snapshot_first.next = self.reads_first.q.val();
        self.snapshot_last.next = self.reads_last.q.val();
        self.bank.next = self.no_bank.val();
        self.base.next = self.wide.val();
        if self.configuration.q.val() {
            self.in_memory.next = self.index.val() < self.configuration_end.val();
            self.stages_configuration.next = self.index.val() < self.configuration_end.val();
            if !self.configuration_bank.val() {
                self.bank.next = self.configuration_1.val();
            }
        }
        if self.active.q.val() {
            self.in_memory.next = self.index.val() < self.configuration_end.val();
            if self.configuration_bank.val() {
                self.bank.next = self.configuration_1.val();
            }
        }
        if self.set_points.q.val() {
            self.base.next = self.set_point.val();
            if self.index.val() < self.set_points_end.val() {
                self.in_memory.next = true;
                self.stages_set_point.next = true;
                if !self.set_point_bank.val() {
                    self.bank.next = self.set_points_1.val();
                }
            } else {
                self.in_memory.next =
                    (self.index.val() >= self.active_start.val()) & (self.index.val() < self.active_end.val());
                if self.set_point_bank.val() {
                    self.bank.next = self.set_points_1.val();
                }
            }
        }
        if self.state.q.val() {
            self.in_memory.next = ((self.index.val() >= self.integrals_start.val())
                & (self.index.val() < self.integrals_end.val()))
                | ((self.index.val() >= self.index_start.val()) & (self.index.val() < self.index_end.val()));
            self.base.next = self.wide.val() | self.at_set_points.val();
        }
        if self.snapshot.q.val() {
            self.in_memory.next = self.index.val() < self.snapshot_end.val();
            self.in_imu.next = self.index.val().get_bits::<3>(3) == self.imu_row.val();
            self.base.next = self.place.address.val();
        }
        self.memory_address.next = self.base.val() | self.bank.val();

        self.staged_set_point.next = self.set_point.val();
        if !self.set_point_bank.val() {
            self.staged_set_point.next = self.set_point.val() | self.set_points_1.val();
        }
        self.staged_configuration.next = self.wide.val();
        if !self.configuration_bank.val() {
            self.staged_configuration.next = self.wide.val() | self.configuration_1.val();
        }
        self.staging_address.next = self.staged_configuration.val();
        self.staging_word.next = bit_cast::<14, 6>(self.index.val()) | self.at_page_configuration.val();
        if self.set_points.q.val() {
            self.staging_address.next = self.staged_set_point.val();
            self.staging_word.next = bit_cast::<14, 6>(self.index.val()) | self.at_page_set_points.val();
        }
    }
}
