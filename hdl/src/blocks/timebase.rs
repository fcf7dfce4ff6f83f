//! Time, control ticks and microseconds.
//!
//! `clock_count` counts clocks. `tick` comes every `tick_period` clocks, or `MIN_TICK_PERIOD` if that is
//! longer; a new period starts with `restart`. `microsecond` comes every `clocks_per_microsecond`
//! clocks; 0 and 1 mean every clock.

use crate::primitives::Literal;
use fixed_kin::registers::MIN_TICK_PERIOD;
use rust_hdl::prelude::*;

/// See the module.
#[derive(LogicBlock, Default)]
pub struct Timebase {
    /// Clock.
    pub clock: Signal<In, Clock>,
    /// Control period in clocks.
    pub tick_period: Signal<In, Bits<24>>,
    /// The period is written: start it anew.
    pub restart: Signal<In, Bit>,
    /// Clocks in a microsecond.
    pub clocks_per_microsecond: Signal<In, Bits<6>>,
    /// Clocks since power-up.
    pub clock_count: Signal<Out, Bits<32>>,
    /// The period in force.
    pub period: Signal<Out, Bits<24>>,
    /// A control tick.
    pub tick: Signal<Out, Bit>,
    /// A microsecond.
    pub microsecond: Signal<Out, Bit>,

    clocks: DFF<Bits<32>>,
    phase: DFF<Bits<24>>,
    part: DFF<Bits<6>>,

    bounded: Signal<Local, Bits<24>>,
    next_phase: Signal<Local, Bits<24>>,
    next_part: Signal<Local, Bits<6>>,

    one: Literal<32, 1>,
    one_phase: Literal<24, 1>,
    phase_start: Literal<24, 0>,
    one_part: Literal<6, 1>,
    part_start: Literal<6, 0>,
    shortest: Literal<24, { MIN_TICK_PERIOD as u64 }>,
}

impl Logic for Timebase {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, clocks, phase, part);
        self.clocks.d.next = self.clocks.q.val() + self.one.val();
        self.clock_count.next = self.clocks.q.val();

        self.bounded.next = self.tick_period.val();
        if self.tick_period.val() < self.shortest.val() {
            self.bounded.next = self.shortest.val();
        }
        self.period.next = self.bounded.val();
        self.next_phase.next = self.phase.q.val() + self.one_phase.val();
        self.phase.d.next = self.next_phase.val();
        self.tick.next = false;
        if self.restart.val() {
            self.phase.d.next = self.phase_start.val();
        } else if self.next_phase.val() >= self.bounded.val() {
            self.phase.d.next = self.phase_start.val();
            self.tick.next = true;
        }

        self.next_part.next = self.part.q.val() + self.one_part.val();
        self.part.d.next = self.next_part.val();
        self.microsecond.next = false;
        if self.next_part.val() >= self.clocks_per_microsecond.val() {
            self.part.d.next = self.part_start.val();
            self.microsecond.next = true;
        }
    }
}
