//! Motors, body, camera and an FPGA, tick by tick, as the driver sees them: registers, a clock, a pose source.

use crate::error::FpgaError;
use crate::fpga::Fpga;
use crate::imu::Chassis;
use driver::drive::PoseSource;
use driver::realtime::Clock;
use driver::{BusError, Registers};
use fixed_kin::AXES;
use fixed_kin::registers::NOMINAL_CLOCK_HZ;
use model::camera::{Camera, CameraModel};
use model::measurement::Measurement;
use model::plant::Plant;
use runs::frames::{Pose, Twist};
use std::cell::RefCell;
use std::rc::Rc;
use std::time::Duration;

/// Where the robot was at a control tick, and how fast its wheels turned, rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// True pose.
    pub pose: Pose,
    /// True wheel speeds; 0 where there is no wheel.
    pub wheel_speeds: [f64; AXES],
}

/// A robot on an FPGA in simulated time; clones are the same one.
///
/// The host's time is counted in control periods: an access takes none, and the card's tick falls together with the
/// host's. Before tick k the host commits the set points that act at k; at k the FPGA latches its encoders and computes
/// the duty that drives the motors until k + 1; after k the host reads what the FPGA saw.
#[derive(Debug)]
pub struct VirtualRobot<F>(Rc<RefCell<Inside<F>>>);

impl<F> Clone for VirtualRobot<F> {
    fn clone(&self) -> Self {
        Self(Rc::clone(&self.0))
    }
}

#[derive(Debug)]
struct Inside<F> {
    fpga: F,
    plant: Plant,
    supply_v: f64,
    camera: Option<Camera>,
    /// Length of a control period, and the same in s.
    period: Duration,
    chassis: Chassis,
    period_s: f64,
    /// Control periods so far.
    now: Duration,
    history: Vec<Moment>,
    failure: Option<FpgaError>,
}

impl<F: Fpga> VirtualRobot<F> {
    /// A `plant`, which may be in motion, behind an FPGA whose control period is this long.
    pub fn new(fpga: F, plant: Plant, supply_v: f64, period: Duration) -> Self {
        Self(Rc::new(RefCell::new(Inside {
            fpga,
            plant,
            supply_v,
            camera: None,
            period,
            chassis: Chassis::default(),
            period_s: period.as_secs_f64(),
            now: Duration::ZERO,
            history: Vec::new(),
            failure: None,
        })))
    }

    /// With a camera above it.
    #[must_use]
    pub fn watched_by(self, camera: CameraModel, seed: u64) -> Self {
        self.0.borrow_mut().camera = Some(Camera::new(camera, seed));
        self
    }

    /// Lets one control period pass.
    ///
    /// # Errors
    /// [`FpgaError`] where the FPGA's simulation fails or an encoder moves too fast.
    pub fn tick(&self) -> Result<(), FpgaError> {
        self.0.borrow_mut().tick()
    }

    /// True pose on the field.
    #[must_use]
    pub fn pose(&self) -> Pose {
        self.0.borrow().plant.pose()
    }

    /// True velocity in the body's frame.
    #[must_use]
    pub fn twist(&self) -> Twist {
        self.0.borrow().plant.twist()
    }

    /// Puts the robot somewhere else, in motion, its wheels rolling; the counters stay.
    pub fn place(&self, pose: Pose, twist: Twist) {
        let mut inside = self.0.borrow_mut();
        inside.plant = inside.plant.clone().at(pose).moving(twist);
    }

    /// Something hit the robot: [`Plant::strike`]; its controller sees no more of it than its encoders do.
    pub fn strike(&self, moved: [f64; 2], changed: [f64; 2], friction_coefficient: f64) {
        self.0.borrow_mut().plant.strike(moved, changed, friction_coefficient);
    }

    /// Looks at the FPGA from outside, such as at its pins.
    pub fn fpga<T>(&self, look: impl FnOnce(&mut F) -> T) -> T {
        look(&mut self.0.borrow_mut().fpga)
    }

    /// Motors and body as they are now.
    #[must_use]
    pub fn with_plant<T>(&self, look: impl FnOnce(&Plant) -> T) -> T {
        look(&self.0.borrow().plant)
    }

    /// What happened at every tick so far; forgotten here.
    #[must_use]
    pub fn take_history(&self) -> Vec<Moment> {
        std::mem::take(&mut self.0.borrow_mut().history)
    }

    /// Why the simulation failed, if it did; from then on the card does not answer.
    #[must_use]
    pub fn take_failure(&self) -> Option<FpgaError> {
        self.0.borrow_mut().failure.take()
    }
}

impl<F: Fpga> Inside<F> {
    fn tick(&mut self) -> Result<(), FpgaError> {
        let mut wheel_speeds = [0.0; AXES];
        wheel_speeds.iter_mut().zip(self.plant.wheel_speeds()).for_each(|(own, speed)| *own = speed);
        self.history.push(Moment { pose: self.plant.pose(), wheel_speeds });
        let mut positions = [0.0; AXES];
        for (position, now) in positions.iter_mut().zip(self.plant.encoder_after()) {
            *position = *now;
        }
        if let Some(sensor) = self.fpga.imu() {
            sensor.feel(&self.chassis.motion(&self.plant, self.period_s), NOMINAL_CLOCK_HZ.into());
        }
        self.fpga.advance(&positions)?;
        let duty = self.fpga.duties()?;
        self.plant.step(&duty, self.supply_v, self.period_s);
        self.now += self.period;
        Ok(())
    }
}

impl<F: Fpga> Registers for VirtualRobot<F> {
    fn read(&mut self, offset: u16) -> Result<u32, BusError> {
        self.0.borrow_mut().fpga.read(offset)
    }
    fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError> {
        self.0.borrow_mut().fpga.write(offset, data)
    }
    fn read_block(&mut self, offset: u16, words: &mut [u32]) -> Result<(), BusError> {
        self.0.borrow_mut().fpga.read_block(offset, words)
    }
}

impl<F: Fpga> Clock for VirtualRobot<F> {
    fn now(&mut self) -> Duration {
        self.0.borrow().now
    }

    fn sleep_until(&mut self, at: Duration) {
        let mut inside = self.0.borrow_mut();
        // Nothing passes after a failure: the driver finds the card without ticks and ends the drive.
        while inside.failure.is_none() && inside.now < at {
            if let Err(error) = inside.tick() {
                inside.failure = Some(error);
            }
        }
    }
}

impl<F: Fpga> PoseSource for VirtualRobot<F> {
    fn arrived(&mut self, t: f64) -> Option<Measurement> {
        let mut inside = self.0.borrow_mut();
        let pose = inside.history.last()?.pose;
        inside.camera.as_mut()?.observe(t, pose).map(Into::into)
    }
}
