//! `wheel-slip`: wheels that slip when the force exceeds what friction holds.

use model::plant::GRAVITY;
use nalgebra::DMatrix;
use runs::frames::Twist;
use runs::geometry::Geometry;
use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

/// Height of the centre of mass, which no file of a robot gives, in body radii: batteries and motors lie low.
const HEIGHT: f64 = 0.45;
/// Time over which the suspension of rollers and carpet passes a load on, s: smooths what counts say.
const LOAD_S: f64 = 0.01;
/// Projected Gauss-Seidel sweeps a tick; one or two while no wheel slips.
const SWEEPS: usize = 12;

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

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        let at = |mu| Parameter::new("friction_coefficient", 0.05, [0.02, 1.5], 0.0).from(mu).material_below(0.45);
        [0.13, 0.18, 0.25, 0.35, 0.5, 0.7, 0.9].into_iter().map(|mu| Form::whole(vec![at(mu)])).collect()
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        let Some(mu) = values.find("friction_coefficient") else { return };
        let n = model.wheels.len();
        let share = mu * model.mass_kg / n as f64 * model.wheel_radius_m;
        let rim2 = model.wheels.iter().map(|w| w.x_m.powi(2) + w.y_m.powi(2)).sum::<f64>() / n as f64;
        // Weight leans on the wheels behind an acceleration: grip per acceleration to the right and forward.
        let lean: Vec<[f64; 2]> =
            model.wheels.iter().map(|w| [w.x_m, w.y_m].map(|x| 2.0 * HEIGHT * x / rim2.sqrt())).collect();
        let inertia = model.inertia.clone();
        let regular = inertia.clone() + DMatrix::identity(n, n) * (1e-9 * inertia.trace());
        let Some(inverse) = regular.try_inverse() else { return };
        let Ok(geometry) = Geometry::new(model.wheels.clone(), model.wheel_radius_m) else { return };
        model.angles.push(Box::new(move |segment, angles| {
            let mut ground: Vec<f64> = segment.speed.iter().map(|w| w[0]).collect();
            let mut lost = vec![0.0; n];
            let mut impulse = vec![0.0; n];
            let mut grip = vec![share * GRAVITY; n];
            let mut pushed = [0.0; 2];
            for k in 1..segment.t.len() {
                let dt = segment.t[k] - segment.t[k - 1];
                // The body frame turns under the robot.
                let v = geometry.twist(&ground);
                let turned = Twist::new(v.omega * v.vy * dt, -v.omega * v.vx * dt, 0.0);
                let free: Vec<f64> = (0..n).map(|i| ground[i] + geometry.wheel_speed(i, turned)).collect();
                // Mostly friction can give what it takes to end every wheel's slip.
                let needed = |i: usize| (0..n).map(|j| inertia[(i, j)] * (segment.speed[j][k] - free[j])).sum::<f64>();
                if (0..n).all(|i| needed(i).abs() <= grip[i] * dt) {
                    for i in 0..n {
                        ground[i] = segment.speed[i][k];
                        angles[i][k] -= lost[i];
                    }
                    lean_back(&mut pushed, &geometry, &ground, &free, dt, share, &lean, &mut grip);
                    continue;
                }
                // Otherwise each wheel takes what it needs, or what friction can give.
                impulse.fill(0.0);
                let moved =
                    |impulse: &[f64], i: usize| free[i] + (0..n).map(|j| inverse[(i, j)] * impulse[j]).sum::<f64>();
                for _ in 0..SWEEPS {
                    let mut change = 0.0_f64;
                    for i in 0..n {
                        let missing = segment.speed[i][k] - moved(&impulse, i);
                        let next = (impulse[i] + missing / inverse[(i, i)]).clamp(-grip[i] * dt, grip[i] * dt);
                        change = change.max((next - impulse[i]).abs());
                        impulse[i] = next;
                    }
                    if change < 1e-3 * share * GRAVITY * dt {
                        break;
                    }
                }
                for i in 0..n {
                    ground[i] = moved(&impulse, i);
                    lost[i] += (segment.speed[i][k] - ground[i]) * dt;
                    angles[i][k] -= lost[i];
                }
                lean_back(&mut pushed, &geometry, &ground, &free, dt, share, &lean, &mut grip);
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

/// What the wheels can hold once an acceleration from `free` to `ground` (wheel speeds, rad/s) has shifted the weight.
#[allow(clippy::too_many_arguments)]
fn lean_back(
    pushed: &mut [f64; 2],
    geometry: &Geometry,
    ground: &[f64],
    free: &[f64],
    dt: f64,
    share: f64,
    lean: &[[f64; 2]],
    grip: &mut [f64],
) {
    let change: Vec<f64> = ground.iter().zip(free).map(|(a, b)| a - b).collect();
    let moved = geometry.twist(&change);
    let part = (dt / LOAD_S).min(1.0);
    pushed[0] += part * (moved.vx / dt - pushed[0]);
    pushed[1] += part * (moved.vy / dt - pushed[1]);
    for (g, l) in grip.iter_mut().zip(lean) {
        *g = share * (GRAVITY - l[0] * pushed[0] - l[1] * pushed[1]).max(0.0);
    }
}
