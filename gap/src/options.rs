//! Everything that is decided before fitting.

use links::effect::{Effect, Link};
use links::thresholds;

/// Thresholds of the selection, fixed before anything is fitted and printed in the report.
#[derive(Debug, Clone, PartialEq)]
pub struct Thresholds {
    /// Standard deviation of an effect that is not named, as a share of its materiality threshold.
    pub held_share: f64,
    /// The same for effects that are switched on, as a share of the size they are tried at.
    pub held_switch: f64,
    /// Share of a named effect that an effect of the same look may have without being named, where the law is one of
    /// friction or motors.
    pub law_share: f64,
    /// Objective an effect must gain after paying for its parameters.
    pub gain: f64,
    /// Cost of naming an effect, and of each parameter beyond the first.
    pub costs: [f64; 2],
    /// Share of the held-out sum of squares an effect must explain: motion, drive.
    pub shares: [f64; 2],
    /// Share of what exceeds the noise, held out, that an effect must explain.
    pub share_of_excess: f64,
    /// Held-out gain over clusters in units of its own spread.
    pub held_out_t: f64,
    /// An effect is dropped, or simplified, if the objective gets no worse than this.
    pub slack: f64,
    /// Objectives that differ by less are a tie, which the order of the catalogue breaks; and the
    /// share of what an effect gains that its law is not exact enough to decide by.
    pub ties: [f64; 2],
    /// Correlation of drive residuals: how many count as one.
    pub drive_correlation: f64,
    /// [`thresholds::ROLLING_LOSES`].
    pub rolling_loses: f64,
    /// [`thresholds::WARMTH`].
    pub warmth: f64,
    /// [`thresholds::STICKS`].
    pub sticks: f64,
    /// [`thresholds::STICKS_OFTEN`].
    pub sticks_often: f64,
    /// [`thresholds::RUNAWAY`].
    pub runaway: f64,
    /// [`thresholds::FAR_LEFT`].
    pub far_left: f64,
    /// [`thresholds::AS_WELL`].
    pub as_well: f64,
    /// [`thresholds::UNDECIDED`].
    pub undecided: f64,
    /// [`thresholds::DWARFS`].
    pub dwarfs: f64,
    /// [`thresholds::FROM_NOISE`].
    pub from_noise: f64,
    /// [`thresholds::TOLD`].
    pub told: f64,
    /// [`thresholds::LEAST_TOGETHER`].
    pub least_together: f64,
    /// [`thresholds::CANCELS`].
    pub cancels: f64,
}

/// Relative uncertainty of a law of friction or motors, to which `law_share` belongs.
const ORDINARY_LAW: f64 = 0.015;

impl Default for Thresholds {
    fn default() -> Self {
        Self {
            held_share: 0.25,
            held_switch: 0.15,
            law_share: 0.08,
            gain: 4.0,
            costs: [8.0, 2.0],
            shares: [0.003, 0.02],
            share_of_excess: 0.12,
            held_out_t: 2.0,
            slack: 0.0,
            ties: [4.0, 0.01],
            drive_correlation: 1.5,
            rolling_loses: thresholds::ROLLING_LOSES,
            warmth: thresholds::WARMTH,
            sticks: thresholds::STICKS,
            sticks_often: thresholds::STICKS_OFTEN,
            runaway: thresholds::RUNAWAY,
            far_left: thresholds::FAR_LEFT,
            as_well: thresholds::AS_WELL,
            undecided: thresholds::UNDECIDED,
            dwarfs: thresholds::DWARFS,
            from_noise: thresholds::FROM_NOISE,
            told: thresholds::TOLD,
            least_together: thresholds::LEAST_TOGETHER,
            cancels: thresholds::CANCELS,
        }
    }
}

impl Thresholds {
    /// The same with next to no margin for what is not named.
    pub fn narrow(&self) -> Self {
        Self { held_share: 0.1 * self.held_share, held_switch: 0.1 * self.held_switch, ..self.clone() }
    }

    /// Share of a named effect whose law is that uncertain which a look-alike may have without being named.
    pub fn law_share(&self, uncertainty: f64) -> f64 {
        self.law_share * (uncertainty / ORDINARY_LAW).min(1.0)
    }

    /// Cost of freeing an effect with this many parameters.
    pub fn cost(&self, parameters: usize) -> f64 {
        self.costs[0] + self.costs[1] * parameters.saturating_sub(1) as f64
    }

    /// Difference below which two explanations that gain this much are a tie.
    pub fn tie(&self, gain: f64) -> f64 {
        self.ties[0].max(self.ties[1] * gain)
    }

    /// Share of the held-out sum of squares.
    pub fn share(&self, link: Link) -> f64 {
        if link == Link::Motion { self.shares[0] } else { self.shares[1] }
    }

    /// Whether the floors left of one law speak against it beside those that another one of no more parameters leaves,
    /// however much both explain: far from the noise, where the other is hardly above it. A servo whose torque constant
    /// was 17 % off (500 floors) was explained to 1 % by viscous friction, which left 26 floors where the torque constant
    /// left 0.9.
    pub fn decided(&self, worse: f64, better: f64) -> bool {
        let excess = |floors: f64| (floors * floors - 1.0).max(0.0);
        worse > self.from_noise && excess(better) < self.undecided * excess(worse)
    }

    /// Residuals per independent one.
    pub fn correlation(&self, link: Link) -> f64 {
        if link == Link::Motion { 1.0 } else { self.drive_correlation }
    }
}

/// What a user may choose.
#[derive(Default)]
pub struct Options {
    /// Thresholds of the selection.
    pub thresholds: Thresholds,
    /// The robot's file, whose comments the new one keeps [default: robot.toml in the data set].
    pub robot_file: Option<std::path::PathBuf>,
    /// Effects beyond the catalogue.
    pub effects: Vec<std::sync::Arc<dyn Effect>>,
    /// Is told the share of the work that is done, 0 to 1, after every stage.
    pub progress: Option<Progress>,
}

/// What is told how far an analysis is.
pub type Progress = Box<dyn Fn(f64) + Send + Sync>;

impl Options {
    /// Says that a stage is done.
    pub(crate) fn reached(&self, stage: Stage) {
        if let Some(progress) = &self.progress {
            progress(f64::from(stage as u32) / 100.0);
        }
    }
}

/// Stages of an analysis with the percentage of its time after which each is done. The percentages are guesses for logs
/// with camera and duties: no experiment set them, and they move the bar alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stage {
    /// Logs read and cut, exact links replayed.
    Exact = 5,
    /// Effects of the motion selected.
    MotionChosen = 25,
    /// Judged.
    MotionStudied = 40,
    /// Effects of the drive selected.
    DriveChosen = 75,
    /// Judged.
    DriveStudied = 85,
    /// The written file measured.
    Measured = 95,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_law_is_decided_against_only_far_from_the_noise() {
        // Floors left by the one, by the other, and whether that speaks against the one.
        for (worse, better, wanted) in
            [(26.0, 0.9, true), (2.0, 1.1, true), (1.4, 0.9, false), (26.0, 20.0, false), (1.0, 26.0, false)]
        {
            assert_eq!(Thresholds::default().decided(worse, better), wanted, "{worse} {better}");
        }
    }
}
