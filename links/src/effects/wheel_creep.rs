//! `wheel-creep`: wheels that creep in proportion to the force they transmit.

use model::plant::Creep;
use runs::robot::{Robot, Support};

use crate::drive::{Ahead, DriveModel};
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values};
use crate::motion::{Floor, MotionModel};
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
        model.floor_beneath().creep = creep(values);
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
        let floor = Floor {
            creep: creep(values),
            friction_coefficient: None,
            wheels: model.wheels.clone(),
            wheel_radius_m: model.wheel_radius_m,
            masses: [model.mass, model.yaw_inertia],
            centre_m: [0.0; 3],
        };
        if floor.gives_way() {
            let none = |segment: &Segment| vec![vec![0.0; segment.t.len()]; segment.speed.len()];
            let ahead = move |_: &DriveModel, segment: &Segment| {
                floor.lost(segment).map_or_else(|| none(segment), |lost| lost.to_vec())
            };
            model.offsets.push((Ahead::Rotor, Box::new(ahead)));
        }
    }

    fn law_uncertainty(&self) -> f64 {
        // Real creep grows with speed and at rest; it is looked for as one of both.
        0.04
    }

    fn also(&self) -> Option<Link> {
        Some(Link::Drive)
    }
}
