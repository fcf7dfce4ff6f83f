//! One control tick of the whole core, axis by axis: what the gateware's sequencer computes.
//!
//! ```text
//!  encoder ─┬─► counts ──► direct kinematics ──► pose
//!           └─► speed ────────────────────────────────────┐
//!  body velocity ──► inverse kinematics ──► slew limit ──► PI ──► duty ──► PWM
//! ```

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "words of the map are raw bits"
)]

use crate::AXES;
use crate::format::{Coefficient, Displacement, Duty, FeedForwardGain, IntegralGain, ProportionalGain, Speed};
use crate::kinematics::{InverseMatrix, TWIST, inverse};
use crate::modulation::{Modulation, modulate};
use crate::pi::{PiGains, PiState};
use crate::pose::{DisplacementMatrix, Pose, displacement};
use crate::slew::SlewLimits;
use crate::speed::{EncoderSample, SpeedMode, SpeedState};

/// Whether the host sets wheel speeds or a velocity of the body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SetPointMode {
    /// One wheel speed per axis, in [`Speed`] words.
    #[default]
    Wheels,
    /// A body velocity in the first three words; inverse kinematics in gateware.
    Twist,
}

/// Matrices and gains: one configuration bank. All zero is off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Configuration {
    /// Body velocity to wheel speeds.
    pub inverse: InverseMatrix,
    /// Counts to displacement of the body.
    pub direct: DisplacementMatrix,
    /// Speed loops.
    pub gains: [PiGains; AXES],
    /// Slew limits of the speed set points.
    pub slew: [SlewLimits; AXES],
}

/// Words of a configuration bank, in the order of [`Configuration::to_words`].
pub const CONFIGURATION_WORDS: usize = 13 * AXES;
/// Words of a set-point bank.
pub const SET_POINT_WORDS: usize = AXES;

impl Configuration {
    /// The bank as the bus sees it: thirteen groups of one word per axis.
    ///
    /// | words | group |
    /// |---|---|
    /// | 0–3, 4–7, 8–11 | inverse matrix, columns x, y, ω |
    /// | 12–15, 16–19, 20–23 | odometry matrix, rows x, y, half the turn |
    /// | 24–27, 28–31, 32–35, 36–39 | kp, ki, lower limit, upper limit |
    /// | 40–43, 44–47, 48–51 | kff, slew limits down and up |
    #[must_use]
    pub fn to_words(&self) -> [i32; CONFIGURATION_WORDS] {
        let mut words = [0; CONFIGURATION_WORDS];
        for axis in 0..AXES {
            for k in 0..TWIST {
                words[k * AXES + axis] = self.inverse[axis][k].to_bits();
                words[(TWIST + k) * AXES + axis] = self.direct[k][axis].to_bits();
            }
            words[6 * AXES + axis] = self.gains[axis].kp.to_bits();
            words[7 * AXES + axis] = self.gains[axis].ki.to_bits();
            words[8 * AXES + axis] = self.gains[axis].lower.to_bits();
            words[9 * AXES + axis] = self.gains[axis].upper.to_bits();
            words[10 * AXES + axis] = self.gains[axis].kff.to_bits();
            words[11 * AXES + axis] = self.slew[axis].fall.to_bits();
            words[12 * AXES + axis] = self.slew[axis].rise.to_bits();
        }
        words
    }

    /// The bank from its words.
    #[must_use]
    pub fn from_words(words: &[i32; CONFIGURATION_WORDS]) -> Self {
        let mut bank = Self::default();
        for axis in 0..AXES {
            for k in 0..TWIST {
                bank.inverse[axis][k] = Coefficient::from_bits(words[k * AXES + axis]);
                bank.direct[k][axis] = Displacement::from_bits(words[(TWIST + k) * AXES + axis]);
            }
            bank.gains[axis] = PiGains {
                kp: ProportionalGain::from_bits(words[6 * AXES + axis]),
                ki: IntegralGain::from_bits(words[7 * AXES + axis]),
                kff: FeedForwardGain::from_bits(words[10 * AXES + axis]),
                lower: Duty::from_bits(words[8 * AXES + axis]),
                upper: Duty::from_bits(words[9 * AXES + axis]),
            };
            bank.slew[axis] = SlewLimits {
                fall: Speed::from_bits(words[11 * AXES + axis]),
                rise: Speed::from_bits(words[12 * AXES + axis]),
            };
        }
        bank
    }
}

/// An index captured since the last control tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct IndexCapture {
    /// Whether there is one; else the other fields say nothing.
    pub event: bool,
    /// Counts are to begin at zero there.
    pub clear: bool,
    /// The encoder's count at it.
    pub count: u16,
}

/// What the core sees at a control tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TickInputs {
    /// Encoder counters, latched at the tick.
    pub encoders: [EncoderSample; AXES],
    /// What each axis's index caught since the tick before.
    pub indices: [IndexCapture; AXES],
    /// Free-running clock counter at the tick, low 24 bits.
    pub now: u32,
    /// Control period in clocks, 24 bits.
    pub tick_period: u32,
    /// How speeds are measured.
    pub speed_mode: SpeedMode,
    /// Whether the host sets wheel speeds or a velocity of the body.
    pub set_point_mode: SetPointMode,
    /// Whether a pose is kept; without it the pose is zero.
    pub odometry: bool,
    /// Set points, valid or not.
    pub set_points: [i32; SET_POINT_WORDS],
    /// Whether a set point is in force; without one the wheels are to stand.
    pub set_points_valid: bool,
    /// Whether the outputs may be on; while not, integrators, references and duties are zero.
    pub armed: bool,
    /// PWM period in clocks, 13 bits; 0 is off.
    pub pwm_period: u16,
}

/// What the core has computed at a control tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TickOutputs {
    /// Positions in counts, 32 bits, wrapping.
    pub counts: [i32; AXES],
    /// Measured wheel speeds.
    pub speeds: [Speed; AXES],
    /// Wheel speed set points in force.
    pub references: [Speed; AXES],
    /// Share of the PWM period that each axis is to drive, −1 to 1.
    pub duties: [Duty; AXES],
    /// Where odometry has the robot; zero without it.
    pub pose: Pose,
    /// Counts since the last tick.
    pub moved: [i32; AXES],
    /// What went to the PWM generators.
    pub modulation: [Modulation; AXES],
}

/// State of the core between control ticks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Core {
    /// Speed measurement of every axis.
    pub speeds: [SpeedState; AXES],
    /// Speed loop of every axis.
    pub loops: [PiState; AXES],
    /// Speed set points in force.
    pub references: [Speed; AXES],
    /// What is added to the counts, so that they are zero at a cleared index.
    pub homes: [i32; AXES],
    /// Counts at the last captured index.
    pub index_positions: [i32; AXES],
    /// Where odometry has the robot since it was switched on.
    pub pose: Pose,
}

impl Core {
    /// One control tick.
    pub fn tick(&mut self, configuration: &Configuration, inputs: &TickInputs) -> TickOutputs {
        let mut outputs = TickOutputs::default();
        for axis in 0..AXES {
            let measured = &mut self.speeds[axis];
            let before = measured.count;
            let speed = measured.step(inputs.encoders[axis], inputs.now, inputs.tick_period, inputs.speed_mode);
            outputs.moved[axis] = measured.count.wrapping_sub(before);
            self.capture(axis, inputs.indices[axis]);
            outputs.counts[axis] = self.speeds[axis].count.wrapping_add(self.homes[axis]);
            outputs.speeds[axis] = speed;
            self.references[axis] = if inputs.armed {
                configuration.slew[axis].step(self.references[axis], target(configuration, inputs, axis))
            } else {
                Speed::ZERO
            };
            outputs.references[axis] = self.references[axis];
            outputs.duties[axis] = if inputs.armed {
                self.loops[axis].step(&configuration.gains[axis], self.references[axis], speed)
            } else {
                self.loops[axis].clear();
                Duty::ZERO
            };
            outputs.modulation[axis] = modulate(outputs.duties[axis], inputs.pwm_period);
        }
        if inputs.odometry {
            self.pose.step(displacement(&configuration.direct, &outputs.moved));
        } else {
            self.pose = Pose::default();
        }
        outputs.pose = self.pose;
        outputs
    }

    fn capture(&mut self, axis: usize, index: IndexCapture) {
        if !index.event {
            return;
        }
        let count = self.speeds[axis].count;
        let position = count.wrapping_add(i32::from(index.count.wrapping_sub(count as u16) as i16));
        self.index_positions[axis] = position.wrapping_add(self.homes[axis]);
        if index.clear {
            self.homes[axis] = position.wrapping_neg();
        }
    }
}

/// The speed that is asked of an axis.
fn target(configuration: &Configuration, inputs: &TickInputs, axis: usize) -> Speed {
    let [x, y, omega, _] = inputs.set_points;
    match inputs.set_point_mode {
        _ if !inputs.set_points_valid => Speed::ZERO,
        SetPointMode::Wheels => Speed::from_bits(inputs.set_points[axis]),
        SetPointMode::Twist => inverse(&configuration.inverse[axis], &[x, y, omega]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_configuration_survives_its_words() {
        let mut words = [0; CONFIGURATION_WORDS];
        for (i, word) in words.iter_mut().enumerate() {
            *word = i as i32 * 1_001 - 17_000;
        }
        assert_eq!(Configuration::from_words(&words).to_words(), words);
    }

    #[test]
    fn disarmed_drives_nothing_and_forgets() {
        let mut core = Core::default();
        core.loops[0].integral = Duty::ONE;
        let mut configuration = Configuration::default();
        configuration.gains[0] = PiGains {
            kp: ProportionalGain::from_num(100),
            ki: IntegralGain::from_num(1),
            kff: FeedForwardGain::ZERO,
            lower: -Duty::ONE,
            upper: Duty::ONE,
        };
        configuration.slew[0] = SlewLimits::NONE;
        let inputs = TickInputs {
            set_points: [1 << 20; SET_POINT_WORDS],
            set_points_valid: true,
            tick_period: 33_333,
            pwm_period: 1_667,
            ..TickInputs::default()
        };
        let off = core.tick(&configuration, &inputs);
        assert_eq!(off.duties[0], Duty::ZERO);
        assert_eq!(core.loops[0].integral, Duty::ZERO);
        let on = core.tick(&configuration, &TickInputs { armed: true, ..inputs });
        assert_eq!(on.duties[0], Duty::ONE);
        assert_eq!(on.modulation[0].compare, 1_667);
        let stale = core.tick(&configuration, &TickInputs { armed: true, set_points_valid: false, ..inputs });
        assert_eq!(stale.references[0], Speed::ZERO);
    }

    #[test]
    fn a_timed_out_set_point_slows_down_and_a_disarmed_one_is_gone() {
        let mut core = Core::default();
        let mut configuration = Configuration::default();
        configuration.slew[0] = SlewLimits { fall: Speed::from_bits(-100), rise: Speed::from_bits(100) };
        let inputs = TickInputs {
            set_points: [250, 0, 0, 0],
            set_points_valid: true,
            armed: true,
            tick_period: 33_333,
            ..TickInputs::default()
        };
        let mut reference = |inputs: &TickInputs| core.tick(&configuration, inputs).references[0].to_bits();
        assert_eq!([(); 4].map(|()| reference(&inputs)), [100, 200, 250, 250]);
        let stale = TickInputs { set_points_valid: false, ..inputs };
        assert_eq!([(); 2].map(|()| reference(&stale)), [150, 50]);
        assert_eq!(reference(&TickInputs { armed: false, ..inputs }), 0);
    }

    #[test]
    fn an_index_latches_the_position_and_zeroes_the_counts_without_a_jump_in_speed() {
        let mut core = Core::default();
        let configuration = Configuration::default();
        let at = |count: i32, index: Option<(i32, bool)>| {
            let mut inputs = TickInputs { tick_period: 1_000, ..TickInputs::default() };
            inputs.encoders[2].count = count as u16;
            if let Some((count, clear)) = index {
                inputs.indices[2] = IndexCapture { event: true, clear, count: count as u16 };
            }
            inputs
        };
        core.tick(&configuration, &at(30_000, None));
        let plain = core.tick(&configuration, &at(60_000, None));
        assert_eq!(plain.counts[2], 60_000);
        let latched = core.tick(&configuration, &at(60_100, Some((60_070, false))));
        assert_eq!((latched.counts[2], core.index_positions[2]), (60_100, 60_070));
        let cleared = core.tick(&configuration, &at(60_200, Some((60_170, true))));
        assert_eq!((cleared.counts[2], core.index_positions[2]), (30, 60_170));
        assert_eq!(cleared.speeds[2], latched.speeds[2]);
        let again = core.tick(&configuration, &at(60_100, Some((60_150, true))));
        assert_eq!((again.counts[2], core.index_positions[2]), (-50, -20));
    }
}
