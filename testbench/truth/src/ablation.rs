//! Data or truth spoiled on purpose. A workflow that still scores a hit on these scores it for a wrong reason.

use std::fmt;
use std::str::FromStr;

use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::log::Log;

/// What is spoiled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ablation {
    /// The camera's poses stand at each other's times.
    ShuffledCamera,
    /// The columns of two wheels are exchanged in the log, the truth keeps the wheel's own number.
    SwappedLabels,
    /// The truth names an effect that is not in the runs.
    AbsentTruth,
}

impl Ablation {
    /// For tables that go through every ablation.
    pub const ALL: [Self; 3] = [Self::ShuffledCamera, Self::SwappedLabels, Self::AbsentTruth];

    /// Spoils a finished log; `wheels` are the two (indices from 0) whose labels are exchanged.
    pub(crate) fn spoil(self, log: &mut Log, wheels: [usize; 2], rng: &mut ChaCha8Rng) {
        match self {
            Self::ShuffledCamera => {
                let mut poses: Vec<[f64; 3]> = log.frames.iter().map(|frame| frame.pose).collect();
                poses.shuffle(rng);
                log.frames.iter_mut().zip(poses).for_each(|(frame, pose)| frame.pose = pose);
            }
            Self::SwappedLabels => {
                let [a, b] = wheels;
                for row in &mut log.rows {
                    row.refs.swap(a, b);
                    row.counts.swap(a, b);
                    row.duties.swap(a, b);
                }
            }
            Self::AbsentTruth => {}
        }
    }
}

impl fmt::Display for Ablation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::ShuffledCamera => "shuffled-camera",
            Self::SwappedLabels => "swapped-labels",
            Self::AbsentTruth => "absent-truth",
        })
    }
}

impl FromStr for Ablation {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        Self::ALL
            .into_iter()
            .find(|ablation| ablation.to_string() == text)
            .ok_or_else(|| Error::UnknownKind(format!("ablation:{text}")))
    }
}
