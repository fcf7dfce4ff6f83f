//! `stribeck-friction`: friction that is larger near standstill.

use runs::robot::Robot;

use crate::drive::{DriveModel, smooth_sign};
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values};

/// Speed over which it turns round, in that of other friction: nearer to rest, because it is largest there.
const TURNS_ROUND: f64 = 0.375;

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
        self.forms_in(robot, &Sizes::of(robot))
    }

    fn forms_in(&self, _robot: &Robot, s: &Sizes) -> Vec<Form> {
        // Near rest beside the speed of the log: 1.5, 3 and 6 rad/s where wheels turn at 17.
        [0.09, 0.18, 0.36]
            .into_iter()
            .map(|w| {
                let drive = s.drive_nm;
                let bounds = [-0.1 * drive, drive.max(s.stall_nm)];
                let torque = Parameter::new("torque_nm", 0.01 * drive, bounds, 0.05 * drive);
                let speed =
                    Parameter::new("speed_rad_s", 0.018 * s.speed, [0.04 * s.speed, 0.7 * s.speed], f64::INFINITY);
                Form::whole(vec![torque.from(0.1 * drive), speed.from(w * s.speed)])
            })
            .collect()
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let (t, w) = (values.get("torque_nm"), values.find("speed_rad_s").unwrap_or(3.0));
        model.loads.push(Box::new(move |now, loads| {
            let width = TURNS_ROUND * now.segment.turning;
            for i in 0..now.speed.len() {
                loads.wheel[i] -= t * (-(now.speed[i] / w).powi(2)).exp() * smooth_sign(now.speed[i], width);
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
