//! `stribeck-friction`: friction that is larger near standstill.

use runs::robot::Robot;

use crate::drive::{DriveModel, smooth_sign};
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values};

/// Speed over which it turns round, in that of other friction: nearer to rest, because it is largest there.
const TURNS_ROUND: f64 = 0.375;

/// Speed over which it falls, at least, in that at which friction turns round: there nine tenths of a direction are known,
/// and within lies the friction that the file has. On a simulated robot with 720 counts a wheel turn, whose friction turns
/// round within 0.04 rad/s, 0.33 rad/s were named on a control, at a turning round of 0.29; on a motor of the blind bench
/// 3.0 rad/s were true, at 1.8.
const BEYOND: f64 = 1.5;
/// The same as a share of the speed of the log.
const LEAST: f64 = 0.04;

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
        let speeds = [(LEAST * s.speed).max(BEYOND * s.turns_round()), 0.7 * s.speed];
        // Near rest beside the speed of the log: 1.5, 3 and 6 rad/s where wheels turn at 17.
        let from = [0.09, 0.18, 0.36].into_iter().filter(|w| w * s.speed > speeds[0]);
        from.map(|w| {
            let drive = s.drive_nm;
            let bounds = [-0.1 * drive, drive.max(s.stall_nm)];
            let torque = Parameter::new("torque_nm", 0.01 * drive, bounds, 0.05 * drive);
            let speed = Parameter::new("speed_rad_s", 0.018 * s.speed, speeds, f64::INFINITY).blurred_below();
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_falls_over_more_than_the_speed_at_which_friction_turns_round() {
        let robot = Robot::racbot();
        let fine = Sizes::of(&robot);
        let least = |s: &Sizes| -> Vec<f64> {
            StribeckFriction.forms_in(&robot, s).iter().map(|form| form.free[1].bounds[0]).collect()
        };
        assert!(least(&fine).len() == 3 && (least(&fine)[0] / (LEAST * fine.speed) - 1.0).abs() < 1e-9);
        // Counts of which one within the smoothing is a tenth of the speed of the log, and all of it.
        let coarse = |share: f64| Sizes { count_rad: share * fine.speed * 0.03, ..fine };
        let tenth = least(&coarse(0.1));
        assert!(
            tenth.len() == 2 && tenth.iter().all(|low| (low / (0.15 * fine.speed) - 1.0).abs() < 0.01),
            "{tenth:?}"
        );
        assert_eq!(least(&coarse(1.0)), Vec::<f64>::new());
    }
}
