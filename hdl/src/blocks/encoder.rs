//! Quadrature encoder of one axis: synchroniser, glitch filter, ×4 decoding, edge time.
//!
//! ```text
//! a ─►[sync 2]─►[filter]─┬─►[last]─┐
//!                        └─────────┤ decode ─► ±1 ─► count ──────┐
//! b ─►[sync 2]─►[filter]─┬─────────┤   │     now ─► edge time ───┤ latch at `sample`
//!                        └─►[last]─┘   └─ both changed ─► error  └─► count, edge_time, direction
//!
//! up:   AB = 00 10 11 01 00   (A leads B)        down: 00 01 11 10 00
//! ```
//!
//! Timing: the count changes `filter + 3` clocks after the edge that first samples the new level
//! (`fixed_kin::encoder::edge_delay`); one more clock and a `sample` until it is seen. Fastest
//! input: one edge per line every `filter + 1` clocks. For the first three clocks after
//! configuration the levels are taken over uncounted, so lines that idle high are no error.
//!
//! The index passes the same filter; its first rise after `arm_index` latches the count as it stands
//! then, and a `sample` later `index_event` tells the program, which keeps the position and may begin the
//! counts at zero there. Serves `encoder_error`, `encoder_lines`, `encoder_filter`, `index_arm`, `index_status`.

use crate::primitives::Literal;
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// Two-flop synchroniser and glitch filter of one pin.
///
/// `value` follows the synchronised pin after `limit + 1` consecutive ticks at which it differs.
#[derive(LogicBlock, Default)]
pub struct GlitchFilter {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// Asynchronous input.
    pub pin: Signal<In, Bit>,
    /// Counts only at these clocks; an equal clock starts anew at any time.
    pub tick: Signal<In, Bit>,
    /// Filter length less one.
    pub limit: Signal<In, Bits<4>>,
    /// Takes the synchronised level over unfiltered.
    pub load: Signal<In, Bit>,
    /// Level behind the synchroniser.
    pub synchronised: Signal<Out, Bit>,
    /// Filtered level.
    pub value: Signal<Out, Bit>,
    first: DFF<Bit>,
    second: DFF<Bit>,
    run: DFF<Bits<4>>,
    filtered: DFF<Bit>,
    differs: Signal<Local, Bit>,
    zero: Literal<4, 0>,
    one: Literal<4, 1>,
}

impl Logic for GlitchFilter {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, first, second, run, filtered);
        self.first.d.next = self.pin.val();
        self.second.d.next = self.first.q.val();
        self.differs.next = self.second.q.val() ^ self.filtered.q.val();
        if self.differs.val() & self.tick.val() {
            self.run.d.next = self.run.q.val() + self.one.val();
            if self.run.q.val() >= self.limit.val() {
                self.run.d.next = self.zero.val();
                self.filtered.d.next = self.second.q.val();
            }
        }
        if !self.differs.val() {
            self.run.d.next = self.zero.val();
        }
        if self.load.val() {
            self.run.d.next = self.zero.val();
            self.filtered.d.next = self.second.q.val();
        }
        self.synchronised.next = self.second.q.val();
        self.value.next = self.filtered.q.val();
    }
}

/// The encoder block; see the head of this file.
#[derive(LogicBlock, Default)]
pub struct Encoder {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// Raw line A.
    pub a: Signal<In, Bit>,
    /// Raw line B.
    pub b: Signal<In, Bit>,
    /// Filter length: a line changes after `filter + 1` equal clocks.
    pub filter: Signal<In, Bits<4>>,
    /// Control tick: latches count, edge time and direction.
    pub sample: Signal<In, Bit>,
    /// Free-running time in clocks.
    pub now: Signal<In, Bits<24>>,
    /// Clears the sticky error, unless a new one comes at the same clock.
    pub clear_error: Signal<In, Bit>,
    /// Raw index line.
    pub index: Signal<In, Bit>,
    /// Strobe: the next rise of the index is to be captured.
    pub arm_index: Signal<In, Bit>,
    /// Count at the last sample, wrapping.
    pub count: Signal<Out, Bits<16>>,
    /// Time of the last counted edge at the last sample.
    pub edge_time: Signal<Out, Bits<24>>,
    /// Direction of the last counted edge at the last sample, true = up.
    pub direction: Signal<Out, Bit>,
    /// Sticky: both lines changed at once.
    pub error: Signal<Out, Bit>,
    /// Filtered line A.
    pub live_a: Signal<Out, Bit>,
    /// Filtered line B.
    pub live_b: Signal<Out, Bit>,
    /// An edge is counted in this clock.
    pub step: Signal<Out, Bit>,
    /// Its direction, true = up.
    pub up: Signal<Out, Bit>,
    /// Filtered index line.
    pub live_index: Signal<Out, Bit>,
    /// Count at the last index captured before the last sample.
    pub index_count: Signal<Out, Bits<16>>,
    /// An index was captured between the last two samples.
    pub index_event: Signal<Out, Bit>,
    /// High from the request until the next index is captured.
    pub index_waiting: Signal<Out, Bit>,
    /// One was captured since the last arming.
    pub index_seen: Signal<Out, Bit>,
    line_a: GlitchFilter,
    line_b: GlitchFilter,
    line_index: GlitchFilter,
    last_index: DFF<Bit>,
    captured: DFF<Bits<16>>,
    waiting: DFF<Bit>,
    seen: DFF<Bit>,
    fresh: DFF<Bit>,
    sampled_event: DFF<Bit>,
    sampled_capture: DFF<Bits<16>>,
    captures: Signal<Local, Bit>,
    settled_0: DFF<Bit>,
    settled_1: DFF<Bit>,
    settled: DFF<Bit>,
    last_a: DFF<Bit>,
    last_b: DFF<Bit>,
    live_count: DFF<Bits<16>>,
    live_time: DFF<Bits<24>>,
    live_direction: DFF<Bit>,
    sampled_count: DFF<Bits<16>>,
    sampled_time: DFF<Bits<24>>,
    sampled_direction: DFF<Bit>,
    sticky_error: DFF<Bit>,
    change_a: Signal<Local, Bit>,
    change_b: Signal<Local, Bit>,
    counts: Signal<Local, Bit>,
    upward: Signal<Local, Bit>,
    change: Signal<Local, Bits<16>>,
    forward: Literal<16, 1>,
    backward: Literal<16, 0xFFFF>,
}

impl Logic for Encoder {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, line_a, line_b, line_index);
        dff_setup!(self, clock, last_index, captured, waiting, seen, fresh, sampled_event, sampled_capture);
        dff_setup!(self, clock, settled_0, settled_1, settled, last_a, last_b);
        dff_setup!(self, clock, live_count, live_time, live_direction);
        dff_setup!(self, clock, sampled_count, sampled_time, sampled_direction, sticky_error);

        self.settled_0.d.next = true;
        self.settled_1.d.next = self.settled_0.q.val();
        self.settled.d.next = self.settled_1.q.val();

        self.line_a.pin.next = self.a.val();
        self.line_b.pin.next = self.b.val();
        self.line_a.tick.next = true;
        self.line_b.tick.next = true;
        self.line_a.limit.next = self.filter.val();
        self.line_b.limit.next = self.filter.val();
        self.line_a.load.next = !self.settled.q.val();
        self.line_b.load.next = !self.settled.q.val();
        self.line_index.pin.next = self.index.val();
        self.line_index.tick.next = true;
        self.line_index.limit.next = self.filter.val();
        self.line_index.load.next = !self.settled.q.val();

        self.last_a.d.next = self.line_a.value.val();
        self.last_b.d.next = self.line_b.value.val();
        self.last_index.d.next = self.line_index.value.val();
        if !self.settled.q.val() {
            self.last_a.d.next = self.line_a.synchronised.val();
            self.last_b.d.next = self.line_b.synchronised.val();
            self.last_index.d.next = self.line_index.synchronised.val();
        }
        self.change_a.next = self.settled.q.val() & (self.line_a.value.val() ^ self.last_a.q.val());
        self.change_b.next = self.settled.q.val() & (self.line_b.value.val() ^ self.last_b.q.val());
        self.upward.next = self.line_a.value.val() ^ self.last_b.q.val();
        self.change.next = self.backward.val();
        if self.upward.val() {
            self.change.next = self.forward.val();
        }
        self.counts.next = self.change_a.val() ^ self.change_b.val();
        if self.counts.val() {
            self.live_count.d.next = self.live_count.q.val() + self.change.val();
            self.live_time.d.next = self.now.val();
            self.live_direction.d.next = self.upward.val();
        }

        self.captures.next =
            self.settled.q.val() & self.line_index.value.val() & !self.last_index.q.val() & self.waiting.q.val();
        if self.sample.val() {
            self.sampled_event.d.next = self.fresh.q.val();
            self.sampled_capture.d.next = self.captured.q.val();
            self.fresh.d.next = false;
        }
        if self.arm_index.val() {
            self.seen.d.next = false;
        }
        if self.captures.val() {
            self.captured.d.next = self.live_count.q.val();
            self.waiting.d.next = false;
            self.seen.d.next = true;
            self.fresh.d.next = true;
        }
        if self.arm_index.val() {
            self.waiting.d.next = true;
        }

        if self.sample.val() {
            self.sampled_count.d.next = self.live_count.q.val();
            self.sampled_time.d.next = self.live_time.q.val();
            self.sampled_direction.d.next = self.live_direction.q.val();
        }
        if self.clear_error.val() {
            self.sticky_error.d.next = false;
        }
        if self.change_a.val() & self.change_b.val() {
            self.sticky_error.d.next = true;
        }

        self.count.next = self.sampled_count.q.val();
        self.edge_time.next = self.sampled_time.q.val();
        self.direction.next = self.sampled_direction.q.val();
        self.error.next = self.sticky_error.q.val();
        self.live_a.next = self.line_a.value.val();
        self.live_b.next = self.line_b.value.val();
        self.step.next = self.counts.val();
        self.up.next = self.upward.val();
        self.live_index.next = self.line_index.value.val();
        self.index_count.next = self.sampled_capture.q.val();
        self.index_event.next = self.sampled_event.q.val();
        self.index_waiting.next = self.waiting.q.val();
        self.index_seen.next = self.seen.q.val();
    }
}
