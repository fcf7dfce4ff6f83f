//! A whole drive along set points, from arming to rest.

use super::memory::MemoryStream;
use super::{Control, LoopError, VirtualRobot, whole_tick_clock_hz};
use crate::fpga::Fpga;
use driver::Board;
use driver::drive::{Ending, Plan, PoseSource};
use driver::realtime::Clock;
use driver::recording::{Recording, logged_robot};
use fixed_kin::speed::SpeedMode;
use model::camera::CameraModel;
use model::measurement::Measurement;
use model::odometry::{Covariance, Estimate};
use model::plant::{Contact, Deviations, Plant};
use model::trajectory::{FIG_6, SetPoint, TrajectoryReport};
use runs::frames::{Pose, Twist};
use runs::robot::Robot;
use runs::{Layout, Run};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// A set point counts as reached if the robot really was this near, m: about its own radius.
const REACHED_M: f64 = 0.1;

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
    /// How well that is known, as [`Plan::start_covariance`].
    pub start_covariance: Option<Covariance>,
    /// How well the place has to be known to drive on, m, as [`Plan::sure_m`].
    pub sure_m: Option<f64>,
    /// Where it really stands at the start, if not there.
    pub stands: Option<Pose>,
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
            start_covariance: None,
            sure_m: None,
            stands: None,
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

/// Log, truth and score of a simulated drive.
#[derive(Debug)]
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
    /// What it believed of its pose at the end.
    pub belief: Estimate,
    /// Why it ended.
    pub ending: Ending,
}

impl Drive {
    /// Drives, by the loop that drives a real robot ([`Plan::drive`]); `progress` hears the time reached (s) every now
    /// and then.
    ///
    /// # Errors
    /// [`LoopError`] where the robot does not fit the card, or the FPGA fails.
    pub fn run<F: Fpga>(&self, fpga: F, progress: impl FnMut(f64)) -> Result<Driven, LoopError> {
        self.run_seen_by(fpga, |robot| robot, progress)
    }

    /// The same with another source of poses, made of the robot it watches or rides on.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn run_seen_by<F: Fpga, S: PoseSource>(
        &self,
        fpga: F,
        source: impl FnOnce(VirtualRobot<F>) -> S,
        progress: impl FnMut(f64),
    ) -> Result<Driven, LoopError> {
        let plan = self.plan();
        let clock_hz = whole_tick_clock_hz(self.believed.control_rate_hz);
        let scale = plan.scale(clock_hz)?;
        let plant = Plant::new(&self.actual)?
            .with_contact(self.contact)
            .with_deviations(&self.deviations)
            .at(self.stands.unwrap_or(self.start))
            .moving(self.moving);
        let period = Duration::from_secs_f64(scale.tick_s());
        let mut robot = VirtualRobot::new(fpga, plant, self.actual.supply_v, period);
        if let Some(camera) = self.camera {
            robot = robot.watched_by(camera, self.seed);
        }
        let wheels = self.believed.wheel_count();
        let posed = self.fused || self.camera.is_some();
        let memory = MemoryStream::new(Layout::of_robot(wheels, posed).with_imu(self.believed.imu.is_some()));
        let mut recording = Recording::onto(Box::new(memory.clone()), Path::new("run"), wheels)?;
        recording.wait_where_full();

        let mut clock = Reported { robot: robot.clone(), progress };
        let mut source = Heard { source: source(robot.clone()), believed: Vec::new() };
        let never = AtomicBool::new(false);
        let driven =
            plan.drive(Board::new(robot.clone()), &mut clock, clock_hz, &mut source, Some(&mut recording), &never);
        if let Some(failure) = robot.take_failure() {
            return Err(failure.into());
        }
        let driven = driven?;
        recording.finish()?;
        let run = memory.take();
        // The last row is that of the last tick.
        let mut history = robot.take_history();
        history.drain(..history.len() - run.len());
        source.believed.truncate(run.len());
        let track: Vec<_> = run.t.iter().zip(&history).map(|(t, moment)| (*t, moment.pose)).collect();
        let speeds = |wheel: usize| history.iter().map(|moment| moment.wheel_speeds[wheel]).collect();
        Ok(Driven {
            robot: logged_robot(&plan.believed(), &scale, &plan.settings),
            report: TrajectoryReport::new(self.start, &self.set_points, &driven.arrivals, &track, REACHED_M),
            wheel_speeds: (0..wheels).map(speeds).collect(),
            believed: source.believed,
            track,
            belief: driven.belief,
            ending: driven.ending,
            run,
        })
    }

    fn plan(&self) -> Plan {
        let mut plan = Plan {
            control: self.control,
            start: self.start,
            start_covariance: self.start_covariance,
            sure_m: self.sure_m,
            fused: self.fused,
            limit_s: self.limit_s,
            ..Plan::new(&self.believed, &self.set_points)
        };
        plan.settings.speed_mode = self.speed_mode;
        plan
    }
}

/// Writes down what the controller believes at every tick.
struct Heard<S> {
    source: S,
    believed: Vec<Pose>,
}

impl<S: PoseSource> PoseSource for Heard<S> {
    fn arrived(&mut self, t: f64) -> Option<Measurement> {
        self.source.arrived(t)
    }

    fn believed(&mut self, t: f64, belief: &Estimate) {
        self.believed.push(belief.pose);
        self.source.believed(t, belief);
    }

    fn contradicts(&self) -> bool {
        self.source.contradicts()
    }
}

/// A robot's clock that tells how far the drive is.
struct Reported<F, P> {
    robot: VirtualRobot<F>,
    progress: P,
}

impl<F: Fpga, P: FnMut(f64)> Clock for Reported<F, P> {
    fn now(&mut self) -> Duration {
        self.robot.now()
    }

    fn sleep_until(&mut self, at: Duration) {
        self.robot.sleep_until(at);
        (self.progress)(at.as_secs_f64());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fpga::BitTrue;
    use driver::drive::Fault;
    use model::trajectory::FIG_7_SKEW_DEG;
    use runs::robot::Layout as Wheels;

    fn fig_7() -> Drive {
        let mut drive = Drive::fig_6();
        drive.actual.layout = Wheels::Rac { body_radius_m: 0.085, skew_rad: FIG_7_SKEW_DEG.map(f64::to_radians) };
        drive
    }

    #[test]
    fn fig_6_is_driven_and_its_log_is_a_data_set() {
        for (control, speed_mode) in
            [(Control::Follower, SpeedMode::Difference), (Control::Follower, SpeedMode::CountAndTime)]
        {
            let drive = Drive { control, speed_mode, ..Drive::fig_6() };
            let driven = drive.run(BitTrue::new(), |_| {}).unwrap();
            let r = &driven.report;
            assert!(matches!(driven.ending, Ending::Finished), "{:?}", driven.ending);
            assert!(r.set_points.iter().all(|p| p.why_not.is_none()), "{control:?}: {r:#?}");
            assert!(r.time_s.is_some_and(|t| t > 13.2 && t < 20.0), "{r:#?}");
            driven.run.check(&driven.robot, std::path::Path::new("log")).unwrap();
            driven.robot.validate(std::path::Path::new("robot.toml")).unwrap();
            assert_eq!(driven.robot.pi.arithmetic.as_deref(), Some("fixed-kin"));
        }
    }

    /// The paper's controller asks for steps of speed. A wheel that is driven fully against its motion for longer than
    /// it takes to stop ends a drive, on the robot and here.
    #[test]
    fn steps_of_speed_that_no_wheel_follows_end_the_drive() {
        let drive = Drive { control: Control::Paper, speed_mode: SpeedMode::CountAndTime, ..Drive::fig_6() };
        let driven = drive.run(BitTrue::new(), |_| {}).unwrap();
        assert!(matches!(driven.ending, Ending::Fault(Fault::Backwards { .. })), "{:?}", driven.ending);
        assert!(driven.run.duration_s() > 1.0);
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
        assert!(matches!(first.ending, Ending::TimeLimit));
        assert_eq!(first.run.len(), 500);
        assert_eq!(first.run, again.run);
        assert_ne!(first.run, other.run);
    }
}
