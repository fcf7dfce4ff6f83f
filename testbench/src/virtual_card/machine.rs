//! Motors, wheels and body behind the card's connector.

use fixed_kin::AXES;
use model::geometry::GeometryError;
use model::plant::Plant;
use model::robot::Robot;

/// A robot that is there whether or not the FPGA is configured.
#[derive(Clone, Debug)]
pub struct Machine {
    plant: Plant,
    supply_v: f64,
    /// Encoder positions when the FPGA started, whole turns of its lines.
    origin: [f64; AXES],
}

impl Machine {
    /// At rest.
    ///
    /// # Errors
    /// A robot whose wheels cannot drive it.
    pub fn new(robot: &Robot) -> Result<Self, GeometryError> {
        Ok(Self { plant: Plant::new(robot)?, supply_v: robot.supply_v, origin: [0.0; AXES] })
    }

    /// The robot, for whoever watches.
    #[must_use]
    pub fn plant(&self) -> &Plant {
        &self.plant
    }

    /// Lets time pass with duties in [−1, 1]; 0 shorts a motor.
    pub fn step(&mut self, duty: &[f64; AXES], time_s: f64) {
        self.plant.step(duty, self.supply_v, time_s);
    }

    /// A new counter starts here.
    pub fn restart_encoders(&mut self) {
        for (origin, position) in self.origin.iter_mut().zip(self.plant.encoder_after()) {
            *origin = (position / 4.0).floor() * 4.0;
        }
    }

    /// Encoder positions since then, in counts.
    #[must_use]
    pub fn positions(&self) -> [f64; AXES] {
        let now = self.plant.encoder_after();
        std::array::from_fn(|axis| now.get(axis).map_or(0.0, |position| position - self.origin[axis]))
    }
}
