//! What a chassis does, for a sensor on it.

use super::Motion;
use crate::plant::Plant;
use runs::frames::Twist;

/// A robot's chassis, looked at once a control period.
#[derive(Clone, Copy, Debug, Default)]
pub struct Chassis {
    before: Option<Twist>,
}

impl Chassis {
    /// How it moves, `dt` seconds after the last look: its acceleration is the mean since then.
    pub fn motion(&mut self, plant: &Plant, dt: f64) -> Motion {
        let now = plant.twist();
        let before = self.before.replace(now).unwrap_or(now);
        let rate = |a: f64, b: f64| (a - b) / dt;
        let (sum, count) =
            plant.wheel_speeds().fold((0.0, 0_u32), |(sum, count), speed| (sum + speed.abs(), count + 1));
        Motion {
            omega: [0.0, 0.0, now.omega],
            omega_rate: [0.0, 0.0, rate(now.omega, before.omega)],
            acceleration: [
                rate(now.vx, before.vx) - now.omega * now.vy,
                rate(now.vy, before.vy) + now.omega * now.vx,
                0.0,
            ],
            wheel_speed: sum / f64::from(count.max(1)),
        }
    }
}
