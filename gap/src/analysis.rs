//! The whole workflow on one data set.

mod driven;
mod gaps;
mod measure;
mod order;
mod patterns;
mod robot_file;
mod study;

use std::sync::Arc;

use runs::robot::{Robot, Support};
use runs::{DataSet, Logs};

use crate::drive::{DriveLink, DriveResiduals};
use crate::effect::{Effect, Link, Sizes};
use crate::evidence::{Evidence, Interval};
use crate::exact::{ExactLink, Finding};
use crate::motion::{MotionLink, WindowResiduals};
use crate::options::{Options, Stage, Thresholds};
use crate::pieces::{PIECE, segments};
use crate::problem::Problem;
use crate::state::{Active, State};
use crate::{GapError, command, controller, effects, timing};

use gaps::Remains;
use measure::{Data, Drive, Measured};
use order::{ORDER, order_named, wheel_order};
use patterns::ripple_named;
use robot_file::{completed, given, robot_text, with_effects};
use study::{Outcome, chosen};

pub use crate::locate::Located;
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
    /// What it is.
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

/// An effect that is detectable but immaterial, or the limit from which it would be named.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// Name of the effect.
    pub name: String,
    /// As in `robot.toml`.
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
    /// Where it is left over.
    pub link: Link,
    /// In words.
    pub structure: String,
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
    /// Windows of the motion link, s.
    pub window_s: f64,
    /// Held-out RMS in floors of the links that were fitted: every run predicted by what the others say.
    pub held_out: Vec<(Link, f64)>,
    /// What remains beside what is named, one sentence a link.
    pub remains: Vec<String>,
    /// What could not be compared, and why.
    pub remarks: Vec<String>,
    /// Deterministic links.
    pub exact: Vec<ExactLink>,
}

/// Whole runs that a report shows.
const SHOWN: usize = 4;

/// Share of the torque that the motors reach in the logs beyond which scatter is no noise of a drive.
const NO_NOISE: f64 = 0.15;
/// Share of what a duty varies that its wheel's motion accounts for, from which it is this drive's, however much
/// scatters: less, and most of it has nothing to do with the wheel.
const OWN: f64 = 0.5;

/// Share of a link's gap that must be left at most once its effects stand in the file.
const FALLS: f64 = 0.98;

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
    let catalogue: Vec<Arc<dyn Effect>> = effects::catalogue_for(set.logs.len())
        .into_iter()
        .map(Arc::from)
        .chain(options.effects.iter().cloned())
        .collect();
    let mut start = State { robot: robot.clone(), active: given(robot, &catalogue) };
    let mut remarks = set.notes();
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
    let window_s = crate::motion::WINDOW_S;
    let order = wheel_order(&MotionLink::new(&pieces, noise, window_s), &start, &catalogue);
    let cabled = |a: &&Active| a.effect.name() == ORDER && a.values.find("cable_1").is_some();
    let wired = order.as_ref().map(|o| o.0.clone()).or_else(|| start.active.iter().find(cabled).cloned());
    if let Some(active) = &wired {
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
    let motion_link = MotionLink::new(&pieces, noise, window_s).felt(&start.motion(None));
    let has_motion = (!motion_link.is_empty() || motion_link.inertial.is_some()) && robot.support == Support::Floor;
    let data = Data {
        pieces: &pieces,
        motion: &motion_link,
        has_motion,
        logs: &set.logs,
        catalogue: &catalogue,
        thresholds: &options.thresholds,
    };
    start = data.state(&set.robot);
    let nominal = start.clone();
    let mut study = Findings::default();

    if let Some((active, gain)) = order {
        study.named.push(order_named(&active, gain));
        study.found.push(active.clone());
        start.active.push(active);
    }
    study.unexplained.extend(crate::leftover::frozen(&pieces));
    study.unexplained.extend(crate::leftover::torn(&pieces));
    options.reached(Stage::Exact);
    let mut seen = None;
    if has_motion {
        let problem = Problem::Motion(&motion_link);
        let selection = chosen(&problem, &start, &[], &catalogue, &thresholds, gaps::motion_matters(&motion_link));
        options.reached(Stage::MotionChosen);
        let outcome = study::study(&problem, &start, selection, &catalogue, &thresholds, gaps::FAR);
        seen = Some(motion_link.residuals(&outcome.written.motion(None)));
        start = study.take(outcome, Link::Motion, start.active.len());
        start.active.iter_mut().for_each(|a| a.given = true);
    }
    if !data.has_camera() {
        remarks.push(missing(set));
    }
    options.reached(Stage::MotionStudied);
    if let Some(found) = data.drive(&start, seen.as_ref()) {
        let Drive { mut link, correlation, .. } = found;
        let mut floor = link.noise.clone();
        let slides = start.active.iter().any(|a| a.effect.name() == "wheel-slip");
        let reached = link.sizes.drive_nm;
        if let Some(worst) = floor.iter().copied().reduce(f64::max).filter(|worst| *worst > NO_NOISE * reached) {
            let scatters =
                format!("scatters by {:.0} mNm, {:.0} % of what they reach", 1e3 * worst, 100.0 * worst / reached);
            let own = crate::drive::accounted(&link, &start.drive(None)).into_iter().all(|share| share > OWN);
            if own {
                remarks.push(format!("What the motors do {scatters}: smaller effects do not show."));
            } else {
                let structure =
                    format!("what the duties predict {scatters}, at random: are these the duties of this drive?");
                study.leave(Link::Drive, [structure]);
            }
        }
        thresholds.drive_correlation = correlation;
        // What a camera would have shown is not deduced from duties.
        let limits = &study.limits;
        let shown = |e: &Arc<dyn Effect>| {
            let own = limits.iter().filter(|l: &&Limit| l.name == e.name());
            e.also() == Some(Link::Drive) && own.clone().count() > 0 && own.clone().all(|l| l.limit < SEEN * l.material)
        };
        let here: Vec<Arc<dyn Effect>> = catalogue.iter().filter(|e| !shown(e)).cloned().collect();
        let looked = |link: &DriveLink, thresholds: &Thresholds, known: &[Active], floor: &[f64]| {
            chosen(
                &Problem::Drive(link),
                &start,
                known,
                &here,
                thresholds,
                gaps::FAR * gaps::floor_of_scatter(link, floor, thresholds),
            )
        };
        let from = start.active.len();
        let mut selection = looked(&link, &thresholds, &[], &floor);
        // What has a name now is no noise: the next effect is looked for above the floor without it.
        for _ in 0..LOOKS {
            if !selection.state.active[from..].iter().any(Active::is_named) {
                break;
            }
            let sticks = link.mask_sticking(&selection.state.drive(None), thresholds.sticks) > thresholds.sticks_often;
            let noise = (&floor[..], thresholds.drive_correlation);
            match lowered(&link, &selection.state, noise, reached) {
                Some((lower, correlation)) => {
                    link.noise.clone_from(&lower);
                    floor = lower;
                    thresholds.drive_correlation = correlation;
                }
                None if sticks => {}
                None => break,
            }
            selection = looked(&link, &thresholds, &selection.state.active[from..], &floor);
        }
        options.reached(Stage::DriveChosen);
        let least = gaps::floor_of_scatter(&link, &floor, &thresholds);
        let mut outcome =
            study::study(&Problem::Drive(&link), &start, selection, &here, &thresholds, gaps::FAR * least);
        outcome.held_out /= least;
        let rattling = patterns::rattling(&pieces, robot, &start.drive(None), &catalogue)
            .filter(|r| !slides && robot.effect(&r.name).is_none());
        if rattling.is_some() && !outcome.named.is_empty() {
            let names: Vec<&str> = outcome.named.iter().map(|n| n.name.as_str()).collect();
            remarks.push(format!(
                "While rotors rattle in their play, friction and inertia are not judged; fitted, and not named: {}.",
                names.join(", ")
            ));
            outcome.forget(&start);
        }
        let [before, after] = [&start, &outcome.written].map(|s| study::rms(&Problem::Drive(&link), s));
        let misses = Misses::new(seen.as_ref(), FAR);
        let rolls = |run: usize, t: f64| !misses.are_near(run, t);
        let model = outcome.selection.state.drive(None);
        let leftover = crate::leftover::drive(&pieces, &model, &link.masked(), &rolls, link.sizes);
        // Beside a named effect only what its law's inexactness cannot leave.
        let explained = if outcome.named.is_empty() { 0.0 } else { before.powi(2) - after.powi(2) };
        for structure in leftover.structures {
            if structure.share * after.powi(2) >= LAW_LEAVES * explained {
                study.leave(Link::Drive, [structure.text]);
            } else {
                remarks.push(format!("Small beside what is named on the drive: {}.", structure.text));
            }
        }
        // Wheels that slide chatter from roller to roller.
        if let Some(ripple) = leftover.ripple.filter(|_| robot.effect("roller-ripple").is_none() && !slides) {
            match ripple_named(&ripple, robot, &catalogue) {
                Ok(ripple) => study.named.push(ripple),
                Err(structure) => study.leave(Link::Drive, [structure]),
            }
        }
        if rattling.is_some() && !has_motion {
            // Sliding wheels shake, too; a camera would have seen that.
            study.alternatives.push(vec!["gear-backlash".to_owned(), "wheel-slip".to_owned()]);
        }
        study.named.extend(rattling);
        study.take(outcome, Link::Drive, from);
    } else {
        remarks.push(
            "No duties in the logs (or none that belong to the wheels): the drive link is not compared.".to_owned(),
        );
    }
    options.reached(Stage::DriveStudied);
    let mut exact_links = Vec::new();
    for link in &exact {
        let is_new = |f: &&Finding| f.name == ORDER || !study.named.iter().any(|n: &Named| n.name == f.name);
        if let Some(f) = link.finding.as_ref().filter(is_new) {
            study.named.push(exact_named(f, link));
        } else if link.unexplained {
            let told = link.replay.as_ref().and_then(|r| r.structure.clone());
            let structure = told.unwrap_or_else(|| {
                format!(
                    "differs at {:.1} % of the ticks, and no hypothesis of the catalogue replays it",
                    100.0 * link.wrong_share
                )
            });
            study.leave(link.link, [structure]);
        }
        remarks.extend(link.replay.as_ref().map(|r| r.remark.clone()));
        exact_links.push(gaps::exact_gap(link));
    }
    let Findings { mut named, mut alternatives, limits, mut unexplained, mut ambiguous, found, refused, held_out } =
        study;
    remarks.extend(refused);
    let odd = odd_clock(robot, &set.logs);
    if let Some(remark) = &odd {
        // What was found by that clock is nothing.
        remarks.push(remark.clone());
        named.clear();
        alternatives.clear();
        unexplained.clear();
    }
    let runs: Vec<String> = set.logs.iter().map(|r| r.name.clone()).collect();
    // What is reported is what the file, read again, gives; where that does not fall, nothing is named.
    let (robot_with, text, measured) = loop {
        let robot_with = with_effects(&set.robot, &named, &alternatives, &runs);
        let text = robot_text(set, options, &robot_with);
        let path = options.robot_file.clone().unwrap_or_else(|| set.folder.join("robot.toml"));
        let reread = Robot::parse_partial(&text, &path).map_err(|e| GapError::Robot(e.to_string()))?;
        // On blocks a log may speak of some of the axes only.
        let reread = reread.first_axes(robot.wheel_count());
        let new: Vec<&str> = named.iter().map(|n| n.name.as_str()).collect();
        let measured = data.measure(&set.robot, &reread, &new);
        let idle = |n: &Named| {
            let link = measured.links.iter().find(|l| l.link == n.link);
            matches!(n.evidence, Evidence::Test { .. })
                && n.link.is_fitted()
                && link.is_some_and(|l| l.after >= FALLS * l.before)
        };
        if !named.iter().any(idle) {
            break (robot_with, text, measured);
        }
        for n in named.iter().filter(|n| idle(n)) {
            remarks.push(format!("Fitted, and not named: {}; as written it does not lower the gap.", n.name));
        }
        let gone: Vec<String> = named.iter().filter(|n| idle(n)).map(|n| n.name.clone()).collect();
        named.retain(|n| !gone.contains(&n.name));
        alternatives.retain(|set| !set.first().is_some_and(|first| gone.contains(first)));
        ambiguous &= !named.is_empty();
    };
    options.reached(Stage::Measured);
    for n in &mut named {
        if let Some((_, gain)) =
            measured.gains.iter().find(|g| g.0 == n.name && matches!(n.evidence, Evidence::Test { .. }))
        {
            n.gain = *gain;
        }
    }
    named.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    let Measured { mut links, motion: motion_plots, drive, mut driven, steps, felt, .. } = measured;
    let mut located = crate::locate::inertial(&felt);
    if let Some(plots) = &motion_plots {
        located.extend(crate::locate::motion(&motion_link, &plots[0]));
    }
    let stall = Sizes::of(robot).stall_nm;
    let drive_noise = drive.as_ref().map_or_else(Vec::new, |d| d.floor.clone());
    if let Some(measured) = &drive
        && let Some(drive) = data.drive(&data.state(&robot_with), motion_plots.as_ref().map(|p| &p[1]))
    {
        located.extend(crate::locate::drive(&drive.link, &measured.plots[0], &measured.floor, stall));
    }
    for link in &exact {
        located.extend(crate::locate::exact(link));
    }
    let weightless = gaps::weightless(&pieces, drive.as_ref().map(|d| &d.plots[1]));
    links.extend(exact_links);
    if links.is_empty() && weightless.is_empty() {
        return Err(GapError::NothingToCompare);
    }
    let whole = data.has_camera().then(|| {
        let uncut = MotionLink::new(&pieces, noise, f64::INFINITY).first(SHOWN);
        let now = data.state(&robot_with);
        [uncut.residuals(&nominal.motion(None)), uncut.residuals(&now.motion(None))]
    });
    if data.has_camera() {
        driven.seen = Driven::seen(&pieces, SHOWN);
    }
    // What slides drives no body as Newton has it: the name says so already.
    let slides = |l: &LinkGap| l.link == Link::Drive && named.iter().any(|n: &Named| n.name == "wheel-slip");
    let mut remains = Vec::new();
    for l in links.iter().filter(|l| !slides(l)) {
        match gaps::remains(l, &located, &felt) {
            _ if odd.is_some() => {}
            Some(Remains::Open(structure)) if !unexplained.iter().any(|u| u.link == l.link) => {
                unexplained.push(Leftover { link: l.link, structure });
            }
            Some(Remains::Open(sentence) | Remains::Beside(sentence)) => remains.push(sentence),
            None => {}
        }
    }
    let compared = links.iter().filter(|l| !weightless.iter().any(|w| w.0 == l.link) && l.link != Link::Timing).count();
    let weight = if odd.is_some() { 0 } else { compared };
    let mut why: Vec<String> = weightless.into_iter().map(|w| w.1).collect();
    why.dedup();
    remarks.extend(why);
    let structural: Vec<String> = unexplained.iter().map(|u: &Leftover| u.link.name().to_owned()).collect();
    let nearest: Vec<String> =
        named.iter().filter(|n| structural.contains(&n.link.name().to_owned())).map(|n| n.name.clone()).collect();
    let verdict = match () {
        () if !unexplained.is_empty() && named.iter().all(|n| nearest.contains(&n.name)) => Verdict::Unexplained,
        () if named.is_empty() && weight == 0 => Verdict::NotCompared,
        () if named.is_empty() => Verdict::Agrees,
        () if ambiguous => Verdict::Ambiguous,
        () => Verdict::MissingEffect,
    };
    located.sort_by(|a: &Located, b| b.excess.total_cmp(&a.excess));
    let waterfall = gaps::waterfall(&links, &steps, &named);
    let known = crate::experiment::Findings {
        robot,
        found: &completed(&robot_with, &set.logs),
        active: &found,
        pieces: &pieces,
        noise: (noise, &drive_noise),
        window_s,
        thresholds: &thresholds,
        catalogue: &catalogue,
    };
    // Without a sensor nobody asked for its effects.
    let shows =
        |e: &dyn Effect| !e.link().is_inertial() || motion_link.inertial.as_ref().is_some_and(|sensor| sensor.shows(e));
    let next_experiment = match verdict {
        Verdict::Ambiguous | Verdict::MissingEffect => crate::experiment::propose(&known, &alternatives),
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
        robot_text: text,
        robot: robot_with,
        tried: catalogue.iter().filter(|e| !e.probe() && shows(e.as_ref())).map(|e| e.name().to_owned()).collect(),
        whole,
        waterfall,
        name: set.folder.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default(),
        runs,
        window_s,
        held_out,
        remains,
        thresholds,
        motion: motion_plots,
        drive: drive.map(|d| d.plots),
        driven,
        remarks,
        exact,
    })
}

/// Control periods between two rows of a log beyond which its times are in another unit.
const ODD_ROWS: f64 = 300.0;

/// What to say of logs whose times cannot be seconds.
fn odd_clock(robot: &Robot, logs: &[runs::Log]) -> Option<String> {
    let periods = logs.iter().filter_map(runs::Log::tick_s).map(|tick| tick * robot.control_rate_hz);
    periods.filter(|p| *p > 0.0).find(|p| p.max(1.0 / p) > ODD_ROWS).map(|odd| {
        format!(
            "Compared nothing: the rows are {odd:.3} control periods apart by the column t and control_rate_hz; t is in seconds \
             (are these milliseconds?)."
        )
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

/// Seconds in which the camera saw something else than the wheels said.
struct Misses(Vec<(usize, f64, f64)>);

impl Misses {
    fn new(windows: Option<&Vec<WindowResiduals>>, far: f64) -> Self {
        let is_far = |w: &&WindowResiduals| {
            let used = w.residuals.iter().zip(&w.weights).filter(|(_, weight)| **weight > 0.0);
            estimation::statistics::rms(used.flat_map(|(r, _)| *r)) > far
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

/// What the links of a data set gave so far.
#[derive(Default)]
struct Findings {
    named: Vec<Named>,
    alternatives: Vec<Vec<String>>,
    limits: Vec<Limit>,
    unexplained: Vec<Leftover>,
    ambiguous: bool,
    /// What was found, with values.
    found: Vec<Active>,
    refused: Vec<String>,
    held_out: Vec<(Link, f64)>,
}

impl Findings {
    /// Structures that nothing explains.
    fn leave(&mut self, link: Link, structures: impl IntoIterator<Item = String>) {
        self.unexplained.extend(structures.into_iter().map(|structure| Leftover { link, structure }));
    }

    /// Takes over what was found on a link from effect `from` on; the state that the next link starts from.
    fn take(&mut self, outcome: Outcome, link: Link, from: usize) -> State {
        self.found.extend(outcome.written.active[from..].iter().cloned());
        self.named.extend(outcome.named);
        self.alternatives.extend(outcome.sets);
        self.limits.extend(outcome.limits);
        self.leave(link, outcome.leftovers);
        self.ambiguous |= outcome.ambiguous;
        self.refused.extend(outcome.refused);
        self.held_out.push((link, outcome.held_out));
        outcome.written
    }
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
        evidence: f.evidence.clone(),
        conditional_on: Vec::new(),
    }
}
