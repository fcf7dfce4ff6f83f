//! `wheel-slip`: wheels that slip when the force exceeds what friction holds.

use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values};
use crate::motion::MotionModel;

/// Friction from which a floor holds whatever rolls on it: rubber on a dry floor holds 0.6 to 1. Whether wheels are driven
/// beyond what holds them the logs tell.
const HOLDS: f64 = 1.0;
/// Height of the centre of mass, by which an acceleration shifts the weight from wheel to wheel.
const HEIGHT: &str = "centre_height_m";
/// Heights in radii of the wheels' circle: where the search begins, batteries and motors lying low, and at most, from which a
/// robot on usual floors tips over before it slips.
const LOW: f64 = 0.3;
const TALLEST: f64 = 1.2;

/// Wheels that slip when the force exceeds what friction holds.
pub(super) struct WheelSlip;

impl Effect for WheelSlip {
    fn name(&self) -> &str {
        "wheel-slip"
    }

    fn equation(&self) -> &str {
        "|traction force| <= friction_coefficient times the load of the wheel, beyond which it turns faster than it rolls; \
         an acceleration a moves the loads by the moment m a centre_height_m"
    }

    fn reference(&self) -> &str {
        "Coulomb; Moreau 1988"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        // What matters is the torque at which a wheel slips.
        let passes = robot.layout.wheels().iter().map(|w| w.roller_rad.cos()).fold(1.0, f64::min);
        let below = HOLDS / passes;
        let at = |mu| Parameter::new("friction_coefficient", 0.05, [0.02, 1.5], 0.0).from(mu).material_below(below);
        let rim = Sizes::of(robot).rim_m;
        let height = Parameter::new(HEIGHT, 0.1 * rim, [0.0, TALLEST * rim], f64::INFINITY).from(LOW * rim);
        let free = |mu: f64| vec![at(mu), height.clone()];
        [0.13, 0.18, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.95]
            .into_iter()
            .map(|mu| Form::whole(free(mu)))
            .collect()
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        let Some(mu) = values.find("friction_coefficient") else { return };
        let floor = model.floor_beneath();
        floor.friction_coefficient = Some(mu);
        floor.centre_m[2] = values.get(HEIGHT);
    }

    fn law_uncertainty(&self) -> f64 {
        // One coefficient stands for static and sliding friction, 5 to 20 % apart, and for all loads.
        0.1
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("pull the robot sideways with a spring scale until it slides", 5.0))
    }
}
