//! `wheel-creep`: wheels that creep in proportion to the force they transmit.

use nalgebra::{Matrix3, Vector3};
use runs::frames::Twist;
use runs::geometry::{Geometry, Wheel};
use runs::robot::{Robot, Support};

use crate::drive::{Ahead, DriveModel};
use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;
use crate::segment::Segment;

/// Time by which a robot lags behind its wheels from which creep matters, s: with 3 ms/kg a league robot of 2.4 kg, whose
/// wheels feel half of that each, is 4 mm off at 1 m/s, as by the camera's latency that matters.
const LAG_S: f64 = 0.00365;

/// Wheels that creep in proportion to the force they transmit.
pub(super) struct WheelCreep;

impl Effect for WheelCreep {
    fn name(&self) -> &str {
        "wheel-creep"
    }

    fn equation(&self) -> &str {
        "slip speed of the contact = creep_s_per_kg times traction force"
    }

    fn reference(&self) -> &str {
        "Johnson 1985, Contact Mechanics, ch. 8"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        // What lags so behind a contact is all that its wheel moves.
        let unit = LAG_S * robot.wheel_radius_m.powi(2) / DriveModel::new(robot).felt_inertia();
        if !(unit > 0.0 && unit.is_finite()) {
            return Vec::new();
        }
        vec![Form::whole(vec![Parameter::new("creep_s_per_kg", 0.7 * unit, [0.0, 170.0 * unit], unit)])]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        let Some(contact) = Contact::new(
            &model.wheels,
            model.wheel_radius_m,
            [model.mass_kg, model.yaw_inertia_kg_m2],
            values.get("creep_s_per_kg"),
        ) else {
            return;
        };
        model.angles.push(Box::new(move |segment, angles| {
            for (angle, lost) in angles.iter_mut().zip(contact.lost(segment)) {
                angle.iter_mut().zip(lost).for_each(|(a, l)| *a -= l);
            }
        }));
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        if model.support == Support::Blocks {
            // Off the floor it is the gear that gives way: each wheel's own inertia, and no body's.
            let creep = values.get("creep_s_per_kg") / (model.wheel_radius_m * model.wheel_radius_m);
            let Some(inertia) = model.mechanics().map(|m| m.inertia) else { return };
            let ahead = move |_: &DriveModel, segment: &Segment| {
                let n = segment.speed.len();
                let momentum = |i: usize, k: usize| (0..n).map(|j| inertia[(i, j)] * segment.speed[j][k]).sum::<f64>();
                (0..n).map(|i| (0..segment.t.len()).map(|k| creep * momentum(i, k)).collect()).collect()
            };
            model.offsets.push((Ahead::Rotor, Box::new(ahead)));
            return;
        }
        let Some(contact) = Contact::new(
            &model.wheels,
            model.wheel_radius_m,
            [model.mass, model.yaw_inertia],
            values.get("creep_s_per_kg"),
        ) else {
            return;
        };
        model.offsets.push((Ahead::Rotor, Box::new(move |_, segment| contact.lost(segment))));
    }

    fn law_uncertainty(&self) -> f64 {
        // Creep grows with speed as well as with force.
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
    /// Torque at a shaft per speed that the contact lacks, Nm s/rad.
    grip: f64,
    /// Body force per twist by which the robot is slower than its wheels.
    pull: Matrix3<f64>,
}

impl Contact {
    /// `None` without creep, or where the wheels cannot drive the robot.
    fn new(wheels: &[Wheel], radius: f64, [mass, yaw]: [f64; 2], creep: f64) -> Option<Self> {
        let geometry = Geometry::new(wheels.to_vec(), radius).ok().filter(|_| creep > 0.0)?;
        let grip = radius * radius / creep;
        let rows = geometry.inverse();
        let pull = Matrix3::from_fn(|a, b| grip * (0..wheels.len()).map(|i| rows[(i, a)] * rows[(i, b)]).sum::<f64>());
        Some(Self { geometry, inertia: Vector3::new(mass, mass, yaw), grip, pull })
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
        let mut solver = (0.0, Matrix3::zeros());
        for k in 1..ticks {
            let dt = segment.t[k] - segment.t[k - 1];
            if (dt - solver.0).abs() > 1e-6 * dt {
                let stiff = Matrix3::from_diagonal(&self.inertia) + self.pull * dt;
                solver = (dt, self.geometry.invert_allowed(&stiff).unwrap_or_default());
            }
            // The body frame turns under the robot.
            let turned = twist + Vector3::new(twist.z * twist.y, -twist.z * twist.x, 0.0) * dt;
            let mut push = self.inertia.component_mul(&turned);
            for i in 0..n {
                let moved = segment.angle[i][k] - segment.angle[i][k - 1];
                for (a, x) in push.iter_mut().enumerate() {
                    *x += self.grip * rows[(i, a)] * moved;
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

    #[test]
    fn two_wheels_on_an_axle_creep_by_no_force_on_a_circle() {
        let wheel = |x_m| Wheel { x_m, y_m: 0.0, drive_rad: 90_f64.to_radians(), roller_rad: 0.0 };
        let contact = Contact::new(&[wheel(0.1), wheel(-0.1)], 0.03, [2.0, 0.01], 0.01).unwrap();
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
