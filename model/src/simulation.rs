//! A whole simulated robot: speed loops, plant, encoders and camera, in one control tick.

use crate::camera::{Camera, CameraModel};
use crate::effects::{Applied, ControlDeviations};
use crate::imu::{Chassis, Imu, ImuModel};
use crate::localisation::Localiser;
use crate::pi::SpeedLoop;
use crate::plant::{Contact, Plant};
use crate::trajectory::{Follower, SetPoint, TrajectoryReport};
use runs::frames::{Pose, Twist};
use runs::geometry::{Geometry, GeometryError};
use runs::robot::Robot;
use runs::{CameraSample, Run};

/// Tells the sensor's noise from the camera's, which has the same seed.
const IMU_NOISE: u64 = 0x696d_7500;

/// A robot that is driven by body twists and keeps a log of everything a real one would.
///
/// The controller's geometry comes with every command, so that it need not be the robot's own.
#[derive(Debug, Clone)]
pub struct VirtualRobot {
    robot: Robot,
    plant: Plant,
    loops: Vec<SpeedLoop>,
    control: ControlDeviations,
    camera: Camera,
    imu: Option<(Imu, Chassis)>,
    log: Run,
}

impl VirtualRobot {
    /// The robot as it really is, at rest at `start`.
    ///
    /// # Errors
    /// [`GeometryError`] if its wheels cannot drive it.
    pub fn new(
        robot: &Robot,
        contact: Contact,
        camera: CameraModel,
        start: Pose,
        seed: u64,
    ) -> Result<Self, GeometryError> {
        let nominal = Robot { effects: Vec::new(), ..robot.clone() };
        Self::of(&Applied { contact, camera, ..Applied::of(&nominal) }, start, seed)
    }

    /// A robot with effects, at rest at `start`.
    ///
    /// # Errors
    /// As [`VirtualRobot::new`].
    pub fn of(applied: &Applied, start: Pose, seed: u64) -> Result<Self, GeometryError> {
        let robot = &applied.robot;
        let n = robot.wheel_count();
        let imu = robot.imu.map(|mount| {
            let model = ImuModel { place: mount.place_m, ..ImuModel::icm_42688_p(robot.control_rate_hz) };
            let sensor = Imu::new(model, applied.imu.part).with_deviations(&applied.imu);
            (sensor.with_noise(seed ^ IMU_NOISE), Chassis::default())
        });
        let log = Run {
            gyro: imu.is_some().then(Default::default),
            acceleration: imu.is_some().then(Default::default),
            imu_temp: imu.is_some().then(Vec::new),
            name: "run".to_owned(),
            command: Some(Default::default()),
            reference: vec![Vec::new(); n],
            counts: vec![Vec::new(); n],
            count_gaps: vec![Vec::new(); n],
            duty: vec![Vec::new(); n],
            supply_v: Some(Vec::new()),
            has_camera: true,
            ..Run::default()
        };
        Ok(Self {
            plant: applied.plant()?.at(start),
            loops: vec![
                SpeedLoop::with_law(robot, applied.control.law(robot))
                    .counting(1.0 + applied.control.more_counts);
                n
            ],
            control: applied.control.clone(),
            camera: Camera::new(applied.camera, seed),
            robot: robot.clone(),
            imu,
            log,
        })
    }

    /// Time of the coming tick, s.
    pub fn time(&self) -> f64 {
        self.log.len() as f64 * self.robot.tick_s()
    }

    /// One control tick, s.
    pub fn tick_s(&self) -> f64 {
        self.robot.tick_s()
    }

    /// Where the robot really is.
    pub fn pose(&self) -> Pose {
        self.plant.pose()
    }

    /// How it really moves.
    pub fn twist(&self) -> Twist {
        self.plant.twist()
    }

    /// What the encoder counters read.
    pub fn counts(&self) -> Vec<i64> {
        self.plant.counts()
    }

    /// What the camera delivers at the coming tick. Once a tick, before [`VirtualRobot::tick`].
    pub fn look(&mut self) -> Option<Pose> {
        let seen = self.camera.observe(self.time(), self.plant.pose());
        if let Some(pose) = seen {
            self.log.camera.push(CameraSample { tick: self.log.len(), pose });
        }
        seen
    }

    /// One control tick: the command becomes set points by the `believed` geometry.
    pub fn tick(&mut self, command: Twist, believed: &Geometry) {
        let counts = self.plant.counts();
        let tick = self.log.len();
        self.feel();
        let mut acting = command;
        if let Some([vx, vy, w]) = &mut self.log.command {
            vx.push(command.vx);
            vy.push(command.vy);
            w.push(command.omega);
            let age = (self.control.command_latency_s / self.robot.tick_s()).round() as usize;
            acting = tick.checked_sub(age).map_or_else(Twist::default, |k| Twist::new(vx[k], vy[k], w[k]));
        }
        let [count_age, reference_age] = self.control.shift_ticks;
        let mut duties = Vec::with_capacity(counts.len());
        for (i, (axis, count)) in self.loops.iter_mut().zip(&counts).enumerate() {
            self.log.reference[i].push(self.control.reference(i, acting, believed));
            self.log.counts[i].push(*count);
            let reference = self.log.reference[i][tick.saturating_sub(reference_age)];
            let duty = axis.step(reference, self.log.counts[i][tick.saturating_sub(count_age)]);
            self.log.duty[i].push(duty);
            duties.push(duty);
        }
        if let Some(supply) = &mut self.log.supply_v {
            supply.push(self.robot.supply_v);
        }
        self.log.t.push(self.log.t.len() as f64 * self.robot.tick_s());
        self.plant.step(&duties, self.robot.supply_v, self.robot.tick_s());
    }

    /// Reads the inertial sensor, in the body's axes.
    fn feel(&mut self) {
        let Some((sensor, chassis)) = &mut self.imu else { return };
        let reading = sensor.read(&chassis.motion(&self.plant, self.robot.tick_s()));
        let triples = [(&mut self.log.gyro, reading.gyro), (&mut self.log.acceleration, reading.acceleration)];
        for (columns, values) in triples {
            columns.iter_mut().flatten().zip(values).for_each(|(column, value)| column.push(value));
        }
        self.log.imu_temp.iter_mut().for_each(|column| column.push(reading.temperature_c));
    }

    /// Drives `twist` for `seconds`, reached and left with limited acceleration: covers `twist` ×
    /// `seconds` and ends at rest.
    pub fn drive(&mut self, twist: Twist, seconds: f64, believed: &Geometry) {
        let ramp = ramp_s(twist);
        let start = self.time();
        loop {
            let t = self.time() - start;
            if t >= seconds + ramp {
                break;
            }
            let share = (t / ramp).min((seconds + ramp - t) / ramp).clamp(0.0, 1.0);
            self.look();
            self.tick(twist.scaled(share), believed);
        }
        for _ in 0..(REST_S / self.robot.tick_s()) as usize {
            self.look();
            self.tick(Twist::default(), believed);
        }
    }

    /// The log so far.
    pub fn log(&self) -> &Run {
        &self.log
    }

    /// All ticks so far, as a real robot would have written them.
    pub fn into_log(self) -> Run {
        self.log
    }
}

/// A followed trajectory.
#[derive(Debug, Clone)]
pub struct Followed {
    /// How well it went, by where the robot really was.
    pub report: TrajectoryReport,
    /// Time (s) and where the robot really was, every tick.
    pub track: Vec<(f64, Pose)>,
    /// Where the controller believed it to be, every tick.
    pub believed: Vec<Pose>,
}

/// Drives a virtual robot along set points until it rests at their end, has given up, or
/// `limit_s` is over. A set point counts as reached if the robot really was within
/// `tolerance_m` of it.
pub fn follow(
    robot: &mut VirtualRobot,
    set_points: &[SetPoint],
    follower: &mut Follower,
    localiser: &mut Localiser,
    believed: &Geometry,
    limit_s: f64,
    tolerance_m: f64,
) -> Followed {
    let (start, began) = (robot.pose(), robot.time());
    let (mut track, mut poses) = (Vec::new(), Vec::new());
    loop {
        let t = robot.time() - began;
        let seen = robot.look();
        let pose = localiser.tick(robot.time(), &robot.counts(), seen.map(Into::into));
        track.push((t, robot.pose()));
        poses.push(pose);
        let Some(command) = follower.command(pose, robot.robot.tick_s()).filter(|_| t < limit_s) else { break };
        robot.tick(command, believed);
    }
    let report = TrajectoryReport::new(start, set_points, follower.arrivals(), &track, tolerance_m);
    Followed { report, track, believed: poses }
}

/// Acceleration of [`VirtualRobot::drive`], m/s². Twice as much saturates the duty of the fastest
/// wheel, and what that wheel then falls behind turns the robot.
const RAMP_ACCELERATION: f64 = 0.8;
/// Shortest time to reach a twist, s: rotation needs little torque.
const SHORTEST_RAMP_S: f64 = 0.2;

/// Time to reach a twist, s.
fn ramp_s(twist: Twist) -> f64 {
    (twist.speed() / RAMP_ACCELERATION).max(SHORTEST_RAMP_S)
}

/// Rest after a drive, for the camera to see where it ended, s.
const REST_S: f64 = 0.15;

/// A drive of about `seconds` that shows all a calibration needs: straight out and back in
/// directions all around, at `speed` (m/s), with turns between.
pub fn calibration_drive(robot: &mut VirtualRobot, speed: f64, seconds: f64, believed: &Geometry) {
    let leg_s = 1.2;
    let leg_total_s = leg_s + speed / RAMP_ACCELERATION + REST_S;
    let end = robot.time() + seconds;
    // The golden angle spreads any number of directions evenly.
    let mut heading = 0.3_f64;
    while robot.time() + 2.0 * leg_total_s < end {
        let twist = Twist::new(speed * heading.cos(), speed * heading.sin(), 0.0);
        robot.drive(twist, leg_s, believed);
        robot.drive(Twist { omega: 1.2, ..twist.scaled(-1.0) }, leg_s, believed);
        heading += 2.399_963;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fusion::FusionOptions;
    use crate::odometry::Estimate;
    use crate::pi::PiLaw;
    use crate::trajectory::{FIG_6, FIG_7_SKEW_DEG, FollowerOptions, Limits};
    use runs::robot::Layout;

    fn robot() -> Robot {
        Robot::racbot()
    }

    fn virtual_robot() -> VirtualRobot {
        let robot = robot();
        VirtualRobot::new(&robot, Contact::Rolling, CameraModel::of(&robot), Pose::new(1.0, 2.0, 0.5), 4).unwrap()
    }

    #[test]
    fn a_metre_forward_is_a_metre_forward_and_the_log_says_so() {
        let mut v = virtual_robot();
        let g = robot().geometry().unwrap();
        v.drive(Twist::new(0.0, 0.5, 0.0), 2.0, &g);
        let local = Pose::new(1.0, 2.0, 0.5).relative(v.pose());
        assert!((local.y - 1.0).abs() < 0.02 && local.x.abs() < 0.005, "{local:?}");
        let run = v.into_log();
        assert_eq!(run.check(&robot(), std::path::Path::new("log")), Ok(()));
        assert_eq!((run.len(), run.duty[2].len(), run.counts[0].len()), (2775, 2775, 2775));
        // Count difference before the first tick is zero: the log replays from the first row.
        let law = PiLaw::of(&robot());
        assert_eq!(run.duty[1][0], law.step(&mut 0.0, run.reference[1][0], 0.0));
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.csv");
        run.write(&path).unwrap();
        assert_eq!(Run::read(&path).unwrap(), run);
    }

    fn drive_fig_6(skew_deg: [f64; 3], believed_deg: [f64; 3], closed: bool, points: &[SetPoint]) -> Followed {
        let layout = |deg: [f64; 3]| Layout::Rac { body_radius_m: 0.085, skew_rad: deg.map(f64::to_radians) };
        let actual = Robot { layout: layout(skew_deg), ..robot() };
        let nominal = Robot { layout: layout(believed_deg), ..robot() };
        let start = Pose::default();
        let mut v = VirtualRobot::new(&actual, Contact::Rolling, CameraModel::of(&actual), start, 1).unwrap();
        let g = nominal.geometry().unwrap();
        let limits = Limits::of(&nominal).unwrap();
        let options = FollowerOptions::of(&nominal).unwrap();
        let mut follower = Follower::new(points, start, &g, limits, options);
        let mut localiser = if closed {
            let options = FusionOptions::of(&nominal).uncalibrated();
            Localiser::fused(&nominal, &g, options, Estimate::new(start, options.camera_noise))
        } else {
            Localiser::odometry(&nominal, &g, start)
        };
        follow(&mut v, points, &mut follower, &mut localiser, &g, 60.0, 0.1)
    }

    #[test]
    fn fig_6_with_dynamics_reaches_every_set_point() {
        for closed in [false, true] {
            let r = drive_fig_6([0.0; 3], [0.0; 3], closed, &FIG_6).report;
            assert!(r.set_points.iter().all(|s| s.why_not.is_none() && s.miss_m < 0.02), "{r:#?}");
            let time = r.time_s.unwrap();
            assert!(time > 13.2 && time < 20.0, "{time}");
            assert!(r.path_error_rms_m < 0.015 && r.path_error_max_m < 0.07 && r.overshoot_m < 0.6, "{r:#?}");
        }
    }

    #[test]
    fn unknown_skew_is_survived_with_a_camera_only_and_known_skew_without() {
        let skew = FIG_7_SKEW_DEG;
        let open = drive_fig_6(skew, [0.0; 3], false, &FIG_6).report;
        assert!(open.time_s.is_none() && open.path_error_max_m > 0.5, "{open:#?}");
        assert!(open.set_points[0].why_not.as_ref().unwrap().contains("never came nearer"));
        let closed = drive_fig_6(skew, [0.0; 3], true, &FIG_6).report;
        assert!(closed.time_s.is_some() && closed.path_error_rms_m < 0.05, "{closed:#?}");
        let known = drive_fig_6(skew, skew, false, &FIG_6).report;
        // Below 1 % of the 13.2 m path.
        assert!(known.time_s.is_some() && known.path_error_max_m < 0.05, "{known:#?}");
    }

    #[test]
    fn stops_come_to_rest_without_overshoot() {
        let points = [SetPoint::stop(0.8, 0.0, 0.8, 0.5), SetPoint::stop(0.8, 0.6, 0.8, -0.5)];
        let followed = drive_fig_6([0.0; 3], [0.0; 3], false, &points);
        let r = &followed.report;
        assert!(r.time_s.is_some() && r.overshoot_m < 0.01, "{r:#?}");
        let at = r.set_points[0].reached_at.unwrap();
        let (_, first) = followed.track.iter().find(|(t, _)| *t >= at).unwrap();
        let (_, later) = followed.track.iter().find(|(t, _)| *t >= at + 0.02).unwrap();
        assert!(first.distance(*later) / 0.02 < 0.06, "nearly at rest");
        let last = followed.track.last().unwrap().1;
        assert!((last.x - 0.8).abs() < 0.02 && (last.y - 0.6).abs() < 0.02, "{last:?}");
    }

    #[test]
    fn a_robot_that_cannot_move_gives_up_and_says_so() {
        let mut weak = robot();
        weak.motor.friction_torque = 1.0;
        let mut v = VirtualRobot::new(&weak, Contact::Rolling, CameraModel::of(&weak), Pose::default(), 1).unwrap();
        let g = weak.geometry().unwrap();
        let limits = Limits::of(&robot()).unwrap();
        let mut follower = Follower::new(&FIG_6, Pose::default(), &g, limits, FollowerOptions::default());
        let mut localiser = Localiser::odometry(&weak, &g, Pose::default());
        let r = follow(&mut v, &FIG_6, &mut follower, &mut localiser, &g, 60.0, 0.1).report;
        assert!(r.set_points[0].why_not.as_ref().unwrap().contains("given up"), "{r:#?}");
        assert!(r.set_points[3].why_not.as_ref().unwrap().contains("ended"), "{r:#?}");
    }

    #[test]
    fn the_seed_decides_the_log() {
        let drive = || {
            let mut v = virtual_robot();
            calibration_drive(&mut v, 0.6, 8.0, &robot().geometry().unwrap());
            v.into_log()
        };
        assert_eq!(drive(), drive());
    }
}
