//! The whole workflow on one data set.

mod driven;
mod gaps;
mod order;
mod patterns;
mod robot_file;

use std::sync::Arc;

use runs::robot::{Robot, Support};
use runs::{DataSet, Logs};

use crate::drive::{DriveLink, DriveResiduals};
use crate::effect::{Effect, Link, Sizes};
use crate::exact::{ExactLink, Finding};
use crate::motion::{MotionLink, WindowResiduals};
use crate::options::{Options, Thresholds};
use crate::pieces::{PIECE, segments};
use crate::problem::{Owner, Problem};
use crate::select::{self, Bench, Selection};
use crate::state::{Active, State};
use crate::{GapError, command, controller, effects, timing};

use order::{ORDER, order_named, wheel_order};
use patterns::ripple_named;
use robot_file::{completed, given, robot_text, with_effects};

pub use driven::{Driven, Moment};
pub use gaps::{LinkGap, overall};
pub use robot_file::undo;

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
}

impl Verdict {
    /// As in `gap.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::MissingEffect => "missing-effect",
            Self::Ambiguous => "ambiguous",
            Self::Unexplained => "unexplained",
        }
    }
}

/// Where the model and the data part.
#[derive(Debug, Clone, PartialEq)]
pub struct Located {
    /// Link.
    pub link: Link,
    /// Signal, such as `enc_3`.
    pub signal: String,
    /// RMS residual in units of the noise floor.
    pub excess: f64,
    /// In words.
    pub place: String,
}

/// A named effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Named {
    /// Name.
    pub name: String,
    /// What it is.
    pub equation: String,
    /// Link it was found on.
    pub link: Link,
    /// Wheels from 1; empty for the whole robot.
    pub wheels: Vec<usize>,
    /// Parameters with 95 % intervals.
    pub parameters: Vec<(String, f64, [f64; 2])>,
    /// Share of the link's squared gap it closes, 0 to 1.
    pub gain: f64,
    /// By flipping the signs of clusters.
    pub p_value: f64,
}

/// An effect that is detectable but immaterial, or the limit from which it would be named.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// Name of the effect.
    pub name: String,
    /// Parameter.
    pub parameter: String,
    /// Its estimate if everything else unnamed is held near zero.
    pub estimate: f64,
    /// Its standard deviation.
    pub sd: f64,
    /// Size that is named in nine of ten such data sets.
    pub limit: f64,
    /// Materiality threshold.
    pub material: f64,
}

/// Structure that no effect of the catalogue explains.
#[derive(Debug, Clone, PartialEq)]
pub struct Leftover {
    /// Link.
    pub link: Link,
    /// In words.
    pub structure: String,
}

/// Everything found out about a data set.
pub struct Analysis {
    /// Verdict.
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
    /// Gap per link.
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
    /// What could not be compared, and why.
    pub remarks: Vec<String>,
    /// Deterministic links.
    pub exact: Vec<ExactLink>,
}

/// Whole runs that a report shows.
const SHOWN: usize = 4;

/// Share of the stall torque beyond which scatter is no noise of a drive.
const NO_NOISE: f64 = 0.15;

/// Limit of detection, in sizes that matter, up to which the camera decides on what both links show.
const SEEN: f64 = 2.0;

/// Analyses a data set in memory.
///
/// # Errors
/// As [`analyse_logs`].
pub fn analyse(set: &DataSet, options: &Options) -> Result<Analysis, GapError> {
    analyse_logs(&Logs::from(set), options)
}

/// Analyses a data set whose logs may be of any length.
///
/// # Errors
/// [`GapError`] if the robot cannot drive, the logs hold nothing that can be compared, or could not be read again.
pub fn analyse_logs(set: &Logs, options: &Options) -> Result<Analysis, GapError> {
    let analysis = analyse_all(set, options);
    match set.logs.iter().find_map(|log| log.failure()) {
        Some(failure) => Err(GapError::Log(failure.clone())),
        None => analysis,
    }
}

fn analyse_all(set: &Logs, options: &Options) -> Result<Analysis, GapError> {
    let robot = &completed(&set.robot, &set.logs);
    let geometry = robot.geometry().map_err(|e| GapError::Robot(e.to_string()))?;
    for effect in &options.effects {
        let wheels = effect.forms(robot).into_iter().flat_map(|f| f.wheels);
        if let Some(wheel) = wheels.filter(|w| *w >= robot.wheel_count()).max() {
            let (name, wheel, n) = (effect.name(), wheel + 1, robot.wheel_count());
            return Err(GapError::Effect(format!("{name}: wheels: there is no wheel {wheel}, the robot has {n}")));
        }
    }
    let catalogue: Vec<Arc<dyn Effect>> =
        effects::catalogue().into_iter().map(Arc::from).chain(options.effects.iter().cloned()).collect();
    let mut start = State { robot: robot.clone(), active: given(robot, &catalogue) };
    let mut remarks: Vec<String> = Vec::new();
    let mut exact: Vec<ExactLink> = [
        timing::analyse(robot, &set.logs),
        command::analyse(robot, &geometry, &set.logs, &mut remarks),
        controller::analyse(robot, &set.logs, &mut remarks),
    ]
    .into_iter()
    .flatten()
    .collect();
    for link in &mut exact {
        // What the robot's file already carries is no news.
        if let Some(f) = &link.finding
            && robot.effect(f.name).is_some()
            && f.name != ORDER
        {
            link.finding = None;
            link.before.clone_from(&link.after);
        }
    }
    let mut pieces = segments(robot, &geometry, &set.logs, PIECE);
    let frames = set.logs.iter().map(|log| log.camera().iter().map(|f| (f.t, f.pose)).collect());
    let noise = robot.camera_noise.unwrap_or_else(|| model::fit::camera_noise_of(frames));
    let order = wheel_order(&MotionLink::new(&pieces, noise, 1.0), &start, &catalogue);
    if let Some((active, _)) = &order {
        // Everything derived from the wheels follows their true order.
        let mut wheels = crate::motion::MotionModel::new(robot);
        active.effect.motion(&active.values, &mut wheels);
        if let Ok(true_geometry) = runs::geometry::Geometry::new(wheels.wheels, robot.wheel_radius_m) {
            pieces = segments(robot, &true_geometry, &set.logs, PIECE);
        }
    }
    if pieces.is_empty() {
        return Err(GapError::NothingToCompare);
    }
    let mut thresholds = options.thresholds.clone();
    let motion_link = MotionLink::new(&pieces, noise, 1.0);
    let mut links: Vec<LinkGap> = Vec::new();
    let mut located = Vec::new();
    let mut named = Vec::new();
    let mut alternatives = Vec::new();
    let mut limits = Vec::new();
    let mut unexplained = Vec::new();
    let mut waterfall_parts: Vec<(String, Link, f64)> = Vec::new();
    let mut ambiguous = false;
    let nominal = start.clone();
    let mut found: Vec<Active> = Vec::new();

    if let Some((active, gain)) = order {
        named.push(order_named(&active, gain));
        found.push(active.clone());
        start.active.push(active);
    }
    unexplained.extend(crate::leftover::frozen(&pieces));
    unexplained.extend(crate::leftover::torn(&pieces));
    let mut driven = Driven::default();
    let mut motion_plots = None;
    let mut whole = None;
    if motion_link.is_empty() || robot.support == Support::Blocks {
        remarks.push(missing(set));
    } else {
        let problem = Problem::Motion(&motion_link);
        let matters = gaps::motion_matters(noise);
        let selection = chosen(&problem, &start, &[], &catalogue, &thresholds, matters);
        let outcome = study(&problem, [&nominal, &start], selection, &catalogue, &thresholds);
        let before = motion_link.residuals(&nominal.motion(None));
        located.extend(crate::locate::motion(&motion_link, &before));
        let plots = [before, motion_link.residuals(&outcome.selection.state.motion(None))];
        links.push(gaps::motion_gap([outcome.before, outcome.after], noise, &plots));
        let uncut = MotionLink::new(&pieces, noise, f64::INFINITY).first(SHOWN);
        whole = Some([uncut.residuals(&nominal.motion(None)), uncut.residuals(&outcome.selection.state.motion(None))]);
        driven.frames = Driven::at_frames(&pieces, &plots[0]);
        driven.seen = Driven::seen(&pieces, SHOWN);
        motion_plots = Some(plots);
        collect(
            &outcome,
            Link::Motion,
            &mut named,
            &mut alternatives,
            &mut limits,
            &mut unexplained,
            &mut waterfall_parts,
            &mut ambiguous,
        );
        found.extend(outcome.selection.state.active[start.active.len()..].iter().filter(|a| a.worth()).cloned());
        start = outcome.selection.state.clone();
        start.active.iter_mut().for_each(|a| a.given = true);
    }
    let mut drive_plots = None;
    let mut drive_noise = Vec::new();
    if let Some(mut link) = DriveLink::new(&pieces, &start.drive(None)) {
        link.mask_slip(&start.motion(None));
        let slides = start.active.iter().any(|a| a.effect.name() == "wheel-slip");
        if slides {
            // Where the law of slip did not catch what slipped, Newton's law has no body to push.
            let misses = Misses::new(motion_plots.as_ref().map(|p: &[Vec<WindowResiduals>; 2]| &p[1]), FAR_AMISS);
            link.mask_times(|run, t| misses.are_near(run, t));
        }
        if let Some(residuals) = link.residuals(&start.drive(None)) {
            let stall = Sizes::of(robot).stall_nm;
            let (mut floor, correlation) = crate::drive::floor(&link, &residuals, stall);
            link.noise.clone_from(&floor);
            if let Some(worst) = floor.iter().copied().reduce(f64::max).filter(|worst| *worst > NO_NOISE * stall) {
                let structure = format!(
                    "what the duties predict scatters by {:.0} mNm, {:.0} % of the stall torque, at random: are these the \
                     duties of this drive?",
                    1e3 * worst,
                    100.0 * worst / stall
                );
                unexplained.push(Leftover { link: Link::Drive, structure });
            }
            thresholds.drive_correlation = correlation;
            // What a camera would have shown is not deduced from duties.
            let shown = |e: &Arc<dyn Effect>| {
                let own = limits.iter().filter(|l: &&Limit| l.name == e.name());
                e.also() == Some(Link::Drive)
                    && own.clone().count() > 0
                    && own.clone().all(|l| l.limit < SEEN * l.material)
            };
            let here: Vec<Arc<dyn Effect>> = catalogue.iter().filter(|e| !shown(e)).cloned().collect();
            let matters = |floor: &[f64]| gaps::drive_matters(floor, stall);
            let looked = |link: &DriveLink, thresholds: &Thresholds, known: &[Active], floor: &[f64]| {
                chosen(&Problem::Drive(link), &start, known, &here, thresholds, matters(floor))
            };
            let from = start.active.len();
            let mut selection = looked(&link, &thresholds, &[], &floor);
            // What has a name now is no noise: the next effect is looked for above the floor without it.
            for _ in 0..LOOKS {
                if !selection.state.active[from..].iter().any(Active::is_named) {
                    break;
                }
                let noise = (&floor[..], thresholds.drive_correlation);
                let Some((lower, correlation)) = lowered(&link, &selection.state, noise, stall) else { break };
                link.noise.clone_from(&lower);
                floor = lower;
                thresholds.drive_correlation = correlation;
                selection = looked(&link, &thresholds, &selection.state.active[from..], &floor);
            }
            let mut outcome = study(&Problem::Drive(&link), [&nominal, &start], selection, &here, &thresholds);
            drive_noise.clone_from(&floor);
            let rattling = patterns::rattling(&pieces, robot, &start.drive(None), &catalogue)
                .filter(|r| !slides && robot.effect(&r.name).is_none());
            if rattling.is_some() && !outcome.named.is_empty() {
                let names: Vec<&str> = outcome.named.iter().map(|n| n.name.as_str()).collect();
                remarks.push(format!(
                    "While rotors rattle in their play, friction and inertia are not judged; fitted, and not named: {}.",
                    names.join(", ")
                ));
                (outcome.after, outcome.ambiguous) = (outcome.before, false);
                outcome.named.clear();
                outcome.sets.clear();
            }
            let before = link.residuals(&nominal.drive(None)).unwrap_or(residuals);
            located.extend(crate::locate::drive(&link, &before, &floor, stall));
            let after = link.residuals(&outcome.selection.state.drive(None)).unwrap_or_else(|| before.clone());
            let plots = [before, after];
            links.push(gaps::drive_gap([outcome.before, outcome.after], &floor, &plots));
            let model = outcome.selection.state.drive(None);
            let misses = Misses::new(motion_plots.as_ref().map(|p| &p[1]), FAR);
            let rolls = |run: usize, t: f64| !misses.are_near(run, t);
            let leftover = crate::leftover::drive(&pieces, &model, &link.masked(), &rolls, Sizes::of(robot));
            // Beside a named effect only what its law's inexactness cannot leave.
            let explained = if outcome.named.is_empty() { 0.0 } else { outcome.before.powi(2) - outcome.after.powi(2) };
            for structure in leftover.structures {
                if structure.share * outcome.after.powi(2) >= LAW_LEAVES * explained {
                    unexplained.push(Leftover { link: Link::Drive, structure: structure.text });
                } else {
                    remarks.push(format!("Small beside what is named on the drive: {}.", structure.text));
                }
            }
            // Wheels that slide chatter from roller to roller.
            if let Some(ripple) = leftover.ripple.filter(|_| robot.effect("roller-ripple").is_none() && !slides) {
                named.push(ripple_named(&ripple, &catalogue));
            }
            if rattling.is_some() && motion_plots.is_none() {
                // Sliding wheels shake, too; a camera would have seen that.
                alternatives.push(vec!["gear-backlash".to_owned(), "wheel-slip".to_owned()]);
            }
            named.extend(rattling);
            collect(
                &outcome,
                Link::Drive,
                &mut named,
                &mut alternatives,
                &mut limits,
                &mut unexplained,
                &mut waterfall_parts,
                &mut ambiguous,
            );
            found.extend(outcome.selection.state.active[start.active.len()..].iter().filter(|a| a.worth()).cloned());
            driven.bumps = Driven::at_bumps(&link);
            drive_plots = Some(plots);
        }
    } else {
        remarks.push(
            "No duties in the logs (or none that belong to the wheels): the drive link is not compared.".to_owned(),
        );
    }
    for link in &exact {
        let is_new = |f: &&Finding| f.name == ORDER || !named.iter().any(|n: &Named| n.name == f.name);
        if let Some(f) = link.finding.as_ref().filter(is_new) {
            named.push(exact_named(f, link));
        } else if link.unexplained {
            let told = link.replay.as_ref().and_then(|r| r.structure.clone());
            let structure = told.unwrap_or_else(|| {
                format!(
                    "differs at {:.1} % of the ticks, and no hypothesis of the catalogue replays it",
                    100.0 * link.wrong_share
                )
            });
            unexplained.push(Leftover { link: link.link, structure });
        }
        remarks.extend(link.replay.as_ref().map(|r| r.remark.clone()));
        located.extend(crate::locate::exact(link));
        links.push(gaps::exact_gap(link));
    }
    if links.is_empty() {
        return Err(GapError::NothingToCompare);
    }
    // What slides drives no body as Newton has it: the name says so already.
    let slides = |l: &LinkGap| l.link == Link::Drive && named.iter().any(|n: &Named| n.name == "wheel-slip");
    let far = links.iter().filter(|l| !slides(l) && !unexplained.iter().any(|u| u.link == l.link));
    let far: Vec<Leftover> = far.filter_map(|l| gaps::stays_open(l, &located, Sizes::of(robot).stall_nm)).collect();
    unexplained.extend(far);
    let structural: Vec<String> = unexplained.iter().map(|u: &Leftover| u.link.name().to_owned()).collect();
    let nearest: Vec<String> =
        named.iter().filter(|n| structural.contains(&n.link.name().to_owned())).map(|n| n.name.clone()).collect();
    let verdict = match () {
        () if !unexplained.is_empty() && named.iter().all(|n| nearest.contains(&n.name)) => Verdict::Unexplained,
        () if named.is_empty() => Verdict::Agrees,
        () if ambiguous => Verdict::Ambiguous,
        () => Verdict::MissingEffect,
    };
    located.sort_by(|a: &Located, b| b.excess.total_cmp(&a.excess));
    let waterfall = gaps::waterfall(&links, &waterfall_parts);
    let robot_with =
        with_effects(&set.robot, &named, &alternatives, &set.logs.iter().map(|r| r.name.clone()).collect::<Vec<_>>());
    let findings = crate::experiment::Findings {
        robot,
        found: &completed(&robot_with, &set.logs),
        active: &found,
        pieces: &pieces,
        noise: (noise, &drive_noise),
        thresholds: &thresholds,
        catalogue: &catalogue,
    };
    let next_experiment = match verdict {
        Verdict::Ambiguous | Verdict::MissingEffect => crate::experiment::propose(&findings, &alternatives),
        _ => None,
    };
    Ok(Analysis {
        verdict,
        located,
        effects: named,
        alternatives,
        unexplained,
        nearest,
        next_experiment,
        links,
        limits,
        robot_text: robot_text(set, options, &robot_with),
        robot: robot_with,
        tried: catalogue.iter().filter(|e| !e.probe()).map(|e| e.name().to_owned()).collect(),
        whole,
        waterfall,
        name: set.folder.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default(),
        runs: set.logs.iter().map(|r| r.name.clone()).collect(),
        thresholds,
        motion: motion_plots,
        drive: drive_plots,
        driven,
        remarks,
        exact,
    })
}

fn missing(set: &Logs) -> String {
    let what = if set.robot.support == Support::Blocks {
        "The wheels are off the floor: the motion link is not compared."
    } else if set.logs.iter().all(|log| log.layout().counts.is_empty()) {
        "No encoder counts in the logs: the motion link is not compared."
    } else {
        "No second of the logs has four camera poses: the motion link is not compared."
    };
    what.to_owned()
}

/// RMS residual of a window far from what a second of noise reaches.
const FAR: f64 = 1.35;
/// The same where wheels slip, whose law is not exact.
const FAR_AMISS: f64 = 2.0;

/// Seconds in which the camera saw something else than the wheels said.
struct Misses(Vec<(usize, f64, f64)>);

impl Misses {
    fn new(windows: Option<&Vec<WindowResiduals>>, far: f64) -> Self {
        let is_far = |w: &&WindowResiduals| {
            let used = w.residuals.iter().zip(&w.weights).filter(|(_, weight)| **weight > 0.0);
            crate::statistics::rms(used.flat_map(|(r, _)| *r)) > far
        };
        let place = |w: &WindowResiduals| Some((w.run, w.t.first()? - 0.3, w.t.last()? + 0.3));
        Self(windows.into_iter().flatten().filter(is_far).filter_map(place).collect())
    }

    /// Whether one of them is near a time; they follow each other in the order of runs and times.
    fn are_near(&self, run: usize, t: f64) -> bool {
        let from = self.0.partition_point(|w| w.0 < run || w.0 == run && w.2 <= t);
        self.0[from..].first().is_some_and(|w| w.0 == run && w.1 < t)
    }
}

/// Share of the explained gap that the inexactness of a law may leave as structure.
const LAW_LEAVES: f64 = 0.05;

/// A link's selection with everything that is said about it.
struct Outcome {
    selection: Selection,
    before: f64,
    after: f64,
    named: Vec<Named>,
    sets: Vec<Vec<String>>,
    ambiguous: bool,
    limits: Vec<Limit>,
    leftovers: Vec<String>,
}

/// Looks at the drive again above a floor lowered by what was named.
const LOOKS: usize = 2;
/// Share of the information on a small effect that the floor must have hidden for another look.
const HIDDEN: f64 = 0.2;

/// Floor and correlation of the drive with what was named in the model, if they hid enough to look again.
fn lowered(
    link: &DriveLink,
    state: &State,
    (floor, correlation): (&[f64], f64),
    stall: f64,
) -> Option<(Vec<f64>, f64)> {
    let residuals = link.residuals(&state.drive(None))?;
    let (now, correlated) = crate::drive::floor(link, &residuals, stall);
    let lower: Vec<f64> = now.iter().zip(floor).map(|(a, b)| a.min(*b)).collect();
    let correlated = correlated.min(correlation);
    let noise = |floor: &[f64], correlation: f64| correlation * floor.iter().map(|f| f * f).sum::<f64>();
    (noise(&lower, correlated) < (1.0 - HIDDEN) * noise(floor, correlation)).then_some((lower, correlated))
}

/// Selects on one link, beginning with effects `known` from an earlier look; a gap of more than `matters` noise floors
/// is not left to adjustments.
fn chosen(
    problem: &Problem,
    start: &State,
    known: &[Active],
    catalogue: &[Arc<dyn Effect>],
    thresholds: &Thresholds,
    matters: f64,
) -> Selection {
    let selection = select::select(problem, start, known, catalogue, thresholds);
    let (inherited, count) = problem.linearise_nothing(start).plain();
    let open = (inherited / count.max(1.0)).sqrt();
    if selection.state.active[start.active.len()..].iter().any(Active::worth)
        || open <= matters
        || select::figures(&selection.bench).1 >= 0.7 * open
    {
        return selection;
    }
    select::single(problem, start, catalogue, thresholds).unwrap_or(selection)
}

/// Judges what was selected on one link, between the nominal robot and where the study starts.
fn study(
    problem: &Problem,
    [nominal, start]: [&State; 2],
    selection: Selection,
    catalogue: &[Arc<dyn Effect>],
    thresholds: &Thresholds,
) -> Outcome {
    let all = select::candidates(start, catalogue, problem.link());
    let from = start.active.len();
    let bench = &selection.bench;
    let fit = bench.fit_roles(&bench.estimating());
    let covariance = bench.covariance(&bench.estimating(), &fit);
    let (plain, n) = problem.linearise_nothing(nominal).plain();
    let before = (plain / n.max(1.0)).sqrt();
    let (_, after) = select::figures(bench);
    let (mut named, mut sets, mut leftovers, mut ambiguous) = (Vec::new(), Vec::new(), Vec::new(), false);
    for index in from..selection.state.active.len() {
        let active = &selection.state.active[index];
        if !active.worth() {
            continue;
        }
        if active.effect.probe() {
            leftovers.push(active.effect.describe(&active.values));
            continue;
        }
        let rivals = select::rivals(problem, &selection, index, &all, thresholds);
        let own = rivals.bench.candidates.iter().position(|c| {
            c.effect.name() == active.effect.name()
                && c.form.wheels == active.form.wheels
                && c.form.fixed == active.form.fixed
        });
        let p_value = own.map_or(1.0, |c| select::sign_flip(&rivals.bench, c));
        let (_, without) = raw_pair(&rivals.bench);
        sets.extend(rivals.sets.into_iter().filter(|s| !s.iter().any(|n| n.starts_with("probe"))));
        ambiguous |= rivals.ambiguous;
        let half = |j: usize| {
            let column = bench.linear.owners.iter().position(|o| *o == Owner::Active(index, j));
            let df = (bench.linear.gram.clusters.len()).saturating_sub(active.form.free.len());
            column.map_or(0.0, |c| model::fit::t_quantile_975(df) * covariance[(c, c)].max(0.0).sqrt())
        };
        let mut parameters: Vec<(String, f64, [f64; 2])> = active
            .form
            .free
            .iter()
            .enumerate()
            .map(|(j, p)| {
                let column = bench.linear.owners.iter().position(|o| *o == Owner::Active(index, j));
                let v = active.values.get(&p.name) + column.map_or(0.0, |c| fit.step[c]).clamp(-p.scale, p.scale);
                let v = active.effect.period(&p.name).map_or(v, |period| v.rem_euclid(period));
                // The effect's own law is not known to better than that.
                let half = half(j).hypot(2.0 * active.effect.law_uncertainty() * v);
                (p.name.clone(), v, [v - half, v + half])
            })
            .collect();
        parameters.extend(active.form.fixed.iter().map(|(n, v)| (n.clone(), *v, [*v, *v])));
        let with = after * after * n;
        named.push(Named {
            name: active.effect.name().to_owned(),
            equation: active.effect.equation().to_owned(),
            link: problem.link(),
            wheels: material_wheels(active),
            parameters,
            gain: ((without - with) / plain.max(without)).clamp(0.0, 1.0),
            p_value,
        });
    }
    named.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    Outcome {
        before,
        after,
        named,
        sets,
        ambiguous,
        limits: crate::limits::limits(problem.link(), bench, from, thresholds),
        leftovers,
        selection,
    }
}

/// RMS and sum of squares of a bench as it stands.
fn raw_pair(bench: &Bench) -> (f64, f64) {
    let (square, n) = bench.linear.gram.plain();
    ((square / n.max(1.0)).sqrt(), square)
}

fn material_wheels(active: &Active) -> Vec<usize> {
    let per_wheel = active.form.wheels.len() > 1 && active.form.free.len() >= active.form.wheels.len();
    if !per_wheel {
        return active.form.wheels.iter().map(|w| w + 1).collect();
    }
    let each = active.form.free.len() / active.form.wheels.len();
    active
        .form
        .wheels
        .iter()
        .enumerate()
        .filter(|(k, _)| {
            (k * each..(k + 1) * each)
                .any(|j| active.form.free[j].is_material(active.values.get(&active.form.free[j].name)))
        })
        .map(|(_, w)| w + 1)
        .collect()
}

#[allow(clippy::too_many_arguments)]
fn collect(
    outcome: &Outcome,
    link: Link,
    named: &mut Vec<Named>,
    alternatives: &mut Vec<Vec<String>>,
    limits: &mut Vec<Limit>,
    unexplained: &mut Vec<Leftover>,
    parts: &mut Vec<(String, Link, f64)>,
    ambiguous: &mut bool,
) {
    for n in &outcome.named {
        parts.push((n.name.clone(), link, n.gain));
    }
    named.extend(outcome.named.iter().cloned());
    alternatives.extend(outcome.sets.iter().cloned());
    limits.extend(outcome.limits.iter().cloned());
    unexplained.extend(outcome.leftovers.iter().map(|s| Leftover { link, structure: s.clone() }));
    *ambiguous |= outcome.ambiguous;
}

fn exact_named(f: &Finding, link: &ExactLink) -> Named {
    let square = |e: &[f64]| e.iter().map(|x| x * x).sum::<f64>();
    let gain = 1.0 - square(&link.after) / square(&link.before).max(1e-300);
    Named {
        name: f.name.to_owned(),
        equation: effects::exact_equation(f.name).to_owned(),
        link: f.link,
        wheels: f.wheels.iter().map(|w| w + 1).collect(),
        parameters: f.parameters.clone(),
        gain: gain.clamp(0.0, 1.0),
        p_value: 2e-4,
    }
}
