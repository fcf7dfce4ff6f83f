//! What to do next: the measurement or drive that separates what the data cannot.
//!
//! For every manoeuvre of the library the run is simulated with the robot as found, linearised like a
//! real log, and put beside the logs that are there: how far are the predictions of the tied
//! hypotheses apart once each is fitted as well as it can be?

use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

use estimation::parallel::each;
use model::effects::Applied;
use model::manoeuvre::{self, Manoeuvre};
use nalgebra::{DMatrix, DVector};
use runs::frames::Pose;
use runs::robot::Robot;
use runs::{Log, Run};

use crate::problem::{Linear, Owner, Problem};
use crate::select::{self, Design};
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use estimation::prior::Role;
use links::drive::DriveLink;
use links::effect::{Effect, Link};
use links::motion::MotionLink;
use links::pieces::{PIECE, Pieces, segments};

/// Standard deviations between hypotheses that count as told apart.
const SIGMAS: f64 = 5.0;
/// Times one manoeuvre is repeated at most; then it does not separate.
const MOST_TIMES: usize = 6;
/// Sets that are looked at.
const MOST_SETS: usize = 3;
/// Combinations of forms of two alternatives that are tried.
const MOST_PAIRS: usize = 120;

/// A proposal.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiment {
    /// `measurement` without driving, or `manoeuvre`.
    pub kind: &'static str,
    /// Name of the manoeuvre, or what to measure.
    pub what: String,
    /// Names it separates.
    pub separates: Vec<String>,
    /// Time it takes, s.
    pub seconds: f64,
    /// How often the manoeuvre is driven; 1 for a measurement.
    pub times: usize,
    /// Predicted distance between the hypotheses then, in standard deviations; `None` for a measurement.
    pub sigmas: Option<f64>,
    /// What it tells apart, for the user.
    pub why: String,
    /// Other manoeuvres that would do, with the seconds they need.
    pub others: Vec<(String, f64)>,
}

/// What is known when the question comes up.
pub(crate) struct Findings<'a> {
    /// The nominal robot, with the effects that its file carries.
    pub robot: &'a Robot,
    /// The same with what was found.
    pub found: &'a Robot,
    /// What was found, with values.
    pub active: &'a [Active],
    /// Pieces of the logs that are compared.
    pub pieces: &'a Pieces<'a>,
    /// Camera noise, and that of a test function of the drive, Nm.
    pub noise: ([f64; 3], &'a [f64]),
    /// Windows of the motion link, s.
    pub window_s: f64,
    /// Thresholds in force.
    pub thresholds: &'a Thresholds,
    /// Effects that may be the cause.
    pub catalogue: &'a [Arc<dyn Effect>],
}

/// The cheapest way to tell any of these sets apart; a drive before a measurement.
pub(crate) fn propose(findings: &Findings, sets: &[Vec<String>]) -> Option<Experiment> {
    let mut libraries: Vec<(&str, Option<Library>)> = Vec::new();
    let mut proposals: Vec<Experiment> = Vec::new();
    for set in sets.iter().take(MOST_SETS) {
        let name = set.first().map_or("", String::as_str);
        let known = libraries.iter().position(|(own, _)| *own == name).unwrap_or_else(|| {
            libraries.push((name, Library::of(findings, name)));
            libraries.len() - 1
        });
        let drives = libraries[known].1.as_ref().map_or_else(Vec::new, |library| library.drives(set));
        proposals.extend(for_set(findings, set, drives));
    }
    let rank = |e: &Experiment| (e.kind != "manoeuvre", e.seconds);
    proposals.into_iter().min_by(|a, b| {
        let ((a, s), (b, t)) = (rank(a), rank(b));
        a.cmp(&b).then(s.total_cmp(&t))
    })
}

/// The cheapest way to tell a set of names apart, the first of which is named, by some drives or without.
fn for_set(findings: &Findings, set: &[String], mut drives: Vec<Experiment>) -> Option<Experiment> {
    let measurement = set
        .iter()
        .filter_map(|n| findings.catalogue.iter().find(|e| e.name() == n))
        .filter_map(|e| e.measurement().map(|(what, minutes)| (what.to_owned(), 60.0 * minutes)))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    drives.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    let mut drives = drives.into_iter();
    let Some(mut best) = drives.next() else {
        let (what, seconds) = measurement?;
        return Some(Experiment {
            kind: "measurement",
            what,
            separates: set.to_vec(),
            seconds,
            times: 1,
            sigmas: None,
            why: "no manoeuvre of the library, driven on top of these logs, tells them apart".to_owned(),
            others: Vec::new(),
        });
    };
    best.others = drives.map(|e| (e.what, e.seconds)).collect();
    if let Some((what, seconds)) = measurement {
        best.why += &format!("; without driving: {what} ({:.0} min)", seconds / 60.0);
    }
    Some(best)
}

/// What the logs and every manoeuvre tell of a named effect.
struct Library<'a> {
    own: &'a Active,
    /// Its place among the candidates.
    index: usize,
    /// The logs, linearised with all else that was found.
    design: Design,
    /// JᵀJ of the logs.
    logs: DMatrix<f64>,
    /// Each manoeuvre, how long it takes in s, and its JᵀJ.
    manoeuvres: Vec<(Manoeuvre, f64, DMatrix<f64>)>,
}

impl<'a> Library<'a> {
    /// Of one of the effects found; every manoeuvre is simulated once, whatever the effect is to be told from.
    fn of(findings: &Findings<'a>, name: &str) -> Option<Self> {
        let own = findings.active.iter().find(|a| a.effect.name() == name)?;
        let link = own.link;
        // The rest of what was found stays as it is.
        let rest = findings.active.iter().filter(|a| a.effect.name() != own.effect.name());
        let rest = rest.map(|a| Active { given: true, ..a.clone() }).collect();
        let state = State { robot: findings.robot.clone(), active: rest };
        let mut candidates = select::candidates(&state, findings.catalogue, link);
        let is_own = |c: &Active| c.effect.name() == own.effect.name() && c.form.is(&own.form);
        let index = candidates.iter().position(is_own)?;
        if own.switched() {
            // Switched on as found; all others start from 0.
            candidates[index].values = own.values.clone();
        }
        let design = on_link(findings, findings.pieces, &state, link, |problem| {
            Design::new(problem, &state, &candidates, findings.thresholds)
        })?;
        let applied = Applied::of(findings.found);
        let driven = |m: &Manoeuvre| {
            let m = *m;
            let run = manoeuvre::simulate(m, &applied, findings.robot, Pose::new(0.4, -0.3, 0.5), 1).ok()?;
            let seconds = run.duration_s();
            let robot = Robot { support: m.support(), ..findings.robot.clone() };
            let log = [log(&robot, run, findings.pieces)?];
            let pieces = segments(&robot, &robot.geometry().ok()?, &log, PIECE);
            let there = State { robot, ..state.clone() };
            let linear = on_link(findings, &pieces, &there, link, |p| p.linearise(&there, &candidates))?;
            Some((m, seconds, information(&linear)))
        };
        let manoeuvres = each(&Manoeuvre::ALL, &driven).into_iter().flatten().collect();
        Some(Self { own, index, logs: information(&design.linear), design, manoeuvres })
    }

    /// Manoeuvres that tell the effect from the others of a set, each with the time it needs.
    fn drives(&self, set: &[String]) -> Vec<Experiment> {
        let alternatives = hypotheses(&self.design.candidates, &set[1..]);
        if alternatives.is_empty() {
            return Vec::new();
        }
        let sigmas = |jj: &DMatrix<f64>| self.sigmas(&alternatives, jj);
        let before = sigmas(&self.logs);
        let separates = |(m, seconds, new): &(Manoeuvre, f64, DMatrix<f64>)| {
            let times = (1..=MOST_TIMES).find(|k| sigmas(&(&self.logs + new * *k as f64)) >= SIGMAS)?;
            let reached = sigmas(&(&self.logs + new * times as f64));
            let own_set =
                if *m == Manoeuvre::Blocks { ", as a data set of its own with support = \"blocks\"" } else { "" };
            Some(Experiment {
                kind: "manoeuvre",
                what: m.name().to_owned(),
                separates: set.to_vec(),
                seconds: seconds * times as f64,
                times,
                sigmas: Some(reached),
                why: format!(
                    "{}{own_set}; simulated with this robot it sets {} {reached:.0} standard deviations apart, these logs {before:.1}",
                    m.purpose(),
                    set.join(" and "),
                ),
                others: Vec::new(),
            })
        };
        each(&self.manoeuvres, &separates).into_iter().flatten().collect()
    }

    /// Standard deviations between the effect as found and the best that alternatives can do, with the help
    /// of everything that is held near zero, where JᵀJ of all columns is `jj`.
    fn sigmas(&self, alternatives: &[Vec<usize>], jj: &DMatrix<f64>) -> f64 {
        let name = self.own.effect.name();
        let columns = self.design.linear.of_candidate(self.index);
        let size = if self.own.switched() {
            DVector::from_element(columns.len(), 1.0)
        } else {
            DVector::from_vec(self.own.parameters())
        };
        let variance = self.design.variance;
        let part = |r: &[usize], c: &[usize]| DMatrix::from_fn(r.len(), c.len(), |i, j| jj[(r[i], c[j])] / variance);
        let total = (size.transpose() * part(&columns, &columns) * &size)[0];
        let nearest = alternatives.iter().map(|alternative| {
            let roles = self.design.freeing(alternative);
            let theirs: Vec<usize> = (0..roles.len())
                .filter(|i| roles[*i] != Role::Out && jj[(*i, *i)] > 0.0)
                .filter(|i| match self.design.linear.owners[*i] {
                    Owner::Candidate(c, _) => self.design.candidates[c].effect.name() != name,
                    _ => true,
                })
                .collect();
            let mut information = part(&theirs, &theirs);
            for (k, i) in theirs.iter().enumerate() {
                if let Role::Held(sd, _) = roles[*i] {
                    information[(k, k)] += 1.0 / (sd * sd);
                }
            }
            let mixed = part(&theirs, &columns) * &size;
            total - mixed.dot(&estimation::normal_equations::solve(&information, &mixed))
        });
        nearest.fold(f64::INFINITY, f64::min).max(0.0).sqrt()
    }
}

/// The simulated run, with no more signals than the real logs have.
fn log(robot: &Robot, mut run: Run, like: &Pieces) -> Option<Log<'static>> {
    if !like.have_frames() {
        run.camera.clear();
        run.has_camera = false;
    }
    if !like.have_duties() {
        run.duty.clear();
    }
    if !like.have_sensor() {
        (run.gyro, run.acceleration, run.imu_temp) = (None, None, None);
    }
    run.check(robot, Path::new("simulated")).ok()?;
    Some(Log::from(Cow::Owned(run)))
}

/// Sets up a link over some pieces of log, with the noise of the real ones, and asks it something.
fn on_link<T>(
    findings: &Findings,
    pieces: &Pieces,
    state: &State,
    link: Link,
    ask: impl FnOnce(&Problem) -> T,
) -> Option<T> {
    match link {
        Link::Motion => {
            let motion = MotionLink::new(pieces, findings.noise.0, findings.window_s).felt(&state.motion(None));
            let lifted = state.robot.support == runs::robot::Support::Blocks;
            ((!motion.is_empty() || motion.inertial.is_some()) && !lifted).then(|| ask(&Problem::Motion(&motion)))
        }
        Link::Drive => {
            let mut drive = DriveLink::new(pieces, &state.drive(None))?;
            state.mask_slip(&mut drive);
            drive.noise = findings.noise.1.to_vec();
            Some(ask(&Problem::Drive(&drive)))
        }
        _ => None,
    }
}

/// JᵀJ of all columns.
fn information(linear: &Linear) -> DMatrix<f64> {
    linear.equations.information()
}

/// Ways in which the alternatives may mimic the named effect: one form of each.
fn hypotheses(candidates: &[Active], alternatives: &[String]) -> Vec<Vec<usize>> {
    let mut out: Vec<Vec<usize>> = vec![Vec::new()];
    for name in alternatives {
        let forms: Vec<usize> = (0..candidates.len()).filter(|c| candidates[*c].effect.name() == name).collect();
        out = out.iter().flat_map(|h| forms.iter().map(|f| [h.clone(), vec![*f]].concat())).take(MOST_PAIRS).collect();
    }
    out
}
