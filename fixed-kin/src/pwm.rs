//! Bit-true twin of the PWM generator of one axis: double-buffered, blanked, sign-magnitude or up/down.
//!
//! One [`Pwm::clock`] is one rising edge of the FPGA clock; the outputs are those that hold until
//! the next edge. Period and compare are unsigned clocks in 13 bits, blanking in 10; a compare of
//! at least the period is 100 %. Nothing wraps: the clocks of a period count from one again, the
//! blanking timer stops.
//!
//! | what | clocks |
//! |---|---|
//! | `enable` low or `stops` to `pwm` low | 1 |
//! | `load` to a change at the pin | 2 after the next period start, up to period + 2 |
//! | `period_start` before the first clock of a period at the pin | 1 |
//! | `pwm` low before `dir` changes, and after it | at least blanking + 2 |
//! | `pwm` low after `enable` | at least blanking + 2 |
//!
//! While disabled, `dir` holds; a compare of zero does not ask for a direction, so crossing
//! zero costs one blanking time and trembling around it none.
//!
//! In up/down mode the `pwm` pin carries the pulses forward and the `dir` pin those backward. Both
//! come from the same gated pulse, so they are never high together and the blanking lies between.
//!
//! `sync` starts a period: axes that are synchronised a quarter of a period apart share the current
//! peaks of the supply among them. In step with the generator's own period it changes nothing.

/// Width mask of period and compare.
pub const PERIOD_MASK: u16 = 0x1FFF;
/// Width mask of the blanking time.
pub const BLANKING_MASK: u16 = 0x3FF;

/// Registers and strobes the generator sees at one clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// Outputs may be on; false forces `pwm` low and forgets the set point.
    pub enable: bool,
    /// Level: the outputs are off after this clock; forces `pwm` low with them, a clock before `enable` does.
    pub stops: bool,
    /// Period in clocks, 13 bits; 0 = off.
    pub period: u16,
    /// Blanking in clocks, 10 bits.
    pub blanking: u16,
    /// Strobe: takes compare and direction into the shadow.
    pub load: bool,
    /// High time in clocks, 13 bits; from the next period start.
    pub compare: u16,
    /// Level of `dir` for this compare.
    pub direction: bool,
    /// Strobe: a period starts with the next clock.
    pub sync: bool,
    /// Up/down instead of sign and magnitude.
    pub up_down: bool,
}

/// Outputs of the generator after a clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// The PWM pin; in up/down mode the pulses forward.
    pub pwm: bool,
    /// The DIR pin; in up/down mode the pulses backward.
    pub dir: bool,
    /// Strobe: the next clock is the first of a period at the pin.
    pub period_start: bool,
    /// Number of the clock of the period, from 1, one ahead of the pin; 0 only at power-up.
    pub position: u16,
}

/// State of one generator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pwm {
    /// Number of the clock of the period that comes, from 1; 0 only at power-up.
    coming: u16,
    shadow_compare: u16,
    shadow_direction: bool,
    active_compare: u16,
    active_direction: bool,
    /// Clocks since `pwm` was high, `dir` changed or `enable` was low; stops at the blanking time.
    quiet: u16,
    /// `quiet` had reached the blanking time a clock ago, and nothing has begun it anew.
    rested: bool,
    /// So it was since `dir` changed or `enable` was low.
    settled: bool,
    pulse: bool,
    reverse: bool,
    period_start: bool,
}

impl Pwm {
    /// A rising edge of the clock, with what the block sees before it.
    pub fn clock(&mut self, inputs: &Inputs) -> Outputs {
        let before = *self;
        let period = inputs.period & PERIOD_MASK;
        let last = before.coming >= period || inputs.sync;
        let wraps = last && period != 0;
        self.coming = if last { 1 } else { before.coming + 1 };
        self.period_start = wraps;

        if inputs.load {
            self.shadow_compare = inputs.compare & PERIOD_MASK;
            self.shadow_direction = inputs.direction;
        }
        if wraps {
            self.active_compare = before.shadow_compare;
            self.active_direction = before.shadow_direction;
        }
        if !inputs.enable {
            self.shadow_compare = 0;
            self.shadow_direction = false;
            self.active_compare = 0;
            self.active_direction = false;
        }

        let long_quiet = before.quiet >= inputs.blanking & BLANKING_MASK;
        let aligned = before.active_direction == before.reverse;
        let turns = inputs.enable && !aligned && before.active_compare != 0 && before.rested && !before.pulse;
        if turns {
            self.reverse = before.active_direction;
        }
        if !long_quiet {
            self.quiet = before.quiet + 1;
        }
        self.rested = long_quiet;
        if turns || before.pulse || !inputs.enable {
            self.quiet = 0;
            self.rested = false;
        }
        self.settled = inputs.enable && !turns && (before.settled || before.rested);
        self.pulse = inputs.enable
            && !inputs.stops
            && period != 0
            && aligned
            && (before.settled || before.rested)
            && before.coming <= before.active_compare;
        self.outputs(inputs.up_down)
    }

    fn outputs(&self, up_down: bool) -> Outputs {
        let (pulse, reverse) = (self.pulse, self.reverse);
        let (pwm, dir) = if up_down { (pulse && !reverse, pulse && reverse) } else { (pulse, reverse) };
        Outputs { pwm, dir, period_start: self.period_start, position: self.coming }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::vec::Vec;

    const OFF: Inputs = Inputs {
        enable: false,
        stops: false,
        period: 0,
        blanking: 0,
        load: false,
        compare: 0,
        direction: false,
        sync: false,
        up_down: false,
    };

    /// Runs until `compare` and `direction` are in force, then from the next start strobe on.
    fn steady(pwm: &mut Pwm, inputs: Inputs) {
        pwm.clock(&Inputs { load: true, ..inputs });
        for _ in 0..3 * u32::from(inputs.period) + 3 * 1024 {
            pwm.clock(&inputs);
        }
        while !pwm.clock(&inputs).period_start {}
    }

    fn high_clocks(pwm: &mut Pwm, inputs: &Inputs) -> u32 {
        (0..inputs.period).map(|_| u32::from(pwm.clock(inputs).pwm)).sum()
    }

    #[test]
    fn duty_is_exact_for_every_compare() {
        for period in [1, 2, 3, 100, 1_667] {
            for compare in (0..=period + 2).chain([8_191]) {
                for direction in [false, true] {
                    let inputs = Inputs { enable: true, period, blanking: 33, load: false, compare, direction, ..OFF };
                    let mut pwm = Pwm::default();
                    steady(&mut pwm, inputs);
                    let high = high_clocks(&mut pwm, &inputs);
                    assert_eq!(high, u32::from(compare.min(period)), "{compare} of {period}");
                    assert!(compare == 0 || pwm.reverse == direction);
                }
            }
        }
        for (compare, high) in [(0, 0), (1, 1), (8_190, 8_190), (8_191, 8_191)] {
            let inputs =
                Inputs { enable: true, period: 8_191, blanking: 0, load: false, compare, direction: true, ..OFF };
            let mut pwm = Pwm::default();
            steady(&mut pwm, inputs);
            assert_eq!(high_clocks(&mut pwm, &inputs), high);
        }
    }

    #[test]
    fn a_period_is_one_pulse_from_its_start() {
        let inputs =
            Inputs { enable: true, period: 50, blanking: 4, load: false, compare: 20, direction: false, ..OFF };
        let mut pwm = Pwm::default();
        steady(&mut pwm, inputs);
        let wave: Vec<bool> = (0..100).map(|_| pwm.clock(&inputs).pwm).collect();
        let ideal: Vec<bool> = (0..100).map(|n| n % 50 < 20).collect();
        assert_eq!(wave, ideal);
    }

    #[test]
    fn zero_and_full_have_no_glitch_at_the_wrap() {
        for (compare, level) in [(0, false), (50, true), (51, true), (8_191, true)] {
            let inputs =
                Inputs { enable: true, period: 50, blanking: 4, load: false, compare, direction: false, ..OFF };
            let mut pwm = Pwm::default();
            steady(&mut pwm, inputs);
            for n in 0..1_000_u32 {
                let load = n.is_multiple_of(7);
                assert_eq!(pwm.clock(&Inputs { load, ..inputs }).pwm, level, "compare {compare}, clock {n}");
            }
        }
    }

    #[test]
    fn a_load_waits_for_the_period_start() {
        let inputs =
            Inputs { enable: true, period: 40, blanking: 0, load: false, compare: 10, direction: false, ..OFF };
        let mut pwm = Pwm::default();
        steady(&mut pwm, inputs);
        let next = Inputs { compare: 30, ..inputs };
        for at in 0..40 {
            let wave: u32 = (0..40).map(|n| u32::from(pwm.clock(&Inputs { load: n == at, ..next }).pwm)).sum();
            assert_eq!(wave, 10, "loaded at {at}");
            // At the last clock it meets the period start, and waits for the one after.
            assert_eq!(high_clocks(&mut pwm, &next), if at == 39 { 10 } else { 30 }, "loaded at {at}");
            steady(&mut pwm, next);
            assert_eq!(high_clocks(&mut pwm, &next), 30);
            steady(&mut pwm, inputs);
        }
    }

    #[test]
    fn a_duty_of_zero_asks_for_no_direction() {
        let forward =
            Inputs { enable: true, period: 50, blanking: 20, load: false, compare: 25, direction: true, ..OFF };
        let mut pwm = Pwm::default();
        steady(&mut pwm, forward);
        let zero = Inputs { compare: 0, direction: false, ..forward };
        steady(&mut pwm, zero);
        assert!(pwm.reverse);
        steady(&mut pwm, Inputs { compare: 1, ..zero });
        assert!(!pwm.reverse);
    }

    #[test]
    fn disabling_acts_in_one_clock_and_forgets() {
        let inputs =
            Inputs { enable: true, period: 50, blanking: 20, load: false, compare: 50, direction: true, ..OFF };
        let mut pwm = Pwm::default();
        steady(&mut pwm, inputs);
        assert!(pwm.pulse && pwm.reverse);
        let out = pwm.clock(&Inputs { enable: false, load: true, ..inputs });
        assert!(!out.pwm && out.dir);
        for _ in 0..500 {
            assert!(!pwm.clock(&inputs).pwm, "the set point before disabling is gone");
        }
    }

    #[test]
    fn enabling_begins_with_a_blanking_time() {
        for blanking in [0, 1, 7, 1_023] {
            let on = Inputs { enable: true, period: 10, blanking, load: true, compare: 10, direction: false, ..OFF };
            let mut pwm = Pwm::default();
            for _ in 0..30 {
                pwm.clock(&Inputs { enable: false, ..on });
            }
            let low = (0..).find(|_| pwm.clock(&on).pwm).unwrap_or(u32::MAX);
            assert!(low >= u32::from(blanking) && low <= u32::from(blanking) + 22, "{blanking}: {low}");
        }
    }

    #[test]
    fn up_and_down_carry_the_same_pulses_on_either_pin() {
        let signed = Inputs { enable: true, period: 50, blanking: 8, compare: 20, ..OFF };
        let (mut one, mut other) = (Pwm::default(), Pwm::default());
        for clock in 0..20_000_u32 {
            let inputs = Inputs { load: clock % 50 == 0, direction: clock / 500 % 2 == 1, ..signed };
            let (plain, up_down) = (one.clock(&inputs), other.clock(&Inputs { up_down: true, ..inputs }));
            assert_eq!(up_down.pwm, plain.pwm && !plain.dir);
            assert_eq!(up_down.dir, plain.pwm && plain.dir);
        }
    }

    #[test]
    fn a_sync_moves_the_period_and_one_in_step_changes_nothing() {
        let inputs = Inputs { enable: true, period: 40, blanking: 0, compare: 10, ..OFF };
        let mut pwm = Pwm::default();
        steady(&mut pwm, inputs);
        for _ in 0..13 {
            pwm.clock(&inputs);
        }
        assert!(pwm.clock(&Inputs { sync: true, ..inputs }).period_start);
        let mut alone = pwm;
        for clock in 1..=400 {
            let sync = clock % 40 == 0;
            let out = pwm.clock(&Inputs { sync, ..inputs });
            assert_eq!((out, out.period_start), (alone.clock(&inputs), sync), "clock {clock}");
        }
    }

    proptest! {
        /// For any stream at a constant blanking time, seen from the pins alone.
        #[test]
        fn blanking_holds_around_every_reversal(
            blanking in prop_oneof![0..4_u16, 0..60_u16],
            period in prop_oneof![0..4_u16, 2..80_u16],
            stream in prop::collection::vec(
                (prop::bool::weighted(0.97), prop::bool::weighted(0.3), 0..90_u16, any::<bool>()), 0..1_500),
        ) {
            let mut pwm = Pwm::default();
            let mut before = Outputs::default();
            // Clocks for which the condition has held, over the output stream.
            let (mut low, mut same_direction, mut enabled) = (1_u32, 0_u32, 0_u32);
            for (enable, load, compare, direction) in stream {
                let out = pwm.clock(&Inputs { enable, period, blanking, load, compare, direction, ..OFF });
                let turned = out.dir != before.dir;
                prop_assert!(!turned || (low > u32::from(blanking) && !out.pwm && !before.pwm));
                enabled = if enable { enabled + 1 } else { 0 };
                if out.pwm && !before.pwm {
                    prop_assert!(same_direction >= u32::from(blanking));
                    prop_assert!(enabled > u32::from(blanking));
                    prop_assert!(!turned);
                }
                prop_assert!(!out.pwm || (enable && period > 0));
                low = if out.pwm { 0 } else { low + 1 };
                same_direction = if turned { 0 } else { same_direction + 1 };
                before = out;
            }
        }
    }
}
