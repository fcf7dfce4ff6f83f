//! Blind bench of the gap workflow: hides effects, lets the workflow look for them, scores.
//!
//! Every data set is written under an opaque name into a scratch folder of its own. The answer stays in memory and is
//! compared only after the workflow has finished. Scoring reads what a user gets: the keys of `gap.json`.

mod answer;
mod binomial;
mod score;
mod series;
mod table;

use std::panic::AssertUnwindSafe;
use std::path::Path;
use std::time::Instant;

use serde::{Deserialize, Serialize};
use thiserror::Error;
use truth::{Ablation, Conditions, Kind, Truth};

pub use answer::{Answer, NamedEffect};
pub use binomial::{lower_bound, upper_bound};
pub use score::{Grade, Scored, grade};
pub use series::{Series, run};
pub use table::Report;

/// What can stop the bench.
#[derive(Debug, Error)]
pub enum BlindError {
    /// A case cannot be drawn or written.
    #[error("the case cannot be made: {0}")]
    Truth(#[from] truth::Error),
    /// No scratch folder.
    #[error("no scratch folder: {0}")]
    Scratch(#[from] std::io::Error),
    /// The file of scores cannot be read or written.
    #[error("{path}: {why}")]
    Scores {
        /// File that holds the scores, or was to.
        path: std::path::PathBuf,
        /// What is wrong with it, and where.
        why: String,
    },
}

/// How many sets of which kind, and the seed of them all.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Seed of the whole series.
    pub seed: u64,
    /// Sets that hide nothing.
    pub effect_free: usize,
    /// Sets of every effect at every size.
    pub single: usize,
    /// Sizes of the single effects, 1 to 5.
    pub sizes: Vec<u8>,
    /// Single effects to be hidden; empty = all that can show.
    pub only: Vec<String>,
    /// Sets with two drawn effects, a look-alike pair every other time.
    pub pairs: usize,
    /// Sizes of both effects of a pair, in turn; empty = each drawn, 2 to 5.
    pub pair_sizes: Vec<u8>,
    /// Sets with a drawn effect that no catalogue lists.
    pub outside: usize,
    /// Sets with a drawn effect of the catalogue whose runs have no rotation.
    pub translations_only: usize,
    /// Sets whose data or truth are spoiled, each of the three ablations in turn.
    pub ablations: usize,
    /// Single motors and drive trains of any size that hide nothing.
    pub axes_free: usize,
    /// The same with one effect, of every effect and size.
    pub axes: usize,
    /// The same with two effects.
    pub axis_pairs: usize,
    /// Conditions of all sets of robots.
    pub conditions: Conditions,
}

impl Plan {
    /// An empty plan: all sizes, all effects, the usual conditions.
    pub fn new(seed: u64) -> Self {
        Self {
            seed,
            effect_free: 0,
            single: 0,
            sizes: vec![1, 2, 3, 4, 5],
            only: Vec::new(),
            pairs: 0,
            pair_sizes: Vec::new(),
            outside: 0,
            translations_only: 0,
            ablations: 0,
            axes_free: 0,
            axes: 0,
            axis_pairs: 0,
            conditions: Conditions::default(),
        }
    }

    /// The sets in the order in which they are tried; the seed of a set does not depend on how many others there are.
    pub fn tasks(&self) -> Vec<Task> {
        let series = |group: Group| truth::set_seed(self.seed, group as u64);
        let task = |group: Group, index: usize, kind: Kind| Task {
            group,
            seed: truth::set_seed(series(group), index as u64),
            kind,
            conditions: self.conditions.clone(),
        };
        let mut tasks = Vec::new();
        let wanted = |name: &str| self.only.is_empty() || self.only.iter().any(|n| n == name);
        for i in 0..self.effect_free {
            tasks.push(task(Group::EffectFree, i, Kind::EffectFree));
        }
        for round in 0..self.single {
            for (e, entry) in truth::catalogue().enumerate() {
                if !wanted(entry.name) || !truth::observable(entry, &self.conditions) {
                    continue;
                }
                for &size in &self.sizes {
                    let kind = Kind::Single { effect: Some(entry.name.to_owned()), size: Some(size) };
                    tasks.push(task(Group::Single, round * 1000 + e * 10 + usize::from(size), kind));
                }
            }
        }
        for i in 0..self.pairs {
            let size = self.pair_sizes.get(i / 2 % self.pair_sizes.len().max(1)).copied();
            let kind = if i % 2 == 0 { Kind::Pair { effects: None, size } } else { Kind::LookAlike { size } };
            tasks.push(task(Group::Pair, i, kind));
        }
        for i in 0..self.outside {
            tasks.push(task(Group::Outside, i, Kind::Outside { name: None, size: None }));
        }
        for i in 0..self.translations_only {
            let mut task = task(Group::TranslationsOnly, i, Kind::Single { effect: None, size: None });
            task.conditions.translations_only = true;
            tasks.push(task);
        }
        let axis =
            |effects: &[&str], size| Kind::Axis { effects: effects.iter().map(|e| (*e).to_owned()).collect(), size };
        for i in 0..self.axes_free {
            tasks.push(task(Group::AxisFree, i, axis(&[], None)));
        }
        for round in 0..self.axes {
            for (e, name) in truth::axis::names().enumerate().filter(|(_, n)| wanted(n)) {
                for &size in &self.sizes {
                    tasks.push(task(Group::Axis, round * 1000 + e * 10 + usize::from(size), axis(&[name], Some(size))));
                }
            }
        }
        for (i, pair) in (0..self.axis_pairs).zip(truth::axis::PAIRS.iter().cycle()) {
            let size = self.pair_sizes.get(i / truth::axis::PAIRS.len() % self.pair_sizes.len().max(1)).copied();
            tasks.push(task(Group::AxisPair, i, axis(pair, size)));
        }
        for (i, which) in (0..self.ablations).zip(Ablation::ALL.into_iter().cycle()) {
            tasks.push(task(Group::Ablation, i, Kind::Ablation(Some(which))));
        }
        tasks
    }
}

/// Rows of the table that belong together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Group {
    /// Nothing hidden.
    EffectFree,
    /// One effect.
    Single,
    /// Two effects.
    Pair,
    /// An effect that no catalogue lists.
    Outside,
    /// One effect, runs without rotation.
    TranslationsOnly,
    /// Data or truth spoiled: to be right is a failure of the bench.
    Ablation,
    /// A motor or a drive train of any size, nothing hidden.
    AxisFree,
    /// The same with one effect.
    Axis,
    /// The same with two effects.
    AxisPair,
}

impl Group {
    /// As in the table.
    pub fn name(self) -> &'static str {
        match self {
            Self::EffectFree => "effect-free",
            Self::Single => "single",
            Self::Pair => "pair",
            Self::Outside => "outside",
            Self::TranslationsOnly => "translations-only",
            Self::Ablation => "ablation",
            Self::AxisFree => "axis, effect-free",
            Self::Axis => "axis, single",
            Self::AxisPair => "axis, pair",
        }
    }
}

/// One set to be made, analysed and scored.
#[derive(Debug, Clone, PartialEq)]
pub struct Task {
    /// Where it is counted.
    pub group: Group,
    /// What its data are drawn from, with the kind and the conditions.
    pub seed: u64,
    /// What is hidden.
    pub kind: Kind,
    /// Under which conditions.
    pub conditions: Conditions,
}

impl Task {
    /// Makes the data, has them analysed, and scores the answer.
    ///
    /// # Errors
    /// [`BlindError`] if the set cannot be made. A workflow that gives up is a score, not an error.
    pub fn run(&self) -> Result<Scored, BlindError> {
        let scratch = tempfile::tempdir()?;
        let sealed = self.make(scratch.path())?;
        Ok(self.score(&sealed, scratch.path(), &gap::Options::default()))
    }

    /// Writes the data into a folder and says what they hide.
    ///
    /// # Errors
    /// [`BlindError`] if the set cannot be made.
    pub fn make(&self, folder: &Path) -> Result<Truth, BlindError> {
        Ok(truth::make(self.seed, &self.kind, &self.conditions, folder)?)
    }

    /// Has the data of a folder analysed, and scores the answer.
    pub fn score(&self, sealed: &Truth, folder: &Path, options: &gap::Options) -> Scored {
        let start = Instant::now();
        let answer = std::panic::catch_unwind(AssertUnwindSafe(|| {
            let set = runs::DataSet::open(folder).map_err(|e| e.to_string())?;
            let analysis = gap::analyse(&set, options).map_err(|e| e.to_string())?;
            Answer::from_json(&analysis.to_json()).ok_or_else(|| "gap.json lacks a key".to_owned())
        }))
        .unwrap_or_else(|_| Err("the workflow panicked".to_owned()));
        Scored::new(self, sealed, answer, start.elapsed().as_secs_f64())
    }
}
