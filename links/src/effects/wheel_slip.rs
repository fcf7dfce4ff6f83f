//! `wheel-slip`: wheels that slip when the force exceeds what friction holds.

use model::plant::GRAVITY;
use nalgebra::DMatrix;
use runs::frames::Twist;
use runs::geometry::{Geometry, Wheel};
use runs::robot::Robot;

use crate::drive::twist_per_wheel_speed;
use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

/// Height of the centre of mass, which no file of a robot gives, in body radii: batteries and motors lie low.
const HEIGHT: f64 = 0.45;
/// Time over which the suspension of rollers and carpet passes a load on, s: smooths what counts say.
const LOAD_S: f64 = 0.01;
/// Projected Gauss-Seidel sweeps a tick; one or two while no wheel slips.
const SWEEPS: usize = 12;

/// Speed that a contact creeps by per impulse, beside the speed the impulse gives the robot there: more than three
/// wheels would otherwise push against each other without end.
const CREEPS: f64 = 0.05;

/// Wheels that slip when the force exceeds what friction holds.
pub(super) struct WheelSlip;

impl Effect for WheelSlip {
    fn name(&self) -> &str {
        "wheel-slip"
    }

    fn equation(&self) -> &str {
        "|traction force| <= friction_coefficient m g / wheels; beyond it the wheel turns faster than it rolls"
    }

    fn reference(&self) -> &str {
        "Coulomb; Moreau 1988, projected Gauss-Seidel"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        // What matters is the torque at which a wheel slips.
        let passes = robot.layout.wheels().iter().map(|w| w.roller_rad.cos()).fold(1.0, f64::min);
        let below = 0.45 / passes;
        let at = |mu| Parameter::new("friction_coefficient", 0.05, [0.02, 1.5], 0.0).from(mu).material_below(below);
        [0.13, 0.18, 0.25, 0.35, 0.5, 0.7, 0.9].into_iter().map(|mu| Form::whole(vec![at(mu)])).collect()
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        let Some(mu) = values.find("friction_coefficient") else { return };
        let n = model.wheels.len();
        // A roller passes on what pushes along its own axis alone: its wheel's torque has that force's part across the axle.
        let lever = |w: &Wheel| model.wheel_radius_m * w.roller_rad.cos();
        let share: Vec<f64> = model.wheels.iter().map(|w| mu * model.mass_kg / n as f64 * lever(w)).collect();
        let grip_at_rest: Vec<f64> = share.iter().map(|share| share * GRAVITY).collect();
        let rim2 = model.wheels.iter().map(|w| w.x_m.powi(2) + w.y_m.powi(2)).sum::<f64>() / n as f64;
        // Weight leans on the wheels behind an acceleration: grip per acceleration to the right and forward.
        let lean: Vec<[f64; 2]> =
            model.wheels.iter().map(|w| [w.x_m, w.y_m].map(|x| 2.0 * HEIGHT * x / rim2.sqrt())).collect();
        let Ok(geometry) = Geometry::new(model.wheels.clone(), model.wheel_radius_m) else { return };
        let Some(Platform { inertia, response }) = Platform::new(&geometry, model.mass_kg, model.yaw_inertia_kg_m2)
        else {
            return;
        };
        let least = grip_at_rest.iter().copied().fold(f64::INFINITY, f64::min);
        let rows = |m: &DMatrix<f64>| -> Vec<Vec<f64>> { m.row_iter().map(|r| r.iter().copied().collect()).collect() };
        let (inertia, response) = (rows(&inertia), rows(&response));
        let leaning = Leaning { geometry: geometry.clone(), share, lean };
        model.angles.push(Box::new(move |segment, angles| {
            let mut ground: Vec<f64> = segment.speed.iter().map(|w| w[0]).collect();
            let mut free = vec![0.0; n];
            let mut lost = vec![0.0; n];
            let mut impulse = vec![0.0; n];
            let mut grip = grip_at_rest.clone();
            let mut pushed = [0.0; 2];
            for k in 1..segment.t.len() {
                let dt = segment.t[k] - segment.t[k - 1];
                // The body frame turns under the robot.
                let v = geometry.twist(&ground);
                let turned = Twist::new(v.omega * v.vy * dt, -v.omega * v.vx * dt, 0.0);
                for (i, free) in free.iter_mut().enumerate() {
                    *free = ground[i] + geometry.wheel_speed(i, turned);
                }
                // Mostly friction can give what it takes to end every wheel's slip.
                let needed = |row: &[f64]| (0..n).map(|j| row[j] * (segment.speed[j][k] - free[j])).sum::<f64>();
                if inertia.iter().zip(&grip).all(|(row, grip)| needed(row).abs() <= grip * dt) {
                    for i in 0..n {
                        ground[i] = segment.speed[i][k];
                        angles[i][k] -= lost[i];
                    }
                    leaning.back(&mut pushed, &ground, &mut free, dt, &mut grip);
                    continue;
                }
                // Otherwise each wheel takes what it needs, or what friction can give.
                impulse.fill(0.0);
                let moved = |impulse: &[f64], i: usize| {
                    free[i] + response[i].iter().zip(impulse).map(|(r, x)| r * x).sum::<f64>()
                };
                for _ in 0..SWEEPS {
                    let mut change = 0.0_f64;
                    for i in 0..n {
                        let creeps = CREEPS * response[i][i];
                        let missing = segment.speed[i][k] - moved(&impulse, i) - creeps * impulse[i];
                        let next = impulse[i] + missing / (response[i][i] + creeps);
                        let next = next.clamp(-grip[i] * dt, grip[i] * dt);
                        change = change.max((next - impulse[i]).abs());
                        impulse[i] = next;
                    }
                    if change < 1e-3 * least * dt {
                        break;
                    }
                }
                for i in 0..n {
                    ground[i] = moved(&impulse, i);
                    lost[i] += (segment.speed[i][k] - ground[i]) * dt;
                    angles[i][k] -= lost[i];
                }
                leaning.back(&mut pushed, &ground, &mut free, dt, &mut grip);
            }
        }));
    }

    fn law_uncertainty(&self) -> f64 {
        // One coefficient stands for static and sliding friction, 5 to 20 % apart, and for all loads.
        0.1
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("pull the robot sideways with a spring scale until it slides", 5.0))
    }
}

/// The robot without its rotors, at the contacts of its wheels: what a contact's force moves. How the rotors turn is
/// measured.
struct Platform {
    /// Torque impulses at the wheels, kg m²/s, that take a change of wheel speeds: the least ones.
    inertia: DMatrix<f64>,
    /// Change of the rolling speeds of the wheels per torque impulse; of rank 3 at most.
    response: DMatrix<f64>,
}

impl Platform {
    fn new(geometry: &Geometry, mass: f64, yaw_inertia: f64) -> Option<Self> {
        let rows = DMatrix::from_fn(geometry.inverse().nrows(), 3, |i, j| geometry.inverse()[(i, j)]);
        let body = [mass, mass, yaw_inertia];
        if body.iter().any(|m| m.is_nan() || *m <= 0.0) {
            return None;
        }
        // Nothing turns the wheels of a differential drive by a sideways motion but roundings.
        let twist = twist_per_wheel_speed(&rows, geometry)?;
        let n = rows.nrows();
        let sum = |of: &dyn Fn(usize, usize, usize) -> f64| {
            DMatrix::from_fn(n, n, |i, j| (0..3).map(|a| of(a, i, j)).sum::<f64>())
        };
        Some(Self {
            inertia: sum(&|a, i, j| twist[(a, i)] * body[a] * twist[(a, j)]),
            response: sum(&|a, i, j| rows[(i, a)] * rows[(j, a)] / body[a]),
        })
    }
}

/// How accelerations shift the weight from wheel to wheel.
struct Leaning {
    geometry: Geometry,
    /// Torque that friction holds per acceleration of the weight, each wheel's share, kg m.
    share: Vec<f64>,
    /// Grip per acceleration to the right and forward, one a wheel.
    lean: Vec<[f64; 2]>,
}

impl Leaning {
    /// What the wheels can hold once an acceleration from `free` to `ground` (wheel speeds, rad/s) has shifted the
    /// weight; `free` is used up.
    fn back(&self, pushed: &mut [f64; 2], ground: &[f64], free: &mut [f64], dt: f64, grip: &mut [f64]) {
        free.iter_mut().zip(ground).for_each(|(free, ground)| *free = ground - *free);
        let moved = self.geometry.twist(free);
        let part = (dt / LOAD_S).min(1.0);
        pushed[0] += part * (moved.vx / dt - pushed[0]);
        pushed[1] += part * (moved.vy / dt - pushed[1]);
        for ((g, l), share) in grip.iter_mut().zip(&self.lean).zip(&self.share) {
            *g = share * (GRAVITY - l[0] * pushed[0] - l[1] * pushed[1]).max(0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use runs::robot::{Layout, Robot};

    use super::*;

    #[test]
    fn a_push_moves_the_platform_as_newton_says() {
        let robot = Robot::racbot();
        let geometry = robot.geometry().unwrap();
        let platform = Platform::new(&geometry, 2.0, 0.01).unwrap();
        let n = robot.wheel_count();
        // What impulses of the inertia give is the change of speed they were asked for.
        let both = &platform.response * &platform.inertia;
        assert!((&both - DMatrix::identity(n, n)).abs().max() < 1e-12, "{both}");
    }

    #[test]
    fn two_wheels_on_an_axle_share_what_moves_them() {
        let mut robot = Robot::racbot();
        let wheel = |x_m: f64| runs::geometry::Wheel { x_m, y_m: 0.0, drive_rad: 90_f64.to_radians(), roller_rad: 0.0 };
        robot.layout = Layout::Wheels(vec![wheel(0.045), wheel(-0.045)]);
        let Platform { inertia, response } = Platform::new(&robot.geometry().unwrap(), 2.0, 0.01).unwrap();
        // Ahead each moves a half of the mass.
        let half = 0.5 * 2.0 * robot.wheel_radius_m.powi(2);
        assert!((inertia.row(0).sum() / half - 1.0).abs() < 1e-9, "{inertia} {half}");
        let both = &response * &inertia;
        assert!((&both - DMatrix::identity(2, 2)).abs().max() < 1e-9, "{both}");
    }

    #[test]
    fn four_wheels_have_no_stiffness_where_no_body_moves() {
        let mut robot = Robot::racbot();
        let wheel = |k: usize| {
            let at = std::f64::consts::FRAC_PI_4 * (2 * k + 1) as f64;
            runs::geometry::Wheel {
                x_m: 0.08 * at.cos(),
                y_m: 0.08 * at.sin(),
                drive_rad: at + std::f64::consts::FRAC_PI_2,
                roller_rad: 0.0,
            }
        };
        robot.layout = Layout::Wheels((0..4).map(wheel).collect());
        let platform = Platform::new(&robot.geometry().unwrap(), 2.0, 0.01).unwrap();
        let both = &platform.response * &platform.inertia;
        // A projection of rank 3, and nothing blown up beside it.
        assert!((&both * &both - &both).abs().max() < 1e-9 && (both.trace() - 3.0).abs() < 1e-9, "{both}");
        assert!(platform.response.max() < 1e4);
    }
}
