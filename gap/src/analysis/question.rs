//! What is settled before anything is fitted: the robot, the catalogue, the camera's noise, the cables.

use std::sync::Arc;

use model::fit::clocks::FEW_RUNS;
use runs::geometry::Geometry;
use runs::robot::{Robot, Support};
use runs::{DutySource, Logs};

use super::clocks;
use super::cut::Cut;
use super::look::driving;
use super::order::{cabled, wheel_order};
use super::robot_file::{completed, given};
use crate::catalogue::strangers;
use crate::controller::ENCODER_SCALE;
use crate::exact::ExactLink;
use crate::options::Options;
use crate::state::{Active, State};
use crate::{GapError, command, controller, timing};
use links::effect::Effect;
use links::effects;
use links::effects::camera_clock::CameraClock;
use links::motion::{MotionLink, MotionModel, WINDOW_S, Ways};
use links::pieces::{Driving, PIECE, Pieces, segments};

/// A data set and what is asked of it.
pub(super) struct Question<'a> {
    pub(super) set: &'a Logs<'a>,
    pub(super) options: &'a Options,
    /// The file's robot, with what it leaves to the logs.
    pub(super) robot: Robot,
    pub(super) catalogue: Vec<Arc<dyn Effect>>,
    /// Standard deviations of a camera pose (m, m, rad).
    pub(super) noise: [f64; 3],
    /// Whether that is what they err by for seconds.
    errs_for_seconds: bool,
    /// Length of a window of camera frames, s.
    pub(super) window_s: f64,
    geometry: Geometry,
    /// Whether causes are to be looked for in every run.
    every_run: bool,
    /// Whether currents drive the wheels, and no duties.
    pub(super) currents: bool,
}

impl<'a> Question<'a> {
    pub(super) fn new(set: &'a Logs<'a>, options: &'a Options) -> Result<Self, GapError> {
        let robot = completed(&set.robot, &set.logs);
        let geometry = robot.geometry().map_err(|e| GapError::Robot(e.to_string()))?;
        if let Some(found) = strangers(&robot, &options.effects).first() {
            return Err(GapError::Effect(format!("{}; {}", found.what, found.hint)));
        }
        for effect in &options.effects {
            let wheels = effect.forms(&robot).into_iter().flat_map(|f| f.wheels);
            if let Some(wheel) = wheels.filter(|w| *w >= robot.wheel_count()).max() {
                let (name, wheel, n) = (effect.name(), wheel + 1, robot.wheel_count());
                return Err(GapError::Effect(format!("{name}: wheels: there is no wheel {wheel}, the robot has {n}")));
            }
        }
        let currents = set.logs.first().is_some_and(|log| log.layout().source.duties == DutySource::Currents);
        // Counts that neither a camera nor a sensor sees the drive alone tells; what a current does tells none from an
        // inertia.
        let senses = |log: &runs::Log| {
            let layout = log.layout();
            !log.camera().is_empty() || layout.gyro.is_some() || layout.acceleration.is_some()
        };
        let unseen = robot.support == Support::Blocks || !set.logs.iter().any(senses);
        let driven = unseen && !currents;
        let catalogue = effects::catalogue_for(set.logs.len())
            .into_iter()
            .filter(|e| !(currents && e.before_current()))
            .map(|e| if driven && e.name() == ENCODER_SCALE { effects::counts_driven() } else { e })
            .map(Arc::from)
            .chain(options.effects.iter().cloned())
            .collect();
        let frames = set.logs.iter().map(|log| log.camera().iter().map(|f| (f.t, f.pose)).collect());
        let noise = robot.camera_noise.unwrap_or_else(|| model::fit::camera_noise_of(frames));
        let noise = model::fit::with_headings(noise, set.logs.iter().any(|log| log.layout().source.positions_only));
        let window_s = model::fit::window_s(WINDOW_S, robot.camera_rate_hz);
        let (errs_for_seconds, every_run) = (false, true);
        Ok(Self { set, options, robot, catalogue, noise, errs_for_seconds, window_s, geometry, every_run, currents })
    }

    /// The links that are replayed bit by bit, and what is to be said of them.
    pub(super) fn exact_links(&self, remarks: &mut Vec<String>) -> Vec<ExactLink> {
        let (robot, logs) = (&self.robot, &self.set.logs);
        let links = [
            timing::analyse(robot, logs),
            command::analyse(robot, &self.geometry, logs, &self.options.thresholds, remarks),
            controller::analyse(robot, logs, &self.options.thresholds, remarks),
        ];
        links.into_iter().flatten().collect()
    }

    /// Leaves out a clock of each run where there are many runs and one clock does for all, and says so; then not every
    /// run need be looked at for causes either.
    pub(super) fn judge_clocks(&mut self) -> Option<String> {
        let (runs, name) = (self.set.logs.len(), CameraClock::NAME);
        if runs <= FEW_RUNS || self.robot.effects.iter().any(|e| e.name == name) {
            return None;
        }
        let pieces = segments(&self.robot, &self.geometry, &self.set.logs, PIECE);
        self.every_run = clocks::differ(&MotionLink::new(&pieces, self.noise, self.window_s), &self.filed());
        if self.every_run {
            return None;
        }
        self.catalogue.retain(|e| e.name() != name);
        pieces
            .have_frames()
            .then(|| format!("One clock does for the camera in all {runs} runs: {name} was not looked for."))
    }

    /// The logs in pieces, everything derived from the wheels by their true order; and that order with its share of the
    /// squared gap, if it is not the file's.
    pub(super) fn cut(&self) -> (Cut<'a>, Option<(Active, f64)>) {
        let start = self.filed();
        let cut = |geometry: &Geometry| {
            let whole = segments(&self.robot, geometry, &self.set.logs, PIECE);
            let held = Cut { sample: whole.sample(self.every_run), whole };
            let driving = driving(&held, &start, self.currents, self.options.thresholds.no_noise);
            if driving == Driving::default() { held } else { held.driven(driving) }
        };
        let pieces = cut(&self.geometry);
        let crossed =
            wheel_order(&MotionLink::new(pieces.searched(), self.noise, self.window_s), &start, &self.catalogue);
        let found = crossed.as_ref().map(|(active, _)| active);
        let Some(active) = found.or_else(|| start.active.iter().find(|a| cabled(a))) else { return (pieces, crossed) };
        let mut wheels = MotionModel::new(&self.robot);
        active.effect.motion(&active.values, &mut wheels);
        match Geometry::new(wheels.wheels, self.robot.wheel_radius_m) {
            Ok(geometry) => (cut(&geometry), crossed),
            Err(_) => (pieces, crossed),
        }
    }

    /// Encoders to camera and inertial sensor; along ways of that length, s, by what wheels and poses part by in them.
    pub(super) fn motion_link<'b>(&self, pieces: &'b Pieces<'b>, ways: Option<(f64, Ways)>) -> MotionLink<'b> {
        let window_s = ways.map_or(self.window_s, |(window_s, _)| window_s);
        let link = MotionLink::new(pieces, self.noise, window_s)
            .along(ways.map(|(_, ways)| ways))
            .erring(self.errs_for_seconds);
        link.felt(&self.filed().motion(None))
    }

    /// Takes for the noise of poses that were smoothed what they know at best, and says so.
    pub(super) fn judge_poses(&mut self, pieces: &Pieces, crossed: Option<&Active>) -> Option<String> {
        if self.robot.camera_noise.is_some() {
            return None;
        }
        let link = MotionLink::new(pieces, self.noise, self.window_s);
        let mut start = self.filed();
        start.active.extend(crossed.cloned());
        let noise = super::truth::smoothed(&link, &start, &self.catalogue, &self.options.thresholds)?;
        let said = super::truth::said(self.noise, noise);
        self.noise = noise;
        self.errs_for_seconds = true;
        Some(said)
    }

    /// The robot as its file has it.
    pub(super) fn filed(&self) -> State {
        State { robot: self.robot.clone(), active: given(&self.robot, &self.catalogue) }
    }
}
