//! What rides on the robot: wheels, gyroscope and camera, joined to a pose tick by tick.

use super::{Now, Senses};
use crate::closed_loop::VirtualRobot;
use crate::eye::SharedEye;
use crate::fpga::Fpga;
use crate::imu::Chassis;
use driver::drive::PoseSource;
use model::fusion::FusionOptions;
use model::imu::{Imu, ImuModel, Motion};
use model::inertial::Inertial;
use model::measurement::Measurement;
use model::odometry;
use runs::frames::{Pose, Twist, wrap_angle};
use runs::robot::Robot;
use std::cell::Cell;
use std::rc::Rc;
use vision::localise::Estimate;
use vision::onboard::Glance;

/// Ticks between two pictures: five a second.
const PICTURE_EVERY: u64 = 200;
/// Ticks between two poses for the control loop.
const POSE_EVERY: u64 = 16;

/// Wheels, gyroscope and camera of a robot as one source of poses.
#[derive(Debug)]
pub struct OnBoard<F> {
    robot: VirtualRobot<F>,
    filter: Inertial,
    imu: Imu,
    chassis: Chassis,
    tick: u64,
    period: f64,
    eye: Option<SharedEye>,
    senses: Senses,
    /// Seconds of the story before this drive.
    since: f64,
    /// What is believed at the last tick, for the next drive.
    end: Rc<Cell<Estimate>>,
}

impl<F: Fpga> OnBoard<F> {
    pub(super) fn new(
        robot: VirtualRobot<F>,
        model: &Robot,
        now: &Now,
        senses: Senses,
        eye: SharedEye,
        end: Rc<Cell<Estimate>>,
        part: u64,
    ) -> Self {
        let sensor = ImuModel::icm_42688_p(model.control_rate_hz);
        let geometry = model.geometry().expect("the robot drives by this geometry");
        let options = FusionOptions::of(model).uncalibrated();
        let start = odometry::Estimate { pose: now.belief.pose, covariance: now.belief.covariance };
        let mut filter = Inertial::new(&geometry, model.counts_per_wheel_rad(), options, &sensor, start);
        let mut imu = Imu::new(sensor, part).with_noise(part + now.legs.len() as u64);
        // A second of rest before the start shows the gyroscope's bias.
        let period = 1.0 / model.control_rate_hz;
        let mut chassis = Chassis::default();
        let counts = robot.with_plant(|plant| {
            chassis.motion(plant, period);
            plant.counts()
        });
        for k in 0..1000 {
            filter.predict((f64::from(k) - 1000.0) * period, &counts, &imu.read(&Motion::default()));
        }
        // At rest nothing was learned of the pose: what the drive before left is known, as a whole.
        filter.adopt(now.belief.pose, now.belief.covariance);
        let eye = (senses == Senses::Camera).then_some(eye);
        Self { robot, filter, imu, chassis, tick: 0, period, eye, senses, since: now.t, end }
    }

    fn belief(&self) -> Estimate {
        Estimate { pose: self.filter.pose(), covariance: self.filter.covariance(), agreeing: 1.0 }
    }

    fn motion(&mut self) -> (Motion, Vec<i64>, (Pose, Twist)) {
        let (chassis, period) = (&mut self.chassis, self.period);
        self.robot.with_plant(|plant| (chassis.motion(plant, period), plant.counts(), (plant.pose(), plant.twist())))
    }
}

impl<F: Fpga> PoseSource for OnBoard<F> {
    fn arrived(&mut self, t: f64) -> Option<Measurement> {
        let (motion, counts, truth) = self.motion();
        let reading = self.imu.read(&motion);
        self.filter.predict(t, &counts, &reading);
        self.tick += 1;
        if self.tick.is_multiple_of(PICTURE_EVERY)
            && let Some(eye) = &self.eye
        {
            let belief = self.belief();
            // The match holds the prediction already: the filter takes it over as it is.
            if let Ok(Glance { pose: Ok(found), .. }) = eye.borrow_mut().look(self.since + t, truth, &belief) {
                self.filter.adopt(found.pose, found.covariance);
            }
        }
        let pose = self.filter.pose();
        self.end.set(self.belief());
        let due = self.senses != Senses::Wheels && self.tick.is_multiple_of(POSE_EVERY);
        due.then(|| Pose::new(pose.x, pose.y, wrap_angle(pose.theta)).into())
    }
}
