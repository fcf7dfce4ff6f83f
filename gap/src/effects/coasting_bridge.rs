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
        vec![Form::whole(vec![Parameter::new("share", 0.02, [0.0, 1.0], 0.12)])]
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let share = values.get("share");
        let braking: Vec<f64> = model.axes.iter().map(|a| a.braking(model.gear_ratio)).collect();
        model.loads.push(Box::new(move |now, loads| {
            for (i, braking) in braking.iter().enumerate() {
                loads.wheel[i] += share * braking * (1.0 - now.duty[i].abs()) * now.speed[i];
            }
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("a duty staircase with the wheels lifted", 2.0))
    }
}
