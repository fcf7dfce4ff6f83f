//! What a recording says of the card, and the loops replayed from it, word for word.
//!
//! A recording holds what went into a speed loop and what came out of it, as words in other units, and
//! the configuration by the names below. It does not hold the integrator, and a host that wakes up late
//! misses ticks that the card computed all the same. One duty that is not at a limit tells the integrator
//! to the last bit ([`PiState::after`]), so [`LoopReplay`] goes on exactly after every gap.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "words of a log are raw bits"
)]

use crate::AXES;
use crate::format::{Coefficient, Duty, FeedForwardGain, Format, IntegralGain, ProportionalGain, Speed};
use crate::kinematics::{InverseMatrix, TWIST, inverse};
use crate::pi::{PiGains, PiState};
use crate::slew::SlewLimits;
use crate::speed::{SpeedMode, TIME_BITS};
use crate::word::WORD_BITS;

/// The configuration of a card whose axes have the same gains, as a recording carries it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RecordedWords {
    /// Gains of every axis.
    pub gains: PiGains,
    /// Control period in clocks.
    pub tick_period: u32,
    /// How speeds are measured.
    pub speed_mode: SpeedMode,
    /// How set points come from body velocities; nothing where the host sends wheel speeds.
    pub set_points: Option<SetPointWords>,
}

/// Inverse kinematics of the gateware.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SetPointWords {
    /// Body velocity to wheel speeds.
    pub inverse: InverseMatrix,
    /// Body velocity words are 2 to these per m/s, m/s and rad/s.
    pub exponents: [i32; TWIST],
    /// Slew limits of every axis.
    pub slew: SlewLimits,
}

/// A word that a recording lacks or that its register cannot hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BadWord {
    /// As [`RecordedWords::each`] calls it.
    pub name: &'static str,
    /// What it says, if it is there.
    pub value: Option<i64>,
}

impl core::fmt::Display for BadWord {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self.value {
            Some(value) => write!(f, "{} = {value} does not fit its register", self.name),
            None => write!(f, "{} is missing", self.name),
        }
    }
}

impl core::error::Error for BadWord {}

const INVERSE: [[&str; TWIST]; AXES] = [
    ["inverse_1_x", "inverse_1_y", "inverse_1_w"],
    ["inverse_2_x", "inverse_2_y", "inverse_2_w"],
    ["inverse_3_x", "inverse_3_y", "inverse_3_w"],
    ["inverse_4_x", "inverse_4_y", "inverse_4_w"],
];
const EXPONENTS: [&str; TWIST] = ["exponent_x", "exponent_y", "exponent_w"];

impl RecordedWords {
    /// Every word by its name.
    pub fn each(&self, mut put: impl FnMut(&'static str, i64)) {
        put("kp", self.gains.kp.to_bits().into());
        put("ki", self.gains.ki.to_bits().into());
        put("kff", self.gains.kff.to_bits().into());
        put("lower", self.gains.lower.to_bits().into());
        put("upper", self.gains.upper.to_bits().into());
        put("tick_period", self.tick_period.into());
        put("count_and_time", i64::from(self.speed_mode == SpeedMode::CountAndTime));
        let Some(set_points) = &self.set_points else { return };
        put("slew_fall", set_points.slew.fall.to_bits().into());
        put("slew_rise", set_points.slew.rise.to_bits().into());
        for (name, exponent) in EXPONENTS.into_iter().zip(set_points.exponents) {
            put(name, exponent.into());
        }
        for (names, row) in INVERSE.into_iter().zip(&set_points.inverse) {
            for (name, entry) in names.into_iter().zip(row) {
                put(name, entry.to_bits().into());
            }
        }
    }

    /// The configuration from words found by their names. `kff` may be missing, and so may all words of the
    /// set points together.
    ///
    /// # Errors
    /// [`BadWord`] for one that is missing, or beyond its register.
    pub fn find(word: impl Fn(&str) -> Option<i64>) -> Result<Self, BadWord> {
        let within = |name: &'static str, bits: u32, value: Option<i64>| match value {
            Some(v) if (-(1_i64 << (bits - 1))..1_i64 << (bits - 1)).contains(&v) => Ok(v as i32),
            value => Err(BadWord { name, value }),
        };
        let signed = |name: &'static str, bits: u32| within(name, bits, word(name));
        let gains = PiGains {
            kp: ProportionalGain::from_bits(signed("kp", Format::PROPORTIONAL.bits())?),
            ki: IntegralGain::from_bits(signed("ki", Format::INTEGRAL.bits())?),
            kff: FeedForwardGain::from_bits(within(
                "kff",
                Format::FEED_FORWARD.bits(),
                Some(word("kff").unwrap_or(0)),
            )?),
            lower: Duty::from_bits(signed("lower", WORD_BITS)?),
            upper: Duty::from_bits(signed("upper", WORD_BITS)?),
        };
        let tick_period = signed("tick_period", TIME_BITS + 1)?;
        if tick_period < 1 {
            return Err(BadWord { name: "tick_period", value: Some(tick_period.into()) });
        }
        let speed_mode =
            if signed("count_and_time", 2)? == 1 { SpeedMode::CountAndTime } else { SpeedMode::Difference };
        let mut set_points = None;
        if word(INVERSE[0][0]).is_some() {
            let mut words = SetPointWords::default();
            words.slew.fall = Speed::from_bits(signed("slew_fall", WORD_BITS)?);
            words.slew.rise = Speed::from_bits(signed("slew_rise", WORD_BITS)?);
            for (name, exponent) in EXPONENTS.into_iter().zip(&mut words.exponents) {
                *exponent = signed(name, 8)?;
            }
            for (names, row) in INVERSE.into_iter().zip(&mut words.inverse) {
                for (name, entry) in names.into_iter().zip(row) {
                    *entry = Coefficient::from_bits(signed(name, Format::COEFFICIENT.bits())?);
                }
            }
            set_points = Some(words);
        }
        Ok(Self { gains, tick_period: tick_period as u32, speed_mode, set_points })
    }
}

impl SetPointWords {
    /// The set point of an axis at a tick, from the one at the tick before and the body velocity in force.
    #[must_use]
    pub fn step(&self, axis: usize, before: Speed, twist: &[i32; TWIST]) -> Speed {
        self.slew.step(before, inverse(&self.inverse[axis], twist))
    }

    /// Whether the set point before matters.
    #[must_use]
    pub fn is_slewed(&self) -> bool {
        self.slew != SlewLimits::NONE
    }
}

/// How the duty of a tick compares with the logged one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compared {
    /// Nothing to compare: the integrator is unknown, or the log has no duty.
    Unknown,
    /// Equal to the last bit.
    Same,
    /// Another word than the loop computes.
    Different(Duty),
}

/// The speed loop of one axis along a log.
#[derive(Clone, Copy, Debug)]
pub struct LoopReplay {
    gains: PiGains,
    state: Option<PiState>,
    /// The state if the last differing duty was right and the integrator had been moved.
    rival: Option<PiState>,
}

impl LoopReplay {
    /// A loop whose integrator nobody knows yet.
    #[must_use]
    pub fn new(gains: PiGains) -> Self {
        Self { gains, state: None, rival: None }
    }

    /// Ticks went by unseen, or a tick whose inputs are not known.
    pub fn lose(&mut self) {
        (self.state, self.rival) = (None, None);
    }

    /// The outputs are off: the card clears the integrator.
    pub fn clear(&mut self) {
        (self.state, self.rival) = (Some(PiState::default()), None);
    }

    /// One tick. A duty that differs is counted once, whether the logged word alone is wrong or the
    /// integrator went another way: the ticks after it tell, and the replay goes on with what they say.
    pub fn step(&mut self, reference: Speed, speed: Speed, logged: Option<Duty>) -> Compared {
        let told = logged.and_then(|duty| PiState::after(&self.gains, reference, speed, duty));
        let Some(mut state) = self.state else {
            self.state = told;
            return Compared::Unknown;
        };
        let computed = state.step(&self.gains, reference, speed);
        let rival = self.rival.map(|mut rival| (rival.step(&self.gains, reference, speed), rival));
        self.state = Some(state);
        let Some(logged) = logged else {
            self.rival = rival.map(|(_, rival)| rival);
            return Compared::Unknown;
        };
        match (computed == logged, rival) {
            (true, rival) => {
                self.rival = rival.filter(|(duty, _)| *duty == logged).map(|(_, rival)| rival);
                Compared::Same
            }
            (false, Some((duty, rival))) if duty == logged => {
                (self.state, self.rival) = (Some(rival), None);
                Compared::Same
            }
            (false, _) => {
                self.rival = told;
                Compared::Different(computed)
            }
        }
    }
}

#[cfg(test)]
mod tests;
