//! One control tick of the whole core, axis by axis: what the gateware's sequencer computes.
//!
//! ```text
//!  encoder ──► speed ──► direct kinematics ──► measured body velocity
//!                │
//!  body velocity ──► inverse kinematics ──► reference ──► PI ──► duty ──► PWM
//! ```

use crate::AXES;
use crate::format::{Coefficient, Duty, IntegralGain, ProportionalGain, Speed};
use crate::kinematics::{DirectMatrix, InverseMatrix, TWIST, direct, inverse};
use crate::modulation::{Modulation, modulate};
use crate::pi::{PiGains, PiState};
use crate::speed::{EncoderSample, SpeedMode, SpeedState};

/// What the set points are.
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
    /// Wheel speeds to body velocity.
    pub direct: DirectMatrix,
    /// Speed loops.
    pub gains: [PiGains; AXES],
}

/// Words of a configuration bank, in the order of [`Configuration::to_words`].
pub const CONFIGURATION_WORDS: usize = 10 * AXES;
/// Words of a set-point bank.
pub const SET_POINT_WORDS: usize = AXES;

impl Configuration {
    /// The bank as the bus sees it: ten groups of one word per axis.
    ///
    /// | words | group |
    /// |---|---|
    /// | 0–3, 4–7, 8–11 | inverse matrix, columns x, y, ω |
    /// | 12–15, 16–19, 20–23 | direct matrix, rows x, y, ω |
    /// | 24–27, 28–31, 32–35, 36–39 | kp, ki, lower limit, upper limit |
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
                bank.direct[k][axis] = Coefficient::from_bits(words[(TWIST + k) * AXES + axis]);
            }
            bank.gains[axis] = PiGains {
                kp: ProportionalGain::from_bits(words[6 * AXES + axis]),
                ki: IntegralGain::from_bits(words[7 * AXES + axis]),
                lower: Duty::from_bits(words[8 * AXES + axis]),
                upper: Duty::from_bits(words[9 * AXES + axis]),
            };
        }
        bank
    }
}

/// What the core sees at a control tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TickInputs {
    /// Encoder counters, latched at the tick.
    pub encoders: [EncoderSample; AXES],
    /// Free-running clock counter at the tick, low 24 bits.
    pub now: u32,
    /// Control period in clocks, 24 bits.
    pub tick_period: u32,
    /// How speeds are measured.
    pub speed_mode: SpeedMode,
    /// What the set points are.
    pub set_point_mode: SetPointMode,
    /// Set points, valid or not.
    pub set_points: [i32; SET_POINT_WORDS],
    /// Whether a set point has been committed since arming; without one the references are zero.
    pub set_points_valid: bool,
    /// Whether the outputs may be on; while not, integrators are cleared and duties zero.
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
    /// Duties.
    pub duties: [Duty; AXES],
    /// Measured body velocity.
    pub twist: [i32; TWIST],
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
}

impl Core {
    /// One control tick.
    pub fn tick(&mut self, configuration: &Configuration, inputs: &TickInputs) -> TickOutputs {
        let mut outputs = TickOutputs::default();
        let twist = [0, 1, 2].map(|k| inputs.set_points[k]);
        for axis in 0..AXES {
            let measured = &mut self.speeds[axis];
            let speed = measured.step(inputs.encoders[axis], inputs.now, inputs.tick_period, inputs.speed_mode);
            outputs.counts[axis] = measured.count;
            outputs.speeds[axis] = speed;
            let reference = match inputs.set_point_mode {
                _ if !inputs.set_points_valid => Speed::ZERO,
                SetPointMode::Wheels => Speed::from_bits(inputs.set_points[axis]),
                SetPointMode::Twist => inverse(&configuration.inverse[axis], &twist),
            };
            outputs.references[axis] = reference;
            outputs.duties[axis] = if inputs.armed {
                self.loops[axis].step(&configuration.gains[axis], reference, speed)
            } else {
                self.loops[axis].clear();
                Duty::ZERO
            };
            outputs.modulation[axis] = modulate(outputs.duties[axis], inputs.pwm_period);
        }
        outputs.twist = direct(&configuration.direct, &outputs.speeds);
        outputs
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
            lower: -Duty::ONE,
            upper: Duty::ONE,
        };
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
}
