//! Safety: watchdog, arm sequence, emergency stop and fault registers; drives every enable.
//!
//! ```text
//! pin ─►[invert]─►[sync 2]─►[filter 16]─► released ─┐
//! pet ─►[down counter from watchdog_timeout]─► 0? ──┤
//! encoder_, stall_, external_fault ─────────────────┴─► fault ─► disarm, stays until re-armed
//!
//! write to the arm register │ armed
//! ARM1                      │ off, sequence begins (unless a fault stands)
//! ARM2 right after ARM1     │ on if no fault stands, else off and "arm refused"
//! ARM2 otherwise            │ off and "arm refused"
//! anything else             │ off
//! ```
//!
//! A time-out that is below what the watchdog still has to count keeps from arming until it is in force, and shows
//! no fault. A fault stands as long as its cause does: the watchdog bitten, the stop pressed or open, a level of
//! `encoder_`, `stall_` or `external_fault`. What `faults` still shows of a cause that is gone keeps nothing
//! from arming, nor do the faults that only report, `commit` and `arm-refused`.
//!
//! Timing, edge of the cause included, until `armed` is low: arm register and fault levels 1,
//! watchdog `watchdog_timeout` + 1 after the last pet, emergency stop pin 19
//! (`fixed_kin::safety::EMERGENCY_STOP_CLOCKS`). Power-up is stopped, bitten and disarmed.
//! `setpoints_valid` falls at the `set_point_timeout`-th control tick without a pet, long before the
//! watchdog bites; the outputs stay armed. Serves `arm`, `faults`, `first_fault`, `watchdog_timeout`,
//! `set_point_timeout`.
//! Limits: the longest time-out is 2²⁴ − 1 clocks, 0.5 s at 33 MHz.

use super::encoder::GlitchFilter;
use crate::primitives::{Literal, Preset};
use fixed_kin::safety::{ARM_FIRST, ARM_SECOND, EMERGENCY_STOP_FILTER, Fault};
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

type FaultBit<const F: u64> = Literal<8, F>;

/// The safety block; see the head of this file. Fault bits are those of `fixed_kin::safety::Fault`.
#[derive(LogicBlock, Default)]
pub struct Safety {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// Raw pin: high or open = stop.
    pub emergency_stop: Signal<In, Bit>,
    /// Strobe: the arm register is written.
    pub arm_write: Signal<In, Bit>,
    /// What is written to it.
    pub arm_data: Signal<In, Bits<32>>,
    /// Strobe: a valid set point was committed.
    pub pet: Signal<In, Bit>,
    /// Clocks a pet lasts; 0 = always bitten. A shorter one takes effect two clocks later.
    pub watchdog_timeout: Signal<In, Bits<24>>,
    /// Level: an encoder is broken.
    pub encoder_fault: Signal<In, Bit>,
    /// Level: a driven wheel does not move.
    pub stall_fault: Signal<In, Bit>,
    /// Strobe: a commit with a wrong checksum; reported only.
    pub commit_fault: Signal<In, Bit>,
    /// Level: link loss or another block's fault.
    pub external_fault: Signal<In, Bit>,
    /// Strobe: bits to clear in both fault registers; what still stands appears again at the same clock.
    pub clear_faults: Signal<In, Bits<8>>,
    /// Strobe: a control tick.
    pub tick: Signal<In, Bit>,
    /// Control ticks a set point lasts; 0 = none at all.
    pub set_point_timeout: Signal<In, Bits<16>>,
    /// The outputs of the card may be on.
    pub armed: Signal<Out, Bit>,
    /// `armed` is low after this clock.
    pub stops: Signal<Out, Bit>,
    /// Not armed: a flip-flop for the pins alone, so that their paths are short.
    pub off: Signal<Out, Bit>,
    /// A set point has come since arming.
    pub setpoints_valid: Signal<Out, Bit>,
    /// Sticky faults.
    pub faults: Signal<Out, Bits<8>>,
    /// Those that came first and have not been cleared since.
    pub first_fault: Signal<Out, Bits<8>>,
    /// The emergency stop stands, synchronised and filtered.
    pub stopped: Signal<Out, Bit>,
    released: GlitchFilter,
    remaining: DFF<Bits<24>>,
    shortened: DFF<Bit>,
    age: DFF<Bits<16>>,
    stale: Signal<Local, Bit>,
    is_stopped: Signal<Local, Bit>,
    first_word: DFF<Bit>,
    is_armed: DFF<Bit>,
    is_off: Preset<1, 1>,
    has_setpoint: DFF<Bit>,
    sticky: DFF<Bits<8>>,
    first: DFF<Bits<8>>,
    bitten: Signal<Local, Bit>,
    standing: Signal<Local, Bit>,
    is_first_word: Signal<Local, Bit>,
    is_second_word: Signal<Local, Bit>,
    arms: Signal<Local, Bit>,
    stays_armed: Signal<Local, Bit>,
    event_watchdog: Signal<Local, Bits<8>>,
    event_stop: Signal<Local, Bits<8>>,
    event_encoder: Signal<Local, Bits<8>>,
    event_commit: Signal<Local, Bits<8>>,
    event_external: Signal<Local, Bits<8>>,
    event_refused: Signal<Local, Bits<8>>,
    event_stall: Signal<Local, Bits<8>>,
    events: Signal<Local, Bits<8>>,
    first_kept: Signal<Local, Bits<8>>,
    none: FaultBit<0>,
    watchdog_bit: FaultBit<{ Fault::Watchdog.mask() as u64 }>,
    stop_bit: FaultBit<{ Fault::EmergencyStop.mask() as u64 }>,
    encoder_bit: FaultBit<{ Fault::Encoder.mask() as u64 }>,
    commit_bit: FaultBit<{ Fault::CommitChecksum.mask() as u64 }>,
    external_bit: FaultBit<{ Fault::External.mask() as u64 }>,
    refused_bit: FaultBit<{ Fault::ArmRefused.mask() as u64 }>,
    stall_bit: FaultBit<{ Fault::Stall.mask() as u64 }>,
    arm_1: Literal<32, { ARM_FIRST as u64 }>,
    arm_2: Literal<32, { ARM_SECOND as u64 }>,
    stop_filter: Literal<4, { EMERGENCY_STOP_FILTER as u64 }>,
    one: Literal<24, 1>,
    no_ticks: Literal<16, 0>,
    one_tick: Literal<16, 1>,
}

impl Logic for Safety {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, released, is_off);
        dff_setup!(self, clock, remaining, shortened, age, first_word, is_armed, has_setpoint, sticky, first);

        // Inverted before its first flop, so that the power-up zero means "stopped".
        self.released.pin.next = !self.emergency_stop.val();
        self.released.tick.next = true;
        self.released.limit.next = self.stop_filter.val();
        self.released.load.next = false;
        self.is_stopped.next = !self.released.value.val();
        self.stopped.next = self.is_stopped.val();

        self.bitten.next = !self.remaining.q.val().any();
        if !self.bitten.val() {
            self.remaining.d.next = self.remaining.q.val() - self.one.val();
        }
        self.shortened.d.next = self.remaining.q.val() > self.watchdog_timeout.val();
        if self.pet.val() | self.shortened.q.val() {
            self.remaining.d.next = self.watchdog_timeout.val();
        }

        self.stale.next = self.age.q.val() >= self.set_point_timeout.val();
        if self.tick.val() & !self.stale.val() {
            self.age.d.next = self.age.q.val() + self.one_tick.val();
        }
        if self.pet.val() {
            self.age.d.next = self.no_ticks.val();
        }

        self.standing.next = self.bitten.val()
            | self.is_stopped.val()
            | self.encoder_fault.val()
            | self.stall_fault.val()
            | self.external_fault.val()
            | self.shortened.q.val();
        self.is_first_word.next = self.arm_data.val() == self.arm_1.val();
        self.is_second_word.next = self.arm_write.val() & (self.arm_data.val() == self.arm_2.val());
        self.arms.next = self.is_second_word.val() & self.first_word.q.val() & !self.standing.val();
        self.stays_armed.next = self.is_armed.q.val() & !self.standing.val();
        if self.arm_write.val() {
            self.first_word.d.next = self.is_first_word.val();
            self.stays_armed.next = self.arms.val();
        }
        if self.standing.val() {
            self.first_word.d.next = false;
        }
        self.is_armed.d.next = self.stays_armed.val();
        self.is_off.d.next = (!self.stays_armed.val()).into();
        self.stops.next = !self.stays_armed.val();
        self.has_setpoint.d.next = self.stays_armed.val()
            & ((self.has_setpoint.q.val() & !self.stale.val()) | (self.is_armed.q.val() & self.pet.val()));

        self.event_watchdog.next = self.none.val();
        self.event_stop.next = self.none.val();
        self.event_encoder.next = self.none.val();
        self.event_commit.next = self.none.val();
        self.event_external.next = self.none.val();
        self.event_refused.next = self.none.val();
        self.event_stall.next = self.none.val();
        if self.bitten.val() {
            self.event_watchdog.next = self.watchdog_bit.val();
        }
        if self.is_stopped.val() {
            self.event_stop.next = self.stop_bit.val();
        }
        if self.encoder_fault.val() {
            self.event_encoder.next = self.encoder_bit.val();
        }
        if self.commit_fault.val() {
            self.event_commit.next = self.commit_bit.val();
        }
        if self.external_fault.val() {
            self.event_external.next = self.external_bit.val();
        }
        if self.is_second_word.val() & !self.arms.val() {
            self.event_refused.next = self.refused_bit.val();
        }
        if self.stall_fault.val() {
            self.event_stall.next = self.stall_bit.val();
        }
        self.events.next = self.event_watchdog.val()
            | self.event_stop.val()
            | self.event_encoder.val()
            | self.event_commit.val()
            | self.event_external.val()
            | self.event_refused.val()
            | self.event_stall.val();
        self.sticky.d.next = (self.sticky.q.val() & !self.clear_faults.val()) | self.events.val();
        self.first_kept.next = self.first.q.val() & !self.clear_faults.val();
        self.first.d.next = self.first_kept.val();
        if !self.first_kept.val().any() {
            self.first.d.next = self.events.val();
        }

        self.armed.next = self.is_armed.q.val();
        self.off.next = self.is_off.q.val().any();
        self.setpoints_valid.next = self.has_setpoint.q.val();
        self.faults.next = self.sticky.q.val();
        self.first_fault.next = self.first.q.val();
    }
}
