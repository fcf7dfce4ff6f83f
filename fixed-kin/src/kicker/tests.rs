//! Requirements on the kicker, stated on its outputs.

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
    full: false,
    by_time: true,
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
fn charging_stops_at_its_time_out_until_disarmed() {
    for timeout in [1, 2, 5_000, CHARGE_MASK] {
        let inputs = Inputs { charge_timeout: timeout, ..CHARGING };
        let mut kicker = ready();
        assert!(kicker.clock(&inputs).charge);
        // The count reaches the time-out, and the clock after sees it.
        assert_eq!(clocks_until(&mut kicker, &inputs, 1 << 25, |o| !o.charge), timeout + 1);
        assert!(kicker.outputs.timed_out);
        assert_eq!(clocks_until(&mut kicker, &inputs, 10_000, |o| o.charge), u32::MAX);
        for again in [Inputs { charge_request: false, ..inputs }, Inputs { clear: true, ..inputs }] {
            assert!(kicker.clock(&again).timed_out, "the time is still used up");
            assert_eq!(clocks_until(&mut kicker, &inputs, 10_000, |o| o.charge), u32::MAX);
        }
        assert!(!kicker.clock(&Inputs { enable: false, clear: true, ..inputs }).timed_out);
        assert_eq!(clocks_until(&mut kicker, &inputs, 10, |o| o.charge), 1, "every arming has its time");
    }
    let never = Inputs { charge_timeout: 0, ..CHARGING };
    assert_eq!(clocks_until(&mut ready(), &never, 1_000, |o| o.charge || o.timed_out), u32::MAX);
}

#[test]
fn a_host_that_toggles_the_request_gains_no_time() {
    let off = Inputs { charge_request: false, ..CHARGING };
    for on_clocks in [1, 7, 1_000] {
        let mut kicker = ready();
        let mut charged = 0;
        for clock in 0..40 * CHARGING.charge_timeout {
            let inputs = if clock % (on_clocks + 1) == 0 { &off } else { &CHARGING };
            charged += u32::from(kicker.clock(&Inputs { clear: clock % 17 == 0, ..*inputs }).charge);
        }
        assert!(charged <= CHARGING.charge_timeout + 1, "{charged} strobes of charging, {on_clocks} at a time");
        assert!(charged >= CHARGING.charge_timeout, "{charged}");
    }
}

#[test]
fn charging_follows_the_input_for_a_full_capacitor() {
    let hungry = Inputs { by_time: false, ..CHARGING };
    let full = Inputs { full: true, ..hungry };
    let delay = 2 + u32::from(BALL_FILTER_US) + 1;
    let mut kicker = ready();
    for _ in 0..20 {
        assert!(!kicker.clock(&full).charge, "an open wire never charges");
    }
    assert_eq!(clocks_until(&mut kicker, &hungry, 100, |o| o.charge), delay);
    // Topping up does not add up to a time-out.
    for _ in 0..20 {
        assert_eq!(clocks_until(&mut kicker, &hungry, 1_000, |o| o.timed_out), u32::MAX);
        assert_eq!(clocks_until(&mut kicker, &full, 100, |o| !o.charge), delay);
        assert!(kicker.outputs().is_full);
        assert_eq!(clocks_until(&mut kicker, &hungry, 100, |o| o.charge), delay);
    }
    assert!(clocks_until(&mut kicker, &hungry, 10_000, |o| o.timed_out) <= CHARGING.charge_timeout + 1);
}

#[test]
fn no_register_value_stretches_the_longest_pulse() {
    for register in 0..64 {
        let clocks = u32::from(MAXIMUM_PULSE_US) * microsecond_clocks(register);
        assert!((250_000..=MAXIMUM_PULSE_CLOCKS).contains(&clocks), "{register}");
    }
}

#[test]
fn every_pulse_allows_a_full_charge() {
    let mut kicker = ready();
    assert_eq!(clocks_until(&mut kicker, &CHARGING, 4_000, |o| o.timed_out), u32::MAX);
    fire(&mut kicker, &CHARGING);
    clocks_until(&mut kicker, &CHARGING, 2_000, |o| o.trigger);
    clocks_until(&mut kicker, &CHARGING, 30_000, |o| o.charge);
    assert_eq!(clocks_until(&mut kicker, &CHARGING, 10_000, |o| !o.charge), CHARGING.charge_timeout + 1);
}

#[test]
fn requests_that_cannot_be_taken_are_dropped_and_flagged() {
    let mut kicker = ready();
    fire(&mut kicker, &IDLE);
    assert!(!kicker.outputs.dropped);
    assert!(fire(&mut kicker, &IDLE).dropped, "a second request");
    assert!(!kicker.clock(&Inputs { clear: true, ..IDLE }).dropped);
    for disabled in [Inputs { enable: false, ..IDLE }, Inputs { pulse: 0, ..IDLE }] {
        let mut kicker = ready();
        assert!(fire(&mut kicker, &disabled).dropped);
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
    assert_eq!(clocks_until(&mut kicker, &ball, 1_000, |o| o.trigger || o.on_ball), u32::MAX);
    // It must drop and rise while the card is armed.
    kicker.clock(&Inputs { arm_on_ball: false, ..ball });
    assert_eq!(clocks_until(&mut kicker, &ball, 10, |o| o.trigger), 2);
    assert!(!kicker.outputs.on_ball, "one shot");
    let mut waiting = ready();
    assert!(waiting.clock(&Inputs { arm_on_ball: true, ..IDLE }).on_ball);
    assert!(!waiting.clock(&Inputs { arm_on_ball: true, enable: false, ..IDLE }).on_ball);
    assert!(!waiting.clock(&Inputs { arm_on_ball: true, ..IDLE }).on_ball);
}

/// Per segment: clocks, strobe interval, and what holds or comes at random in it.
fn segment() -> impl Strategy<Value = (u32, u32, Inputs, u32)> {
    let levels = (prop::bool::weighted(0.9), any::<bool>(), any::<bool>(), any::<bool>());
    let times = (prop_oneof![Just(0), Just(1), 2..3_000_u32], prop_oneof![Just(0), 0..3_000_u16, Just(16_383)]);
    let pace = (prop_oneof![0..50_u32, 0..60_000_u32], 1..4_u32, prop_oneof![Just(7_u32), Just(1_000), Just(30_000)]);
    (levels, times, pace).prop_map(|((enable, charge_request, ball, arm_on_ball), (charge_timeout, pulse), pace)| {
        let inputs = Inputs { enable, charge_request, ball, arm_on_ball, charge_timeout, pulse, ..IDLE };
        (pace.0, pace.1, inputs, pace.2)
    })
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
