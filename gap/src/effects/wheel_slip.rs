//! `wheel-slip`: wheels that slip when the force exceeds what friction holds.

use model::robot::Robot;
use nalgebra::{DMatrix, DVector};

use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

/// Wheels that slip when the force exceeds what friction holds.
pub(super) struct WheelSlip;

impl Effect for WheelSlip {
    fn name(&self) -> &str {
        "wheel-slip"
    }

    fn equation(&self) -> &str {
        "|traction force| <= friction_coefficient times normal force; beyond it the wheel spins"
    }

    fn reference(&self) -> &str {
        "Coulomb"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        let _ = robot;
        [0.15, 0.25, 0.4, 0.6]
            .into_iter()
            .map(|mu| Form::whole(vec![Parameter::new("friction_coefficient", 0.05, [0.02, 1.5], 0.0).from(mu)]))
            .collect()
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        let Some(mu) = values.find("friction_coefficient") else { return };
        let n = model.wheels.len();
        let grip = mu * model.mass_kg * 9.806_65 / n as f64 * model.wheel_radius_m;
        let inertia = model.inertia.clone();
        let Some(inverse) = (inertia.clone() + DMatrix::identity(n, n) * (1e-9 * inertia.trace())).try_inverse() else {
            return;
        };
        model.angles.push(Box::new(move |segment, angles| {
            let speed_at = |k: usize| DVector::from_fn(n, |i, _| segment.speed[i][k]);
            let mut ground = speed_at(0);
            let mut lost = DVector::<f64>::zeros(n);
            for k in 1..segment.t.len() {
                let dt = segment.t[k] - segment.t[k - 1];
                let wheel = speed_at(k);
                let torque = (&inertia * (&wheel - &ground)) / dt;
                if torque.iter().any(|t| t.abs() > grip) {
                    ground += &inverse * torque.map(|t| t.clamp(-grip, grip)) * dt;
                } else {
                    ground.copy_from(&wheel);
                }
                lost += (&wheel - &ground) * dt;
                for (angle, l) in angles.iter_mut().zip(lost.iter()) {
                    angle[k] -= l;
                }
            }
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("pull the robot sideways with a spring scale until it slides", 5.0))
    }
}
