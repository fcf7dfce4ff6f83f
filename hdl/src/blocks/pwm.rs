//! PWM generator of one axis for an H-bridge: sign and magnitude, or up and down.
//!
//! ```text
//! compare, direction ─►[shadow at load]─►[active at period start]─► coming ≤ compare ─► gate ─► pwm
//! coming  /|/|/|        period_start  _|‾|____________                                  └──► dir
//!
//! pwm ‾‾‾‾\____________________________/‾‾‾‾    low for more than the blanking time
//! dir ______________/‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾    before and after DIR changes
//!         ├─ > b ───┤├────── > b ─────┤
//!
//! pulse │ reverse │ up_down 0: pwm dir │ up_down 1: pwm dir
//!   0   │    0    │             0   0  │             0   0
//!   1   │    0    │             1   0  │             1   0      forward
//!   0   │    1    │             0   1  │             0   0
//!   1   │    1    │             1   1  │             0   1      backward
//! ```
//!
//! There is no locked anti-phase (50 % as zero): a wheel at rest would carry the full ripple. Ripple
//! is what a coreless motor asks about: the 2224 at 12 V has 8.77 Ω and L/R = 23 µs, so the current follows
//! the voltage within a period. Peak to peak at 50 %, V/R·(1 − e^(−T/2τ))²/(1 − e^(−T/τ)):
//!
//! | frequency | period | steps at 33 MHz | ripple | of the rated 0.485 A |
//! |---|---|---|---|---|
//! | 20 kHz | 50 µs | 1667 | 0.68 A | 140 % |
//! | 40 kHz | 25 µs | 833 | 0.36 A | 75 % |
//! | 100 kHz | 10 µs | 333 | 0.15 A | 31 % |
//!
//! The driver's default is 20 kHz all the same: it is what the 7I30 is known to be set to, the mean
//! current, which makes the torque, does not depend on it, and what the ripple adds is heat, 0.2 A RMS.
//! With a bridge that is known to stand more, choose 40 kHz or above.
//!
//! Timing: the pin is one clock behind the phase; `period_start` is high in the clock before the
//! first clock of a period at the pin. `enable` low takes `pwm` low in one clock, clears shadow
//! and active set point and holds `dir`; the blanking time runs again after it. `stops` takes `pwm` low
//! in the clock in which `enable` falls, so that the pin needs no gate for it. The phase runs on
//! while disabled. `sync` starts a period; the core syncs the axes a quarter of a period apart, so that
//! they do not draw their pulses from the supply together. A compare of zero asks for no
//! direction. Serves `pwm_period`, `pwm_blanking`, `mode`. Limits: period up to 8191 clocks (4 kHz at 33 MHz), blanking up to 1023 (30 µs).

use crate::primitives::Literal;
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// The PWM block; see the head of this file.
#[derive(LogicBlock, Default)]
pub struct Pwm {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// Outputs may be on.
    pub enable: Signal<In, Bit>,
    /// The outputs are off at the next clock.
    pub stops: Signal<In, Bit>,
    /// Period in clocks; 0 = off.
    pub period: Signal<In, Bits<13>>,
    /// Blanking in clocks.
    pub blanking: Signal<In, Bits<10>>,
    /// Strobe: takes compare and direction into the shadow.
    pub load: Signal<In, Bit>,
    /// High time in clocks; from the next period start. The period or more is 100 %.
    pub compare: Signal<In, Bits<13>>,
    /// Level of `dir` for this compare.
    pub direction: Signal<In, Bit>,
    /// Strobe: a period starts with the next clock.
    pub sync: Signal<In, Bit>,
    /// Up/down instead of sign and magnitude.
    pub up_down: Signal<In, Bit>,
    /// The PWM pin; in up/down mode the pulses forward.
    pub pwm: Signal<Out, Bit>,
    /// The DIR pin; in up/down mode the pulses backward.
    pub dir: Signal<Out, Bit>,
    /// Strobe: the next clock is the first of a period at the pin.
    pub period_start: Signal<Out, Bit>,
    /// Number of the clock of the period, from 1, one ahead of the pin; 0 only at power-up.
    pub position: Signal<Out, Bits<13>>,
    coming: DFF<Bits<13>>,
    shadow_compare: DFF<Bits<13>>,
    shadow_direction: DFF<Bit>,
    active_compare: DFF<Bits<13>>,
    active_direction: DFF<Bit>,
    quiet: DFF<Bits<10>>,
    rested: DFF<Bit>,
    settled: DFF<Bit>,
    pwm_pin: DFF<Bit>,
    dir_pin: DFF<Bit>,
    start: DFF<Bit>,
    after: Signal<Local, Bits<13>>,
    last: Signal<Local, Bit>,
    running: Signal<Local, Bit>,
    wraps: Signal<Local, Bit>,
    long_quiet: Signal<Local, Bit>,
    aligned: Signal<Local, Bit>,
    turns: Signal<Local, Bit>,
    permitted: Signal<Local, Bit>,
    no_compare: Literal<13, 0>,
    one: Literal<13, 1>,
    quiet_zero: Literal<10, 0>,
    quiet_one: Literal<10, 1>,
}

// The comparison as the carry chain computes it: one `>`, then an inverter.
#[expect(clippy::nonminimal_bool)]
impl Logic for Pwm {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, coming, shadow_compare, shadow_direction, active_compare, active_direction);
        dff_setup!(self, clock, quiet, rested, settled, pwm_pin, dir_pin, start);

        self.running.next = self.period.val().any();
        // Clocks are numbered from 1, so that the period is compared with a register, not with a sum.
        self.after.next = self.coming.q.val() + self.one.val();
        self.last.next = (self.coming.q.val() >= self.period.val()) | self.sync.val();
        self.wraps.next = self.last.val() & self.running.val();
        self.coming.d.next = self.after.val();
        if self.last.val() {
            self.coming.d.next = self.one.val();
        }
        self.start.d.next = self.wraps.val();

        if self.load.val() {
            self.shadow_compare.d.next = self.compare.val();
            self.shadow_direction.d.next = self.direction.val();
        }
        if self.wraps.val() {
            self.active_compare.d.next = self.shadow_compare.q.val();
            self.active_direction.d.next = self.shadow_direction.q.val();
        }
        if !self.enable.val() {
            self.shadow_compare.d.next = self.no_compare.val();
            self.shadow_direction.d.next = false;
            self.active_compare.d.next = self.no_compare.val();
            self.active_direction.d.next = false;
        }

        self.long_quiet.next = self.quiet.q.val() >= self.blanking.val();
        self.aligned.next = !(self.active_direction.q.val() ^ self.dir_pin.q.val());
        self.turns.next = self.enable.val()
            & !self.aligned.val()
            & self.active_compare.q.val().any()
            & self.rested.q.val()
            & !self.pwm_pin.q.val();
        if self.turns.val() {
            self.dir_pin.d.next = self.active_direction.q.val();
        }
        if !self.long_quiet.val() {
            self.quiet.d.next = self.quiet.q.val() + self.quiet_one.val();
        }
        self.rested.d.next = self.long_quiet.val();
        if self.turns.val() | self.pwm_pin.q.val() | !self.enable.val() {
            self.quiet.d.next = self.quiet_zero.val();
            self.rested.d.next = false;
        }
        self.permitted.next = self.enable.val() & (self.settled.q.val() | self.rested.q.val());
        self.settled.d.next = self.permitted.val() & !self.turns.val();
        self.pwm_pin.d.next = self.permitted.val()
            & !self.stops.val()
            & self.running.val()
            & self.aligned.val()
            & !(self.coming.q.val() > self.active_compare.q.val());

        self.position.next = self.coming.q.val();
        self.pwm.next = self.pwm_pin.q.val();
        self.dir.next = self.dir_pin.q.val();
        if self.up_down.val() {
            self.pwm.next = self.pwm_pin.q.val() & !self.dir_pin.q.val();
            self.dir.next = self.pwm_pin.q.val() & self.dir_pin.q.val();
        }
        self.period_start.next = self.start.q.val();
    }
}
