//! The PI speed loop of one axis, with feed-forward.
//!
//! ```text
//! e = reference − speed                      speed LSB
//! t = integral + ki·e                        duty LSB; ki holds the control period
//! p = kp·e + kff·reference
//! s = p + t
//! integral = t, unless s is outside [lower, upper] and e drives it further out
//! duty = clip(p + integral, lower, upper)
//! ```
//!
//! The integral is kept in units of duty, so that new gains make no bump where the error is zero (a new
//! `kff` does, by its change times the reference), and is cleared while the outputs are off. Against the same law in real numbers, with the *rounded* gains, one step is
//! within 1.5 LSB of duty (three products, half an LSB each); the integral collects half an LSB of
//! 2⁻²⁴ a tick at most.

use crate::format::{Duty, FeedForwardGain, IntegralGain, ProportionalGain, Speed};
use crate::word::{Scale, add, multiply, subtract};

/// Gains and limits of one axis; all zero is off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PiGains {
    /// Duty per speed.
    pub kp: ProportionalGain,
    /// Duty per speed and control tick.
    pub ki: IntegralGain,
    /// Duty per speed set point: what the speed costs anyway, so that the loop need not find it.
    pub kff: FeedForwardGain,
    /// Smallest duty; −1 is full reverse.
    pub lower: Duty,
    /// Largest duty; 1 is full drive. Below `lower`, `lower` wins.
    pub upper: Duty,
}

/// Integrator of one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PiState {
    /// Integral part of the duty.
    pub integral: Duty,
}

impl PiState {
    /// One control tick; returns the duty.
    pub fn step(&mut self, gains: &PiGains, reference: Speed, speed: Speed) -> Duty {
        let error = subtract(reference.to_bits(), speed.to_bits());
        let proportional = proportional(gains, reference, speed);
        let integral = add(multiply(error, gains.ki.to_bits(), Scale::FINE), self.integral.to_bits());
        let sum = add(integral, proportional);
        let clip = |x: i32| x.min(gains.upper.to_bits()).max(gains.lower.to_bits());
        let outside = clip(sum) != sum;
        let held = outside && (sum ^ error) >= 0;
        if held {
            return Duty::from_bits(clip(add(proportional, self.integral.to_bits())));
        }
        self.integral = Duty::from_bits(integral);
        Duty::from_bits(clip(sum))
    }

    /// The state after a tick that gave this duty; nothing where the duty is at a limit.
    #[must_use]
    pub fn after(gains: &PiGains, reference: Speed, speed: Speed, duty: Duty) -> Option<Self> {
        // Held or not, a duty between the limits is the proportional part plus what is kept.
        let kept = subtract(duty.to_bits(), proportional(gains, reference, speed));
        (duty > gains.lower && duty < gains.upper).then_some(Self { integral: Duty::from_bits(kept) })
    }

    /// Forgets the integral: the outputs are off.
    pub fn clear(&mut self) {
        self.integral = Duty::ZERO;
    }
}

/// The part of the duty that follows the set point and the error at once.
fn proportional(gains: &PiGains, reference: Speed, speed: Speed) -> i32 {
    let error = subtract(reference.to_bits(), speed.to_bits());
    let forward = multiply(reference.to_bits(), gains.kff.to_bits(), Scale::COEFFICIENT);
    add(multiply(error, gains.kp.to_bits(), Scale::WIDE), forward)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::word::WORD_MIN;
    use proptest::prelude::*;

    const ONE: Duty = Duty::ONE;

    fn gains(kp: f64, ki: f64) -> PiGains {
        PiGains {
            kp: ProportionalGain::from_num(kp),
            ki: IntegralGain::from_num(ki),
            kff: FeedForwardGain::ZERO,
            lower: -ONE,
            upper: ONE,
        }
    }

    #[test]
    fn all_zero_gains_are_off() {
        let mut state = PiState::default();
        let duty = state.step(&PiGains::default(), Speed::from_bits(1 << 20), Speed::ZERO);
        assert_eq!((duty, state.integral), (Duty::ZERO, Duty::ZERO));
    }

    #[test]
    fn the_integral_does_not_wind_up() {
        let mut state = PiState::default();
        let law = gains(16.0, 0.1);
        for _ in 0..10_000 {
            assert_eq!(state.step(&law, Speed::from_bits(40_000_000), Speed::ZERO), ONE);
        }
        // Saturated by the proportional part alone: nothing was ever integrated.
        assert_eq!(state.integral, Duty::ZERO);
        // One tick after the error turns, the duty turns too.
        assert!(state.step(&law, Speed::ZERO, Speed::from_bits(100_000)) < 0);
    }

    #[test]
    fn saturated_but_unwinding_integrates() {
        let mut state = PiState { integral: Duty::from_num(3) };
        let law = gains(0.0, 0.5);
        let duty = state.step(&law, Speed::ZERO, Speed::from_bits(1 << 24));
        assert_eq!(duty, ONE);
        assert_eq!(state.integral, Duty::from_num(2.5));
    }

    #[test]
    fn a_new_integral_gain_makes_no_bump() {
        let mut state = PiState { integral: Duty::from_num(0.25) };
        for ki in [0.0, 0.01, 1.9] {
            assert_eq!(
                state.step(&gains(16.0, ki), Speed::from_bits(777), Speed::from_bits(777)),
                Duty::from_num(0.25)
            );
        }
    }

    #[test]
    fn gains_and_limits_change_without_a_bump_where_the_error_is_zero() {
        let mut state = PiState { integral: Duty::from_num(0.25) };
        let speed = Speed::from_bits(3_000_000);
        for (kp, ki) in [(16.0, 0.1), (1.0, 0.0), (100.0, 1.5), (0.0, 0.0)] {
            for limit in [1.0, 0.5, 0.25] {
                let law = PiGains { lower: Duty::from_num(-limit), upper: Duty::from_num(limit), ..gains(kp, ki) };
                assert_eq!(state.step(&law, speed, speed), Duty::from_num(0.25), "{kp} {ki} {limit}");
            }
        }
    }

    #[test]
    fn feed_forward_alone_drives_and_respects_the_limits() {
        let law = PiGains { kff: FeedForwardGain::from_num(0.5), ..gains(0.0, 0.0) };
        let mut state = PiState::default();
        assert_eq!(state.step(&law, Speed::from_bits(1 << 23), Speed::ZERO), Duty::from_num(0.25));
        assert_eq!(state.step(&law, Speed::from_bits(1 << 26), Speed::ZERO), ONE);
        assert_eq!(state.step(&law, -Speed::from_bits(1 << 26), Speed::ZERO), -ONE);
    }

    proptest! {
        /// Against the law in f64 with the rounded gains: within 1.5 LSB, wherever f64 and words take
        /// the same side of the anti-windup test.
        #[test]
        fn one_step_is_within_its_bound(
            kp in 0..1 << 23_i32, ki in 0..1 << 21_i32, kff in -(1 << 17)..1 << 17_i32,
            reference in -(1 << 21)..1 << 21_i32, speed in -(1 << 21)..1 << 21_i32,
            integral in -(1 << 24)..1 << 24_i32,
        ) {
            let law = PiGains { kp: ProportionalGain::from_bits(kp), ki: IntegralGain::from_bits(ki), kff: FeedForwardGain::from_bits(kff), lower: -ONE, upper: ONE };
            let mut state = PiState { integral: Duty::from_bits(integral) };
            let duty = f64::from(state.step(&law, Speed::from_bits(reference), Speed::from_bits(speed)).to_bits());

            let one = f64::from(ONE.to_bits());
            let e = f64::from(reference) - f64::from(speed);
            let p = (e * f64::from(kp) + f64::from(reference) * f64::from(kff)) / 65_536.0;
            let t = f64::from(integral) + e * f64::from(ki) / 4_194_304.0;
            let s = p + t;
            prop_assume!((s.abs() - one).abs() > 2.0);
            let kept = if s.abs() > one && e * s > 0.0 { f64::from(integral) } else { t };
            let exact = (p + kept).clamp(-one, one);
            prop_assert!((duty - exact).abs() <= 1.5, "{duty} for {exact}");
            prop_assert!((f64::from(state.integral.to_bits()) - kept).abs() <= 0.5);
        }

        #[test]
        fn never_leaves_the_limits(bits in prop::array::uniform6(any::<i32>()), limit in 0..1_i32 << 24) {
            let word = |x: i32| x >> 2;
            let law = PiGains {
                kp: ProportionalGain::from_bits(bits[0]),
                ki: IntegralGain::from_bits(bits[1]),
                kff: FeedForwardGain::from_bits(bits[5]),
                lower: Duty::from_bits(-(limit / 2)),
                upper: Duty::from_bits(limit),
            };
            let mut state = PiState { integral: Duty::from_bits(word(bits[2])) };
            let duty = state.step(&law, Speed::from_bits(word(bits[3])), Speed::from_bits(word(bits[4])));
            prop_assert!(duty.to_bits() <= limit && duty.to_bits() >= -(limit / 2));
            prop_assert!(state.integral.to_bits() >= WORD_MIN);
        }
    }
}
