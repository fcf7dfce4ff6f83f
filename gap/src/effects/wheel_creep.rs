//! `wheel-creep`: wheels that creep in proportion to the force they transmit.

use model::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

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

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        vec![Form::whole(vec![Parameter::new("creep_s_per_kg", 0.002, [0.0, 0.5], 0.003)])]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        let creep = values.get("creep_s_per_kg") / (model.wheel_radius_m * model.wheel_radius_m);
        let inertia = model.inertia.clone();
        model.angles.push(Box::new(move |segment, angles| {
            // The time integral of the inertial force is the change of speed.
            for (i, angle) in angles.iter_mut().enumerate() {
                for k in 0..angle.len() {
                    let momentum: f64 = (0..segment.speed.len()).map(|j| inertia[(i, j)] * segment.speed[j][k]).sum();
                    angle[k] -= creep * momentum;
                }
            }
        }));
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let creep = values.get("creep_s_per_kg") / (model.wheel_radius_m * model.wheel_radius_m);
        let Some(inertia) = model.mechanics().map(|m| m.inertia) else { return };
        // Encoder minus rolled angle: the time integral of the inertial force is the change of speed.
        model.offsets.push(Box::new(move |_, segment| {
            let n = segment.speed.len();
            let momentum = |i: usize, k: usize| (0..n).map(|j| inertia[(i, j)] * segment.speed[j][k]).sum::<f64>();
            (0..n).map(|i| (0..segment.t.len()).map(|k| creep * momentum(i, k)).collect()).collect()
        }));
    }

    fn law_uncertainty(&self) -> f64 {
        // Creep grows with speed as well as with force.
        0.04
    }

    fn also(&self) -> Option<Link> {
        Some(Link::Drive)
    }
}
