//! `stribeck-friction`: friction that is larger near standstill.

use runs::robot::Robot;

use crate::drive::{DriveModel, smooth_sign};
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values};

/// Speed over which it turns round, rad/s: nearer to rest than other friction, because it is largest there.
const TURNS_ROUND: f64 = 0.15;

/// Friction that is larger near standstill.
pub(super) struct StribeckFriction;

impl Effect for StribeckFriction {
    fn name(&self) -> &str {
        "stribeck-friction"
    }

    fn equation(&self) -> &str {
        "torque -T exp(-(w / speed)^2) sign(w)"
    }

    fn reference(&self) -> &str {
        "Armstrong-Helouvry 1994"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        let s = Sizes::of(robot);
        [1.5, 3.0, 6.0]
            .into_iter()
            .map(|w| {
                let torque =
                    Parameter::new("torque_nm", 0.01 * s.stall_nm, [-0.1 * s.stall_nm, s.stall_nm], 0.05 * s.stall_nm);
                let speed = Parameter::new("speed_rad_s", 0.3, [0.7, 12.0], f64::INFINITY);
                Form::whole(vec![torque.from(0.1 * s.stall_nm), speed.from(w)])
            })
            .collect()
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let (t, w) = (values.get("torque_nm"), values.find("speed_rad_s").unwrap_or(3.0));
        model.loads.push(Box::new(move |now, loads| {
            for i in 0..now.speed.len() {
                loads.wheel[i] -= t * (-(now.speed[i] / w).powi(2)).exp() * smooth_sign(now.speed[i], TURNS_ROUND);
            }
        }));
    }

    fn law_uncertainty(&self) -> f64 {
        // How the extra friction falls with speed is a convention, and at rest it is not seen.
        0.1
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("a slow ramp of the duty with the wheels lifted", 3.0))
    }
}
