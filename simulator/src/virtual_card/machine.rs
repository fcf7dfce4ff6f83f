//! Motors, wheels and body behind the card's connector.

use super::Wiring;
use crate::imu::{Chassis, VirtualImu};
use fixed_kin::AXES;
use model::imu::Motion;
use model::plant::Plant;
use runs::frames::Pose;
use runs::geometry::GeometryError;
use runs::robot::Robot;

/// Seed of the inertial sensor's tolerances and noise.
const IMU_SEED: u64 = 1;

/// A robot that is there whether or not the FPGA is configured.
#[derive(Clone, Debug)]
pub struct Machine {
    plant: Plant,
    supply_v: f64,
    /// Encoder positions when the FPGA started, whole turns of its lines.
    origin: [f64; AXES],
    /// Encoder positions before the last step.
    before: [f64; AXES],
    chassis: Chassis,
    imu: Option<VirtualImu>,
    motion: Motion,
    /// Encoder cables.
    pub wiring: [Wiring; AXES],
}

impl Machine {
    /// At rest.
    ///
    /// # Errors
    /// A robot whose wheels cannot drive it.
    pub fn new(robot: &Robot) -> Result<Self, GeometryError> {
        Ok(Self {
            plant: Plant::new(robot)?,
            supply_v: robot.supply_v,
            origin: [0.0; AXES],
            before: [0.0; AXES],
            chassis: Chassis::default(),
            imu: VirtualImu::of_robot(robot, IMU_SEED),
            motion: Motion::default(),
            wiring: [Wiring::Whole; AXES],
        })
    }

    /// The robot, for whoever watches.
    #[must_use]
    pub fn plant(&self) -> &Plant {
        &self.plant
    }

    pub(super) fn stand(&mut self, pose: Pose) {
        self.plant.stand(pose);
    }

    /// Lets time pass with duties in [−1, 1]; 0 shorts a motor.
    pub fn step(&mut self, duty: &[f64; AXES], time_s: f64) {
        self.before = self.encoders();
        self.plant.step(duty, self.supply_v, time_s);
        self.motion = self.chassis.motion(&self.plant, time_s);
    }

    /// The inertial sensor, once: it goes to the FPGA that reads it.
    pub fn take_imu(&mut self) -> Option<VirtualImu> {
        self.imu.take()
    }

    /// How the chassis moved in the last step.
    #[must_use]
    pub fn motion(&self) -> Motion {
        self.motion
    }

    /// A new counter starts here.
    pub fn restart_encoders(&mut self) {
        for (origin, position) in self.origin.iter_mut().zip(self.plant.encoder_after()) {
            *origin = (position / 4.0).floor() * 4.0;
        }
    }

    /// Encoder positions since then as they reach the card, in counts.
    #[must_use]
    pub fn positions(&self) -> [f64; AXES] {
        let real = self.encoders();
        std::array::from_fn(|axis| self.wiring[axis].position(axis, &real))
    }

    /// Makes every broken cable whole again; counts go on from where they are, in step with the encoder's lines.
    pub fn mend(&mut self) {
        let (real, seen) = (self.encoders(), self.positions());
        for (axis, wiring) in self.wiring.iter_mut().enumerate() {
            if *wiring != Wiring::Whole {
                *wiring = Wiring::Mended(4.0 * ((real[axis] - seen[axis]) / 4.0).round());
            }
        }
    }

    /// Axes on which both lines changed at once in the last step, a bit each.
    #[must_use]
    pub fn illegal_steps(&self) -> u8 {
        let real = self.encoders();
        (0..AXES).fold(0, |bits, axis| {
            let shorted = matches!(self.wiring[axis], Wiring::Shorted(_));
            bits | u8::from(shorted && real[axis].floor() != self.before[axis].floor()) << axis
        })
    }

    /// Where the encoders really are.
    #[must_use]
    pub fn encoders(&self) -> [f64; AXES] {
        let now = self.plant.encoder_after();
        std::array::from_fn(|axis| now.get(axis).map_or(0.0, |position| position - self.origin[axis]))
    }
}
