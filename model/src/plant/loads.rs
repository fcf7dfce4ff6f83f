//! Forces and torques of the [`Deviations`](super::Deviations) on wheels and body.

use nalgebra::{Matrix3, Vector3};

use super::{GRAVITY, Plant, WheelDeviation};
use runs::robot::Support;

/// Speed over which the drag of rollers and carpet turns round, m/s.
const SLIDE_WIDTH: f64 = 0.005;

impl Plant {
    /// Sets every wheel's load and friction, and the force on the body, for one step.
    pub(super) fn load(&mut self) {
        let Some(d) = self.deviations.as_deref() else { return };
        let heading = self.walk.pose().theta;
        for (i, wheel) in self.wheels.iter_mut().enumerate() {
            let WheelDeviation { viscous_nms, quadratic_nms2, .. } = d.wheel(i);
            wheel.load = d.at_angle(i, wheel.angle) - (viscous_nms + quadratic_nms2 * wheel.speed.abs()) * wheel.speed;
            wheel.dry = d.friction(i, wheel.speed, wheel.drive, heading);
        }
        if self.support == Support::Blocks {
            return;
        }
        let twist = self.twist;
        let (s, c) = heading.sin_cos();
        let weight = self.mass * GRAVITY;
        let [grain, azimuth] = d.grain;
        let g = [azimuth.cos(), azimuth.sin()];
        let world = [c * twist.vx - s * twist.vy, s * twist.vx + c * twist.vy];
        let drag = -grain * ((world[0] * g[0] + world[1] * g[1]) / SLIDE_WIDTH).tanh();
        let f = [weight * d.tilt_rad[0] + drag * g[0], weight * d.tilt_rad[1] + drag * g[1]];
        // What turns with the body pulls its centre of mass outwards.
        let outwards = self.mass * twist.omega * twist.omega;
        let [cx, cy] = d.centre_of_mass_m;
        let mut push = Vector3::new(c * f[0] + s * f[1] + outwards * cx, -s * f[0] + c * f[1] + outwards * cy, 0.0);
        let speed = twist.speed();
        if d.drag_n != 0.0 && speed > 0.0 {
            let per_speed = d.drag_n * (speed / SLIDE_WIDTH).tanh() / speed;
            push -= per_speed * Vector3::new(twist.vx, twist.vy, 0.0);
        }
        if d.turning_nm != 0.0 {
            let rim = self.geometry.wheels().iter().map(|w| w.x_m.hypot(w.y_m)).fold(0.0, f64::max);
            push[2] -= d.turning_nm * (twist.omega * rim / SLIDE_WIDTH).tanh();
        }
        if d.roller_friction_n != 0.0 {
            let speeds = Vector3::new(twist.vx, twist.vy, twist.omega);
            for wheel in self.geometry.wheels() {
                let row = Vector3::from(wheel.free_row());
                push -= row * (d.roller_friction_n * (row.dot(&speeds) / SLIDE_WIDTH).tanh());
            }
        }
        self.push = push;
    }

    /// Gravity along the body's right and forward axes, m/s²: 0 on a level floor.
    pub fn downhill(&self) -> [f64; 2] {
        let [x, y] = self.deviations.as_ref().map_or([0.0; 2], |d| d.tilt_rad.map(|tilt| GRAVITY * tilt));
        let (s, c) = self.walk.pose().theta.sin_cos();
        [c * x + s * y, -s * x + c * y]
    }

    /// Mass matrix of the platform about the chassis centre.
    pub(super) fn platform(&self) -> Matrix3<f64> {
        let [cx, cy] = self.deviations.as_ref().map_or([0.0; 2], |d| d.centre_of_mass_m);
        let (m, i) = (self.mass, self.yaw_inertia);
        Matrix3::new(m, 0.0, -m * cy, 0.0, m, m * cx, -m * cy, m * cx, i)
    }
}
