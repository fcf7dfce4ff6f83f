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
//! The pulse is not the kick strength where a triac switches: it conducts until its current ends.
//! Hence the commutation time before charging.

use crate::encoder::GlitchFilter;

/// Longest trigger pulse; a longer setting acts as this one.
pub const MAXIMUM_PULSE_US: u16 = 10_000;
/// Shortest lock-out, from the end of a pulse: ten of the longest pulses, so that the solenoid and
/// its switch are never on for more than a tenth of the time whatever the registers say.
pub const MINIMUM_LOCKOUT_US: u32 = 100_000;
/// Time after a pulse in which charging stays off: twice the longest pulse, because a triac
/// conducts on after its gate and must not be fed by the charger.
pub const COMMUTATION_US: u32 = 20_000;
/// Time between charging and a pulse: many periods of the charger's oscillator.
pub const CHARGE_GAP_US: u16 = 1_000;
/// Strobes for which the ball sensor must differ.
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
    /// Armed.
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
    /// Level: fire when the ball is seen, once until this drops or the kicker is disabled.
    pub arm_on_ball: bool,
    /// Strobe: clears the sticky flags and a charging time-out.
    pub clear: bool,
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
    pub charge_timed_out: bool,
    /// Sticky: a fire request was dropped.
    pub fire_dropped: bool,
}

/// State of the kicker block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Kicker {
    ball: GlitchFilter,
    state: State,
    /// Strobes since the pulse began or ended.
    elapsed: u32,
    /// Strobes until a pulse may begin.
    gap: u16,
    /// Strobes of charging since the request or the last pulse.
    charged: u32,
    /// The ball trigger has had its shot.
    spent: bool,
    outputs: Outputs,
}

impl Kicker {
    /// One clock.
    pub fn clock(&mut self, inputs: &Inputs) -> Outputs {
        let before = *self;
        let pulse = inputs.pulse & PULSE_MASK;
        let idle = if inputs.enable { State::Ready } else { State::Off };
        self.ball.clock(inputs.ball, inputs.microsecond, BALL_FILTER_US - 1, false);

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
        if !inputs.charge_request || before.state == State::Pulse || (inputs.clear && expired) {
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
            charge: inputs.enable && inputs.charge_request && !expired && may_charge,
            trigger: self.state == State::Pulse,
            ready: self.state == State::Ready && pulse != 0,
            state: self.state as u8,
            charge_timed_out: (before.outputs.charge_timed_out && !inputs.clear) || (before.outputs.charge && expired),
            fire_dropped: (before.outputs.fire_dropped && !inputs.clear) || (inputs.fire && !takes) || cancels,
        };
        self.outputs
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Strobe at every clock, armed, 50 µs pulse, charging allowed for 5 ms but not asked for.
    const IDLE: Inputs = Inputs {
        enable: true,
        microsecond: true,
        charge_request: false,
        charge_timeout: 5_000,
        fire: false,
        pulse: 50,
        lockout: 0,
        ball: false,
        arm_on_ball: false,
        clear: false,
    };
    const CHARGING: Inputs = Inputs { charge_request: true, ..IDLE };

    fn ready() -> Kicker {
        let mut kicker = Kicker::default();
        assert!(kicker.clock(&IDLE).ready);
        kicker
    }

    fn fire(kicker: &mut Kicker, inputs: &Inputs) -> Outputs {
        kicker.clock(&Inputs { fire: true, ..*inputs })
    }

    /// Clocks until the condition holds, at most `limit`.
    fn clocks_until(kicker: &mut Kicker, inputs: &Inputs, limit: u32, is: fn(&Outputs) -> bool) -> u32 {
        (1..=limit).find(|_| is(&kicker.clock(inputs))).unwrap_or(u32::MAX)
    }

    #[test]
    fn the_pulse_is_exact_and_bounded() {
        for (pulse, length) in
            [(1, 1), (2, 2), (50, 50), (9_999, 9_999), (10_000, 10_000), (10_001, 10_000), (16_383, 10_000)]
        {
            let inputs = Inputs { pulse, ..IDLE };
            let mut kicker = ready();
            assert!(!fire(&mut kicker, &inputs).trigger);
            assert_eq!(clocks_until(&mut kicker, &inputs, 2, |o| o.trigger), 1);
            assert_eq!(clocks_until(&mut kicker, &inputs, 20_000, |o| !o.trigger), length);
        }
    }

    #[test]
    fn lock_out_is_as_set_but_never_below_the_minimum() {
        for (lockout, length) in [(0, 100_000), (99_999, 100_000), (100_001, 100_001), (LOCKOUT_MASK, LOCKOUT_MASK)] {
            let inputs = Inputs { lockout, ..IDLE };
            let mut kicker = ready();
            fire(&mut kicker, &inputs);
            clocks_until(&mut kicker, &inputs, 10, |o| o.trigger);
            clocks_until(&mut kicker, &inputs, 100, |o| !o.trigger);
            assert_eq!(clocks_until(&mut kicker, &inputs, 2_000_000, |o| o.ready), length);
        }
    }

    #[test]
    fn firing_while_charging_waits_for_the_gap_and_charging_for_commutation() {
        let mut kicker = ready();
        assert!(kicker.clock(&CHARGING).charge);
        assert!(!fire(&mut kicker, &CHARGING).charge);
        let wait = clocks_until(&mut kicker, &CHARGING, 5_000, |o| o.trigger);
        assert_eq!(wait, u32::from(CHARGE_GAP_US) + 1);
        clocks_until(&mut kicker, &CHARGING, 100, |o| !o.trigger);
        assert_eq!(clocks_until(&mut kicker, &CHARGING, 100_000, |o| o.charge), COMMUTATION_US);
    }

    #[test]
    fn charging_stops_at_its_time_out_until_asked_again() {
        for timeout in [1, 2, 5_000, CHARGE_MASK] {
            let inputs = Inputs { charge_timeout: timeout, ..CHARGING };
            let mut kicker = ready();
            assert!(kicker.clock(&inputs).charge);
            // The count reaches the time-out, and the clock after sees it.
            assert_eq!(clocks_until(&mut kicker, &inputs, 1 << 25, |o| !o.charge), timeout + 1);
            assert!(kicker.outputs.charge_timed_out);
            assert_eq!(clocks_until(&mut kicker, &inputs, 10_000, |o| o.charge), u32::MAX);
            kicker.clock(&Inputs { charge_request: false, ..inputs });
            assert!(kicker.clock(&inputs).charge);
            assert!(kicker.outputs.charge_timed_out, "the flag stays until cleared");
            clocks_until(&mut kicker, &inputs, 1 << 25, |o| !o.charge);
            let cleared = kicker.clock(&Inputs { clear: true, ..inputs });
            assert!(!cleared.charge_timed_out && kicker.clock(&inputs).charge);
        }
        let never = Inputs { charge_timeout: 0, ..CHARGING };
        assert_eq!(clocks_until(&mut ready(), &never, 1_000, |o| o.charge || o.charge_timed_out), u32::MAX);
    }

    #[test]
    fn requests_that_cannot_be_taken_are_dropped_and_flagged() {
        let mut kicker = ready();
        fire(&mut kicker, &IDLE);
        assert!(!kicker.outputs.fire_dropped);
        assert!(fire(&mut kicker, &IDLE).fire_dropped, "a second request");
        assert!(!kicker.clock(&Inputs { clear: true, ..IDLE }).fire_dropped);
        for disabled in [Inputs { enable: false, ..IDLE }, Inputs { pulse: 0, ..IDLE }] {
            let mut kicker = ready();
            assert!(fire(&mut kicker, &disabled).fire_dropped);
            assert_eq!(clocks_until(&mut kicker, &IDLE, 1_000, |o| o.trigger), u32::MAX);
        }
    }

    #[test]
    fn disabling_acts_in_one_clock_and_shortens_nothing() {
        let off = Inputs { enable: false, ..CHARGING };
        let mut kicker = ready();
        kicker.clock(&CHARGING);
        let out = kicker.clock(&off);
        assert!(!out.charge && !out.ready);
        let mut kicker = ready();
        fire(&mut kicker, &IDLE);
        clocks_until(&mut kicker, &IDLE, 10, |o| o.trigger);
        assert!(!kicker.clock(&off).trigger);
        assert_eq!(clocks_until(&mut kicker, &CHARGING, 100_000, |o| o.charge), COMMUTATION_US);
        let rest = MINIMUM_LOCKOUT_US - COMMUTATION_US;
        assert_eq!(clocks_until(&mut kicker, &IDLE, 1_000_000, |o| o.ready), rest);
    }

    #[test]
    fn the_ball_fires_once_per_arming_after_the_stated_delay() {
        let armed = Inputs { arm_on_ball: true, ..IDLE };
        let ball = Inputs { ball: true, ..armed };
        let mut kicker = ready();
        for width in 1..u32::from(BALL_FILTER_US) {
            for n in 0..width + 20 {
                assert!(!kicker.clock(if n < width { &ball } else { &armed }).trigger);
            }
        }
        let delay = 2 + u32::from(BALL_FILTER_US) + 2;
        assert_eq!(clocks_until(&mut kicker, &ball, 100, |o| o.trigger), delay);
        clocks_until(&mut kicker, &ball, 100, |o| !o.trigger);
        assert_eq!(clocks_until(&mut kicker, &ball, 500_000, |o| o.trigger), u32::MAX, "one kick per arming");
        kicker.clock(&Inputs { ball: true, ..IDLE });
        assert_eq!(clocks_until(&mut kicker, &ball, 10, |o| o.trigger), 2);
    }

    #[test]
    fn an_arming_on_the_ball_does_not_survive_disabling() {
        let ball = Inputs { arm_on_ball: true, ball: true, ..IDLE };
        let mut kicker = Kicker::default();
        for _ in 0..50 {
            kicker.clock(&Inputs { enable: false, ..ball });
        }
        assert_eq!(clocks_until(&mut kicker, &ball, 1_000, |o| o.trigger), u32::MAX);
    }

    /// Per segment: clocks, strobe interval, and what holds or comes at random in it.
    fn segment() -> impl Strategy<Value = (u32, u32, Inputs, u32)> {
        let levels = (prop::bool::weighted(0.9), any::<bool>(), any::<bool>(), any::<bool>());
        let times = (prop_oneof![Just(0), Just(1), 2..3_000_u32], prop_oneof![Just(0), 0..3_000_u16, Just(16_383)]);
        let pace =
            (prop_oneof![0..50_u32, 0..60_000_u32], 1..4_u32, prop_oneof![Just(7_u32), Just(1_000), Just(30_000)]);
        (levels, times, pace).prop_map(
            |((enable, charge_request, ball, arm_on_ball), (charge_timeout, pulse), pace)| {
                let inputs = Inputs { enable, charge_request, ball, arm_on_ball, charge_timeout, pulse, ..IDLE };
                (pace.0, pace.1, inputs, pace.2)
            },
        )
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        /// For any stream, seen from the outputs alone.
        #[test]
        fn charge_and_trigger_exclude_each_other(segments in prop::collection::vec(segment(), 1..60)) {
            let mut kicker = Kicker::default();
            let (mut since_charge, mut since_trigger, mut pulse) = (u32::MAX, u32::MAX, 0_u32);
            for (clocks, interval, inputs, fire_interval) in segments {
                for clock in 0..clocks {
                    let microsecond = clock % interval == 0;
                    let fire = clock % fire_interval == 1;
                    let out = kicker.clock(&Inputs { microsecond, fire, clear: clock % 999 == 0, ..inputs });
                    prop_assert!(!(out.charge && out.trigger));
                    prop_assert!(inputs.enable || !(out.charge || out.trigger || out.ready));
                    let strobe = u32::from(microsecond);
                    if out.trigger {
                        prop_assert!(since_charge >= u32::from(CHARGE_GAP_US));
                        prop_assert!(pulse > 0 || since_trigger >= MINIMUM_LOCKOUT_US);
                        // The strobe that begins a pulse is not in it.
                        pulse += if pulse == 0 { 1 } else { strobe };
                        prop_assert!(pulse <= u32::from(MAXIMUM_PULSE_US));
                        since_trigger = 0;
                    } else {
                        pulse = 0;
                        since_trigger = since_trigger.saturating_add(strobe);
                    }
                    if out.charge {
                        prop_assert!(since_trigger >= COMMUTATION_US);
                        since_charge = 0;
                    } else {
                        since_charge = since_charge.saturating_add(strobe);
                    }
                }
            }
        }
    }
}
