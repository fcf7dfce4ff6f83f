//! Everything that is decided before fitting.

use crate::effect::{Effect, Link};

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
