//! Bit-true reference of the motion control gateware: pure functions and small state structs that
//! equal the hardware bit for bit. `no_std`, no allocation, no unsafe, and no panic whatever the arguments, but of
//! [`registers::Register::at`] for a word that an array does not have.
//!
//! Every block of the gateware has its twin here: clock by clock ([`encoder`], [`pwm`], [`kicker`],
//! [`safety`], [`stall`], [`interrupt`], [`clock_monitor`], [`local_bus`], [`radio`], [`imu_spi`]) or control tick by control tick
//! ([`speed`], [`kinematics`], [`slew`], [`pi`], [`modulation`], [`pose`], joined in [`control::Core`]). [`card::Card`] is the whole,
//! behind the register map of [`registers`]; [`recording`] replays what it left in a log.
//!
//! # Every signal
//!
//! A *word* is 30 bits, see [`word`]. Sums and differences of words saturate; nothing wraps but what
//! is marked so.
//!
//! | signal | format | LSB | range | rounding |
//! |---|---|---|---|---|
//! | encoder count in the counter | unsigned 16 | 1 count | wraps | exact |
//! | encoder count, position | signed 32 | 1 count | wraps | exact |
//! | edge time, time of the tick | unsigned 24 | 1 clock | wraps | exact |
//! | control period | unsigned 24 | 1 clock | 1000 … 2²³ | exact |
//! | speed, speed set point ([`format::Speed`]) | word | 2⁻³² counts/clock | ±⅛ counts/clock | quotient towards zero |
//! | body velocity set point | word | a power of two, chosen by the driver | ±2²⁹ LSB | half up, per product |
//! | kinematics coefficient ([`format::Coefficient`]) | signed 18 | 2⁻¹⁶ | [−2, 2) | to nearest, ties to even, by [`format::Format::round`] |
//! | odometry matrix entry ([`format::Displacement`]) | word | 2⁻⁸ LSB of displacement per count | ±2²¹ LSB per count | likewise |
//! | displacement x, y in a tick; pose x, y | word; signed 32 | 2⁻²⁷ m; 2⁻²⁸ m, as the driver scales | ±4 m, saturates; ±8 m, wraps | half up, per product |
//! | half turn in a tick; heading | word; unsigned 32 | 2⁻³² turn | ±⅛ turn; a turn, wraps | likewise |
//! | slew limits | word | speed LSB per control tick | as speed | exact |
//! | feed-forward gain ([`format::FeedForwardGain`]) | signed 18 | 2⁻¹⁶ duty LSB per speed LSB | [−2, 2) | likewise |
//! | proportional gain ([`format::ProportionalGain`]) | signed 24 | 2⁻¹⁶ duty LSB per speed LSB | [−128, 128) | likewise |
//! | integral gain × period ([`format::IntegralGain`]) | signed 24 | 2⁻²² duty LSB per speed LSB | [−2, 2) | likewise |
//! | speed error | word | speed LSB | saturates | exact |
//! | proportional part, integral, sum, duty, limits ([`format::Duty`]) | word | 2⁻²⁴ of full drive | ±32 | half up, per product |
//! | PWM period, compare, blanking | unsigned 13, 13, 10 | 1 clock | compare ≥ period is 100 % | compare half up |
//! | watchdog time-out | unsigned 24 | 1 clock | to 0.5 s at 33 MHz | exact |
//! | set-point time-out, stall window | unsigned 16 | 1 control tick | | exact |
//! | kicker pulse, lock-out, charge time-out | unsigned 14, 20, 24 | 1 µs | pulse ≤ 10 ms | exact |
//!
//! # Clocks of a control tick
//!
//! One sequencer, one serial multiplier and one divider serve all axes. A multiplication takes 2 +
//! digits clocks, a division 34, both beside other work: the parts of an axis are woven into each other.
//!
//! | part | multiplications | beside |
//! |---|---|---|
//! | counts, captured index | | |
//! | direct kinematics, three rows | 3 × 10 | counts; speed, first part; limits of the PI |
//! | speed, first part: division started | | |
//! | inverse kinematics, slew limit | 3 × 11 | the division |
//! | speed, second part: the quotient | | feed-forward |
//! | PI with feed-forward | 11 + 2 × 14 | |
//! | PWM compare | 9 | |
//! | pose, once for all axes | 11 + 2 × 14 + 4 × 11 | |
//! | **all of four axes, pose and snapshot** | | **997** clocks at most, measured |
//!
//! The measure holds the worst of a random walk and of a drive in which every axis captures an index
//! and creeps without an edge at every tick. The shortest control period is
//! [`registers::MIN_TICK_PERIOD`] = 1000 clocks: 33 kHz at 33.33 MHz.
//!
//! ```
//! use fixed_kin::format::{Format, Speed};
//! use fixed_kin::word::{Scale, multiply};
//!
//! // 100 000 counts/s at 33.33 MHz, as the card has it.
//! let word = Format::SPEED.round(100_000.0 / 33_333_333.0)?;
//! assert_eq!(word, 12_884_902);
//! // Half of it, by a coefficient of ½.
//! let half = Format::COEFFICIENT.round(0.5)?;
//! assert_eq!(Speed::from_bits(multiply(word, half, Scale::COEFFICIENT)).to_bits(), 6_442_451);
//! // What is written for any format is written by the traits of [`fixed`], which stands here in the version that they are of.
//! fn lsb<F: fixed_kin::fixed::traits::Fixed>() -> f64 {
//!     F::DELTA.to_num()
//! }
//! assert_eq!(lsb::<Speed>(), 2.0_f64.powi(-32));
//! # Ok::<(), fixed_kin::format::OutOfRange>(())
//! ```
#![no_std]
// A file in which casts are the point says so itself.
#![cfg_attr(not(test), warn(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_possible_wrap))]

#[cfg(test)]
extern crate std;

pub use fixed;

pub mod card;
pub mod clock_monitor;
pub mod commit;
pub mod control;
pub mod encoder;
pub mod format;
pub mod imu_spi;
pub mod interrupt;
pub mod kicker;
pub mod kinematics;
pub mod local_bus;
pub mod modulation;
pub mod pi;
pub mod pose;
pub mod pwm;
pub mod radio;
pub mod recording;
pub mod registers;
pub mod safety;
pub mod serial;
pub mod serial_host;
pub mod slew;
pub mod speed;
pub mod stall;
pub mod word;

/// Axes of the core: three wheels and a spare, which is a fourth wheel or the dribbler.
pub const AXES: usize = 4;
