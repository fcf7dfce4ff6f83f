//! Where the wheels are and which way they push.
//!
//! Body frame: x to the right, y forward, angles counter-clockwise, SI units.

use std::f64::consts::FRAC_PI_2;

/// A wheel's place on the chassis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mount {
    /// Contact point, body frame, m.
    pub x_m: f64,
    /// Contact point, body frame, m.
    pub y_m: f64,
    /// Direction in which the rim drives the robot when the wheel turns in its positive sense, rad.
    pub drive_rad: f64,
    /// Angle from the drive direction to the direction in which the rollers can push, rad: 0 for an omni wheel, ±π/4 for
    /// a mecanum wheel.
    pub roller_rad: f64,
}

impl Mount {
    /// An omni wheel on a circle around the chassis centre, driving at right angles to the spoke: positive speed turns
    /// the robot clockwise, and a positive skew turns the drive direction clockwise.
    #[must_use]
    pub fn on_circle(spoke_rad: f64, radius_m: f64, skew_rad: f64) -> Self {
        let (sin, cos) = spoke_rad.sin_cos();
        Self { x_m: radius_m * cos, y_m: radius_m * sin, drive_rad: spoke_rad - FRAC_PI_2 - skew_rad, roller_rad: 0.0 }
    }

    /// Unit vector along which the ground can push the wheel, body frame.
    #[must_use]
    pub fn grip(&self) -> [f64; 2] {
        let (sin, cos) = (self.drive_rad + self.roller_rad).sin_cos();
        [cos, sin]
    }

    /// Speed of the rim (m/s) that rolls without slip when the chassis centre moves with `[vx, vy, ω]` (m/s, m/s, rad/s,
    /// body frame): `(v + ω×p)·a / cos(roller)`.
    #[must_use]
    pub fn rim_speed(&self, [vx, vy, spin]: [f64; 3]) -> f64 {
        let [ax, ay] = self.grip();
        ((vx - spin * self.y_m) * ax + (vy + spin * self.x_m) * ay) / self.roller_rad.cos()
    }

    /// Turns the whole wheel (place and drive direction) about the chassis centre, counter-clockwise, rad.
    pub fn turn_about_centre(&mut self, angle_rad: f64) {
        let (sin, cos) = angle_rad.sin_cos();
        (self.x_m, self.y_m) = (cos * self.x_m - sin * self.y_m, sin * self.x_m + cos * self.y_m);
        self.drive_rad += angle_rad;
    }

    /// Moves the contact point away from the chassis centre: distance × `factor`.
    pub fn spread(&mut self, factor: f64) {
        self.x_m *= factor;
        self.y_m *= factor;
    }
}

/// Wraps an angle into (−π, π].
#[must_use]
pub fn wrap(angle_rad: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    let wrapped = angle_rad - turn * (angle_rad / turn).round();
    if wrapped <= -std::f64::consts::PI { wrapped + turn } else { wrapped }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn mounts_follow_the_published_matrix() {
        let (radius, skew) = (0.085, [0.07_f64, -0.05, 0.03]);
        let velocity = [0.4, -0.7, 1.3];
        let third = PI / 3.0;
        let rows = [
            [skew[0].cos(), -skew[0].sin()],
            [-(third + skew[1]).cos(), (third + skew[1]).sin()],
            [-(third - skew[2]).cos(), -(third - skew[2]).sin()],
        ];
        for (i, spoke) in [90.0_f64, 210.0, 330.0].into_iter().enumerate() {
            let mount = Mount::on_circle(spoke.to_radians(), radius, skew[i]);
            let expected = rows[i][0] * velocity[0] + rows[i][1] * velocity[1] - skew[i].cos() * radius * velocity[2];
            assert!((mount.rim_speed(velocity) - expected).abs() < 1e-12, "wheel {}", i + 1);
        }
    }

    #[test]
    fn wrapped_angles_lie_in_the_half_open_circle() {
        for step in -400..400 {
            let angle = f64::from(step) * 0.1;
            let wrapped = wrap(angle);
            assert!(wrapped > -PI - 1e-12 && wrapped <= PI + 1e-12);
            assert!((wrapped.cos() - angle.cos()).abs() < 1e-9 && (wrapped.sin() - angle.sin()).abs() < 1e-9);
        }
        assert!(wrap(PI) > 0.0);
    }
}
