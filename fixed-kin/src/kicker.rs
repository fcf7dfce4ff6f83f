//! Bit-true twin of the kicker: charging, trigger pulse, commutation and lock-out.
//!
//! One [`Kicker::clock`] is one rising edge of the FPGA clock; the outputs are those that hold
//! until the next edge. Times are unsigned microseconds, counted in strobes of `microsecond`;
//! nothing wraps: a counter that has reached its limit stops or returns to zero.
//!
//! The trigger rises and falls with a strobe, so a pulse is exactly as many strobe intervals as
//! asked for, up to [`MAXIMUM_PULSE_US`]. From `fire` to the trigger: two clocks and up to one
//! strobe interval, and [`CHARGE_GAP_US`] more if charging or just before. From the ball pin to the
//! same point as `fire`: two clocks and [`BALL_FILTER_US`] strobes. `enable` low takes everything
//! low in one clock; commutation and lock-out run on, so that switching off and on shortens neither.
//!
//! A microsecond is what the time base says: [`microsecond_clocks`] clocks, bounded, so that no register
//! value stretches the longest pulse beyond [`MAXIMUM_PULSE_CLOCKS`].
//!
//! Charging pauses while the capacitor is full and goes on when it is not; the comparator in front of
//! `full` has the hysteresis. An open wire reads as full. The time-out counts all charging since the
//! capacitor was last full, the last pulse or the last time the card was disarmed, whichever came last:
//! neither a new request nor clearing the flag gives more, so a charger that never gets the capacitor full
//! runs for one time-out in an arming.
//!
//! The ball trigger has one shot for every time `arm_on_ball` rises while enabled. One that was set before,
//! or stands while the card is disarmed, has none: it must drop and rise again.
//!
//! The pulse is not the kick strength where a triac switches: it conducts until its current ends.
//! Hence the commutation time before charging.

use crate::encoder::GlitchFilter;

/// Longest trigger pulse; a longer setting acts as this one.
pub const MAXIMUM_PULSE_US: u16 = 10_000;
/// Bounds of the clocks that count as a microsecond: the local bus runs at 25 to 33.3 MHz.
pub const MICROSECOND_CLOCKS: [u32; 2] = [25, 34];
/// Longest pulse in clocks, whatever the registers say: 10.2 ms at 33.33 MHz.
pub const MAXIMUM_PULSE_CLOCKS: u32 = MAXIMUM_PULSE_US as u32 * MICROSECOND_CLOCKS[1];

/// Clocks between two strobes of `microsecond` for a value of the register.
#[must_use]
pub const fn microsecond_clocks(register: u32) -> u32 {
    let [low, high] = MICROSECOND_CLOCKS;
    if register < low {
        low
    } else if register > high {
        high
    } else {
        register
    }
}

/// Shortest lock-out, from the end of a pulse: ten of the longest pulses, so that the solenoid and
/// its switch are never on for more than a tenth of the time whatever the registers say.
pub const MINIMUM_LOCKOUT_US: u32 = 100_000;
/// Time after a pulse in which charging stays off: twice the longest pulse, because a triac
/// conducts on after its gate and must not be fed by the charger.
pub const COMMUTATION_US: u32 = 20_000;
/// Time between charging and a pulse: many periods of the charger's oscillator.
pub const CHARGE_GAP_US: u16 = 1_000;
/// Strobes for which the ball sensor, and the input for a full capacitor, must differ.
pub const BALL_FILTER_US: u8 = 8;

const PULSE_MASK: u16 = 0x3FFF;
const LOCKOUT_MASK: u32 = 0x000F_FFFF;
const CHARGE_MASK: u32 = 0x00FF_FFFF;

/// State of the kicker, as the register shows it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum State {
    /// Not enabled.
    #[default]
    Off = 0,
    /// Takes a fire request; may charge.
    Ready = 1,
    /// A request is taken; charging is off and its gap runs.
    Pending = 2,
    /// The trigger is on.
    Pulse = 3,
    /// After a pulse: no charging, no firing.
    Commutation = 4,
    /// After that: no firing; may charge.
    Lockout = 5,
}

/// Pins, strobes and registers the kicker sees at one clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// The outputs are armed; else nothing fires.
    pub enable: bool,
    /// Strobe, once a microsecond.
    pub microsecond: bool,
    /// Level: charge the capacitor.
    pub charge_request: bool,
    /// Microseconds after which charging stops, 24 bits; 0 = never charge.
    pub charge_timeout: u32,
    /// Strobe: fire.
    pub fire: bool,
    /// Pulse in microseconds, 14 bits; 0 = never fire.
    pub pulse: u16,
    /// Lock-out in microseconds, 20 bits, from the end of the pulse.
    pub lockout: u32,
    /// Raw ball sensor, true = ball.
    pub ball: bool,
    /// Level: fire when the ball is seen, once for every rise of this while enabled.
    pub arm_on_ball: bool,
    /// Strobe: clears the sticky flags; a charging time-out that still stops the charger stays.
    pub clear: bool,
    /// Raw pin, high or open: the capacitor is full.
    pub full: bool,
    /// Level: charge by time alone, `full` is ignored.
    pub by_time: bool,
}

/// Outputs of the kicker after a clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// Charger on; active high here.
    pub charge: bool,
    /// Trigger on; active high here.
    pub trigger: bool,
    /// A fire request would be taken.
    pub ready: bool,
    /// [`State`] as a number.
    pub state: u8,
    /// Sticky: charging was stopped by its time-out.
    pub timed_out: bool,
    /// Sticky: a fire request was dropped.
    pub dropped: bool,
    /// The capacitor is full, filtered.
    pub is_full: bool,
    /// The next ball fires.
    pub on_ball: bool,
}

/// State of the kicker block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Kicker {
    ball: GlitchFilter,
    /// Filters the inverted pin, so that the power-up state is "full".
    hungry: GlitchFilter,
    state: State,
    /// Strobes since the pulse began or ended.
    elapsed: u32,
    /// Strobes until a pulse may begin.
    gap: u16,
    /// Strobes of charging since the capacitor was full, the last pulse, or disarmed.
    charged: u32,
    /// The ball trigger has had its shot.
    spent: bool,
    outputs: Outputs,
}

impl Kicker {
    /// The outputs after the last clock.
    #[must_use]
    pub fn outputs(&self) -> Outputs {
        self.outputs
    }

    /// A rising edge of the clock, with what the block sees before it.
    pub fn clock(&mut self, inputs: &Inputs) -> Outputs {
        let before = *self;
        let pulse = inputs.pulse & PULSE_MASK;
        let idle = if inputs.enable { State::Ready } else { State::Off };
        self.ball.clock(inputs.ball, inputs.microsecond, BALL_FILTER_US - 1, false);
        self.hungry.clock(!inputs.full, inputs.microsecond, BALL_FILTER_US - 1, false);
        let full = !before.hungry.value && !inputs.by_time;

        let takes = before.state == State::Ready && inputs.enable && pulse != 0;
        let by_ball = inputs.arm_on_ball && before.ball.value && !before.spent;
        let accepts = takes && (inputs.fire || by_ball);
        let cancels = before.state == State::Pending && (!inputs.enable || pulse == 0);
        let next = before.elapsed + 1;

        match before.state {
            State::Off => self.state = idle,
            State::Ready => self.state = if accepts { State::Pending } else { idle },
            State::Pending if cancels => self.state = idle,
            State::Pending if inputs.microsecond && before.gap == 0 => self.state = State::Pulse,
            State::Pending => {}
            State::Pulse => {
                let over = next >= u32::from(pulse) || next >= u32::from(MAXIMUM_PULSE_US);
                if !inputs.enable || (inputs.microsecond && over) {
                    self.state = State::Commutation;
                    self.elapsed = 0;
                } else if inputs.microsecond {
                    self.elapsed = next;
                }
            }
            State::Commutation if inputs.microsecond => {
                self.elapsed = next;
                if next >= COMMUTATION_US {
                    self.state = State::Lockout;
                }
            }
            State::Lockout if inputs.microsecond => {
                self.elapsed = next;
                if next >= inputs.lockout & LOCKOUT_MASK && next >= MINIMUM_LOCKOUT_US {
                    self.state = idle;
                    self.elapsed = 0;
                }
            }
            State::Commutation | State::Lockout => {}
        }
        self.spent = inputs.arm_on_ball && (before.spent || !inputs.enable || accepts);

        let expired = before.charged >= inputs.charge_timeout & CHARGE_MASK;
        if !inputs.enable || full || before.state == State::Pulse {
            self.charged = 0;
        } else if inputs.microsecond && before.outputs.charge && !expired {
            self.charged = before.charged + 1;
        }
        if before.outputs.charge {
            self.gap = CHARGE_GAP_US;
        } else if inputs.microsecond {
            self.gap = before.gap.saturating_sub(1);
        }

        let may_charge = matches!(self.state, State::Ready | State::Lockout);
        self.outputs = Outputs {
            charge: inputs.enable && inputs.charge_request && !full && !expired && may_charge,
            trigger: self.state == State::Pulse,
            ready: self.state == State::Ready && pulse != 0,
            state: self.state as u8,
            timed_out: (before.outputs.timed_out && !(inputs.clear && (!expired || !inputs.enable)))
                || (before.outputs.charge && expired),
            dropped: (before.outputs.dropped && !inputs.clear) || (inputs.fire && !takes) || cancels,
            is_full: !self.hungry.value,
            on_ball: inputs.arm_on_ball && !self.spent,
        };
        self.outputs
    }
}

#[cfg(test)]
mod tests;
