//! `battery-sag`: a supply that drops under load.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values};

/// A supply that drops under load.
pub(super) struct BatterySag;

impl Effect for BatterySag {
    fn name(&self) -> &str {
        "battery-sag"
    }

    fn equation(&self) -> &str {
        "supply V - drop_v - resistance_ohm times what the motors draw, the sum of duty times current"
    }

    fn reference(&self) -> &str {
        "battery data sheet"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn before_current(&self) -> bool {
        true
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        let s = Sizes::of(robot);
        let unit = robot.supply_v / (s.stall_a * robot.wheel_count() as f64);
        let r = Parameter::new("resistance_ohm", 0.05 * unit, [-0.05 * unit, 3.0 * unit], 0.25 * unit);
        let d = Parameter::new(
            "drop_v",
            0.02 * robot.supply_v,
            [-0.08 * robot.supply_v, 0.6 * robot.supply_v],
            // A supply that is low whatever the load looks like a weak motor; it sags only under load.
            f64::INFINITY,
        );
        vec![Form::whole(vec![r.clone()]), Form::whole(vec![r, d])]
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let (r, d) = (values.get("resistance_ohm"), values.get("drop_v"));
        model.supply_maps.push(Box::new(move |now, supply, currents| {
            // A bridge draws current from the battery in proportion to its duty.
            let drawn: f64 = now.duty.iter().zip(currents).map(|(u, i)| u * i).sum();
            (supply - d - r * drawn).max(0.0)
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("log supply_v at the motor terminals", 2.0))
    }
}
