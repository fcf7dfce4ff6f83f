//! A whole simulated robot: speed loops, plant, encoders and camera, in one control tick.

use crate::camera::{Camera, CameraModel};
use crate::frames::{Pose, Twist};
use crate::geometry::{Geometry, GeometryError};
use crate::pi::SpeedLoop;
use crate::plant::{Contact, Plant};
use crate::robot::Robot;
use crate::run::{CameraSample, Run};

/// A robot that is driven by body twists and keeps a log of everything a real one would.
///
/// The controller's geometry comes with every command, so that it need not be the robot's own.
#[derive(Debug, Clone)]
pub struct VirtualRobot {
    robot: Robot,
    plant: Plant,
    loops: Vec<SpeedLoop>,
    camera: Camera,
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
        let n = robot.wheel_count();
        let log = Run {
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
            plant: Plant::new(robot)?.with_contact(contact).at(start),
            loops: vec![SpeedLoop::new(robot); n],
            camera: Camera::new(camera, seed),
            robot: robot.clone(),
            log,
        })
    }

    /// Time of the coming tick, s.
    pub fn time(&self) -> f64 {
        self.log.len() as f64 * self.robot.tick_s()
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
        let mut duties = Vec::with_capacity(counts.len());
        for (i, (axis, count)) in self.loops.iter_mut().zip(&counts).enumerate() {
            let reference = believed.wheel_speed(i, command);
            let duty = axis.step(reference, *count);
            self.log.reference[i].push(reference);
            self.log.counts[i].push(*count);
            self.log.duty[i].push(duty);
            duties.push(duty);
        }
        if let Some([vx, vy, w]) = &mut self.log.command {
            vx.push(command.vx);
            vy.push(command.vy);
            w.push(command.omega);
        }
        if let Some(supply) = &mut self.log.supply_v {
            supply.push(self.robot.supply_v);
        }
        self.log.t.push(self.log.t.len() as f64 * self.robot.tick_s());
        self.plant.step(&duties, self.robot.supply_v, self.robot.tick_s());
    }

    /// Drives `twist` for `seconds`, reached and left with limited acceleration: a trapezoid that
    /// covers about `twist` × `seconds` and ends at rest.
    pub fn drive(&mut self, twist: Twist, seconds: f64, believed: &Geometry) {
        let ramp = RAMP_S.min(0.5 * seconds);
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

    /// The log.
    pub fn into_log(self) -> Run {
        self.log
    }
}

/// Time to reach a twist, s.
const RAMP_S: f64 = 0.3;
/// Rest after a drive, for the camera to see where it ended, s.
const REST_S: f64 = 0.15;

/// A drive of about `seconds` that shows all a calibration needs: straight out and back in
/// directions all around, at `speed` (m/s), with turns between.
pub fn calibration_drive(robot: &mut VirtualRobot, speed: f64, seconds: f64, believed: &Geometry) {
    let leg_s = 1.5;
    let end = robot.time() + seconds;
    // The golden angle spreads any number of directions evenly.
    let mut heading = 0.3_f64;
    while robot.time() + 2.0 * (leg_s + RAMP_S + REST_S) < end {
        let twist = Twist::new(speed * heading.cos(), speed * heading.sin(), 0.0);
        robot.drive(twist, leg_s, believed);
        robot.drive(Twist { omega: 1.2, ..twist.scaled(-1.0) }, leg_s, believed);
        heading += 2.399_963;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pi::PiLaw;

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
        assert_eq!((run.len(), run.duty[2].len(), run.counts[0].len()), (2450, 2450, 2450));
        // Count difference before the first tick is zero: the log replays from the first row.
        let law = PiLaw::of(&robot());
        assert_eq!(run.duty[1][0], law.step(&mut 0.0, run.reference[1][0], 0.0));
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.csv");
        run.write(&path).unwrap();
        assert_eq!(Run::read(&path).unwrap(), run);
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
