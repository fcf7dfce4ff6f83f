//! A whole drive along set points, from arming to rest.

use super::recording::Recording;
use super::{ClosedLoop, Control, LoopError};
use crate::fpga::Fpga;
use driver::Settings;
use driver::drive::Controller;
use driver::recording::logged_robot;
use fixed_kin::registers::FAULT_FIELDS;
use fixed_kin::speed::SpeedMode;
use model::camera::{Camera, CameraModel};
use model::fusion::FusionOptions;
use model::localisation::Localiser;
use model::plant::{Contact, Deviations, Plant};
use model::trajectory::{FIG_6, SetPoint, TrajectoryReport};
use runs::Run;
use runs::frames::{Pose, Twist};
use runs::robot::Robot;

/// A set point counts as reached if the robot really was this near, m: about its own radius.
const REACHED_M: f64 = 0.1;
/// Time for the robot to come to rest after the last command, s.
const SETTLING_S: f64 = 0.25;
/// What the filter is told of wheels whose skew nobody knows, rad²/rad.
const UNCALIBRATED_WHEEL_VARIANCE: f64 = 1e-2;

/// What to drive, with which robot.
#[derive(Clone, Debug)]
pub struct Drive {
    /// The robot as controller and driver believe it to be.
    pub believed: Robot,
    /// The robot as it is; unknown to the controller.
    pub actual: Robot,
    /// How its wheels hold the floor.
    pub contact: Contact,
    /// What it does beyond its model.
    pub deviations: Deviations,
    /// Where to go.
    pub set_points: Vec<SetPoint>,
    /// Who steers.
    pub control: Control,
    /// The overhead camera that watches, if any.
    pub camera: Option<CameraModel>,
    /// Whether the camera corrects the controller's pose; else odometry is all it has.
    pub fused: bool,
    /// Where the robot starts; controller and camera agree on it.
    pub start: Pose,
    /// How it moves when the card is armed.
    pub moving: Twist,
    /// How the FPGA measures speeds.
    pub speed_mode: SpeedMode,
    /// Longest drive, s.
    pub limit_s: f64,
    /// Seed of the camera's noise.
    pub seed: u64,
}

impl Drive {
    /// Set points for a robot that is what it believes to be.
    #[must_use]
    pub fn new(robot: &Robot, set_points: &[SetPoint]) -> Self {
        Self {
            believed: robot.clone(),
            actual: robot.clone(),
            contact: Contact::default(),
            deviations: Deviations::default(),
            set_points: set_points.to_vec(),
            control: Control::default(),
            camera: None,
            fused: false,
            start: Pose::default(),
            moving: Twist::default(),
            speed_mode: SpeedMode::Difference,
            limit_s: 60.0,
            seed: 1,
        }
    }

    /// The paper's Fig. 6: four set points, ideal geometry.
    #[must_use]
    pub fn fig_6() -> Self {
        Self::new(&Robot::racbot(), &FIG_6)
    }
}

/// Why a drive ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The controller had nothing left to do: all reached, or given up.
    Finished,
    /// The time was over.
    TimeLimit,
    /// The card switched off; the names of its faults.
    Disarmed(String),
}

/// A drive that was driven.
#[derive(Clone, Debug)]
pub struct Driven {
    /// The log, as a real robot would have written it.
    pub run: Run,
    /// The `robot.toml` that belongs beside it.
    pub robot: Robot,
    /// How well it went, by where the robot really was.
    pub report: TrajectoryReport,
    /// Time (s) and where the robot really was, every tick.
    pub track: Vec<(f64, Pose)>,
    /// Where the controller believed it to be, every tick.
    pub believed: Vec<Pose>,
    /// Speeds of the wheels as they were, rad/s, `[wheel][tick]`.
    pub wheel_speeds: Vec<Vec<f64>>,
    /// Why it ended.
    pub ending: Ending,
}

impl Drive {
    /// Drives; `progress` hears the time reached (s) every now and then.
    ///
    /// # Errors
    /// [`LoopError`] where the robot does not fit the card, or the FPGA fails.
    pub fn run<F: Fpga>(&self, fpga: F, mut progress: impl FnMut(f64)) -> Result<Driven, LoopError> {
        let settings = self.settings();
        let plant = Plant::new(&self.actual)?
            .with_contact(self.contact)
            .with_deviations(&self.deviations)
            .at(self.start)
            .moving(self.moving);
        let mut robot = ClosedLoop::start(fpga, &self.believed, plant, &settings)?.with_supply(self.actual.supply_v);
        let mut controller = Controller::new(self.control, &self.believed, &self.set_points, self.start)?;
        let mut localiser = self.localiser()?;
        let mut camera = self.camera.map(|model| Camera::new(model, self.seed));

        let dt = robot.scale().tick_s();
        let wheels = self.believed.wheel_count();
        let mut recording = Recording::new(wheels, camera.is_some());
        let (mut track, mut believed, mut wheel_speeds) = (Vec::new(), Vec::new(), vec![Vec::new(); wheels]);
        let mut pose = self.start;
        let mut counts = vec![0; wheels];
        let mut settling = 0.0;
        let mut tick = 0_u64;
        let ending = loop {
            let t = tick as f64 * dt;
            if t >= self.limit_s {
                break Ending::TimeLimit;
            }
            let command = controller.command(pose, dt);
            if command.is_none() {
                settling += dt;
                if settling > SETTLING_S {
                    break Ending::Finished;
                }
            }
            let command = command.unwrap_or_default();
            let seen = camera.as_mut().and_then(|camera| camera.observe(t, robot.plant().pose()));
            track.push((t, robot.plant().pose()));
            for (speeds, speed) in wheel_speeds.iter_mut().zip(robot.plant().wheel_speeds()) {
                speeds.push(speed);
            }
            let snapshot = robot.tick(command)?;
            recording.row(t, command, &snapshot, robot.scale(), self.actual.supply_v, seen);
            for (count, word) in counts.iter_mut().zip(snapshot.counts) {
                *count = i64::from(word);
            }
            pose = localiser.tick(t, &counts, seen);
            believed.push(pose);
            if !snapshot.status.armed {
                break Ending::Disarmed(fault_names(snapshot.faults));
            }
            if tick.is_multiple_of(64) {
                progress(t);
            }
            tick += 1;
        };
        let report = TrajectoryReport::new(self.start, &self.set_points, controller.arrivals(), &track, REACHED_M);
        let robot = logged_robot(&self.believed, robot.scale(), &settings);
        Ok(Driven { run: recording.finish(), robot, report, track, believed, wheel_speeds, ending })
    }

    fn settings(&self) -> Settings {
        // Slow control loops pet a slow dog.
        let watchdog_s = Settings::default().watchdog_s.max(5.0 * self.believed.tick_s());
        Settings { speed_mode: self.speed_mode, watchdog_s, ..Settings::default() }
    }

    fn localiser(&self) -> Result<Localiser, LoopError> {
        let geometry = self.believed.geometry()?;
        if !self.fused {
            return Ok(Localiser::odometry(&self.believed, &geometry, self.start));
        }
        let options =
            FusionOptions { wheel_variance: UNCALIBRATED_WHEEL_VARIANCE, ..FusionOptions::of(&self.believed) };
        Ok(Localiser::fused(&self.believed, &geometry, options, self.start))
    }
}

fn fault_names(faults: u32) -> String {
    let names: Vec<&str> = FAULT_FIELDS.iter().filter(|f| f.of(faults) == 1).map(|f| f.name).collect();
    if names.is_empty() { "no fault shown".to_owned() } else { names.join(", ") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fpga::BitTrue;
    use model::trajectory::FIG_7_SKEW_DEG;
    use runs::robot::Layout;

    fn fig_7() -> Drive {
        let mut drive = Drive::fig_6();
        drive.actual.layout = Layout::Rac { body_radius_m: 0.085, skew_rad: FIG_7_SKEW_DEG.map(f64::to_radians) };
        drive
    }

    #[test]
    fn fig_6_is_driven_and_its_log_is_a_data_set() {
        for (control, speed_mode) in [
            (Control::Follower, SpeedMode::Difference),
            (Control::Follower, SpeedMode::CountAndTime),
            (Control::Paper, SpeedMode::CountAndTime),
        ] {
            let drive = Drive { control, speed_mode, ..Drive::fig_6() };
            let driven = drive.run(BitTrue::new(), |_| {}).unwrap();
            let r = &driven.report;
            assert_eq!(driven.ending, Ending::Finished);
            assert!(r.set_points.iter().all(|p| p.why_not.is_none()), "{control:?}: {r:#?}");
            assert!(r.time_s.is_some_and(|t| t > 13.2 && t < 20.0), "{r:#?}");
            driven.run.check(&driven.robot, std::path::Path::new("log")).unwrap();
            driven.robot.validate(std::path::Path::new("robot.toml")).unwrap();
            assert_eq!(driven.robot.pi.arithmetic.as_deref(), Some("fixed-kin"));
        }
    }

    #[test]
    fn hidden_skew_leads_astray_and_the_camera_leads_back() {
        let open = fig_7().run(BitTrue::new(), |_| {}).unwrap().report;
        assert!(open.time_s.is_none() && open.path_error_max_m > 0.5, "{open:#?}");
        let camera = Some(CameraModel::of(&Robot::racbot()));
        let closed = Drive { camera, fused: true, ..fig_7() }.run(BitTrue::new(), |_| {}).unwrap();
        assert!(closed.report.time_s.is_some(), "{:#?}", closed.report);
        assert!(closed.run.camera.len() > 800);
    }

    #[test]
    fn time_runs_out_and_the_seed_decides_the_camera() {
        let camera = Some(CameraModel::of(&Robot::racbot()));
        let drive = |seed| Drive { camera, limit_s: 0.5, seed, ..Drive::fig_6() }.run(BitTrue::new(), |_| {}).unwrap();
        let (first, again, other) = (drive(1), drive(1), drive(2));
        assert_eq!(first.ending, Ending::TimeLimit);
        assert_eq!(first.run.len(), 500);
        assert_eq!(first.run, again.run);
        assert_ne!(first.run, other.run);
    }
}
