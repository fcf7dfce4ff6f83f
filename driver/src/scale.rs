//! Between SI units and the card's words.
//!
//! The card measures time in its own clocks; this is the one place that knows how long a clock is
//! and what the robot looks like.
//!
//! | quantity | one LSB |
//! |---|---|
//! | wheel speed | clock / (2³² · counts per wheel radian) rad/s |
//! | body velocity x, y | 2⁻ᵃ m/s, a chosen so that the largest coefficient is in (½, 1] |
//! | body velocity ω | 2⁻ᵇ rad/s, b likewise |
//! | position x, y; heading | 2⁻²⁸ m; 2⁻³² turn |
//! | duty | 2⁻²⁴ of the supply |

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "numbers are clamped to their word just before"
)]

use fixed_kin::AXES;
use fixed_kin::control::Configuration;
use fixed_kin::format::{
    Coefficient, Displacement, Duty, FeedForwardGain, Format, IntegralGain, OutOfRange, ProportionalGain, Speed,
    speed_words,
};
use fixed_kin::pi::PiGains;
use fixed_kin::registers::MIN_TICK_PERIOD;
use fixed_kin::slew::SlewLimits;
use fixed_kin::word::WORD_BITS;
use runs::frames::{Pose, Twist};
use runs::geometry::GeometryError;
use runs::robot::Robot;
use std::f64::consts::{PI, TAU};

/// PWM frequency. At 20 kHz the current of a coreless 2224 motor (L/R = 23 µs) follows the voltage
/// almost completely in every period; the 7I30 is specified for it, so it is the default.
pub const PWM_FREQUENCY_HZ: f64 = 20_000.0;

/// A robot that the card cannot be set up for.
#[derive(Debug, thiserror::Error)]
pub enum ScaleError {
    /// More wheels than axes.
    #[error("the robot has {0} wheels, the card {AXES} axes; use a card per group of wheels")]
    TooManyWheels(usize),
    /// Geometry without inverse or without direct kinematics.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// A control period outside the card's range.
    #[error(
        "a control rate of {rate_hz} Hz is {clocks} clocks at {clock_hz} Hz; the card takes {MIN_TICK_PERIOD} to 2^23"
    )]
    Rate {
        /// Control rate asked for.
        rate_hz: f64,
        /// Clock of the card.
        clock_hz: f64,
        /// Control period in clocks.
        clocks: f64,
    },
    /// A parameter that its format cannot hold.
    #[error("{what} of wheel {wheel} does not fit the card: {source}")]
    OutOfRange {
        /// Name of the parameter.
        what: &'static str,
        /// Wheel, from 1.
        wheel: usize,
        /// Format and value.
        source: OutOfRange,
    },
}

/// Conversions for one robot on one card.
#[derive(Clone, Debug)]
pub struct Scale {
    /// Clock of the card in hertz, measured or nominal.
    pub clock_hz: f64,
    /// Control period in clocks.
    pub tick_period: u32,
    wheels: usize,
    /// Speed words per rad/s at the wheel.
    words_per_rad_s: f64,
    /// Body velocity words per m/s and rad/s are 2 to these.
    exponents: [i32; 3],
    /// Body velocity per wheel speed: m/s and rad/s per rad/s, a row a component.
    direct: [[f64; AXES]; 3],
    odometry: bool,
    configuration: Configuration,
}

/// Position words per metre.
const POSITION_PER_M: f64 = 268_435_456.0;
/// Heading words per radian.
const HEADING_PER_RAD: f64 = 4_294_967_296.0 / TAU;

impl Scale {
    /// Conversions and the configuration bank for a robot, calibrated skew included.
    ///
    /// # Errors
    /// [`ScaleError`] where the robot does not fit the card.
    pub fn new(robot: &Robot, clock_hz: f64) -> Result<Self, ScaleError> {
        let wheels = robot.wheel_count();
        if wheels > AXES {
            return Err(ScaleError::TooManyWheels(wheels));
        }
        let clocks = (clock_hz / robot.control_rate_hz).round();
        if !(f64::from(MIN_TICK_PERIOD)..8_388_608.0).contains(&clocks) {
            return Err(ScaleError::Rate { rate_hz: robot.control_rate_hz, clock_hz, clocks });
        }
        let words_per_rad_s = speed_words(robot.counts_per_wheel_rad(), clock_hz);
        let mut scale = Self {
            clock_hz,
            tick_period: clocks as u32,
            wheels,
            words_per_rad_s,
            exponents: [0; 3],
            direct: [[0.0; AXES]; 3],
            odometry: false,
            configuration: Configuration::default(),
        };
        scale.set_gains(robot)?;
        if wheels >= 3 {
            scale.set_kinematics(robot)?;
            scale.odometry = scale.set_odometry(robot.counts_per_wheel_rad()).is_ok();
        }
        Ok(scale)
    }

    fn set_gains(&mut self, robot: &Robot) -> Result<(), ScaleError> {
        let duty_per_speed_word = 1.0 / Format::DUTY.lsb() / self.words_per_rad_s;
        let rate = self.clock_hz / f64::from(self.tick_period);
        let kp = fit("kp", 0, Format::PROPORTIONAL, robot.pi.kp * duty_per_speed_word)?;
        let ki = fit("ki", 0, Format::INTEGRAL, robot.pi.ki / rate * duty_per_speed_word)?;
        let gains = PiGains {
            kp: ProportionalGain::from_bits(kp),
            ki: IntegralGain::from_bits(ki),
            kff: FeedForwardGain::ZERO,
            lower: -Duty::ONE,
            upper: Duty::ONE,
        };
        self.configuration.gains[..self.wheels].fill(gains);
        self.configuration.slew[..self.wheels].fill(SlewLimits::NONE);
        Ok(())
    }

    fn set_kinematics(&mut self, robot: &Robot) -> Result<(), ScaleError> {
        let geometry = robot.geometry()?;
        let (inverse, direct) = (geometry.inverse(), geometry.direct());
        let largest = |columns: std::ops::Range<usize>| {
            let entries = columns.flat_map(|k| (0..self.wheels).map(move |i| (i, k)));
            entries.map(|entry| inverse[entry].abs()).fold(0.0, f64::max) * self.words_per_rad_s
        };
        let exponent = |magnitude: f64| magnitude.log2().ceil() as i32;
        let linear = exponent(largest(0..2));
        self.exponents = [linear, linear, exponent(largest(2..3))];
        for i in 0..self.wheels {
            for k in 0..3 {
                let words_per_unit = f64::from(self.exponents[k]).exp2();
                let forth = inverse[(i, k)] * self.words_per_rad_s / words_per_unit;
                let forth = fit("inverse kinematics", i, Format::COEFFICIENT, forth)?;
                self.configuration.inverse[i][k] = Coefficient::from_bits(forth);
                self.direct[k][i] = direct[(k, i)];
            }
        }
        Ok(())
    }

    /// Rows x and y are in two words of position, as the card doubles them, the third is half the turn.
    fn set_odometry(&mut self, counts_per_wheel_rad: f64) -> Result<(), OutOfRange> {
        let words = [POSITION_PER_M / 2.0, POSITION_PER_M / 2.0, HEADING_PER_RAD / 2.0];
        let mut matrix = self.configuration.direct;
        for ((row, direct), words) in matrix.iter_mut().zip(&self.direct).zip(words) {
            for (entry, direct) in row.iter_mut().zip(direct).take(self.wheels) {
                let word = Format::DISPLACEMENT.round(direct / counts_per_wheel_rad * words)?;
                *entry = Displacement::from_bits(word);
            }
        }
        self.configuration.direct = matrix;
        Ok(())
    }

    /// Matrices and gains for the card.
    #[must_use]
    pub fn configuration(&self) -> &Configuration {
        &self.configuration
    }

    /// Body velocity words are 2 to these per m/s, m/s and rad/s.
    #[must_use]
    pub fn exponents(&self) -> [i32; 3] {
        self.exponents
    }

    /// Wheels in use.
    #[must_use]
    pub fn wheels(&self) -> usize {
        self.wheels
    }

    /// Whether the card can keep a pose for this robot: from three wheels on, and while a count turns the
    /// robot by less than 2⁻¹¹ of a turn.
    #[must_use]
    pub fn has_odometry(&self) -> bool {
        self.odometry
    }

    /// Feed-forward gain for all wheels, in duty per rad/s at the wheel: what the speed costs anyway.
    ///
    /// # Errors
    /// [`ScaleError::OutOfRange`] where the card cannot hold it.
    pub fn set_feed_forward(&mut self, duty_per_rad_s: f64) -> Result<(), ScaleError> {
        let gain = duty_per_rad_s / Format::DUTY.lsb() / self.words_per_rad_s;
        let kff = fit("feed-forward gain", 0, Format::FEED_FORWARD, gain)?;
        for gains in &mut self.configuration.gains[..self.wheels] {
            gains.kff = FeedForwardGain::from_bits(kff);
        }
        Ok(())
    }

    /// Slew limit of all wheels' set points, in rad/s² at the wheel; beyond the range, none.
    pub fn set_slew_limit(&mut self, rad_s2: f64) {
        let rise = self.speed_word(rad_s2.abs() * self.tick_s());
        self.configuration.slew[..self.wheels].fill(SlewLimits { fall: -rise, rise });
    }

    /// Control period in seconds.
    #[must_use]
    pub fn tick_s(&self) -> f64 {
        f64::from(self.tick_period) / self.clock_hz
    }

    /// PWM period in clocks for a frequency, at most the 13 bits of the register.
    #[must_use]
    pub fn pwm_period(&self, frequency_hz: f64) -> u32 {
        (self.clock_hz / frequency_hz).round().clamp(1.0, 8_191.0) as u32
    }

    /// Wheel speed as a word; beyond the range, the nearest.
    #[must_use]
    pub fn speed_word(&self, rad_s: f64) -> Speed {
        Speed::from_bits(nearest(rad_s * self.words_per_rad_s))
    }

    /// Wheel speed in rad/s.
    #[must_use]
    pub fn speed(&self, word: Speed) -> f64 {
        f64::from(word.to_bits()) / self.words_per_rad_s
    }

    /// Body velocity as words; beyond the range, the nearest.
    #[must_use]
    pub fn twist_words(&self, twist: Twist) -> [i32; 3] {
        let components = [twist.vx, twist.vy, twist.omega];
        [0, 1, 2].map(|k| nearest(components[k] * power_of_two(self.exponents[k])))
    }

    /// Pose from the words of a snapshot: position in metres, within ±8 m of where it wraps, heading in
    /// (−π, π].
    #[must_use]
    pub fn pose(&self, [x, y, heading]: [i32; 3]) -> Pose {
        let theta = f64::from(heading) / HEADING_PER_RAD;
        let theta = if theta <= -PI { PI } else { theta };
        Pose::new(f64::from(x) / POSITION_PER_M, f64::from(y) / POSITION_PER_M, theta)
    }

    /// Body velocity from measured wheel speeds, in m/s and rad/s; zero for fewer than three wheels.
    #[must_use]
    pub fn measured_twist(&self, speeds: &[Speed; AXES]) -> Twist {
        let component = |k: usize| (0..self.wheels).map(|i| self.direct[k][i] * self.speed(speeds[i])).sum();
        Twist { vx: component(0), vy: component(1), omega: component(2) }
    }

    /// Body velocity in m/s and rad/s.
    #[must_use]
    pub fn twist(&self, words: [i32; 3]) -> Twist {
        let component = |k: usize| f64::from(words[k]) * power_of_two(-self.exponents[k]);
        Twist { vx: component(0), vy: component(1), omega: component(2) }
    }
}

/// Two to an exponent, made of its bits: `exp2` is a function call, three times a tick.
fn power_of_two(exponent: i32) -> f64 {
    const BIAS: i32 = 1023;
    f64::from_bits(u64::from((exponent + BIAS).clamp(1, 2 * BIAS).unsigned_abs()) << 52)
}

/// The nearest word; no number is zero, which stands still.
fn nearest(value: f64) -> i32 {
    // A number this large has no place for a fraction, so the sum is rounded, ties to even; `round_ties_even` is a
    // function call.
    const WHOLE: f64 = 1.5 * (1_u64 << 52) as f64;
    let limit = f64::from(1 << (WORD_BITS - 1));
    let nearest = (value.clamp(-limit, limit - 1.0) + WHOLE) - WHOLE;
    // No number becomes zero here.
    nearest as i32
}

fn fit(what: &'static str, wheel: usize, format: Format, value: f64) -> Result<i32, ScaleError> {
    format.round(value).map_err(|source| ScaleError::OutOfRange { what, wheel: wheel + 1, source })
}

#[cfg(test)]
mod tests {
    use super::*;
    use fixed_kin::kinematics::inverse;
    use fixed_kin::pose::displacement;
    use runs::robot::Layout;

    const CLOCK: f64 = 33_333_333.0;

    #[test]
    fn kinematics_over_the_card_agree_with_the_model() {
        let mut robot = Robot::racbot();
        robot.layout = Layout::Rac { body_radius_m: 0.085, skew_rad: [0.07, -0.05, 0.03] };
        let scale = Scale::new(&robot, CLOCK).unwrap();
        let geometry = robot.geometry().unwrap();
        for twist in [
            Twist { vx: 1.0, vy: 0.0, omega: 0.0 },
            Twist { vx: -0.3, vy: 2.5, omega: -4.0 },
            Twist { vx: 0.0, vy: 0.0, omega: 15.0 },
        ] {
            let words = scale.twist_words(twist);
            let mut speeds = [Speed::ZERO; AXES];
            for (axis, exact) in geometry.wheel_speeds(twist).into_iter().enumerate() {
                speeds[axis] = inverse(&scale.configuration().inverse[axis], &words);
                assert!((scale.speed(speeds[axis]) - exact).abs() < 2e-3, "axis {axis}");
            }
            let back = scale.measured_twist(&speeds);
            for (got, want) in [(back.vx, twist.vx), (back.vy, twist.vy), (back.omega, twist.omega)] {
                assert!((got - want).abs() < 1e-4 * (1.0 + want.abs()), "{got} for {want}");
            }
        }
    }

    #[test]
    fn the_odometry_matrix_agrees_with_the_model() {
        let robot = Robot::racbot();
        let scale = Scale::new(&robot, CLOCK).unwrap();
        assert!(scale.has_odometry());
        let counts = [300, -200, 50, 0];
        let turns: Vec<f64> = counts[..3].iter().map(|n| f64::from(*n) / robot.counts_per_wheel_rad()).collect();
        let exact = robot.geometry().unwrap().twist(&turns);
        let [x, y, half] = displacement(&scale.configuration().direct, &counts);
        for (got, want, lsb) in [
            (x, exact.vx, 2.0 / POSITION_PER_M),
            (y, exact.vy, 2.0 / POSITION_PER_M),
            (half, exact.omega, 2.0 / HEADING_PER_RAD),
        ] {
            assert!((f64::from(got) * lsb - want).abs() < 3.0 * lsb, "{} for {want}", f64::from(got) * lsb);
        }
    }

    #[test]
    fn slew_and_feed_forward_have_their_units() {
        let mut scale = Scale::new(&Robot::racbot(), CLOCK).unwrap();
        scale.set_slew_limit(2_000.0);
        assert!((scale.speed(scale.configuration().slew[1].rise) - 2.0).abs() < 1e-4);
        assert_eq!(scale.configuration().slew[1].fall, -scale.configuration().slew[1].rise);
        scale.set_feed_forward(0.01).unwrap();
        let duty = f64::from(scale.configuration().gains[2].kff) * f64::from(scale.speed_word(20.0).to_bits());
        assert!((duty * Format::DUTY.lsb() - 0.2).abs() < 1e-4, "{duty}");
        assert!(scale.set_feed_forward(1e6).is_err());
    }

    #[test]
    fn units_go_there_and_back() {
        let scale = Scale::new(&Robot::racbot(), CLOCK).unwrap();
        assert_eq!(scale.tick_period, 33_333);
        assert_eq!(scale.pwm_period(20_000.0), 1_667);
        assert!((scale.speed(scale.speed_word(12.5)) - 12.5).abs() < 1e-5);
        assert_eq!(scale.speed_word(f64::NAN), Speed::ZERO);
        assert_eq!(scale.speed_word(1e9).to_bits(), fixed_kin::word::WORD_MAX);
    }

    #[test]
    fn what_does_not_fit_is_refused_by_name() {
        let mut robot = Robot::racbot();
        robot.pi.kp = 5.0;
        let message = Scale::new(&robot, CLOCK).unwrap_err().to_string();
        assert!(message.contains("kp"), "{message}");
        robot = Robot::racbot();
        robot.control_rate_hz = 50_000.0;
        assert!(matches!(Scale::new(&robot, CLOCK), Err(ScaleError::Rate { .. })));
    }
}
