//! Kicker: charging with a time-out, a trigger pulse with a hard maximum, commutation, lock-out.
//!
//! ```text
//!          enable      fire or ball      gap over, strobe       pulse over
//!  OFF 0 ─────────► READY 1 ─────► PENDING 2 ──────────► PULSE 3 ─────► COMMUTATION 4
//!     ▲               ▲                                  (or disabled)       │ 20 ms
//!     └── not enable ─┴──────────────── lock-out over ──────── LOCKOUT 5 ◄───┘
//!
//!  state        charge        trigger   a fire request
//!  READY        as requested  off       taken
//!  LOCKOUT      as requested  off       dropped, flagged
//!  PULSE        off           ON        dropped, flagged
//!  all others   off           off       dropped, flagged
//! ```
//!
//! Timing: outputs are flip-flops. `enable` low takes all of them low in one clock; commutation
//! and lock-out run on. Trigger edges come with the microsecond strobe, so a pulse is exact; it
//! starts two clocks and up to one strobe after `fire`, and 1 ms more if the charger was on. The
//! ball pin adds two clocks and eight strobes. Charging pauses while `full` is high, filtered alike,
//! unless `by_time`; the time-out counts all charging since it was last full, the last pulse or the last clock
//! disarmed: a new request or a cleared flag gives no more. The ball fires once for every rise of `arm_on_ball`
//! while enabled; one that stood before has no shot. Limits, in gateware: pulse ≤ 10 ms
//! (340 000 clocks at the most, because the time base bounds a microsecond to 25 … 34 clocks), lock-out
//! ≥ 100 ms, charging ≥ 20 ms after a pulse. Charge and trigger are active high here; the
//! connector inverts them, because an unconfigured FPGA pulls its pins high. A triac conducts on
//! after its gate: pulse length then is not kick strength.
//! Serves `kicker_control`, `kicker_fire`, `kicker_pulse`, `kicker_lockout`, `kicker_charge_timeout`,
//! `kicker_status`.

use super::encoder::GlitchFilter;
use crate::primitives::Literal;
use fixed_kin::kicker::{BALL_FILTER_US, CHARGE_GAP_US, COMMUTATION_US, MAXIMUM_PULSE_US, MINIMUM_LOCKOUT_US, State};
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// The kicker block; see the head of this file.
#[derive(LogicBlock, Default)]
pub struct Kicker {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// The outputs are armed; else nothing fires.
    pub enable: Signal<In, Bit>,
    /// Strobe, once a microsecond.
    pub microsecond: Signal<In, Bit>,
    /// Level: charge the capacitor.
    pub charge_request: Signal<In, Bit>,
    /// Microseconds after which charging stops; 0 = never charge.
    pub charge_timeout: Signal<In, Bits<24>>,
    /// Strobe: fire.
    pub fire: Signal<In, Bit>,
    /// Pulse in microseconds; 0 = never fire.
    pub pulse: Signal<In, Bits<14>>,
    /// Lock-out in microseconds from the end of the pulse.
    pub lockout: Signal<In, Bits<20>>,
    /// Raw ball sensor, true = ball; invert at the pin where an open wire reads high.
    pub ball: Signal<In, Bit>,
    /// Level: fire when the ball is seen, once for every rise of this while enabled.
    pub arm_on_ball: Signal<In, Bit>,
    /// Strobe: clears the sticky flags; a charging time-out that still stops the charger stays.
    pub clear: Signal<In, Bit>,
    /// Raw pin, high or open: the capacitor is full.
    pub full: Signal<In, Bit>,
    /// Level: charge by time alone, `full` is ignored.
    pub by_time: Signal<In, Bit>,
    /// Switches the charger of the kicker's capacitor on.
    pub charge: Signal<Out, Bit>,
    /// Drives the kick transistor.
    pub trigger: Signal<Out, Bit>,
    /// A fire request would be taken.
    pub ready: Signal<Out, Bit>,
    /// State as in `fixed_kin::kicker::State`.
    pub state: Signal<Out, Bits<3>>,
    /// Sticky: charging was stopped by its time-out.
    pub timed_out: Signal<Out, Bit>,
    /// Sticky: a fire request was dropped.
    pub dropped: Signal<Out, Bit>,
    /// The capacitor is full, filtered.
    pub is_full: Signal<Out, Bit>,
    /// The next ball fires.
    pub on_ball: Signal<Out, Bit>,
    ball_filter: GlitchFilter,
    hungry_filter: GlitchFilter,
    stuffed: Signal<Local, Bit>,
    now: DFF<Bits<3>>,
    coming: DFF<Bits<20>>,
    gap: DFF<Bits<10>>,
    charged: DFF<Bits<24>>,
    spent: DFF<Bit>,
    charge_pin: DFF<Bit>,
    trigger_pin: DFF<Bit>,
    is_ready: DFF<Bit>,
    timed_out_flag: DFF<Bit>,
    dropped_flag: DFF<Bit>,
    in_ready: Signal<Local, Bit>,
    in_pending: Signal<Local, Bit>,
    in_pulse: Signal<Local, Bit>,
    has_pulse: Signal<Local, Bit>,
    takes: Signal<Local, Bit>,
    by_ball: Signal<Local, Bit>,
    accepts: Signal<Local, Bit>,
    cancels: Signal<Local, Bit>,
    idle: Signal<Local, Bits<3>>,
    next_state: Signal<Local, Bits<3>>,
    after: Signal<Local, Bits<20>>,
    short_coming: Signal<Local, Bits<14>>,
    pulse_over: Signal<Local, Bit>,
    lockout_over: Signal<Local, Bit>,
    gap_over: Signal<Local, Bit>,
    expired: Signal<Local, Bit>,
    may_charge: Signal<Local, Bit>,
    clears_time_out: Signal<Local, Bit>,
    off_state: Literal<3, { State::Off as u64 }>,
    ready_state: Literal<3, { State::Ready as u64 }>,
    pending_state: Literal<3, { State::Pending as u64 }>,
    pulse_state: Literal<3, { State::Pulse as u64 }>,
    commutation_state: Literal<3, { State::Commutation as u64 }>,
    lockout_state: Literal<3, { State::Lockout as u64 }>,
    maximum_pulse: Literal<14, { MAXIMUM_PULSE_US as u64 }>,
    commutation_time: Literal<20, { COMMUTATION_US as u64 }>,
    minimum_lockout: Literal<20, { MINIMUM_LOCKOUT_US as u64 }>,
    charge_gap: Literal<10, { CHARGE_GAP_US as u64 }>,
    ball_limit: Literal<4, { BALL_FILTER_US as u64 - 1 }>,
    one: Literal<20, 1>,
    gap_one: Literal<10, 1>,
    charged_zero: Literal<24, 0>,
    charged_one: Literal<24, 1>,
}

impl Logic for Kicker {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, ball_filter, hungry_filter);
        dff_setup!(self, clock, now, coming, gap, charged, spent);
        dff_setup!(self, clock, charge_pin, trigger_pin, is_ready, timed_out_flag, dropped_flag);
        self.ball_filter.pin.next = self.ball.val();
        self.ball_filter.tick.next = self.microsecond.val();
        self.ball_filter.limit.next = self.ball_limit.val();
        self.ball_filter.load.next = false;
        // Inverted before its first flop, so that the power-up zero means "full".
        self.hungry_filter.pin.next = !self.full.val();
        self.hungry_filter.tick.next = self.microsecond.val();
        self.hungry_filter.limit.next = self.ball_limit.val();
        self.hungry_filter.load.next = false;
        self.stuffed.next = !self.hungry_filter.value.val() & !self.by_time.val();
        self.is_full.next = !self.hungry_filter.value.val();

        self.in_ready.next = self.now.q.val() == self.ready_state.val();
        self.in_pending.next = self.now.q.val() == self.pending_state.val();
        self.in_pulse.next = self.now.q.val() == self.pulse_state.val();
        self.has_pulse.next = self.pulse.val().any();
        self.takes.next = self.in_ready.val() & self.enable.val() & self.has_pulse.val();
        self.by_ball.next = self.arm_on_ball.val() & self.ball_filter.value.val() & !self.spent.q.val();
        self.accepts.next = self.takes.val() & (self.fire.val() | self.by_ball.val());
        self.cancels.next = self.in_pending.val() & !(self.enable.val() & self.has_pulse.val());
        self.spent.d.next = self.arm_on_ball.val() & (self.spent.q.val() | !self.enable.val() | self.accepts.val());

        self.gap_over.next = !self.gap.q.val().any();
        // `coming` numbers the strobe that is next in this state, from 1: so a limit is compared with
        // a register, and no adder stands in front of a comparator.
        self.after.next = self.coming.q.val() + self.one.val();
        // A pulse ends below 2^14, so fourteen bits decide.
        self.short_coming.next = self.coming.q.val().get_bits::<14>(0);
        self.pulse_over.next =
            (self.short_coming.val() >= self.pulse.val()) | (self.short_coming.val() >= self.maximum_pulse.val());
        self.lockout_over.next =
            (self.coming.q.val() >= self.lockout.val()) & (self.coming.q.val() >= self.minimum_lockout.val());

        self.idle.next = self.off_state.val();
        if self.enable.val() {
            self.idle.next = self.ready_state.val();
        }
        self.next_state.next = self.now.q.val();
        if self.in_ready.val() {
            self.next_state.next = self.idle.val();
            if self.accepts.val() {
                self.next_state.next = self.pending_state.val();
            }
        } else if self.in_pending.val() {
            if self.cancels.val() {
                self.next_state.next = self.idle.val();
            } else if self.microsecond.val() & self.gap_over.val() {
                self.next_state.next = self.pulse_state.val();
                self.coming.d.next = self.one.val();
            }
        } else if self.in_pulse.val() {
            if self.microsecond.val() {
                self.coming.d.next = self.after.val();
            }
            if !self.enable.val() | (self.microsecond.val() & self.pulse_over.val()) {
                self.next_state.next = self.commutation_state.val();
                self.coming.d.next = self.one.val();
            }
        } else if self.now.q.val() == self.commutation_state.val() {
            if self.microsecond.val() {
                self.coming.d.next = self.after.val();
                if self.coming.q.val() >= self.commutation_time.val() {
                    self.next_state.next = self.lockout_state.val();
                }
            }
        } else if self.now.q.val() == self.lockout_state.val() {
            if self.microsecond.val() {
                self.coming.d.next = self.after.val();
                if self.lockout_over.val() {
                    self.next_state.next = self.idle.val();
                }
            }
        } else {
            self.next_state.next = self.idle.val();
        }
        self.now.d.next = self.next_state.val();

        self.expired.next = self.charged.q.val() >= self.charge_timeout.val();
        if self.microsecond.val() & self.charge_pin.q.val() & !self.expired.val() {
            self.charged.d.next = self.charged.q.val() + self.charged_one.val();
        }
        if !self.enable.val() | self.stuffed.val() | self.in_pulse.val() {
            self.charged.d.next = self.charged_zero.val();
        }
        if self.charge_pin.q.val() {
            self.gap.d.next = self.charge_gap.val();
        } else if self.microsecond.val() & !self.gap_over.val() {
            self.gap.d.next = self.gap.q.val() - self.gap_one.val();
        }

        self.may_charge.next =
            (self.next_state.val() == self.ready_state.val()) | (self.next_state.val() == self.lockout_state.val());
        self.charge_pin.d.next = self.enable.val()
            & self.charge_request.val()
            & !self.stuffed.val()
            & !self.expired.val()
            & self.may_charge.val();
        self.trigger_pin.d.next = self.next_state.val() == self.pulse_state.val();
        self.is_ready.d.next = (self.next_state.val() == self.ready_state.val()) & self.has_pulse.val();
        self.clears_time_out.next = self.clear.val() & (!self.expired.val() | !self.enable.val());
        self.timed_out_flag.d.next = (self.timed_out_flag.q.val() & !self.clears_time_out.val())
            | (self.charge_pin.q.val() & self.expired.val());
        self.dropped_flag.d.next = (self.dropped_flag.q.val() & !self.clear.val())
            | (self.fire.val() & !self.takes.val())
            | self.cancels.val();

        self.charge.next = self.charge_pin.q.val();
        self.trigger.next = self.trigger_pin.q.val();
        self.ready.next = self.is_ready.q.val();
        self.state.next = self.now.q.val();
        self.timed_out.next = self.timed_out_flag.q.val();
        self.dropped.next = self.dropped_flag.q.val();
        self.on_ball.next = self.arm_on_ball.val() & !self.spent.q.val();
    }
}
