//! What a `robot.toml` gives on the logs as it is written: nothing is fitted but what the file declares a recording's
//! own, such as the clocks of its runs.

use std::sync::Arc;

use estimation::normal_equations::NormalEquations;

use runs::Log;
use runs::robot::{Robot, Support};

use super::driven::Driven;
use super::found::LinkGap;
use super::gaps;
use super::misses::Misses;
use super::question::Question;
use super::robot_file::{completed, given};
use super::study::rms;
use crate::problem::Problem;
use crate::state::{Active, SLIP, State};
use crate::thresholds::Thresholds;
use links::drive::{DriveLink, DriveResiduals};
use links::effect::{Effect, Link};
use links::inertial::{self, Fit, InertialLink};
use links::motion::{MotionLink, WindowResiduals};
use links::pieces::Pieces;

/// Data on which models are measured, or causes looked for.
#[derive(Clone, Copy)]
pub(super) struct Data<'a> {
    pub(super) pieces: &'a Pieces<'a>,
    pub(super) motion: &'a MotionLink<'a>,
    /// Whether the motion of the wheels is compared at all, with a camera or an inertial sensor.
    pub(super) has_motion: bool,
    pub(super) logs: &'a [Log<'a>],
    pub(super) catalogue: &'a [Arc<dyn Effect>],
    pub(super) thresholds: &'a Thresholds,
    /// Length of a window of single frames, s.
    window_s: f64,
}

/// The drive link under one model of the motion, its floor and the correlation of its residuals.
pub(super) struct Drive<'a> {
    pub(super) link: DriveLink<'a>,
    pub(super) correlation: f64,
    pub(super) residuals: DriveResiduals,
}

/// The drive link as measured.
pub(super) struct MeasuredDrive<'a> {
    /// Above the floor that the written model leaves.
    pub(super) link: DriveLink<'a>,
    /// Residuals, nominal and written.
    pub(super) plots: [DriveResiduals; 2],
}

/// Figures of a written model beside the nominal one's.
pub(super) struct Measured<'a> {
    pub(super) links: Vec<LinkGap>,
    /// Motion residuals, nominal and written.
    pub(super) motion: Option<[Vec<WindowResiduals>; 2]>,
    pub(super) drive: Option<MeasuredDrive<'a>>,
    /// Axes of the inertial sensor under the nominal model.
    pub(super) felt: Vec<Fit>,
    /// Share of the link's squared gap that goes with each effect of the file, by name.
    pub(super) gains: Vec<(String, f64)>,
    /// What is switched on, and closes next to nothing.
    pub(super) idle: Vec<String>,
    /// RMS of motion and drive in floors after each effect of the file, in its order.
    pub(super) steps: Vec<(String, Vec<(Link, f64)>)>,
    pub(super) driven: Driven,
}

impl<'a> Data<'a> {
    pub(super) fn new(question: &'a Question<'a>, motion: &'a MotionLink<'a>) -> Self {
        let compared = !motion.is_empty() || motion.inertial.is_some();
        Self {
            pieces: motion.pieces,
            motion,
            has_motion: compared && question.robot.support == Support::Floor,
            logs: &question.set.logs,
            catalogue: &question.catalogue,
            thresholds: &question.options.thresholds,
            window_s: question.window_s,
        }
    }

    /// Whether a camera sees that motion.
    pub(super) fn has_camera(&self) -> bool {
        self.has_motion && !self.motion.is_empty()
    }

    /// The state that a robot's file describes, with what it declares the recording's own fitted.
    pub(super) fn state(&self, robot: &Robot) -> State {
        let state = State { robot: completed(robot, self.logs), active: given(robot, self.catalogue) };
        self.declared(state)
    }

    fn declared(&self, mut state: State) -> State {
        let robot = state.robot.clone();
        let mut any = false;
        for a in state.active.iter_mut().filter(|a| a.effect.nuisance()) {
            let Some(form) = a.effect.forms(&robot).into_iter().next() else {
                a.values.0.clear();
                continue;
            };
            a.values.0.retain(|(name, _)| form.free.iter().any(|p| p.name == *name));
            a.form = form;
            a.given = false;
            any = true;
        }
        if any && self.has_motion {
            Problem::Motion(self.motion).fit(&mut state);
        }
        state.active.iter_mut().for_each(|a| a.given = true);
        state
    }

    /// The drive link under a model, above the floor that this model leaves.
    pub(super) fn drive(&self, state: &State, seen: Option<&Vec<WindowResiduals>>) -> Option<Drive<'a>> {
        let mut link = DriveLink::new(self.pieces, &state.drive(None))?;
        let motion = state.motion(None);
        state.mask_slip(&mut link);
        if state.active.iter().any(|a| a.effect.name() == SLIP) {
            // Where the law of slip did not catch what slipped, Newton's law has no body to push.
            let misses = Misses::new(seen, self.thresholds.missed[1]);
            link.mask_times(|run, t| misses.are_near(run, t));
        }
        let model = state.drive(None);
        link.feel(&model, &motion.sensor);
        let mut residuals = link.residuals(&model)?;
        let (mut floor, mut correlation) = links::drive::floor(&link, &residuals, link.sizes.drive_nm);
        link.noise = floor;
        if link.mask_sticking(&model, self.thresholds.sticks) > 0.0 {
            residuals = link.residuals(&model)?;
            (floor, correlation) = links::drive::floor(&link, &residuals, link.sizes.drive_nm);
            link.noise = floor;
        }
        Some(Drive { link, correlation, residuals })
    }

    /// The drive with the test functions that count for the first of two models, in the floors of the second's: where those
    /// that count for the second hide what it closes. Beside its lower floor more of them may have stuck to dry friction, and
    /// what a gear's play does is done where a wheel turns round.
    fn drive_by_its_own_rows(
        &self,
        link: &DriveLink<'a>,
        [before, after]: [&State; 2],
        seen: Option<&Vec<WindowResiduals>>,
    ) -> Option<DriveLink<'a>> {
        let closes = |link: &DriveLink| {
            let [before, after] = [before, after].map(|state| rms(&Problem::Drive(link), state).powi(2));
            after < (1.0 - self.thresholds.closes) * before
        };
        if closes(link) {
            return None;
        }
        let mut own = self.drive(before, seen)?.link;
        own.noise.clone_from(&link.noise);
        closes(&own).then_some(own)
    }

    /// Measures a written robot beside the nominal one, both as files; `new` are the names of the effects that only the
    /// written one has.
    pub(super) fn measure(&self, nominal: &Robot, written: &Robot, new: &[&str]) -> Measured<'a> {
        let before = self.state(nominal);
        let after = self.state(written);
        let is_new = |a: &Active| new.contains(&a.effect.name());
        let without = |name: &str| -> State {
            let mut state = after.clone();
            state.active.retain(|a| a.effect.name() != name || !is_new(a));
            state
        };
        let mut out = Measured {
            links: Vec::new(),
            motion: None,
            drive: None,
            felt: Vec::new(),
            gains: Vec::new(),
            idle: Vec::new(),
            steps: Vec::new(),
            driven: Driven::default(),
        };
        let seen = |state: &State| {
            let (square, n) = NormalEquations::new(self.motion.linearise_camera(&state.motion(None), &[])).plain();
            self.motion.floors() * (square / n.max(1.0)).sqrt()
        };
        if self.has_camera() {
            let plots = [self.motion.residuals(&before.motion(None)), self.motion.residuals(&after.motion(None))];
            let figures = [seen(&before), seen(&after)];
            out.links.push(gaps::motion_gap(figures, self.motion, &plots));
            out.driven.frames = Driven::at_frames(self.pieces, &plots[0]);
            out.motion = Some(plots);
        }
        // As the drive's, its floors are those that the written model leaves.
        let felt = self.motion.inertial.as_ref().filter(|_| self.has_motion);
        let felt = felt.and_then(|_| InertialLink::new(self.pieces, &after.motion(None)));
        let sensor = |state: &State| -> Vec<(Link, Vec<Fit>)> {
            let links = felt.iter().flat_map(|felt| {
                let model = state.motion(None);
                let links = [Link::Gyroscope, Link::Accelerometer].into_iter().filter(|link| felt.has(*link));
                links.map(|link| (link, felt.fits(&model, link))).collect::<Vec<_>>()
            });
            links.collect()
        };
        for ((_, before), (link, after)) in sensor(&before).into_iter().zip(sensor(&after)) {
            out.links.push(gaps::inertial_gap(link, &before, &after));
            out.felt.extend(before);
        }
        let single = self.motion.ways.map(|_| self.motion.of_frames(&after.motion(None), self.window_s));
        let mut drive = self.drive(&after, single.as_ref().or(out.motion.as_ref().map(|p| &p[1])));
        if let Some(Drive { link, .. }) = &mut drive {
            link.noise = gaps::drive_floor(link, &link.noise, self.thresholds);
        }
        let mut plotted = None;
        let own = drive.as_ref().filter(|_| !new.is_empty()).and_then(|drive| {
            let seen = out.motion.as_ref().map(|plots| &plots[0]);
            self.drive_by_its_own_rows(&drive.link, [&before, &after], seen)
        });
        // The link on which what is not written whole is told.
        let told = own.as_ref().or(drive.as_ref().map(|d| &d.link));
        if let (Some(drive), Some(told)) = (&drive, told) {
            let (left, nominally) = left_on_drive(told, &before);
            let plots = [nominally.unwrap_or_else(|| drive.residuals.clone()), drive.residuals.clone()];
            let figures = [left, rms(&Problem::Drive(&drive.link), &after)];
            out.links.push(gaps::drive_gap(figures, &drive.link.noise, &plots));
            out.driven.test_functions = Driven::at_test_functions(&drive.link);
            plotted = Some(plots);
        }
        let on_links = |state: &State| -> Vec<(Link, f64)> {
            let motion = self.has_camera().then(|| (Link::Motion, seen(state)));
            let felt = sensor(state).into_iter().map(|(link, fits)| (link, inertial::overall(&fits)));
            let drive = told.map(|link| (Link::Drive, left_on_drive(link, state).0));
            motion.into_iter().chain(felt).chain(drive).collect()
        };
        let mut sofar = after.clone();
        sofar.active.retain(|a| !is_new(a));
        let has = |state: &State, name: &str| state.active.iter().any(|a| a.effect.name() == name);
        let gone = before.active.iter().map(|a| a.effect.name()).filter(|name| !has(&sofar, name)).collect::<Vec<_>>();
        if !gone.is_empty() {
            out.steps.push((format!("{}{}", gaps::WITHOUT, gone.join(", ")), on_links(&sofar)));
        }
        for a in after.active.iter().filter(|a| is_new(a)) {
            let name = a.effect.name().to_owned();
            sofar.active.push(a.clone());
            let whole = sofar.active.len() == after.active.len();
            let last = || out.links.iter().map(|l| (l.link, l.after)).collect();
            out.steps.push((name.clone(), if whole { last() } else { on_links(&sofar) }));
            let alone = on_links(&without(&name));
            let closed = out.links.iter().filter_map(|l| {
                let without = alone.iter().find(|x| x.0 == l.link)?.1;
                Some((without.powi(2) - l.after.powi(2), l.before.max(without).powi(2)))
            });
            let [share, floors] =
                closed.fold([0.0_f64; 2], |[share, floors], (closed, of)| [share.max(closed / of), floors.max(closed)]);
            out.gains.push((name.clone(), share.clamp(0.0, 1.0)));
            if is_switched_on_for_nothing(&*a.effect, &after.robot, floors, self.thresholds) {
                out.idle.push(name);
            }
        }
        out.drive = drive.zip(plotted).map(|(Drive { link, .. }, plots)| MeasuredDrive { link, plots });
        out
    }
}

/// Whether an effect that is switched on closes next to nothing: so many squared floors of a link.
fn is_switched_on_for_nothing(effect: &dyn Effect, robot: &Robot, floors: f64, thresholds: &Thresholds) -> bool {
    let forms = effect.forms(robot);
    floors < thresholds.switched_closes && forms.iter().flat_map(|form| &form.free).any(|p| p.start.is_some())
}

/// What a state leaves on the drive, in floors, and its residuals: in the torque of the link's inertia or in that of its
/// own, whichever is less. By an inertia fifty times too small every torque of the logs is fifty times too much for the
/// link's, beside which nothing else counted; by one too large it is too much for its own.
pub(super) fn left_on_drive(link: &DriveLink, state: &State) -> (f64, Option<DriveResiduals>) {
    let model = state.drive(None);
    let weighed = |residuals: &DriveResiduals| -> f64 {
        let rows = residuals.torque.iter().zip(&residuals.weights);
        let values = rows.flat_map(|(torque, weights)| torque.iter().zip(weights).zip(&link.noise));
        values.map(|((t, w), noise)| (w * t / noise).powi(2)).sum()
    };
    let left = rms(&Problem::Drive(link), state);
    let residuals = link.residuals(&model);
    match (residuals, link.residuals_in_own_torque(&model)) {
        (Some(residuals), Some(own)) => {
            let share = weighed(&own) / weighed(&residuals).max(f64::MIN_POSITIVE);
            if share < 1.0 { (left * share.sqrt(), Some(own)) } else { (left, Some(residuals)) }
        }
        (residuals, _) => (left, residuals),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a mecanum robot whose gears have play a grip of 0.5 closed 0.004 squared floors between wheels and camera, and was named.
    #[test]
    fn what_is_switched_on_closes_something() {
        let robot = Robot::racbot();
        let idle = |name: &str, floors: f64| {
            let effect = links::effects::find(name).unwrap();
            is_switched_on_for_nothing(&*effect, &robot, floors, &Thresholds::default())
        };
        assert!(idle("wheel-slip", 0.004) && idle("current-limit", 0.0));
        assert!(!idle("wheel-slip", 0.2) && !idle("robot-mass", 0.004));
    }
}
