//! Time, control ticks and microseconds.
//!
//! `clock_count` counts clocks. `tick` comes every `tick_period` clocks, or `MIN_TICK_PERIOD` if that is
//! longer, in the clock after the period's last; a new period starts with `restart`. `microsecond` comes every `clocks_per_microsecond`
//! clocks, bounded to 25 … 34, so that no value stretches the kicker's pulse or shortens its lock-out by
//! more than the bus clock itself may (`fixed_kin::kicker::microsecond_clocks`). `window` comes with every
//! `stall_window`-th tick. Bounds are kept in registers, so that no two carry chains follow each other; all
//! counters therefore count from one. Serves `time`, `tick_period`, `clocks_per_us`, `stall_window`.

use crate::primitives::{Literal, Preset};
use fixed_kin::kicker::MICROSECOND_CLOCKS;
use fixed_kin::registers::{DEFAULT_TICK_PERIOD, MIN_TICK_PERIOD};
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// See the module.
#[derive(LogicBlock, Default)]
pub struct Timebase {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// Control period in clocks.
    pub tick_period: Signal<In, Bits<24>>,
    /// The period is written: start it anew.
    pub restart: Signal<In, Bit>,
    /// Clocks of LCLK between two microsecond strobes.
    pub clocks_per_microsecond: Signal<In, Bits<6>>,
    /// Control ticks in a window of the stall detectors.
    pub stall_window: Signal<In, Bits<16>>,
    /// Clocks since power-up.
    pub clock_count: Signal<Out, Bits<32>>,
    /// The period in force.
    pub period: Signal<Out, Bits<24>>,
    /// A control tick.
    pub tick: Signal<Out, Bit>,
    /// High for one clock every microsecond.
    pub microsecond: Signal<Out, Bit>,
    /// A window of the stall detectors ends with this tick.
    pub window: Signal<Out, Bit>,

    clocks: DFF<Bits<32>>,
    limit: Preset<24, { DEFAULT_TICK_PERIOD as u64 }>,
    phase: Preset<24, 1>,
    part_limit: Preset<6, 33>,
    part: Preset<6, 1>,
    ticks: Preset<16, 1>,
    ticking: DFF<Bit>,
    window_ends: DFF<Bit>,
    microsecond_ends: DFF<Bit>,

    tick_now: Signal<Local, Bit>,

    one: Literal<32, 1>,
    one_phase: Literal<24, 1>,
    one_part: Literal<6, 1>,
    one_tick: Literal<16, 1>,
    shortest: Literal<24, { MIN_TICK_PERIOD as u64 }>,
    shortest_part: Literal<6, { MICROSECOND_CLOCKS[0] as u64 }>,
    longest_part: Literal<6, { MICROSECOND_CLOCKS[1] as u64 }>,
}

impl Logic for Timebase {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, clocks, limit, phase, part_limit, part, ticks, ticking);
        dff_setup!(self, clock, window_ends, microsecond_ends);
        self.clocks.d.next = self.clocks.q.val() + self.one.val();
        self.clock_count.next = self.clocks.q.val();

        self.limit.d.next = self.tick_period.val();
        if self.tick_period.val() < self.shortest.val() {
            self.limit.d.next = self.shortest.val();
        }
        self.period.next = self.limit.q.val();
        self.phase.d.next = self.phase.q.val() + self.one_phase.val();
        self.tick_now.next = false;
        if self.restart.val() {
            self.phase.d.next = self.one_phase.val();
        } else if self.phase.q.val() >= self.limit.q.val() {
            self.phase.d.next = self.one_phase.val();
            self.tick_now.next = true;
        }
        // What starts much at once comes from a flip-flop.
        self.ticking.d.next = self.tick_now.val();
        self.tick.next = self.ticking.q.val();

        self.window_ends.d.next = self.tick_now.val() & (self.ticks.q.val() >= self.stall_window.val());
        if self.ticking.q.val() {
            self.ticks.d.next = self.ticks.q.val() + self.one_tick.val();
            if self.window_ends.q.val() {
                self.ticks.d.next = self.one_tick.val();
            }
        }

        self.window.next = self.window_ends.q.val();

        self.part_limit.d.next = self.clocks_per_microsecond.val();
        if self.clocks_per_microsecond.val() < self.shortest_part.val() {
            self.part_limit.d.next = self.shortest_part.val();
        }
        if self.clocks_per_microsecond.val() > self.longest_part.val() {
            self.part_limit.d.next = self.longest_part.val();
        }
        self.part.d.next = self.part.q.val() + self.one_part.val();
        self.microsecond_ends.d.next = false;
        if self.part.q.val() >= self.part_limit.q.val() {
            self.part.d.next = self.one_part.val();
            self.microsecond_ends.d.next = true;
        }
        self.microsecond.next = self.microsecond_ends.q.val();
    }
}
