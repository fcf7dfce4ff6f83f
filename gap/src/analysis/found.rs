//! What an analysis reports.

use runs::robot::Robot;

use super::driven::Driven;
use crate::evidence::{Evidence, Interval};
use crate::exact::ExactLink;
use crate::limits::Limit;
use crate::locate::Located;
use crate::thresholds::Thresholds;
use links::drive::DriveResiduals;
use links::effect::Link;
use links::motion::{Ways, WindowResiduals};

/// What the analysis comes to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing material beyond noise.
    Agrees,
    /// One or more effects are missing, and named.
    MissingEffect,
    /// Several effects explain the gap equally well.
    Ambiguous,
    /// Something significant and structured is left that no effect explains.
    Unexplained,
    /// Nothing in the logs had any weight: the remarks say what would be needed.
    NotCompared,
}

impl Verdict {
    /// As in `gap.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::MissingEffect => "missing-effect",
            Self::Ambiguous => "ambiguous",
            Self::Unexplained => "unexplained",
            Self::NotCompared => "not-compared",
        }
    }
}

/// A named effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Named {
    /// As in the catalogue, such as `wheel-radius`.
    pub name: String,
    /// Its law, as the catalogue has it.
    pub equation: String,
    /// Link it was found on.
    pub link: Link,
    /// Wheels from 1; empty for the whole robot.
    pub wheels: Vec<usize>,
    /// Parameters, and how well each is known.
    pub parameters: Vec<(String, f64, Interval)>,
    /// Share of its link's squared gap that comes back if it alone is taken out of the written file, 0 to 1.
    pub gain: f64,
    /// What the name rests on.
    pub evidence: Evidence,
    /// Effects on whose absence its sizes depend: the named ones can do what they do, with a part of what they are free
    /// to do, and how much of it is theirs does not show.
    pub conditional_on: Vec<String>,
}

#[cfg(test)]
impl Named {
    /// A name without parameters, on wheels from 1.
    pub(crate) fn bare(name: &str, link: Link, wheels: &[usize]) -> Self {
        Self {
            name: name.to_owned(),
            equation: String::new(),
            link,
            wheels: wheels.to_vec(),
            parameters: Vec::new(),
            gain: 0.0,
            evidence: Evidence::Test { method: "", p: 0.0002 },
            conditional_on: Vec::new(),
        }
    }
}

/// Structure that no effect of the catalogue explains.
#[derive(Debug, Clone, PartialEq)]
pub struct Leftover {
    /// Where it is left over.
    pub link: Link,
    /// In words.
    pub structure: String,
}

/// Gap figures of one link.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkGap {
    /// Between which two stages it was measured.
    pub link: Link,
    /// Held-out RMS in units of the noise floor, nominal.
    pub before: f64,
    /// With the named effects.
    pub after: f64,
    /// Physical floor per signal.
    pub floor: Vec<f64>,
    /// Physical RMS per signal, nominal and after.
    pub rms: Vec<[f64; 2]>,
    /// Unit of each signal.
    pub units: Vec<&'static str>,
    /// Number of signals.
    pub signals: usize,
}

/// Everything found out about a data set.
pub struct Analysis {
    /// What the workflow makes of the data set as a whole.
    pub verdict: Verdict,
    /// Where it disagrees, worst first.
    pub located: Vec<Located>,
    /// Named effects, largest gain first.
    pub effects: Vec<Named>,
    /// Sets of effects that cannot be told apart.
    pub alternatives: Vec<Vec<String>>,
    /// What is left.
    pub unexplained: Vec<Leftover>,
    /// Named effects that fit best but do not explain what is left.
    pub nearest: Vec<String>,
    /// What to do next.
    pub next_experiment: Option<crate::experiment::Experiment>,
    /// How far what was compared is from its noise, by the file and with what is named.
    pub links: Vec<LinkGap>,
    /// Detection limits, and what is detectable but immaterial.
    pub limits: Vec<Limit>,
    /// The robot with the named effects.
    pub robot: Robot,
    /// The text of its file.
    pub robot_text: String,
    /// Names of the effects that were tried.
    pub tried: Vec<String>,
    /// The first runs whole, as windows, before and after, for plots.
    pub whole: Option<[Vec<WindowResiduals>; 2]>,
    /// Waterfall: label and held-out RMS in units of the floor.
    pub waterfall: Vec<(String, f64)>,
    /// Name of the data set.
    pub name: String,
    /// Names of its runs.
    pub runs: Vec<String>,
    /// Thresholds that were in force.
    pub thresholds: Thresholds,
    /// Motion residuals before and after, for plots.
    pub motion: Option<[Vec<WindowResiduals>; 2]>,
    /// Drive residuals before and after.
    pub drive: Option<[DriveResiduals; 2]>,
    /// What was driven where those residuals are, and what the camera saw.
    pub driven: Driven,
    /// Windows of the motion link, s.
    pub window_s: f64,
    /// What wheels and poses part by, where motion is compared along ways.
    pub ways: Option<Ways>,
    /// Held-out RMS in floors of the links that were fitted: every run predicted by what the others say.
    pub held_out: Vec<(Link, f64)>,
    /// What remains beside what is named, one sentence a link.
    pub remains: Vec<String>,
    /// Mistakes of the set-up that were passed over.
    pub mistakes: Vec<String>,
    /// What could not be compared, and why.
    pub remarks: Vec<String>,
    /// Deterministic links.
    pub exact: Vec<ExactLink>,
}
