//! Bit-true twin of the quadrature encoder block: filter, ×4 decoding, count, edge time and index.
//!
//! One [`Encoder::clock`] is one rising edge of the FPGA clock; the outputs are those that hold
//! until the next edge. Formats: count 16 bits and times 24 bits, both unsigned and wrapping, which
//! whoever extends them relies on. Nothing saturates and no input panics.
//!
//! Convention: A leads B counts up. A transition of both lines at once is illegal: it sets the
//! sticky error and does not count.
//!
//! The index line passes the same filter. Its first rise after `arm_index` latches the count as it
//! stands then; one capture an arming, so that a trembling index cannot move it.

/// Width mask of the free-running time.
pub const TIME_MASK: u32 = 0x00FF_FFFF;

/// Clocks from the edge that first samples a changed pin to the edge that changes the count.
///
/// The count therefore changes at edge n + `edge_delay`, if edge n is the first to see the new
/// level, and `edge_time` is the value of `now` at that edge: subtract the delay to get the time
/// of the pin. The pin itself changed up to one clock before edge n. The latched outputs show an
/// edge from the first `sample` after the count has changed: a change *at* the sampling edge is in
/// the next sample.
#[must_use]
pub const fn edge_delay(filter: u8) -> u32 {
    // Two synchroniser flops, filter + 1 equal clocks of which the first is the second flop's
    // successor, one clock to decode.
    (filter & 15) as u32 + 3
}

/// Clocks at power-up in which the levels of the lines are taken over without counting.
pub const SETTLING_CLOCKS: u32 = 3;

/// Two-flop synchroniser and glitch filter of one pin.
///
/// The filtered value follows the synchronised pin after `limit + 1` consecutive ticks at which
/// it differs; a single equal clock in between, tick or not, starts anew.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GlitchFilter {
    first: bool,
    second: bool,
    run: u8,
    /// The filtered level.
    pub value: bool,
}

impl GlitchFilter {
    /// One clock. `limit` is 4 bits; `load` takes the synchronised level over unfiltered.
    pub fn clock(&mut self, pin: bool, tick: bool, limit: u8, load: bool) {
        let Self { first, second, run, value } = *self;
        self.second = first;
        self.first = pin;
        if load || second == value {
            self.run = 0;
        } else if tick {
            self.run = if run >= limit & 15 { 0 } else { run + 1 };
        }
        if load || (second != value && tick && run >= limit & 15) {
            self.value = second;
        }
    }

    /// The level behind the synchroniser, before the filter.
    #[must_use]
    pub fn synchronised(&self) -> bool {
        self.second
    }
}

/// Pins and registers the encoder sees at one clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// Raw line A.
    pub a: bool,
    /// Raw line B.
    pub b: bool,
    /// Filter length, 4 bits: a line changes after `filter + 1` equal clocks.
    pub filter: u8,
    /// Control tick: latches count, edge time and direction.
    pub sample: bool,
    /// Free-running time in clocks, 24 bits.
    pub now: u32,
    /// Clears the sticky error, unless a new one comes at the same clock.
    pub clear_error: bool,
    /// Raw index line.
    pub index: bool,
    /// Strobe: the next rise of the index is to be captured.
    pub arm_index: bool,
}

/// Outputs of the encoder after a clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// Count at the last sample.
    pub count: u16,
    /// Time of the last counted edge at the last sample, 24 bits.
    pub edge_time: u32,
    /// Direction of the last counted edge at the last sample, true = up.
    pub direction: bool,
    /// Sticky: both lines changed at once.
    pub error: bool,
    /// Filtered line A.
    pub live_a: bool,
    /// Filtered line B.
    pub live_b: bool,
    /// An edge is counted in the clock to come.
    pub step: bool,
    /// Its direction, true = up.
    pub up: bool,
    /// Filtered index line.
    pub live_index: bool,
    /// Count at the last index captured before the last sample.
    pub index_count: u16,
    /// An index was captured between the last two samples.
    pub index_event: bool,
    /// Armed for an index that has not come yet.
    pub index_waiting: bool,
    /// One was captured since the last arming.
    pub index_seen: bool,
}

/// State of one encoder channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Encoder {
    line_a: GlitchFilter,
    line_b: GlitchFilter,
    line_index: GlitchFilter,
    settling: u32,
    last_a: bool,
    last_b: bool,
    last_index: bool,
    /// Captured since the last sample.
    index_new: bool,
    index_count: u16,
    count: u16,
    edge_time: u32,
    direction: bool,
    outputs: Outputs,
}

impl Encoder {
    /// The outputs after the last clock.
    #[must_use]
    pub fn outputs(&self) -> Outputs {
        self.outputs
    }

    /// A rising edge of the clock, with what the block sees before it.
    pub fn clock(&mut self, inputs: &Inputs) -> Outputs {
        let before = *self;
        let settled = before.settling >= SETTLING_CLOCKS;
        if !settled {
            self.settling += 1;
        }
        self.line_a.clock(inputs.a, true, inputs.filter, !settled);
        self.line_b.clock(inputs.b, true, inputs.filter, !settled);
        self.line_index.clock(inputs.index, true, inputs.filter, !settled);

        let (a, b) = (before.line_a.value, before.line_b.value);
        self.last_a = if settled { a } else { before.line_a.synchronised() };
        self.last_b = if settled { b } else { before.line_b.synchronised() };
        let change_a = settled && a != before.last_a;
        let change_b = settled && b != before.last_b;
        if change_a != change_b {
            self.direction = a != before.last_b;
            self.count = if self.direction { before.count.wrapping_add(1) } else { before.count.wrapping_sub(1) };
            self.edge_time = inputs.now & TIME_MASK;
        }
        if inputs.sample {
            self.outputs.count = before.count;
            self.outputs.edge_time = before.edge_time;
            self.outputs.direction = before.direction;
        }
        self.outputs.error = (before.outputs.error && !inputs.clear_error) || (change_a && change_b);
        self.capture(&before, inputs, settled);
        self.outputs.live_a = self.line_a.value;
        self.outputs.live_b = self.line_b.value;
        self.outputs.live_index = self.line_index.value;
        let settled = self.settling >= SETTLING_CLOCKS;
        let changes = [self.line_a.value != self.last_a, self.line_b.value != self.last_b];
        self.outputs.step = settled && changes[0] != changes[1];
        self.outputs.up = self.line_a.value != self.last_b;
        self.outputs
    }

    fn capture(&mut self, before: &Self, inputs: &Inputs, settled: bool) {
        let index = before.line_index.value;
        self.last_index = if settled { index } else { before.line_index.synchronised() };
        let captures = settled && index && !before.last_index && before.outputs.index_waiting;
        if captures {
            self.index_count = before.count;
        }
        self.outputs.index_waiting = inputs.arm_index || (before.outputs.index_waiting && !captures);
        self.outputs.index_seen = captures || (before.outputs.index_seen && !inputs.arm_index);
        self.index_new = captures || (before.index_new && !inputs.sample);
        if inputs.sample {
            self.outputs.index_event = before.index_new;
            self.outputs.index_count = before.index_count;
        }
    }
}

#[cfg(test)]
mod tests;
