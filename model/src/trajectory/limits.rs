//! What a robot can do.

use crate::motor::Axis;
use runs::frames::Twist;
use runs::geometry::{Geometry, GeometryError};
use runs::robot::Robot;

/// Share of the stall torque and of the no-load speed that plans may use; the rest is for the
/// speed loops and for friction.
const TORQUE_SHARE: f64 = 0.5;
const SPEED_SHARE: f64 = 0.8;

/// Limits of speed and acceleration, all greater than 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Speed of the chassis centre, m/s.
    pub speed: f64,
    /// Acceleration of the chassis centre in any direction, m/s².
    pub acceleration: f64,
    /// Angular acceleration, rad/s².
    pub angular_acceleration: f64,
    /// Speed of any wheel, rad/s.
    pub wheel_speed: f64,
}

impl Limits {
    /// What the motors allow in the weakest direction: half their stall torque, 80 % of their
    /// no-load speed.
    ///
    /// # Errors
    /// [`GeometryError`] if the robot's wheels cannot drive it.
    pub fn of(robot: &Robot) -> Result<Self, GeometryError> {
        let geometry = robot.geometry()?;
        let torque = TORQUE_SHARE * Axis::of(robot).winding_torque(robot.supply_v, 0.0);
        // A force F on the body needs the wheel torques direct()ᵀ·F.
        let column = |f: &dyn Fn(f64, f64, f64) -> f64| {
            geometry.direct().column_iter().map(|c| f(c[0], c[1], c[2])).fold(0.0, f64::max)
        };
        let wheel_speed = SPEED_SHARE * robot.no_load_wheel_speed(robot.supply_v);
        let fastest = geometry.inverse().row_iter().map(|r| r[0].hypot(r[1])).fold(0.0, f64::max);
        Ok(Self {
            speed: wheel_speed / fastest,
            acceleration: torque / (robot.mass_kg * column(&|x, y, _| x.hypot(y))),
            angular_acceleration: torque / (robot.yaw_inertia_kg_m2 * column(&|_, _, w| w.abs())),
            wheel_speed,
        })
    }

    /// The twist, slowed down as a whole if a wheel would have to turn faster than it can: the
    /// robot keeps its direction and its curve.
    pub fn within_wheel_speed(&self, twist: Twist, geometry: &Geometry) -> Twist {
        let fastest = (0..geometry.wheel_count()).map(|i| geometry.wheel_speed(i, twist).abs()).fold(0.0, f64::max);
        if fastest > self.wheel_speed { twist.scaled(self.wheel_speed / fastest) } else { twist }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_of_the_racbot_are_those_of_its_motors() {
        let limits = Limits::of(&Robot::racbot()).unwrap();
        // 7.2 V / (6.92 mVs · 3.71) · 0.8 = 224 rad/s, or 6.2 m/s at the rim.
        assert!((limits.wheel_speed - 224.36).abs() < 0.01, "{limits:?}");
        assert!((limits.speed - 224.36 * 0.0275).abs() < 0.001);
        // 47.6 mNm · 3 / (2 · 27.5 mm) over 2.4 kg.
        assert!((limits.acceleration - 1.083).abs() < 0.001);
        assert!((limits.angular_acceleration - 46.49).abs() < 0.05);
    }

    #[test]
    fn saturation_keeps_the_direction() {
        let robot = Robot::racbot();
        let g = robot.geometry().unwrap();
        let limits = Limits { wheel_speed: 30.0, ..Limits::of(&robot).unwrap() };
        let wanted = Twist::new(1.0, 2.0, -3.0);
        let got = limits.within_wheel_speed(wanted, &g);
        assert!((got.vx / got.vy - 0.5).abs() < 1e-12 && (got.omega / got.vx + 3.0).abs() < 1e-12);
        let fastest = g.wheel_speeds(got).iter().fold(0.0, |m: f64, w| m.max(w.abs()));
        assert!((fastest - 30.0).abs() < 1e-9);
        let slow = Twist::new(0.1, 0.1, 0.1);
        assert_eq!(limits.within_wheel_speed(slow, &g), slow);
    }
}
