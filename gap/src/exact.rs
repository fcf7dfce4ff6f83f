//! What the deterministic links share: findings that are proved by replay, not fitted.

use runs::{Columns, Log, Run};

use crate::evidence::{Evidence, Interval};
use links::effect::Link;

/// An effect on a link that can be replayed to the last digit.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// Link it was found on.
    pub link: Link,
    /// Name of the effect.
    pub name: &'static str,
    /// Wheels from 0; empty for the whole robot.
    pub wheels: Vec<usize>,
    /// Parameters, and how well each is known.
    pub parameters: Vec<(String, f64, Interval)>,
    /// What it rests on.
    pub evidence: Evidence,
}

/// How well a deterministic link agrees.
#[derive(Debug, Clone, PartialEq)]
pub struct ExactLink {
    /// Link the figures are of.
    pub link: Link,
    /// Unit of the figures below.
    pub unit: &'static str,
    /// Half the rounding of what is logged: the floor.
    pub floor: f64,
    /// RMS of measured minus replayed, nominal and with the finding, one a wheel.
    pub before: Vec<f64>,
    /// With the finding; equal to `before` without one.
    pub after: Vec<f64>,
    /// Share of ticks that differ by more than rounding allows, nominal.
    pub wrong_share: f64,
    /// What explains it.
    pub finding: Option<Finding>,
    /// Whether it differs and nothing explains it.
    pub unexplained: bool,
    /// What the replay met, if there is something to tell.
    pub replay: Option<Replay>,
}

/// A replay of logged signals.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Replay {
    /// In a sentence.
    pub remark: String,
    /// Which words differ, where it was word for word and some do.
    pub structure: Option<String>,
    /// Words that were compared; 0 where it was not word for word.
    pub compared: usize,
    /// Words that differ.
    pub different: usize,
    /// Gaps in the logs.
    pub gaps: usize,
    /// Ticks that are missing in them.
    pub missing: u64,
}

/// Ticks at the start of a log that tell how its numbers are rounded.
pub(crate) const FIRST: usize = 1 << 16;

/// The step that all values of a signal are multiples of, if there is one above 1e-7.
pub(crate) fn quantum(logs: &[&Log], columns: Columns, signal: impl Fn(&Run) -> &[Vec<f64>]) -> f64 {
    let mut values = Vec::new();
    for log in logs {
        let part = log.part(0..log.len().min(FIRST), columns);
        let logged = signal(&part).iter().flatten().copied().filter(|v| v.is_finite() && *v != 0.0);
        values.extend(logged.take(4000 - values.len()));
    }
    for q in [0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 1e-4, 1e-5, 1e-6] {
        if !values.is_empty() && values.iter().all(|v| (v / q - (v / q).round()).abs() < 1e-4) {
            return q;
        }
    }
    0.0
}
