//! `coasting-bridge`: a bridge that is open between its pulses, so that no current brakes there.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};

/// A bridge that is open between its pulses.
pub(super) struct CoastingBridge;

impl Effect for CoastingBridge {
    fn name(&self) -> &str {
        "coasting-bridge"
    }

    fn equation(&self) -> &str {
        "back-EMF e brakes as e (1 - share (1 - |u|)): between its pulses the bridge is open for that share of the time"
    }

    fn reference(&self) -> &str {
        "H-bridge decay modes: coast instead of brake"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn before_current(&self) -> bool {
        true
    }

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        // A bridge that is open between all its pulses has 1, about which an estimate scatters.
        vec![Form::whole(vec![Parameter::new("share", 0.02, [0.0, 1.3], 0.12)])]
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let share = values.get("share");
        model.loads.push(Box::new(move |now, loads| {
            // Of the motors as all effects leave them, whichever is applied first.
            for (i, braking) in now.braking.iter().enumerate() {
                loads.wheel[i] += share * braking * (1.0 - now.duty[i].abs()) * now.speed[i];
            }
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("a duty staircase with the wheels lifted", 2.0))
    }
}

#[cfg(test)]
mod tests {
    use std::borrow::Cow;

    use model::effects::Applied;
    use model::manoeuvre::{Manoeuvre, simulate};
    use runs::Log;
    use runs::frames::Pose;

    use super::*;
    use crate::pieces::{PIECE, segments};

    #[test]
    fn a_stronger_motor_brakes_more_whichever_effect_is_applied_first() {
        let robot = Robot::racbot();
        let run = simulate(Manoeuvre::StopAndGo, &Applied::of(&robot), &robot, Pose::default(), 1).unwrap();
        let logs = [Log::from(Cow::Owned(run))];
        let pieces = segments(&robot, &robot.geometry().unwrap(), &logs, PIECE);
        let segment = pieces.get(0);
        let stronger = crate::effects::find("torque-constant").unwrap();
        let values = |name: &str, value: f64| Values(vec![(name.to_owned(), value)]);
        let forces = |order: [usize; 2]| {
            let mut model = DriveModel::new(&robot);
            for effect in order {
                match effect {
                    0 => CoastingBridge.drive(&values("share", 0.6), &mut model),
                    _ => stronger.drive(&values("scale", 0.3), &mut model),
                }
            }
            model.forces(&segment).concat()
        };
        let (one, other) = (forces([0, 1]), forces([1, 0]));
        let most = one.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let apart = one.iter().zip(&other).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        assert!(most > 0.01 && apart < 1e-12 * most, "{apart} of {most} Nm");
    }
}
