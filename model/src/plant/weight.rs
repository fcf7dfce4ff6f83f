//! How the weight of a robot stands on its wheels.

use nalgebra::{Matrix3, Vector3};
use runs::geometry::Wheel;

use super::GRAVITY;

/// Time over which the suspension of rollers and carpet passes a load on, s. Reasoned: a few steps of the loop.
const LOAD_S: f64 = 0.01;
/// Share of the largest extent of the wheels below which they stand along one line: casters carry what is across it.
const LINE: f64 = 1e-3;

/// The loads of the wheels of a stiff body on contacts that all give way alike.
#[derive(Debug, Clone, PartialEq)]
pub struct Weight {
    /// Of each wheel its part of the mass, and the mass that an acceleration to the right and forward takes off it.
    parts: Vec<[f64; 3]>,
    /// Acceleration to the right and forward as the wheels feel it, m/s².
    felt: [f64; 2],
}

impl Weight {
    /// Of a centre of mass at a place in the body frame, and so high, m.
    pub fn new(wheels: &[Wheel], mass: f64, [x_m, y_m]: [f64; 2], height_m: f64) -> Self {
        let at = |w: &Wheel| Vector3::new(1.0, w.x_m - x_m, w.y_m - y_m);
        let spread: Matrix3<f64> = wheels.iter().map(|w| at(w) * at(w).transpose()).sum();
        // A number and areas: each in units of its own size.
        let extent = (spread.m22 + spread.m33).max(f64::MIN_POSITIVE).sqrt();
        let unit = Matrix3::from_diagonal(&Vector3::new(
            1.0 / (wheels.len().max(1) as f64).sqrt(),
            1.0 / extent,
            1.0 / extent,
        ));
        let inverse =
            (unit * spread * unit).pseudo_inverse(LINE * LINE).map_or_else(|_| Matrix3::zeros(), |i| unit * i * unit);
        let part = |w: &Wheel| {
            let per = inverse * at(w) * mass;
            [per.x, height_m * per.y, height_m * per.z]
        };
        Self { parts: wheels.iter().map(part).collect(), felt: [0.0; 2] }
    }

    /// Force that a wheel presses on the floor with, N.
    #[inline]
    pub fn on(&self, wheel: usize) -> f64 {
        let [part, right, forward] = self.parts[wheel];
        (part * GRAVITY - right * self.felt[0] - forward * self.felt[1]).max(0.0)
    }

    /// The body accelerates to the right and forward, m/s², for some time, s.
    pub fn shift(&mut self, acceleration: [f64; 2], dt: f64) {
        let share = (dt / LOAD_S).min(1.0);
        for (felt, now) in self.felt.iter_mut().zip(acceleration) {
            *felt += share * (now - *felt);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wheels(at: &[[f64; 2]]) -> Vec<Wheel> {
        at.iter().map(|&[x_m, y_m]| Wheel { x_m, y_m, drive_rad: 0.0, roller_rad: 0.0 }).collect()
    }

    /// The moments of the loads about the centre of mass, Nm, and their sum, N.
    fn moments(weight: &Weight, wheels: &[Wheel], [x, y]: [f64; 2]) -> [f64; 3] {
        let loads = wheels.iter().enumerate().map(|(i, w)| (weight.on(i), w));
        loads.fold([0.0; 3], |s, (f, w)| [s[0] + f, s[1] + f * (w.x_m - x), s[2] + f * (w.y_m - y)])
    }

    #[test]
    fn loads_hold_the_weight_in_balance_under_an_acceleration() {
        let wheels = wheels(&[[0.067, 0.047], [-0.067, 0.047], [-0.058, -0.058], [0.058, -0.058]]);
        let (mass, centre, height) = (2.7, [0.01, -0.005], 0.04);
        let mut weight = Weight::new(&wheels, mass, centre, height);
        let [sum, x, y] = moments(&weight, &wheels, centre);
        assert!((sum / (mass * GRAVITY) - 1.0).abs() < 1e-9 && x.abs().max(y.abs()) < 1e-12, "{sum} {x} {y}");
        // An acceleration that acts for long, below what lifts a wheel.
        weight.shift([2.0, 1.0], 1.0);
        let [sum, x, y] = moments(&weight, &wheels, centre);
        assert!((sum / (mass * GRAVITY) - 1.0).abs() < 1e-9, "{sum}");
        assert!((x + mass * height * 2.0).abs() < 1e-9 && (y + mass * height).abs() < 1e-9, "{x} {y}");
    }

    /// Casters hold what no wheel does: an acceleration ahead takes nothing off two wheels on an axle.
    #[test]
    fn two_wheels_on_an_axle_carry_half_each_whatever_is_ahead() {
        let wheels = wheels(&[[0.1, 0.0], [-0.1, 0.0]]);
        let mut weight = Weight::new(&wheels, 2.0, [0.0, 0.03], 0.05);
        weight.shift([0.0, 3.0], 1.0);
        for i in 0..2 {
            assert!((weight.on(i) / GRAVITY - 1.0).abs() < 0.1, "{}", weight.on(i));
        }
    }
}
