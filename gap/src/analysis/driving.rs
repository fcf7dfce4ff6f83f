//! The drive in an analysis: what is missing from duties to wheels.

use std::cell::OnceCell;
use std::sync::Arc;

use runs::robot::Support;

use super::answered::beside_answers;
use super::found::Named;
use super::gaps;
use super::look_alikes::{Against, LookAlike};
use super::measure::{Data, Drive};
use super::misses::Misses;
use super::study::{self, Outcome, Refused, chosen, study};
use super::workflow::Workflow;
use super::{filtered, patterns, ratios};
use crate::options::Stage;
use crate::problem::{Problem, look_for_play};
use crate::select::Selection;
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use crate::units;
use links::drive::DriveLink;
use links::effect::{Effect, Link};
use links::effects::fits;
use links::motion::WindowResiduals;
use links::pieces::Pieces;

/// Whether a robot goes along one line of the floor, to and fro: across it nothing shows what the carpet does, and along it
/// the carpet is friction of the wheels. The mean of the directions, twice their angle, weighted by the squared speed.
fn ways_lie_along_one_line(pieces: &Pieces) -> bool {
    let (mut along, mut across, mut all) = (0.0, 0.0, 0.0);
    for s in pieces.iter() {
        for k in s.own.clone() {
            let (twist, heading) = (s.twist[k], s.heading[k]);
            let square = twist.vx * twist.vx + twist.vy * twist.vy;
            let (sin, cos) = (2.0 * (heading + twist.vy.atan2(twist.vx))).sin_cos();
            along += square * cos;
            across += square * sin;
            all += square;
        }
    }
    along.hypot(across) > ONE_LINE * all
}

/// Length of that mean from which ways are one line: that of directions spread evenly over 10 degrees on either side.
const ONE_LINE: f64 = 0.98;

/// An encoder that reads ahead once a turn, and the loads that look like it.
const READ_AMISS: &str = "encoder-eccentricity";
const ONCE_A_TURN: [&str; 2] = ["gravity-load", "joint-spring"];

/// Looks at the drive again, each above a floor lowered by what was named.
const LOOKS: usize = 2;

impl<'a> Workflow<'a> {
    /// Duties to encoders.
    pub(super) fn drive(&mut self) {
        let options = self.question.options;
        let Some(first) = self.drive_looked() else {
            let logs = &self.question.set.logs;
            let told = logs.iter().any(|log| log.layout().duty.len() == self.question.robot.wheel_count());
            let none = if told && logs.iter().all(|log| log.layout().counts.is_empty()) {
                "No encoder counts or wheel speeds beside the duties: the drive link is not compared; log them."
            } else {
                "No duties in the logs (or none that belong to the wheels): the drive link is not compared."
            };
            self.findings.remarks.push(none.to_owned());
            options.reached(Stage::DriveStudied);
            return;
        };
        let (link, mut outcome) =
            self.resized(Link::Drive, first, &Self::drive_looked, &|(link, outcome)| (Problem::Drive(link), outcome));
        self.scatter(&link);
        if self.question.currents {
            ratios::tie(&mut outcome, &self.start, &link.sizes);
        }
        let alike = self.look_alikes(&outcome);
        self.findings.remarks.extend(outcome.look_alike(alike));
        self.findings.remarks.extend(logged_late(&outcome, self.question.robot.control_rate_hz));
        let from = self.start.active.len();
        self.patterns(&link, &mut outcome);
        let alike = self.filtered(&outcome);
        self.findings.remarks.extend(outcome.look_alike(alike));
        self.nameless(&outcome);
        self.findings.take(outcome, Link::Drive, from);
        options.reached(Stage::DriveStudied);
    }

    /// The drive and what is found on it, by a first look and those that it asks for; none without duties.
    fn drive_looked(&mut self) -> Option<(DriveLink<'a>, Outcome)> {
        let mut here = self.not_seen();
        let mut link = self.drive_link()?;
        let read_right: Vec<_> = here.iter().filter(|e| e.name() != READ_AMISS).cloned().collect();
        let mut outcome = self.drive_studied(&mut link, &read_right);
        if let Some(again) = self.beside_answered(&link, &outcome, &read_right) {
            (link, outcome) = again;
        }
        if let Some(again) = self.unbraked(&link, &mut outcome, &read_right) {
            (link, outcome) = again;
        }
        // What comes once a turn is a load, or is read so: where neither load has a name, not by a load.
        let once_a_turn = |name: &str| ONCE_A_TURN.contains(&name);
        let may_be_read = fits(READ_AMISS, &self.question.robot)
            && (outcome.named.is_empty() || outcome.named.iter().any(|n| once_a_turn(&n.name)));
        if may_be_read {
            let loads = !outcome.named.is_empty();
            let or_read: Vec<_> = here.iter().filter(|e| loads || !once_a_turn(e.name())).cloned().collect();
            if let Some(again) = self.drive_again(&or_read) {
                (link, outcome) = again;
            }
        }
        let speaks: [fn(&Self, &Outcome) -> Option<Against>; 4] =
            [Self::against_camera, Self::against_counts, Self::against_currents, Self::against_ratios];
        for speaks in speaks {
            let Some(Against { names, said }) = speaks(self, &outcome) else { continue };
            here.retain(|e| !names.iter().any(|name| name == e.name()));
            if let Some(again) = self.drive_again(&here) {
                (link, outcome) = again;
                self.findings.remarks.push(said);
            }
        }
        Some((link, outcome))
    }

    /// The drive laid anew, and what is found on it of a catalogue.
    pub(super) fn drive_again(&mut self, here: &[Arc<dyn Effect>]) -> Option<(DriveLink<'a>, Outcome)> {
        let mut link = self.drive_link()?;
        let outcome = self.drive_studied(&mut link, here);
        Some((link, outcome))
    }

    /// The drive of what is looked at above its own floor; none without duties.
    fn drive_link(&mut self) -> Option<DriveLink<'a>> {
        let Drive { link, correlation, .. } = self.laid(self.searched(), self.seen.as_ref())?;
        self.thresholds.drive_correlation = correlation;
        Some(link)
    }

    /// What is found on the drive.
    fn drive_studied(&mut self, link: &mut DriveLink<'a>, here: &[Arc<dyn Effect>]) -> Outcome {
        let (selection, floor) = self.drive_chosen(link, here);
        self.question.options.reached(Stage::DriveChosen);
        let least = gaps::floor_of_scatter(link, &floor, &self.thresholds);
        let problem = Problem::Drive(link);
        let found = selection.state.clone();
        let all = OnceCell::new();
        let made = || self.beyond().and_then(|data| self.whole_drive(data, link, &found));
        let whole = || all.get_or_init(made).as_ref().map(Problem::Drive);
        let far = self.thresholds.far * least;
        let mut outcome = study(&problem, &whole, &self.start, selection, here, &self.thresholds, far);
        outcome.held_out /= least;
        let open = study::rms(&problem, &self.start);
        let far = open >= self.thresholds.far_left * least;
        let again = if far { self.within_bounds(&outcome, here) } else { None };
        let worth = open >= self.thresholds.worth_saying * least;
        if let Some(again) = again.or_else(|| if worth { self.without_refused(&outcome, here) } else { None }) {
            (*link, outcome) = again;
        }
        outcome
    }

    /// What is found without the effects that fit best at the bound of what is physical, if that closes most of what was left.
    /// Such an effect is no cause, but took what others do: motors without torque leave nothing to explain.
    fn within_bounds(&mut self, outcome: &Outcome, here: &[Arc<dyn Effect>]) -> Option<(DriveLink<'a>, Outcome)> {
        if !outcome.named.is_empty() && outcome.held_out <= self.thresholds.far {
            return None;
        }
        let most = 1.0 - self.thresholds.explained;
        let closes = |link: &DriveLink, again: &Outcome| {
            let square = |state: &State| study::rms(&Problem::Drive(link), state).powi(2);
            square(&again.written) < most * square(&outcome.written)
        };
        let at_bound: Vec<Refused> = outcome.refused.iter().filter(|r| r.at_bound).cloned().collect();
        let mut again = self.drive_without(here, &at_bound, &closes)?;
        again.1.refused.extend(at_bound);
        Some(again)
    }

    /// What else is found where what was fitted may not be named and stood in the way of the rest: beside what has a name it
    /// leaves nothing worth a sentence. `None` where nothing is; what was refused may be the cause, and something near it no
    /// name.
    fn without_refused(&mut self, outcome: &Outcome, here: &[Arc<dyn Effect>]) -> Option<(DriveLink<'a>, Outcome)> {
        let worth = self.thresholds.worth_saying;
        if !outcome.named.is_empty() && outcome.held_out < worth {
            return None;
        }
        let explains = |_: &DriveLink, again: &Outcome| {
            let is_kept = |n: &Named| again.named.iter().any(|other| other.name == n.name);
            again.named.len() > outcome.named.len() && outcome.named.iter().all(is_kept) && again.held_out < worth
        };
        self.drive_without(here, &outcome.refused, &explains)
    }

    /// What is found without what was refused, if it may take the place of what was.
    fn drive_without(
        &mut self,
        here: &[Arc<dyn Effect>],
        refused: &[Refused],
        is_kept: &dyn Fn(&DriveLink, &Outcome) -> bool,
    ) -> Option<(DriveLink<'a>, Outcome)> {
        let others: Vec<_> = here.iter().filter(|e| !refused.iter().any(|r| r.name == e.name())).cloned().collect();
        if others.len() == here.len() {
            return None;
        }
        let correlation = self.thresholds.drive_correlation;
        let again = self.drive_again(&others).filter(|(link, again)| is_kept(link, again));
        if again.is_none() {
            self.thresholds.drive_correlation = correlation;
        }
        again
    }

    /// The drive of some data, beside what its loops answered if they do.
    pub(super) fn laid<'b>(&self, data: Data<'b>, seen: Option<&Vec<WindowResiduals>>) -> Option<Drive<'b>> {
        let drive = data.drive(&self.start, seen)?;
        Some(if self.answered.is_some() { beside_answers(drive) } else { drive })
    }

    /// The drive of all data with the noise of what was searched.
    fn whole_drive<'b>(&self, data: Data<'b>, searched: &DriveLink, found: &State) -> Option<DriveLink<'b>> {
        let seen = data.has_motion.then(|| data.motion.residuals(&self.start.motion(None)));
        let mut link = self.laid(data, seen.as_ref())?.link;
        link.noise.clone_from(&searched.noise);
        link.mask_sticking(&found.drive(None), self.thresholds.sticks);
        Some(link)
    }

    /// Says of a drive that scatters too much beside what is named what that means.
    fn scatter(&mut self, link: &DriveLink) {
        let reached = link.sizes.drive_nm;
        let worst = link.noise.iter().copied().fold(0.0, f64::max);
        if worst <= self.thresholds.no_noise * reached {
            return;
        }
        let scatters =
            format!("scatters by {}, {:.0} % of what they reach", units::torque(worst), 100.0 * worst / reached);
        let counted = !runs::is_from_speeds(&self.question.robot) && worst <= links::drive::of_a_count(link);
        let own = counted
            || links::drive::accounted(link, &self.start.drive(None))
                .into_iter()
                .all(|share| share > self.thresholds.foreign);
        if own {
            let by = if counted { ", no more than single counts of the encoder make" } else { "" };
            self.findings.remarks.push(format!("What the motors do {scatters}{by}: smaller effects do not show."));
        } else {
            let driven = if self.question.currents { "currents" } else { "duties" };
            let structure =
                format!("what the {driven} predict {scatters}, at random: are these the {driven} of this drive?");
            self.findings.leave(Link::Drive, [structure]);
        }
    }

    /// What looks like what is named on the drive.
    fn look_alikes(&self, outcome: &Outcome) -> Vec<LookAlike> {
        let (named, robot) = (&outcome.named, &self.start.robot);
        let [turns, _] = self.thresholds.level;
        // Behind currents no bridge does anything.
        let of_one_way = || ratios::of_one_way(named, self.data.pieces, turns).filter(|_| !self.question.currents);
        let all = [
            ratios::of_rotor_and_load(named, robot),
            ratios::of_wrong_counts(named, robot),
            ratios::of_a_load(named, robot),
            ratios::of_a_caster(named, robot),
            ratios::of_one_encoder(named, robot),
            ratios::of_counts(named, robot, self.data.has_camera()),
            of_one_way(),
            ratios::of_warmth(named),
        ];
        all.into_iter().flatten().collect()
    }

    /// What a filter in the firmware has to do with a delay or an inertia that was found from logged speeds.
    fn filtered(&self, outcome: &Outcome) -> Vec<LookAlike> {
        if !runs::is_from_speeds(&self.question.robot) {
            return Vec::new();
        }
        let alone = self.question.robot.support == Support::Blocks && !self.question.currents;
        let (named, model) = (&outcome.named, self.start.drive(None));
        let row_s = 1.0 / self.question.robot.control_rate_hz;
        let late_s = 0.5 * row_s * self.data.pieces.half_rows() as f64;
        let all = [
            filtered::in_place_of_inertia(named, &model, [row_s, late_s], &self.thresholds).filter(|_| alone),
            filtered::of_delay(named, row_s),
            filtered::exchanged(named, &model, row_s).filter(|_| alone),
        ];
        all.into_iter().flatten().collect()
    }

    /// The catalogue without what a camera or an inertial sensor would have shown: that is not deduced from duties. Nor is
    /// what only they show: on the drive alone creep is a latency by another name.
    fn not_seen(&self) -> Vec<Arc<dyn Effect>> {
        let shown = |e: &Arc<dyn Effect>| {
            let mut own = self.findings.limits.iter().filter(|l| l.name == e.name()).peekable();
            let drives = e.link() == Link::Drive || e.also() == Some(Link::Drive);
            // Nor from duties alone what a camera that is far from its noise does not have.
            let hidden = e.link() != Link::Drive && (self.seen.is_none() || self.motion_is_far());
            let of_ways = ["body-drag", "carpet-grain"].contains(&e.name());
            let grain = || of_ways && ways_lie_along_one_line(self.searched().pieces);
            hidden
                || self.is_told_by_currents(e.name())
                || drives && own.peek().is_some() && own.all(|l| l.limit < self.thresholds.seen * l.material)
                || grain()
        };
        self.data.catalogue.iter().filter(|e| !shown(e)).cloned().collect()
    }

    /// What was named for the drive, belongs to camera and wheels, and leaves more between them: that is not deduced from
    /// duties.
    fn against_camera(&self, outcome: &Outcome) -> Option<Against> {
        if !self.data.has_camera() {
            return None;
        }
        let problem = Problem::Motion(self.searched().motion);
        let square = |state: &State| study::rms(&problem, state).powi(2);
        let with = square(&outcome.written);
        let worse = |name: &str| {
            let mut without = outcome.written.clone();
            without.active.retain(|a| a.given || a.effect.name() != name);
            with > (1.0 + self.thresholds.worse) * square(&without)
        };
        let seen = |a: &&Active| !a.given && a.effect.link() == Link::Motion;
        let names = outcome.written.active.iter().filter(seen).map(|a| a.effect.name().to_owned());
        let names: Vec<String> = names.filter(|name| worse(name)).collect();
        let fitted = names.join(", ");
        (!names.is_empty()).then(|| Against {
            names,
            said: format!("Fitted on the drive link, and not named: {fitted}; the camera speaks against it."),
        })
    }

    fn against_counts(&self, outcome: &Outcome) -> Option<Against> {
        ratios::of_the_same_counts(&outcome.named, &self.findings.named, &self.findings.alternatives)
    }

    fn against_ratios(&self, outcome: &Outcome) -> Option<Against> {
        let support = self.question.robot.support;
        self.question.currents.then(|| ratios::on_both_sides(&outcome.named, support)).flatten()
    }

    /// Whether what the camera saw remains far from its noise with what is named for it.
    fn motion_is_far(&self) -> bool {
        self.findings.held_out.iter().any(|(link, left)| *link == Link::Motion && *left > self.thresholds.far)
    }

    /// What is selected, and the floor above which it was looked for. What has a name is no noise: the next effect is
    /// looked for above the floor without it.
    fn drive_chosen(&mut self, link: &mut DriveLink, here: &[Arc<dyn Effect>]) -> (Selection, Vec<f64>) {
        let from = self.start.active.len();
        let mut floor = link.noise.clone();
        let mut selection = self.looked(link, here, &[], &floor);
        for _ in 0..LOOKS {
            if !selection.state.active[from..].iter().any(Active::is_named) {
                break;
            }
            let stuck = link.mask_sticking(&selection.state.drive(None), self.thresholds.sticks);
            let lowered = lowered(link, &selection.state, &floor, &self.thresholds);
            let held = look_for_play(link, &selection.state, here);
            match lowered {
                Some((lower, correlation)) => {
                    link.noise.clone_from(&lower);
                    floor = lower;
                    self.thresholds.drive_correlation = correlation;
                }
                None if held || stuck > self.thresholds.sticks_often => {}
                None => break,
            }
            selection = self.looked(link, here, &selection.state.active[from..], &floor);
        }
        (selection, floor)
    }

    fn looked(&self, link: &DriveLink, here: &[Arc<dyn Effect>], known: &[Active], floor: &[f64]) -> Selection {
        let matters = self.thresholds.far * gaps::floor_of_scatter(link, floor, &self.thresholds);
        chosen(&Problem::Drive(link), &self.start, known, here, &self.thresholds, matters)
    }

    /// Rattle, ripple and what else repeats in what is left.
    fn patterns(&mut self, link: &DriveLink, outcome: &mut Outcome) {
        let (robot, catalogue, pieces) = (&self.question.robot, self.data.catalogue, self.searched().pieces);
        // Wheels that slide chatter from roller to roller.
        let slides = self.start.active.iter().any(|a| a.effect.name() == "wheel-slip");
        let [before, mut after] = [&self.start, &outcome.written].map(|s| study::rms(&Problem::Drive(link), s));
        // What takes a drive that was far off to next to its noise is no answer to a rotor that shakes.
        let is_explained = before >= self.thresholds.far && after < self.thresholds.worth_saying;
        let shaken = if is_explained { &outcome.written } else { &self.start }.drive(None);
        let rattling = patterns::rattling(pieces, robot, &shaken, catalogue, &self.thresholds)
            .filter(|r| !slides && robot.effect(&r.name).is_none());
        if rattling.is_some() && !outcome.named.is_empty() && !is_explained {
            let names: Vec<&str> = outcome.named.iter().map(|n| n.name.as_str()).collect();
            self.findings.remarks.push(format!(
                "While rotors rattle in their play, friction and inertia are not judged; fitted, and not named: {}.",
                names.join(", ")
            ));
            outcome.forget(&self.start);
            after = before;
        }
        let misses = Misses::new(self.seen.as_ref(), self.thresholds.missed[0]);
        let rolls = |run: usize, t: f64| !misses.are_near(run, t);
        let model = outcome.selection.state.drive(None);
        let leftover = crate::leftover::drive(pieces, &model, &link.masked(), &rolls, link.sizes, &self.thresholds);
        // Beside a named effect only what its law's inexactness cannot leave.
        let explained = if outcome.named.is_empty() { 0.0 } else { before.powi(2) - after.powi(2) };
        for structure in leftover.structures {
            if structure.share * after.powi(2) >= self.thresholds.law_leaves * explained {
                self.findings.leave(Link::Drive, [structure.text]);
            } else {
                self.findings.remarks.push(format!("Small beside what is named on the drive: {}.", structure.text));
            }
        }
        if let Some(ripple) = leftover.ripple.filter(|_| robot.effect("roller-ripple").is_none() && !slides) {
            match patterns::ripple_named(&ripple, robot, catalogue) {
                Ok(ripple) => self.findings.named.push(ripple),
                Err(structure) => self.findings.leave(Link::Drive, [structure]),
            }
        }
        let may_slide = robot.support == Support::Floor && (!self.data.has_motion || misses.are_some());
        if rattling.is_some() && may_slide {
            // Sliding wheels shake, too; a camera sees that.
            self.findings.alternatives.push(vec!["gear-backlash".to_owned(), "wheel-slip".to_owned()]);
        }
        self.findings.named.extend(rattling);
    }
}

/// What a latency below 0 means, in a sentence.
fn logged_late(outcome: &Outcome, rate_hz: f64) -> Option<String> {
    let latency = outcome.named.iter().find(|n| n.name == "actuation-latency")?.parameters.first()?.1;
    (latency < 0.0).then(|| {
        format!(
            "Duties act {:.1} ms before their row: the log has them {:.1} rows late, and the machine is not early.",
            -1e3 * latency,
            -latency * rate_hz
        )
    })
}

/// Floor and correlation of the drive with what was named in the model, if they hid enough to look again.
fn lowered(link: &DriveLink, state: &State, floor: &[f64], thresholds: &Thresholds) -> Option<(Vec<f64>, f64)> {
    let correlation = thresholds.drive_correlation;
    let residuals = link.residuals(&state.drive(None))?;
    let (now, correlated) = links::drive::floor(link, &residuals, link.sizes.drive_nm);
    let lower: Vec<f64> = now.iter().zip(floor).map(|(a, b)| a.min(*b)).collect();
    let correlated = correlated.min(correlation);
    let noise = |floor: &[f64], correlation: f64| correlation * floor.iter().map(|f| f * f).sum::<f64>();
    (noise(&lower, correlated) < (1.0 - thresholds.hidden) * noise(floor, correlation)).then_some((lower, correlated))
}
