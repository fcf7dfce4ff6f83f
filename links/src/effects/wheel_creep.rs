//! `wheel-creep`: wheels that creep in proportion to the force they transmit.

use model::plant::Creep;
use nalgebra::{Matrix3, Vector3};
use runs::frames::Twist;
use runs::geometry::{Geometry, Wheel};
use runs::robot::{Robot, Support};

use crate::drive::{Ahead, DriveModel};
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values};
use crate::motion::MotionModel;
use crate::segment::Segment;

/// Time by which a robot lags behind its wheels from which creep matters, s: with 3 ms/kg a league robot of 2.4 kg, whose
/// wheels feel half of that each, is 4 mm off at 1 m/s, as by the camera's latency that matters.
const LAG_S: f64 = 0.00365;

/// Wheels that creep in proportion to the force they transmit.
pub(super) struct WheelCreep {
    /// Looked for as creep that goes with the way a wheel rolls, as of tyres, and not with time, as of a contact that yields
    /// at rest as well. What a file carries may be either or both.
    pub(super) rolled: bool,
}

const AT_REST: &str = "creep_s_per_kg";
const ROLLED: &str = "creep_per_n";

fn creep(values: &Values) -> Creep {
    Creep { s_per_kg: values.get(AT_REST), per_n: values.get(ROLLED) }
}

impl Effect for WheelCreep {
    fn name(&self) -> &str {
        "wheel-creep"
    }

    fn equation(&self) -> &str {
        "slip speed of the contact = traction force times (creep_s_per_kg + creep_per_n times the speed it rolls at)"
    }

    fn reference(&self) -> &str {
        "Johnson 1985, Contact Mechanics, ch. 8; Pacejka 2012, Tire and Vehicle Dynamics, ch. 3"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        self.forms_in(robot, &Sizes::of(robot))
    }

    fn forms_in(&self, robot: &Robot, sizes: &Sizes) -> Vec<Form> {
        // What lags so behind a contact is all that its wheel moves.
        let unit = LAG_S * robot.wheel_radius_m.powi(2) / DriveModel::new(robot).felt_inertia();
        if !(unit > 0.0 && unit.is_finite()) {
            return Vec::new();
        }
        // As much at the speed of the logs.
        let usual_m_s = sizes.speed * robot.wheel_radius_m;
        let form = |name: &str, unit: f64| {
            vec![Form::whole(vec![Parameter::new(name, 0.7 * unit, [0.0, 170.0 * unit], unit)])]
        };
        if self.rolled { form(ROLLED, unit / usual_m_s) } else { form(AT_REST, unit) }
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        let masses = [model.mass_kg, model.yaw_inertia_kg_m2];
        let Some(contact) = Contact::new(&model.wheels, model.wheel_radius_m, masses, creep(values)) else { return };
        model.angles.push(Box::new(move |segment, angles| {
            for (angle, lost) in angles.iter_mut().zip(contact.lost(segment)) {
                angle.iter_mut().zip(lost).for_each(|(a, l)| *a -= l);
            }
        }));
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        if model.support == Support::Blocks {
            // Off the floor it is the gear that gives way: each wheel's own inertia, and no body's.
            let creep = values.get(AT_REST) / (model.wheel_radius_m * model.wheel_radius_m);
            let Some(inertia) = model.mechanics().map(|m| m.inertia) else { return };
            let ahead = move |_: &DriveModel, segment: &Segment| {
                let n = segment.speed.len();
                let momentum = |i: usize, k: usize| (0..n).map(|j| inertia[(i, j)] * segment.speed[j][k]).sum::<f64>();
                (0..n).map(|i| (0..segment.t.len()).map(|k| creep * momentum(i, k)).collect()).collect()
            };
            model.offsets.push((Ahead::Rotor, Box::new(ahead)));
            return;
        }
        let masses = [model.mass, model.yaw_inertia];
        let Some(contact) = Contact::new(&model.wheels, model.wheel_radius_m, masses, creep(values)) else { return };
        model.offsets.push((Ahead::Rotor, Box::new(move |_, segment| contact.lost(segment))));
    }

    fn law_uncertainty(&self) -> f64 {
        // Real creep grows with speed and at rest; it is looked for as one of both.
        0.04
    }

    fn also(&self) -> Option<Link> {
        Some(Link::Drive)
    }
}

/// A body that its wheels pull along through dampers.
struct Contact {
    geometry: Geometry,
    /// Mass twice and yaw inertia.
    inertia: Vector3<f64>,
    creep: Creep,
    /// Traction speed per wheel speed, one a wheel, m.
    levers: Vec<f64>,
}

impl Contact {
    /// `None` without creep, or where the wheels cannot drive the robot.
    fn new(wheels: &[Wheel], radius: f64, [mass, yaw]: [f64; 2], creep: Creep) -> Option<Self> {
        let geometry = Geometry::new(wheels.to_vec(), radius).ok().filter(|_| creep.is_any())?;
        let levers = wheels.iter().map(|w| radius * w.roller_rad.cos()).collect();
        Some(Self { geometry, inertia: Vector3::new(mass, mass, yaw), creep, levers })
    }

    /// Torque at each shaft per speed that its contact lacks, Nm s/rad, for wheels that turn like this.
    fn grips(&self, speeds: impl Iterator<Item = f64>, grips: &mut [f64]) {
        let radius = self.geometry.wheel_radius_m();
        for ((grip, lever), speed) in grips.iter_mut().zip(&self.levers).zip(speeds) {
            *grip = lever * lever / self.creep.at(radius * speed);
        }
    }

    /// What a step takes from body momentum to twist.
    fn solver(&self, grips: &[f64], dt: f64) -> Matrix3<f64> {
        let rows = self.geometry.inverse();
        let pull =
            |a, b| dt * grips.iter().enumerate().map(|(i, grip)| grip * rows[(i, a)] * rows[(i, b)]).sum::<f64>();
        let stiff = Matrix3::from_diagonal(&self.inertia) + Matrix3::from_fn(pull);
        self.geometry.invert_allowed(&stiff).unwrap_or_default()
    }

    /// By how much each wheel has turned further than it rolled, rad, `[wheel][tick]`.
    ///
    /// The equation of motion of the body, a step of implicit Euler a tick: creep may be as stiff as it likes,
    /// and counts enter as they are.
    fn lost(&self, segment: &Segment) -> Vec<Vec<f64>> {
        let (n, ticks) = (segment.angle.len(), segment.t.len());
        let mut lost = vec![vec![0.0; ticks]; n];
        let rows = self.geometry.inverse();
        let start: Vec<f64> = segment.speed.iter().map(|w| w[0]).collect();
        let mut twist = as_vector(self.geometry.twist(&start));
        let mut grips = vec![0.0; n];
        self.grips(start.iter().copied(), &mut grips);
        let mut solver = (0.0, Matrix3::zeros());
        for k in 1..ticks {
            let dt = segment.t[k] - segment.t[k - 1];
            if self.creep.per_n > 0.0 {
                self.grips(segment.speed.iter().map(|w| w[k]), &mut grips);
                solver = (dt, self.solver(&grips, dt));
            } else if (dt - solver.0).abs() > 1e-6 * dt {
                solver = (dt, self.solver(&grips, dt));
            }
            // The body frame turns under the robot.
            let turned = twist + Vector3::new(twist.z * twist.y, -twist.z * twist.x, 0.0) * dt;
            let mut push = self.inertia.component_mul(&turned);
            for i in 0..n {
                let moved = segment.angle[i][k] - segment.angle[i][k - 1];
                for (a, x) in push.iter_mut().enumerate() {
                    *x += grips[i] * rows[(i, a)] * moved;
                }
            }
            twist = solver.1 * push;
            for i in 0..n {
                let moved = segment.angle[i][k] - segment.angle[i][k - 1];
                let rolled = (0..3).map(|a| rows[(i, a)] * twist[a]).sum::<f64>() * dt;
                lost[i][k] = lost[i][k - 1] + moved - rolled;
            }
        }
        lost
    }
}

fn as_vector(t: Twist) -> Vector3<f64> {
    Vector3::new(t.vx, t.vy, t.omega)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two wheels ahead that speed up evenly from rest: each moves half of the mass, and the slip ratio grows by its force alone.
    #[test]
    fn creep_of_a_rolling_wheel_is_a_part_of_its_way() {
        let wheel = |x_m| Wheel { x_m, y_m: 0.0, drive_rad: 90_f64.to_radians(), roller_rad: 0.0 };
        let (radius, mass, per_n, spin_up) = (0.03, 2.0, 0.01, 20.0);
        let creep = Creep { s_per_kg: 0.0, per_n };
        let contact = Contact::new(&[wheel(0.1), wheel(-0.1)], radius, [mass, 0.01], creep).unwrap();
        let ticks = |of: &dyn Fn(f64) -> f64| (0..2001).map(|k| of(0.001 * f64::from(k))).collect::<Vec<f64>>();
        let segment = Segment {
            t: ticks(&|t| t),
            angle: vec![ticks(&|t| 0.5 * spin_up * t * t); 2],
            speed: vec![ticks(&|t| spin_up * t); 2],
            ..Segment::default()
        };
        let lost = contact.lost(&segment);
        // Of its way each loses the slip ratio, which the force of the slower body is less by itself.
        let ratio = per_n * 0.5 * mass * radius * spin_up;
        let expected = ratio / (1.0 + ratio) * segment.angle[0][2000];
        assert!((lost[0][2000] / expected - 1.0).abs() < 0.01, "{} {expected}", lost[0][2000]);
    }

    #[test]
    fn two_wheels_on_an_axle_creep_by_no_force_on_a_circle() {
        let wheel = |x_m| Wheel { x_m, y_m: 0.0, drive_rad: 90_f64.to_radians(), roller_rad: 0.0 };
        let contact =
            Contact::new(&[wheel(0.1), wheel(-0.1)], 0.03, [2.0, 0.01], Creep { s_per_kg: 0.01, per_n: 0.0 }).unwrap();
        let turned = |speed: f64| (0..400).map(|k| 0.01 * speed * f64::from(k)).collect::<Vec<f64>>();
        let speeds = [10.0, 6.0];
        let segment = Segment {
            t: turned(1.0),
            angle: speeds.map(turned).to_vec(),
            speed: speeds.map(|speed| vec![speed; 400]).to_vec(),
            ..Segment::default()
        };
        // What the floor gives across the axle holds it there.
        let lost = contact.lost(&segment).concat().into_iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        assert!(lost < 1e-6, "{lost} rad");
    }
}
