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
            downhill: plant.downhill(),
            wheel_speed: sum / f64::from(count.max(1)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Imu, ImuModel};
    use super::*;
    use crate::effects::Applied;
    use crate::plant::GRAVITY;
    use runs::frames::Pose;
    use runs::robot::{Effect, EffectParameter, Robot};

    #[test]
    fn a_robot_at_rest_on_a_slope_feels_the_floor_push_uphill() {
        let tilt = EffectParameter { value: 0.05, ..EffectParameter::default() };
        let parameters = [("x_rad".to_owned(), tilt)].into_iter().collect();
        let effect = Effect { name: "floor-tilt".to_owned(), parameters, ..Effect::default() };
        let felt = |effects: Vec<Effect>| {
            let plant = Applied::of(&Robot { effects, ..Robot::racbot() }).plant().unwrap();
            // Its right points to +y of the field, so that downhill, +x, is behind it.
            let plant = plant.at(Pose::new(0.0, 0.0, std::f64::consts::FRAC_PI_2));
            let mut imu = Imu::new(ImuModel::icm_42688_p(1000.0), 3);
            imu.read(&Chassis::default().motion(&plant, 1e-3)).acceleration
        };
        let (tilted, level) = (felt(vec![effect]), felt(Vec::new()));
        let changed = [0, 1].map(|i| tilted[i] - level[i]);
        assert!(changed[0].abs() < 0.02 && (changed[1] - 0.05 * GRAVITY).abs() < 0.02, "{changed:?}");
    }
}
