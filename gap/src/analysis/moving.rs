//! The motion in an analysis: what is missing from wheels to camera and inertial sensor.

use std::sync::Arc;

use runs::Logs;
use runs::robot::Support;

use super::clocks;
use super::counts;
use super::found::Named;
use super::gaps;
use super::study::{self, Outcome, chosen, study};
use super::workflow::Workflow;
use crate::controller::{ENCODER_SCALE, with_other_counts};
use crate::options::Stage;
use crate::problem::Problem;
use crate::state::{Active, SLIP, State};
use links::effect::{Effect, Link};
use links::effects;
use links::motion::MotionLink;

/// What a second look comes to.
enum Look {
    /// Something else takes the place of what was found.
    Other(Outcome),
    /// The same, with what is said of it.
    Because(&'static str, Outcome),
    /// The logs do not decide between the two.
    Tied([&'static str; 2]),
}

impl<'a> Workflow<'a> {
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
            let first = self.motion_looked();
            let again = |workflow: &mut Self| Some(workflow.motion_looked());
            let (link, outcome) =
                self.resized(Link::Motion, first, &again, &|(link, outcome)| (Problem::Motion(link), outcome));
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

    /// What is found between encoders and camera, by a first look and those that it asks for.
    fn motion_looked(&mut self) -> (&'a MotionLink<'a>, Outcome) {
        let mut outcome = self.motion_studied(&self.without(&[SMOOTHED]));
        let looks: [fn(&Self, &Outcome) -> Option<Look>; 7] = [
            Self::beside_refused,
            Self::of_one_clock,
            Self::crept,
            Self::smoothed,
            Self::of_filtered_speeds,
            Self::in_step,
            Self::of_other_counts,
        ];
        for look in looks {
            match look(self, &outcome) {
                Some(Look::Other(other)) => outcome = other,
                Some(Look::Because(said, other)) => {
                    outcome = other;
                    self.findings.remarks.push(said.to_owned());
                }
                Some(Look::Tied(names)) => outcome.tie(&names, true),
                None => {}
            }
        }
        (self.searched().motion, outcome)
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
    fn beside_refused(&self, outcome: &Outcome) -> Option<Look> {
        self.searched().motion.ways.filter(|_| outcome.named.is_empty() && !outcome.refused.is_empty())?;
        let refused = outcome.refused.iter().map(|r| r.name.as_str());
        let again = self.motion_studied(&self.without(&refused.chain([SMOOTHED]).collect::<Vec<_>>()));
        (!again.named.is_empty()).then_some(Look::Other(again))
    }

    /// What is found without clocks of single runs, where those that have a name part by no more than chance, or all is far from
    /// the noise and they close little: wheels that slip in some of the runs fall behind there as if frames were young. So do
    /// contacts that give way in runs that speed up more: theirs is a law of one number for all runs.
    fn of_one_clock(&self, outcome: &Outcome) -> Option<Look> {
        let clocks = outcome.named.iter().find(|n| n.name == CLOCKS)?;
        let is_far = outcome.held_out > self.thresholds.far;
        let again = self.motion_studied(&self.without(&[SMOOTHED, CLOCKS]));
        let gives_way = again.named.iter().any(|n| n.name == CREEP || n.name == SLIP);
        if !is_far && !gives_way && !clocks::are_one(clocks) {
            return None;
        }
        let more = if is_far { self.thresholds.undecided } else { self.thresholds.worse };
        (again.held_out.powi(2) < (1.0 + more) * outcome.held_out.powi(2)).then_some(Look::Other(again))
    }

    /// What is found where wheels creep as they roll, and not with time, if that leaves clearly less. What creeps so lags behind in
    /// proportion to its speed: it is looked for where creep has a name, or that lag is left.
    fn crept(&self, outcome: &Outcome) -> Option<Look> {
        let lags = outcome.selection.state.active.iter().any(|a| a.effect.name() == LAGS);
        if !lags && !outcome.named.iter().any(|n| n.name == CREEP) {
            return None;
        }
        let again = self.motion_studied(&rolled(self.without(&[SMOOTHED])));
        (creeps_rolled(&again) && self.leaves_more(outcome, &again)).then_some(Look::Other(again))
    }

    /// The catalogue without some of its effects, beside what was found: one law of creep at a time.
    fn without_beside(&self, outcome: &Outcome, names: &[&str]) -> Vec<Arc<dyn Effect>> {
        let here = self.without(names);
        if creeps_rolled(outcome) { rolled(here) } else { here }
    }

    /// What is found where the camera's poses are smoothed, in place of all by which poses are merely late, if that leaves clearly
    /// less: a little of a filter is a latency, which many robots have and few filters make.
    fn smoothed(&self, outcome: &Outcome) -> Option<Look> {
        let is_late = |n: &Named| LATE_POSES.iter().chain(&LATE_WHEELS).any(|late| n.name == *late);
        if !outcome.named.iter().any(is_late) {
            return None;
        }
        let again = self.motion_studied(&self.without(&LATE_WHEELS));
        let is_named = again.named.iter().any(|n| n.name == SMOOTHED);
        (is_named && self.leaves_more(outcome, &again)).then_some(Look::Other(again))
    }

    /// What is found without counts that are late against the camera, where the drive, which shows late counts as well, has them in
    /// step with the duties: then it is the frames that are stamped early.
    fn in_step(&self, outcome: &Outcome) -> Option<Look> {
        if !outcome.named.iter().any(|n| n.name == LATE_COUNTS) {
            return None;
        }
        let mut without = outcome.written.clone();
        without.active.retain(|a| a.given || a.effect.name() != LATE_COUNTS);
        let in_step = self.is_more(self.drive_scatter(&outcome.written), self.drive_scatter(&without));
        let again = || self.motion_studied(&self.without_beside(outcome, &[SMOOTHED, LATE_COUNTS]));
        in_step.then(|| Look::Because(IN_STEP, again()))
    }

    /// What is found without another radius where the drive has other counts.
    fn of_other_counts(&self, outcome: &Outcome) -> Option<Look> {
        let again = || self.motion_studied(&self.without_beside(outcome, &[SMOOTHED, RADIUS]));
        self.drive_has_other_counts(outcome).then(|| Look::Because(OTHER_COUNTS, again()))
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

    /// Whether one of two looks leaves more than the other by what decides.
    fn leaves_more(&self, one: &Outcome, other: &Outcome) -> bool {
        let [one, other] = [one, other].map(|outcome| Some(outcome.held_out.powi(2)));
        self.is_more(one, other)
    }

    /// What is found where logged speeds are filtered, in place of counts or frames that are late: against a camera both are one,
    /// and the drive shows the shape of a filter. Where it does not, both are tied.
    fn of_filtered_speeds(&self, outcome: &Outcome) -> Option<Look> {
        if !runs::is_from_speeds(&self.question.robot) {
            return None;
        }
        // Frames that seem early are counts that are late, by another name.
        let late_s = |a: &Active| match (a.effect.name(), a.values.get(&a.form.free[0].name)) {
            (LATE_COUNTS, late_s) if late_s > 0.0 => Some(late_s),
            (LATE_FRAMES, late_s) if late_s < 0.0 => Some(-late_s),
            _ => None,
        };
        let own = |a: &&Active| !a.given;
        let late: Vec<_> = outcome.written.active.iter().filter(own).filter(|a| late_s(a).is_some()).collect();
        let time_s = late.iter().filter_map(|a| late_s(a)).reduce(f64::max)?;
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
            let others = self.without_beside(outcome, &[SMOOTHED]).into_iter().filter(|e| !one(e.name()));
            let here: Vec<_> = others.chain([filter.clone()]).collect();
            return Some(Look::Other(self.motion_studied(&here)));
        }
        let open = late.iter().any(|a| a.effect.name() == LATE_COUNTS) && !self.is_more(filtered, written);
        open.then_some(Look::Tied([LATE_COUNTS, SPEED_FILTER]))
    }
}

/// Counts that are older than their rows, and what is said where the drive does not have them so.
const LATE_COUNTS: &str = "encoder-lag";
const LATE_FRAMES: &str = "camera-latency";
const SPEED_FILTER: &str = "speed-filter";
const SMOOTHED: &str = "camera-filter";
/// Effects by which poses are late that may stand beside a filter, and those that do the same as it.
const CLOCKS: &str = "camera-clock";
const LATE_POSES: [&str; 2] = [CLOCKS, LATE_FRAMES];
const LATE_WHEELS: [&str; 2] = [LATE_COUNTS, CREEP];
const CREEP: &str = "wheel-creep";
const LAGS: &str = "probe-camera-speed-delay";
const RADIUS: &str = "wheel-radius";
const OTHER_COUNTS: &str = "Against the camera other counts are another radius: the drive follows its duties with the counts, and not with \
     the radius.";
const IN_STEP: &str = "The drive has counts and duties in step: against the camera the whole log is late, or its frames are \
     stamped early.";

/// A catalogue in which creep goes with the way a wheel rolls.
fn rolled(catalogue: Vec<Arc<dyn Effect>>) -> Vec<Arc<dyn Effect>> {
    let law = |e: Arc<dyn Effect>| if e.name() == CREEP { Arc::from(effects::rolled_creep()) } else { e };
    catalogue.into_iter().map(law).collect()
}

/// Whether wheels were found to creep so.
fn creeps_rolled(outcome: &Outcome) -> bool {
    let own = |a: &Active| !a.given && a.effect.name() == CREEP;
    outcome.named.iter().any(|n| n.name == CREEP)
        && outcome.written.active.iter().any(|a| own(a) && a.values.find("creep_per_n").is_some())
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
