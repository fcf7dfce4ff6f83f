//! An analysis under way: link after link, each from what the one before left.

use std::sync::Arc;

use runs::Logs;
use runs::robot::Support;

use super::clocks;
use super::counts::{self, Wrong};
use super::findings::Findings;
use super::found::{LinkGap, Named};
use super::gaps;
use super::measure::Data;
use super::order::{TWO_SIDED, order_named};
use super::question::Question;
use super::stale::{self, Stale};
use super::study::{self, Outcome, chosen, study};
use crate::controller::{ENCODER_SCALE, with_other_counts};
use crate::exact::{ExactLink, Finding};
use crate::options::Stage;
use crate::problem::Problem;
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use crate::timing;
use links::effect::{Effect, Link};
use links::effects;
use links::motion::{MotionLink, WindowResiduals};
use model::setup::Winding;

/// An analysis under way.
pub(super) struct Workflow<'a> {
    pub(super) question: &'a Question<'a>,
    /// Pieces of the runs, links, logs and the thresholds that decide.
    pub(super) data: Data<'a>,
    /// What of them causes are looked for in; `None` for all.
    sample: Option<Data<'a>>,
    /// What the file says.
    pub(super) nominal: State,
    /// What of it the logs contradict.
    pub(super) stale: Vec<Stale>,
    /// What the next link starts from.
    pub(super) start: State,
    pub(super) thresholds: Thresholds,
    pub(super) findings: Findings,
    /// Residuals of the motion that was searched, with what is named there.
    pub(super) seen: Option<Vec<WindowResiduals>>,
    /// What currents beside the duties say of the motors.
    pub(super) winding: Option<Winding>,
    /// Torque that its speed loops answered, in that of the drive, where this is compared beside it.
    pub(super) answered: Option<f64>,
}

impl<'a> Workflow<'a> {
    /// `crossed` are cables that are not where the file has them, and their share of the squared gap.
    pub(super) fn new(
        question: &'a Question<'a>,
        motion: &'a MotionLink<'a>,
        sample: Option<&'a MotionLink<'a>>,
        crossed: Option<(Active, f64)>,
        mut remarks: Vec<String>,
    ) -> Self {
        let data = Data::new(question, motion);
        let sample = sample.map(|motion| Data::new(question, motion));
        let pieces = data.pieces;
        remarks.extend(sample.map(|sample| {
            let [part, all] = [sample.pieces, pieces].map(|pieces| pieces.seconds() / 60.0);
            format!(
                "Causes were looked for in {part:.1} of {all:.1} minutes, spread over all runs; estimates and gaps are of all."
            )
        }));
        let nominal = data.state(&question.set.robot);
        let mut start = nominal.clone();
        let stale = stale::taken_out(&sample.unwrap_or(data), &mut start);
        let mut findings = Findings { remarks, ..Findings::default() };
        if let Some((active, gain)) = crossed {
            findings.named.push(order_named(&active, gain));
            findings.found.push(active.clone());
            start.active.push(active);
        }
        findings.unexplained.extend(crate::leftover::frozen(pieces, &question.options.thresholds));
        findings.unexplained.extend(crate::leftover::torn(
            pieces,
            [motion.noise[0], motion.noise[1]],
            &question.options.thresholds,
        ));
        let thresholds = question.options.thresholds.clone();
        Self {
            question,
            data,
            sample,
            nominal,
            stale,
            start,
            thresholds,
            findings,
            seen: None,
            winding: None,
            answered: None,
        }
    }

    /// The data that causes are looked for in.
    pub(super) fn searched(&self) -> Data<'a> {
        self.sample.unwrap_or(self.data)
    }

    /// All data, where causes are looked for in a part of them.
    pub(super) fn beyond(&self) -> Option<Data<'a>> {
        self.sample.map(|_| self.data)
    }

    /// Counts a wheel turn that the controller reckons with, if they are not the file's.
    pub(super) fn counts(&mut self, links: &[ExactLink]) {
        let told = |link: &'_ ExactLink| {
            Some((exact_named(link.finding.as_ref()?, link), counts::of_loop(link.finding.as_ref()?)?))
        };
        let Some((named, scale)) = links.iter().find_map(told) else { return };
        let robot = &self.question.robot;
        let wrong = counts::whose(scale, &self.searched(), &self.start, &self.thresholds);
        let turn = std::f64::consts::TAU * robot.counts_per_wheel_rad();
        self.findings.remarks.push(counts::said(&wrong, scale, turn, self.data.has_motion));
        if let Wrong::File(active) = wrong {
            self.findings.named.push(counts::both_sides(named));
            self.findings.found.push(active.clone());
            self.start.active.push(active);
        }
    }

    /// What the controller says of a radius that the camera does not tell from counts.
    fn shared_counts(&mut self) {
        let scale = counts::for_radius(&self.findings.named, &self.findings.alternatives);
        let replayed = scale.and_then(|s| with_other_counts(&self.question.robot, self.data.logs, s, &self.thresholds));
        self.findings.remarks.extend(replayed.map(counts::shared));
        self.findings.remarks.extend(counts::slipped(&self.findings.named, &self.thresholds));
    }

    /// Encoders to camera and inertial sensor.
    pub(super) fn motion(&mut self) {
        if self.data.has_motion {
            let link = self.searched().motion;
            let mut outcome = self.motion_studied(&self.without(&[SMOOTHED]));
            outcome = self.beside_refused(&outcome).unwrap_or(outcome);
            outcome = self.of_one_clock(&outcome).unwrap_or(outcome);
            outcome = self.smoothed(&outcome).unwrap_or(outcome);
            self.late_or_filtered(&mut outcome);
            if self.drive_is_in_step(&outcome) {
                outcome = self.motion_studied(&self.without(&[SMOOTHED, LATE_COUNTS]));
                self.findings.remarks.push(IN_STEP.to_owned());
            }
            if self.drive_has_other_counts(&outcome) {
                outcome = self.motion_studied(&self.without(&[SMOOTHED, RADIUS]));
                self.findings.remarks.push(OTHER_COUNTS.to_owned());
            }
            self.seen = Some(link.of_frames(&outcome.written.motion(None), self.question.window_s));
            self.start = self.findings.take(outcome, Link::Motion, self.start.active.len());
            self.start.active.iter_mut().for_each(|a| a.given = true);
            self.shared_counts();
        }
        if !self.data.has_camera() {
            self.findings.remarks.push(missing(self.question.set));
        }
        self.question.options.reached(Stage::MotionStudied);
    }

    /// What is found between encoders and camera by effects of a catalogue.
    fn motion_studied(&self, here: &[Arc<dyn Effect>]) -> Outcome {
        let problem = Problem::Motion(self.searched().motion);
        let whole = || self.beyond().map(|data| Problem::Motion(data.motion));
        let matters = gaps::motion_matters(self.searched().motion, &self.thresholds);
        let selection = chosen(&problem, &self.start, &[], here, &self.thresholds, matters);
        self.question.options.reached(Stage::MotionChosen);
        study(&problem, &whole, &self.start, selection, here, &self.thresholds, self.thresholds.far)
    }

    /// The catalogue without some of its effects.
    fn without(&self, names: &[&str]) -> Vec<Arc<dyn Effect>> {
        self.data.catalogue.iter().filter(|e| !names.contains(&e.name())).cloned().collect()
    }

    /// What is found along ways beside what was fitted there and is not named, where nothing is: a clock of each run by chance took the
    /// place of half a track that is wider.
    fn beside_refused(&self, outcome: &Outcome) -> Option<Outcome> {
        self.searched().motion.ways.filter(|_| outcome.named.is_empty() && !outcome.refused.is_empty())?;
        let refused = outcome.refused.iter().map(|r| r.name.as_str());
        let again = self.motion_studied(&self.without(&refused.chain([SMOOTHED]).collect::<Vec<_>>()));
        (!again.named.is_empty()).then_some(again)
    }

    /// What is found without clocks of single runs, where those that have a name part by no more than chance, or all is far from
    /// the noise and they close little: wheels that slip in some of the runs fall behind there as if frames were young.
    fn of_one_clock(&self, outcome: &Outcome) -> Option<Outcome> {
        let clocks = outcome.named.iter().find(|n| n.name == CLOCKS)?;
        let is_far = outcome.held_out > self.thresholds.far;
        if !is_far && !clocks::are_one(clocks) {
            return None;
        }
        let again = self.motion_studied(&self.without(&[SMOOTHED, CLOCKS]));
        let more = if is_far { self.thresholds.undecided } else { self.thresholds.worse };
        (again.held_out.powi(2) < (1.0 + more) * outcome.held_out.powi(2)).then_some(again)
    }

    /// What is found where the camera's poses are smoothed, in place of all by which poses are merely late, if that leaves clearly
    /// less: a little of a filter is a latency, which many robots have and few filters make.
    fn smoothed(&self, outcome: &Outcome) -> Option<Outcome> {
        let is_late = |n: &Named| LATE_POSES.iter().chain(&LATE_WHEELS).any(|late| n.name == *late);
        if !outcome.named.iter().any(is_late) {
            return None;
        }
        let again = self.motion_studied(&self.without(&LATE_WHEELS));
        let is_named = again.named.iter().any(|n| n.name == SMOOTHED);
        let [before, after] = [outcome, &again].map(|o| Some(o.held_out.powi(2)));
        (is_named && self.is_more(before, after)).then_some(again)
    }

    /// Whether counts were found to be late against the camera, and the drive, which shows late counts as well, has them in
    /// step with the duties: then it is the frames that are stamped early.
    fn drive_is_in_step(&self, outcome: &Outcome) -> bool {
        if !outcome.named.iter().any(|n| n.name == LATE_COUNTS) {
            return false;
        }
        let mut without = outcome.written.clone();
        without.active.retain(|a| a.given || a.effect.name() != LATE_COUNTS);
        self.is_more(self.drive_scatter(&outcome.written), self.drive_scatter(&without))
    }

    /// Whether wheels seem to have another radius, the camera does not tell that from other counts, and the drive does: it is
    /// far from its noise with the radius, and leaves a small part of that with the counts. It would want a second name for the
    /// same wheels: a motor that brakes more.
    fn drive_has_other_counts(&self, outcome: &Outcome) -> bool {
        let tied = |set: &Vec<String>| [RADIUS, ENCODER_SCALE].iter().all(|name| set.iter().any(|n| n == name));
        // What slips has neither.
        if outcome.held_out > self.thresholds.far || !outcome.sets.iter().any(tied) {
            return false;
        }
        let own = |a: &Active| !a.given && a.effect.name() == RADIUS;
        let Some(at) = outcome.written.active.iter().position(own) else { return false };
        let radius = &outcome.written.active[at];
        let Some(effect) = self.data.catalogue.iter().find(|e| e.name() == ENCODER_SCALE) else { return false };
        let forms = effect.forms(&self.question.robot);
        let Some(form) = forms.into_iter().find(|form| form.wheels == radius.form.wheels) else { return false };
        let mut counts = Active::new(effect.clone(), form);
        for p in &radius.form.free {
            // Of less counts a turn the camera sees a larger wheel.
            counts.values.set(&p.name, 1.0 / (1.0 + radius.values.get(&p.name)) - 1.0);
        }
        let mut other = outcome.written.clone();
        other.active[at] = counts;
        // Above the floor that the counts leave: what the drive lacks with the radius is a part of its own.
        let Some(drive) = self.searched().drive(&other, None) else { return false };
        let left = |state: &State| study::rms(&Problem::Drive(&drive.link), state).powi(2);
        let [radius, counts] = [&outcome.written, &other].map(left);
        let is_far = radius >= self.thresholds.from_noise.powi(2);
        is_far && counts - 1.0 < self.thresholds.undecided * (radius - 1.0)
    }

    /// Squared scatter of the drive beside a state: by what any law of a wheel's own speed and duty leaves, for what else
    /// is missing on the drive is in none of the states that are compared by it.
    fn drive_scatter(&self, state: &State) -> Option<f64> {
        Some(self.searched().drive(state, None)?.link.noise.iter().map(|n| n * n).sum())
    }

    /// Whether one squared scatter is more than another by what decides; not where one is not known.
    fn is_more(&self, one: Option<f64>, other: Option<f64>) -> bool {
        one.zip(other).is_some_and(|(one, other)| one > (1.0 + self.thresholds.worse) * other)
    }

    /// Against a camera speeds that a firmware filters are late as counts would be; the drive shows the shape of a filter.
    /// Where it does not, both are said.
    fn late_or_filtered(&self, outcome: &mut Outcome) {
        if !runs::is_from_speeds(&self.question.robot) {
            return;
        }
        // Frames that seem early are counts that are late, by another name.
        let late_s = |a: &Active| match (a.effect.name(), a.values.get(&a.form.free[0].name)) {
            (LATE_COUNTS, late_s) if late_s > 0.0 => Some(late_s),
            (LATE_FRAMES, late_s) if late_s < 0.0 => Some(-late_s),
            _ => None,
        };
        let own = |a: &&Active| !a.given;
        let late: Vec<_> = outcome.written.active.iter().filter(own).filter(|a| late_s(a).is_some()).collect();
        let Some(time_s) = late.iter().filter_map(|a| late_s(a)).reduce(f64::max) else { return };
        let filter: Arc<dyn Effect> = Arc::from(effects::filter_seen());
        let mut without = outcome.written.clone();
        without.active.retain(|a| a.given || late_s(a).is_none());
        let mut filtered = without.clone();
        for form in filter.forms(&self.question.robot) {
            let mut active = Active::new(filter.clone(), form);
            active.values.set(&active.form.free[0].name, time_s);
            filtered.active.push(active);
        }
        let [written, without, filtered] =
            [&outcome.written, &without, &filtered].map(|state| self.drive_scatter(state));
        if [written, without].into_iter().all(|other| self.is_more(other, filtered)) {
            // For the motion all three are one; where two are named, the camera may be late as well.
            let one =
                |name: &str| name == LATE_COUNTS || name == filter.name() || name == LATE_FRAMES && late.len() < 2;
            let others = self.without(&[SMOOTHED]).into_iter().filter(|e| !one(e.name()));
            let here: Vec<_> = others.chain([filter.clone()]).collect();
            *outcome = self.motion_studied(&here);
        } else if late.iter().any(|a| a.effect.name() == LATE_COUNTS) && !self.is_more(filtered, written) {
            outcome.ambiguous = true;
            outcome.sets.push(vec![LATE_COUNTS.to_owned(), filter.name().to_owned()]);
        }
    }

    /// Takes back what stamps alone said of the camera where the poses do not say so.
    pub(super) fn judge_stamps(&mut self, links: &mut [ExactLink]) {
        let question = self.question;
        let (seen, noise) = (self.seen.as_deref().unwrap_or(&[]), self.searched().motion.noise);
        let logs = (&question.robot, self.data.logs);
        for link in links.iter_mut().filter(|l| l.link == Link::Timing && l.finding.is_some()) {
            self.findings.remarks.extend(timing::uneven(link, logs, noise, seen, &self.thresholds));
        }
    }

    /// Takes over what the replayed links gave; their gaps.
    pub(super) fn exact(&mut self, links: &[ExactLink]) -> Vec<LinkGap> {
        self.findings.remarks.extend(counts::geared(&self.findings.named, self.question.robot.gear_ratio));
        for link in links {
            let findings = &mut self.findings;
            // Of an effect with two sides the other one may have its name.
            let is_same = |n: &Named, f: &Finding| {
                let side = |n: &Named| f.parameters.iter().all(|(p, ..)| n.parameters.iter().any(|(own, ..)| own == p));
                n.name == f.name && (!TWO_SIDED.contains(&f.name) || side(n))
            };
            let is_new = |f: &&Finding| !findings.named.iter().any(|n| is_same(n, f));
            if let Some(f) = link.finding.as_ref().filter(is_new) {
                findings.named.push(exact_named(f, link));
            } else if link.unexplained {
                let told = link.replay.as_ref().and_then(|r| r.structure.clone());
                let structure = told.unwrap_or_else(|| {
                    format!(
                        "differs at {:.1} % of the ticks, and no hypothesis of the catalogue replays it",
                        100.0 * link.wrong_share
                    )
                });
                findings.leave(link.link, [structure]);
            }
            findings.remarks.extend(link.replay.as_ref().map(|r| r.remark.clone()).filter(|said| !said.is_empty()));
        }
        links.iter().map(gaps::exact_gap).collect()
    }
}

/// Counts that are older than their rows, and what is said where the drive does not have them so.
const LATE_COUNTS: &str = "encoder-lag";
const LATE_FRAMES: &str = "camera-latency";
const SMOOTHED: &str = "camera-filter";
/// Effects by which poses are late that may stand beside a filter, and those that do the same as it.
const CLOCKS: &str = "camera-clock";
const LATE_POSES: [&str; 2] = [CLOCKS, LATE_FRAMES];
const LATE_WHEELS: [&str; 2] = [LATE_COUNTS, "wheel-creep"];
const RADIUS: &str = "wheel-radius";
const OTHER_COUNTS: &str = "Against the camera other counts are another radius: the drive follows its duties with the counts, and not with \
     the radius.";
const IN_STEP: &str = "The drive has counts and duties in step: against the camera the whole log is late, or its frames are \
     stamped early.";

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

/// Why there is no camera to compare with.
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
